#include "studio/server/stage.h"

#include <algorithm>
#include <utility>

#include "studio/compare/session_track.h"
#include "studio/film/expert_cut_of.h"
#include "studio/film/reel.h"
#include "studio/server/glimpse.h"
#include "studio/server/idle_pause.h"
#include "studio/server/seeker.h"
#include "studio/server/text.h"
#include "studio/session/urgency.h"

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
    : reader_(std::move(reader)),
      moments_(std::move(moments)),
      number_(number),
      outbox_(std::move(outbox)),
      cuts_(std::make_shared<DrawnCuts>(reader_.start().model, number)),
      ahead_(reader_.path(), reader_.start().model, number, cuts_),
      spares_(reader_) {
  replay_thread_ = std::thread([this] { replay(); });
  glimpse_thread_ = std::thread([this] { glance(); });
}

Stage::~Stage() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  news_.notify_all();
  replay_thread_.join();
  glimpse_thread_.join();
}

void Stage::show(std::int64_t tick, std::uint32_t request) {
  {
    const std::lock_guard lock(mutex_);
    newest_ = {std::clamp<std::int64_t>(tick, 0, reader_.tick_count()), request};
    is_wanted_ = true;
    wants_glimpse_ = is_replaying_;  // else the replay says whether it needs one
  }
  moments_->aim(tick), moments_->rest(Moments::Rest::all), IdlePause::hold();
  news_.notify_all();
}

void Stage::ready(std::uint32_t request) {
  {
    const std::lock_guard lock(mutex_);
    drawn_ = request, follows_page_ = true;
  }
  news_.notify_all();
}

/// See film::full_scale_of().
Result<double> Stage::full_scale(render::ElementQuantity quantity) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = full_scales_.find(quantity); known != full_scales_.end()) return known->second;
  }
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(reader_.path());  // of this thread
  if (!reader) return reader.errors();
  const Result<double> found = film::full_scale_of({&*reader}, quantity);
  if (!found) return found;
  const std::lock_guard lock(mutex_);
  return full_scales_[quantity] = *found;
}

/// What an expert cut in that session; null: it is of another scene, or damaged, which is said once.
std::shared_ptr<const render::ExpertCut> Stage::expert_of(const std::string& file) {
  const std::optional<KnownFiles::Stamp> stamp = KnownFiles::stamp_of(file);
  {
    const std::lock_guard lock(mutex_);
    if (stamp && known_expert_.file == file && known_expert_.stamp == stamp) return known_expert_.cut;
  }
  const auto find = [&]() -> Result<std::shared_ptr<const render::ExpertCut>> {
    Result<recordings::SessionReader> reader = recordings::SessionReader::open(file);
    if (!reader) return reader.errors();
    if (!compare::check_same_scene(*reader, reader_)) return std::shared_ptr<const render::ExpertCut>();
    return film::expert_cut_of(*reader);
  };
  const Result<std::shared_ptr<const render::ExpertCut>> cut = find();
  if (!cut) outbox_->send(stage_failed(number_, cut.errors()));
  const std::lock_guard lock(mutex_);
  known_expert_ = {file, stamp, cut ? *cut : nullptr};
  return known_expert_.cut;
}

/// The one whose cut is shown.
std::shared_ptr<const render::ExpertCut> Stage::expert() {
  const std::lock_guard lock(mutex_);
  return plan_ ? plan_->look.draw.expert : nullptr;
}

/// See film::telling_state(). Null: the session is damaged.
const State* Stage::told() {
  const std::lock_guard lock(told_mutex_);
  if (!told_) {
    Result<recordings::SessionReader> reader = recordings::SessionReader::open(reader_.path());  // of this thread
    if (!reader) return nullptr;
    const session::TickRange whole{0, reader->tick_count()};
    const Result<std::vector<film::Moment>> all = film::all_moments(*reader, whole);
    Result<State> state = film::telling_state(*reader, whole, all ? *all : std::vector<film::Moment>());
    if (!state) return nullptr;
    told_ = std::make_unique<State>(std::move(*state));
  }
  return told_.get();
}

