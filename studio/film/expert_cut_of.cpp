#include "studio/film/expert_cut_of.h"

#include <utility>

#include "studio/session/cut_at_end.h"

namespace ctpm::film {

Result<std::shared_ptr<const render::ExpertCut>> expert_cut_of(recordings::SessionReader& expert) {
  const Result<session::CutAtEnd> end = session::cut_at_end(expert);
  if (!end) return end.errors();
  return std::make_shared<const render::ExpertCut>(expert.start().model, end->state);
}

Result<Done> pair_up(std::vector<recordings::SessionReader*>& sessions, bool is_ghost, bool has_line,
                     ExportOptions& options) {
  recordings::SessionReader& expert = *sessions[is_ghost ? 1 : 0];
  if (is_ghost) options.ghost = sessions.back(), sessions.pop_back();
  if (!has_line) return Done{};
  Result<std::shared_ptr<const render::ExpertCut>> cut = expert_cut_of(expert);
  if (!cut) return cut.errors();
  options.expert = std::move(*cut);
  return Done{};
}

}  // namespace ctpm::film
