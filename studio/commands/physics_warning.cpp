#include "studio/commands/physics_warning.h"

#include "studio/commands/console.h"

namespace ctpm::commands {

void warn_of_physics(const recordings::SessionReader& session) {
  const std::string remark = recordings::physics_remark(session.start().physics_revision);
  if (!remark.empty()) print_remark(session.path() + ": warning: " + remark);
  for (const std::string& choice : session.remarks()) print_remark(session.path() + ": warning: " + choice);
}

}  // namespace ctpm::commands
