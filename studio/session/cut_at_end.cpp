#include "studio/session/cut_at_end.h"

#include <utility>
#include <vector>

#include "recordings/replay.h"

namespace ctpm::session {
namespace {

bool may_cut(const Model& model, const recordings::TickRecord& record) {
  for (std::size_t hand = 0; hand < std::size_t(model.hands); ++hand)
    if (model.is_scalpel(record.inputs.hand(hand).tool)) return true;
  return record.severed != 0;
}

}  // namespace

Result<CutAtEnd> cut_at_end(recordings::SessionReader& session) {
  Result<recordings::Keyframe> last = session.keyframe_at_or_before(session.tick_count());
  if (!last) return last.errors();
  const auto records = session.ticks(last->tick, session.tick_count());
  if (!records) return records.errors();
  std::size_t cutting = records->size();
  while (cutting > 0 && !may_cut(session.start().model, (*records)[cutting - 1])) --cutting;
  if (cutting == 0) return CutAtEnd{std::move(last->state)};
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(session);
  if (!cursor) return cursor.errors();
  if (const Result<Done> there = cursor->seek(last->tick + std::int64_t(cutting)); !there) return there.errors();
  return CutAtEnd{cursor->state(), cursor->same_so_far()};
}

}  // namespace ctpm::session