Result<DrawingPlan> Stage::draw_as(const DrawingRequest& request, const std::vector<std::shared_ptr<Stage>>& shown) {
  Result<DrawingPlan> plan = plan_drawing(reader_, request, told());
  if (!plan) return plan;
  if (render::DrawOptions& draw = plan->look.draw; draw.view == render::View::elements) {
    double largest = 0;
    for (const std::shared_ptr<Stage>& stage : shown) {
      const Result<double> found = stage->full_scale(draw.quantity);
      if (!found) return found.errors();
      largest = std::max(largest, *found);
    }
    draw.full_scale = views::unit_of(draw.quantity) * largest;
    plan->legend = render::legend_of(reader_.start().model, draw);
  }
  if (!request.expert.empty()) plan->look.draw.expert = expert_of(request.expert);
  const std::lock_guard lock(mutex_);
  plan_ = *plan, is_plan_new_ = true;
  return plan;
}

/// Takes over the newest plan, in the thread that replays. Returns whether there is something to draw.
Result<bool> Stage::follow_plan(Drawing& drawing) {
  std::optional<DrawingPlan> plan;
  {
    const std::lock_guard lock(mutex_);
    if (!plan_ || !plan_->size) return false;
    if (!std::exchange(is_plan_new_, false)) return true;
    plan = plan_;
  }
  const Result<Done> followed = drawing.follow(*plan);
  if (followed) return true;
  const std::lock_guard lock(mutex_);
  if (!is_plan_new_) plan_.reset();
  return followed.errors();
}

/// Waits for the newest wish and takes it; nothing: the stage ends.
std::optional<Stage::Wish> Stage::next() {
  std::unique_lock lock(mutex_);
  news_.wait(lock, [&] { return is_wanted_ || ends_; });
  if (ends_) return std::nullopt;
  is_wanted_ = false, is_replaying_ = true;
  glimpse_due_ = Clock::now() + kPatience;
  news_.notify_all();
  return newest_;
}

/// Waits until the newest wish needs a glimpse, or its replay takes long; nothing: the stage ends.
std::optional<Stage::Wish> Stage::next_glimpse() {
  std::unique_lock lock(mutex_);
  while (!wants_glimpse_ && !ends_) {
    if (glimpse_due_ == Clock::time_point::max())
      news_.wait(lock);
    else
      news_.wait_until(lock, glimpse_due_);
    if (Clock::now() >= glimpse_due_) wants_glimpse_ = true;
  }
  if (ends_) return std::nullopt;
  glimpse_due_ = Clock::time_point::max();
  wants_glimpse_ = false, is_glancing_ = true;
  return newest_;
}

/// Whether the present request need not be finished.
bool Stage::is_outdated() {
  const std::lock_guard lock(mutex_);
  return ends_ || is_wanted_;
}

/// Shows the picture of a wish, unless a newer one came, or the replayed picture was there before the glimpse.
void Stage::show(Picture picture, const Wish& wish, bool is_glimpse) {
  const std::lock_guard lock(mutex_);
  if (wish.request != newest_.request || (is_glimpse && !is_replaying_)) return;
  if (is_glimpse)
    glimpsed_ = wish.request;
  else
    is_replaying_ = wants_glimpse_ = false, glimpse_due_ = Clock::time_point::max();
  outbox_->show(std::move(picture));
  IdlePause::hold();
  moments_->rest(is_glimpse ? Moments::Rest::replaying : Moments::Rest::none);
}

/// The replay would only hold up the glimpse, and a browser that draws it on the same processors, and begins where that
/// read from the file already.
void Stage::wait_for_glimpse(const Wish& wish) {
  std::unique_lock lock(mutex_);
  if (wish.request != newest_.request) return;
  wants_glimpse_ = true;
  news_.notify_all();
  news_.wait(lock, [&] { return (!wants_glimpse_ && !is_glancing_) || is_wanted_ || ends_; });
  if (glimpsed_ != wish.request) return;  // there is none of that moment
  news_.wait_for(lock, follows_page_ ? kDrawing : kUsualDrawing,
                 [&] { return drawn_ == wish.request || is_wanted_ || ends_; });
}

