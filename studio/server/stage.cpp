#include "studio/server/stage.h"

#include <algorithm>

#include "studio/server/text.h"

namespace ctpm::server {

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

/// Whether the present request need not be finished.
bool Stage::is_outdated() {
  const std::lock_guard lock(mutex_);
  return ends_ || wanted_ >= 0;
}

/// Shows what is known of a moment without a simulation. Damaged parts of the session have no glimpse.
void Stage::show_glimpse(PictureMaker& maker, Seeker& seeker, std::int64_t tick, std::uint32_t request) {
  const Result<Seeker::Glimpse> glimpse = seeker.glimpse(tick);
  if (!glimpse) return;
  const recordings::TickRecord& record = glimpse->record;
  FrameFacts facts;
  facts.request = request, facts.is_glimpse = true, facts.tick = tick, facts.severed = severed_in(glimpse->state);
  facts.hand = record.inputs.position, facts.force = record.tool_force, facts.depth = record.depth;
  facts.contacts = record.contacts, facts.tick_time = record.tick_time, facts.slip = record.slip;
  facts.second = {record.second, record.inputs.second.position};
  outbox_->show(maker.make(glimpse->state, facts));
}

FrameFacts Stage::facts(const Seeker& seeker, std::uint32_t request) {
  const recordings::ReplayCursor& cursor = seeker.cursor();
  FrameFacts facts;
  facts.request = request;
  facts.is_same = seeker.is_same();
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
  Seeker seeker(reader_, *moments_);
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
    if (seeker.is_far(tick)) show_glimpse(maker, seeker, tick, request);
    const Result<bool> there = seeker.go_to(tick, [this] { return is_outdated(); });
    if (!there)
      outbox_->send(stage_failed(number_, there.errors()));
    else if (*there)
      outbox_->show(maker.make(seeker.cursor().state(), facts(seeker, request)));
  }
}

}  // namespace ctpm::server
