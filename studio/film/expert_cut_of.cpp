#include "studio/film/expert_cut_of.h"

#include "studio/session/cut_at_end.h"

namespace ctpm::film {

Result<std::shared_ptr<const render::ExpertCut>> expert_cut_of(recordings::SessionReader& expert) {
  const Result<session::CutAtEnd> end = session::cut_at_end(expert);
  if (!end) return end.errors();
  return std::make_shared<const render::ExpertCut>(expert.start().model, end->state);
}

}  // namespace ctpm::film