/// A long replay of a stage has its turn until what is returned goes away: beside all of them there is a processor for
/// the browser. Null: the request is outdated.
Stage::Turn Stage::wait_for_turn() {
  static std::counting_semaphore<> turns(std::max(1, int(std::thread::hardware_concurrency()) - 1));
  while (!is_outdated())
    if (turns.try_acquire_for(std::chrono::milliseconds(2))) return Turn(&turns);
  return nullptr;
}

void Stage::replay() {
  session::become(session::Urgency::picture);
  Seeker seeker(reader_, *moments_, spares_);
  PictureMaker maker(reader_.start().model, number_, cuts_);
  Drawing drawing(reader_);
  session::ToolDepth depth(reader_.start().model);
  while (const std::optional<Wish> wish = next()) {
    const bool is_far = seeker.is_far(wish->tick);
    if (is_far) wait_for_glimpse(*wish);
    const Turn turn = is_far ? wait_for_turn() : nullptr;
    if (is_far && !turn) continue;
    const Result<bool> there = seeker.go_to(wish->tick, [this] { return is_outdated(); });
    if (!there) outbox_->send(stage_failed(number_, there.errors())), moments_->rest(Moments::Rest::none);
    if (!there || !*there) continue;
    const State& state = seeker.cursor().state();
    maker.show(expert());
    Picture picture = maker.make(state, facts(seeker, wish->request, depth));
    const Result<bool> is_drawn = follow_plan(drawing);
    if (!is_drawn) outbox_->send(stage_failed(number_, is_drawn.errors()));
    if (is_drawn && *is_drawn) {
      Result<std::string> drawn = drawing.draw(state, seeker.cursor().tick(), number_, wish->request);
      if (drawn) picture.drawing = std::move(*drawn);
    }
    show(std::move(picture), *wish, false);
  }
}

void Stage::end_glance() {
  const std::lock_guard lock(mutex_);
  is_glancing_ = false;
  news_.notify_all();
}

/// Shows what is known of moments without a simulation. Damaged parts of the session and its beginning have no glimpse.
void Stage::glance() {
  session::become(session::Urgency::picture);
  Result<recordings::SessionReader> reader = recordings::SessionReader::open(reader_.path());
  if (!reader) {  // it went away since it was opened: the replay says so
    while (next_glimpse()) end_glance();
    return;
  }
  Glimpses glimpses(*reader, *moments_);
  PictureMaker maker(reader_.start().model, number_, cuts_);
  for (;; end_glance()) {
    const std::optional<Wish> wish = next_glimpse();
    if (!wish) return;
    if (wish->tick == 0) continue;
    Result<Glimpses::Glimpse> glimpse = glimpses.of(wish->tick);
    if (!glimpse) continue;
    const recordings::TickRecord& record = glimpse->record;
    FrameFacts facts;
    facts.request = wish->request, facts.is_glimpse = true, facts.tick = wish->tick;
    facts.severed = severed_in(glimpse->state);
    facts.hand = record.inputs.position, facts.force = record.tool_force, facts.depth = record.depth;
    facts.contacts = record.contacts, facts.tick_time = record.tick_time, facts.slip = record.slip;
    facts.second = {record.second, record.inputs.second.position};
    maker.show(expert());
    show(maker.make_glimpse(std::move(glimpse->state), facts), *wish, true);
  }
}

FrameFacts Stage::facts(const Seeker& seeker, std::uint32_t request, session::ToolDepth& depth) {
  const recordings::ReplayCursor& cursor = seeker.cursor();
  FrameFacts facts;
  facts.request = request;
  facts.is_same = seeker.is_same();
  facts.tick = cursor.tick();
  facts.severed = severed_in(cursor.state());
  facts.hand = cursor.state().last_inputs.position;
  facts.second.hand = cursor.state().last_inputs.second.position;
  if (cursor.tick() == 0) return facts;  // nothing was simulated yet
  const State& state = cursor.state();
  facts.force = cursor.report().tool_force, facts.contacts = cursor.report().contacts;
  facts.second.report = cursor.report().second;
  facts.depth = depth.of(state.last_inputs, cursor.report().depth, state);
  facts.second.report.depth = depth.of(state.last_inputs.second, cursor.report().second.depth, state);
  facts.tick_time = cursor.record().tick_time, facts.slip = cursor.record().slip;
  return facts;
}

}  // namespace ctpm::server
