#include "studio/server/training.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

#include "studio/output/json_writer.h"
#include "studio/server/idle_pause.h"
#include "studio/server/picture.h"
#include "studio/server/text.h"
#include "studio/session/recent_times.h"
#include "studio/session/record_session.h"
#include "studio/session/tool_depth.h"
#include "studio/session/unkept_session.h"
#include "studio/session/urgency.h"

namespace ctpm::server {
namespace {

namespace fs = std::filesystem;

constexpr auto kLookAgain = std::chrono::milliseconds(1);  // whether the next tick is done

/// Button n is pressed while tool n is in the hand.
std::vector<std::string> buttons_of(const Model& model) {
  std::vector<std::string> buttons;
  for (std::size_t i = 0; i < std::min<std::size_t>(32, model.tools.size()); ++i)
    buttons.push_back(std::to_string(i) + "=" + model.tools[i].name);
  return buttons;
}

/// A value that the source gave; 0 if it gave none.
double value_of(const recordings::SessionStatistics& statistics, std::string_view name) {
  const auto& values = statistics.values;
  const auto found = std::find_if(values.begin(), values.end(), [&](const auto& value) { return value.first == name; });
  return found == values.end() ? 0 : found->second;
}

/// `tick`: its length [s]. `began`: device_clock() when the first tick began.
std::string ended_text(const std::string& shown, const Result<session::RecordOutcome>& outcome, double tick,
                       double began) {
  output::JsonWriter json;
  json.begin_object().member("path", std::string_view(shown)).key("errors");
  write_errors(json, outcome ? Errors{} : outcome.errors());
  if (outcome) {
    const recordings::SessionStatistics& s = outcome->statistics;
    json.member("began_s", began)
        .member("tick_s", tick)
        .member("ticks", outcome->run.ticks)
        .member("late_ticks", outcome->run.late_ticks);
    json.key("late_by").begin_object();
    for (const recordings::LateCause cause : recordings::kLateCauses)
      if (const std::int64_t count = outcome->run.late_by.of(cause); count > 0)
        json.member(recordings::name_of(cause), count);
    json.end_object()
        .member("waited_for_processor_s", outcome->run.waited)
        .member("slip_s", s.slip)
        .member("slip_max_s", s.slip_max)
        .member("fault", std::string_view(outcome->run.fault))
        .member("refused", stepping::is_refused(outcome->run.status))
        .member("max_force_n", s.max_force)
        .member("max_depth_m", s.max_depth)
        .member("severed", s.severed)
        .member("tick_time_p50_s", s.tick_time_p50)
        .member("tick_time_p99_s", s.tick_time_p99)
        .member("pose_wait_p50_s", value_of(s, "device_pose_wait_p50_s"))
        .member("pose_wait_p99_s", value_of(s, "device_pose_wait_p99_s"))
        .member("pose_way_p99_s", value_of(s, "device_pose_way_p99_s"))
        .member("poses_within_5ms", value_of(s, "device_poses_within_5ms"));
  }
  return event_text("train_ended", json.end_object().text());
}

}  // namespace

Result<std::unique_ptr<Training>> Training::begin(std::shared_ptr<const recordings::SessionStart> start,
                                                  const TrainingRequest& request, std::uint32_t stage,
                                                  std::shared_ptr<Outbox> outbox) {
  auto named = std::make_shared<recordings::SessionStart>(*start);
  std::unique_ptr<Training> training(new Training(named, request, stage, std::move(outbox)));
  const bool has_device = devices::asks_for_device(request.device);
  const Result<std::map<std::string, std::string>> metadata =
      has_device ? training->follow_device() : training->follow_hands();
  if (!metadata) return metadata.errors();
  for (const auto& [key, value] : *metadata) named->metadata[key] = value;
  if (!has_device) named->metadata["source"] = "studio";
  training->outbox_->send_bytes(shapes_message(start->model, stage));
  training->ticks_ = std::thread([t = training.get()] { t->tick(); });
  training->pictures_ = std::thread([t = training.get()] { t->show(); });
  return training;
}

/// Makes the page's hands the source. Returns what the session stores about them.
Result<std::map<std::string, std::string>> Training::follow_hands() {
  const Model& model = start_->model;
  devices::DeviceRequest device;
  device.buttons = buttons_of(model);
  device.most_speed_mm_per_s = 1e3 * request_.most_speed;
  device.gives_way_n = request_.limits.force_n, device.gives_way_mm = 1e3 * request_.limits.depth_m;
  device.timeout_s = 1e5;  // a hidden page sends nothing; its reader ends the session
  const auto make_hand = [&](std::size_t number) {
    auto hand = std::make_unique<PageHand>();
    hands_[number] = hand.get();
    return hand;
  };
  if (model.hands > 1) {
    devices::DeviceRequest second;
    second.buttons = device.buttons;
    Result<devices::FollowedPair> pair =
        devices::follow_devices(device, make_hand(0), devices::as_second_hand(second, device), make_hand(1), model);
    if (!pair) return pair.errors();
    followed_ = {&pair->source->of_hand(0), &pair->source->of_hand(1)};
    source_ = std::move(pair->source);
    return std::move(pair->metadata);
  }
  Result<devices::FollowedDevice> followed = devices::follow_device(device, make_hand(0), model);
  if (!followed) return followed.errors();
  followed_ = {followed->source.get()};
  source_ = std::move(followed->source);
  return std::move(followed->metadata);
}

/// Makes a device the source, as `record` does. Returns what the session stores about it.
Result<std::map<std::string, std::string>> Training::follow_device() {
  Result<devices::OpenedDevice> opened = devices::open_device(request_.device);
  if (!opened) return opened.errors();
  Result<devices::FollowedDevice> followed =
      devices::follow_device(request_.device, std::move(opened->device), start_->model);
  if (!followed) return followed.errors();
  awaited_ = opened->place;
  followed_ = {followed->source.get()};
  source_ = std::move(followed->source);
  return std::move(followed->metadata);
}

Training::Training(std::shared_ptr<const recordings::SessionStart> start, const TrainingRequest& request,
                   std::uint32_t stage, std::shared_ptr<Outbox> outbox)
    : start_(std::move(start)), request_(request), stage_(stage), outbox_(std::move(outbox)) {}

Training::~Training() {
  ends_ = true;
  if (ticks_.joinable()) ticks_.join();
  if (pictures_.joinable()) pictures_.join();
}

/// Sends an event with a text.
void Training::tell(const char* event, const std::string& text) {
  const output::JsonWriter content =
      output::JsonWriter().begin_object().member("text", std::string_view(text)).end_object();
  outbox_->send(event_text(event, content.text()));
}

void Training::tick() {
  session::become(session::Urgency::tick);
  const auto should_stop = [this] { return ends_.load(); };
  if (std::all_of(followed_.begin(), followed_.end(), [&](devices::DeviceSource* hand) {
        return hand->wait_for_first_pose(should_stop, [this](const std::string& why) { tell("train_waits", why); });
      })) {
    const IdlePause pause;
    session::RunOptions options;
    options.threads = session::threads_for(start_->model);
    options.should_stop = should_stop;
    session::RecentTimes times;
    double began = INFINITY;  // a tick may begin late, never early
    options.watch = [&](const State& state, const recordings::TickRecord& record, const session::RunOutcome& so_far) {
      const double done = double(state.tick - 1) * start_->model.tick + record.slip;
      began = std::min(began, devices::device_clock() - record.tick_time - done);
      times.add(record.tick_time);
      newest_.offer(state, record, so_far.late_ticks, times.p99());
    };
    options.note = [this](const std::string& text) { tell("train_notes", text); };
    options.tell = [this](const std::string& problem) { tell("train_fails", problem); };
    const session::UnkeptSession unkept;
    const std::string file = request_.file.empty() ? unkept.file() : request_.file;
    const Result<session::RecordOutcome> outcome = session::record_session(*start_, *source_, file, false, options);
    outbox_->send(ended_text(request_.file.empty() ? "" : request_.shown, outcome, start_->model.tick, began));
  } else {
    outbox_->send(ended_text("", Error{request_.shown, "ended before the hand moved; nothing was recorded", ""},
                             start_->model.tick, 0));
  }
  has_ended_ = true;
  pace_.ready();
}

void Training::show() {
  const Model& model = start_->model;
  PictureMaker maker(model, stage_);
  session::ToolDepth depth(model);
  FrameFacts facts;
  facts.is_live = true;
  outbox_->show(maker.make(start_->initial_state, facts));
  const auto make = [&](const LiveTick& tick) {
    facts.tick = tick.state.tick, facts.force = tick.record.tool_force;
    facts.depth = depth.of(tick.record.inputs, tick.record.depth, tick.state);
    facts.contacts = tick.record.contacts, facts.tick_time = tick.record.tick_time;
    facts.severed = severed_in(tick.state), facts.late_ticks = tick.late_ticks;
    facts.tick_p99 = tick.tick_p99, facts.slip = tick.record.slip;
    facts.hand = tick.record.inputs.position;
    facts.second = {tick.record.second, tick.record.inputs.second.position};
    facts.second.report.depth = depth.of(tick.record.inputs.second, tick.record.second.depth, tick.state);
    outbox_->show(maker.make(tick.state, facts));
  };
  while (!has_ended_) {
    pace_.wait();
    newest_.ask();
    while (!newest_.take(make) && !has_ended_) std::this_thread::sleep_for(kLookAgain);
  }
}

}  // namespace ctpm::server
