#include "studio/server/stage.h"

#include <algorithm>
#include <chrono>

#include "studio/server/text.h"

namespace ctpm::server {
namespace {

using Clock = std::chrono::steady_clock;

/// A request that came later replaces the present one, unless the page has waited this long for a picture.
constexpr auto kPatience = std::chrono::milliseconds(100);

}  // namespace

Result<std::unique_ptr<Stage>> Stage::open(const std::string& file, std::uint32_t number,
                                           std::shared_ptr<Outbox> outbox) {
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(file);
  if (!reader) return reader.errors();
  Result<std::unique_ptr<Moments>> moments = Moments::open(file);
  if (!moments) return moments.errors();
  outbox->send_bytes(shapes_message(reader->start().model, number));
  return std::unique_ptr<Stage>(new Stage(std::move(*reader), std::move(*moments), number, std::move(outbox)));
}

Stage::Stage(recordings::SessionReader reader, std::unique_ptr<Moments> moments, std::uint32_t number,
             std::shared_ptr<Outbox> outbox)
    : reader_(std::move(reader)), moments_(std::move(moments)), number_(number), outbox_(std::move(outbox)) {
  thread_ = std::thread([this] { work(); });
}

Stage::~Stage() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  news_.notify_all();
  thread_.join();
}

void Stage::show(std::int64_t tick, std::uint32_t request) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = std::clamp<std::int64_t>(tick, 0, reader_.tick_count());
    request_ = request;
  }
  moments_->aim(tick);
  news_.notify_all();
}

/// Whether the present request need not be finished. A newer one ends it only while it `is_young`.
bool Stage::is_outdated(bool is_young) {
  const std::lock_guard lock(mutex_);
  return ends_ || (is_young && wanted_ >= 0);
}

/// Moves the cursor to `tick` from wherever it is nearest. False if a newer request came on the way.
Result<bool> Stage::go_to(recordings::ReplayCursor& cursor, std::int64_t tick) {
  const Clock::time_point began = Clock::now();
  // The last tick is simulated in any case, because its report belongs to the picture.
  const std::int64_t before = std::max<std::int64_t>(0, tick - 1);
  const auto [near, kept] = moments_->before(before);
  if (before < cursor.tick() || near > cursor.tick()) {
    if (kept)
      cursor.resume(near, kept->state);
    else if (const Result<Done> found = cursor.seek(near); !found)
      return found.errors();
    was_same_ = !kept || kept->is_same;
  }
  constexpr std::int64_t kAsk = 20;  // ticks between two looks for a newer request
  while (cursor.tick() < tick) {
    if (cursor.tick() % kAsk == 0 && is_outdated(Clock::now() - began < kPatience)) return false;
    const Result<bool> stepped = cursor.step();
    if (!stepped) return stepped.errors();
    if (!*stepped) break;
  }
  return true;
}

FrameFacts Stage::facts(const recordings::ReplayCursor& cursor, std::uint32_t request) {
  FrameFacts facts;
  facts.request = request;
  facts.is_same = was_same_ && cursor.same_so_far();
  facts.tick = cursor.tick();
  facts.severed = severed_in(cursor.state());
  facts.hand = cursor.state().last_inputs.position;
  facts.second.hand = cursor.state().last_inputs.second.position;
  if (cursor.tick() == 0) return facts;  // nothing was simulated yet
  facts.force = cursor.report().tool_force, facts.depth = cursor.report().depth;
  facts.contacts = cursor.report().contacts, facts.second.report = cursor.report().second;
  facts.tick_time = cursor.record().tick_time, facts.slip = cursor.record().slip;
  return facts;
}

void Stage::work() {
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(reader_);
  if (!cursor) return outbox_->send(stage_failed(number_, cursor.errors()));
  PictureMaker maker(reader_.start().model, number_);
  for (;;) {
    std::int64_t tick;
    std::uint32_t request;
    {
      std::unique_lock lock(mutex_);
      news_.wait(lock, [&] { return wanted_ >= 0 || ends_; });
      if (ends_) return;
      tick = std::exchange(wanted_, -1), request = request_;
    }
    const Result<bool> there = go_to(*cursor, tick);
    if (!there)
      outbox_->send(stage_failed(number_, there.errors()));
    else if (*there)
      outbox_->show(maker.make(cursor->state(), facts(*cursor, request)));
  }
}

}  // namespace ctpm::server
