#include "studio/session/whole_verdict.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <vector>

#include "core/model/physics_revision.h"
#include "core/stepping/step.h"
#include "scenes/scene_file.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/number_text.h"
#include "studio/session/event_watch.h"

namespace ctpm::session {
namespace {

using recordings::Event;

constexpr std::int64_t kReadTicks = 10000;  // held in memory at a time

/// An event is known this many ticks after its own at most; twice what an EventWatch waits.
constexpr std::int64_t kKnownAfter = 600;

/// What a replay says of a tick and its record does not.
struct TissueNews {
  std::int32_t came_loose = 0, inverted = 0;
};
using NewsByTick = std::map<std::int64_t, TissueNews>;

/// The events that follow from the ticks.
Result<std::vector<Event>> find_events(recordings::SessionReader& reader, const NewsByTick& news, CutEnds cut_ends) {
  const recordings::SessionStart& start = reader.start();
  const Result<scenes::SceneText> scene = scenes::read_scene(start.scene_text, reader.path());
  std::vector<Event> found;
  EventWatch watch(
      start.model, scene ? loading::damage_force_of(scene->spec) : 0,
      [&](Event event) { found.push_back(std::move(event)); }, cut_ends);
  const std::int64_t count = reader.tick_count();
  for (std::int64_t from = 0; from < count; from += kReadTicks) {
    const auto records = reader.ticks(from, std::min(from + kReadTicks, count));
    if (!records) return records.errors();
    for (std::int64_t tick = from; const recordings::TickRecord& record : *records) {
      stepping::StepReport report;
      report.tool_force = record.tool_force, report.depth = record.depth;
      report.contacts = record.contacts, report.severed = record.severed, report.second = record.second;
      if (const auto more = news.find(tick); more != news.end())
        report.came_loose = more->second.came_loose, report.inverted = more->second.inverted;
      watch.look(tick++, record.inputs, report);
    }
  }
  watch.finish(count);
  return found;
}

std::string shown(const Event& event, const Model& model) {
  return std::string(recordings::name_of(event.kind)) + " at " + output::fixed(double(event.tick) * model.tick, 3) +
         " s";
}

/// The first stored event that is not found anew, or the first found one that is not stored; empty if there is none.
Result<std::string> find_wrong_event(recordings::SessionReader& reader, const NewsByTick& news, CutEnds cut_ends) {
  const Result<std::vector<Event>> found = find_events(reader, news, cut_ends);
  if (!found) return found.errors();
  Result<std::vector<Event>> stored = reader.events();
  if (!stored) return stored.errors();
  std::erase_if(*stored, [](const Event& event) { return !follows_from_ticks(event.kind); });
  const Model& model = reader.start().model;
  const bool is_whole = reader.ended_cleanly();
  auto next = found->begin();
  for (const Event& event : *stored) {
    const auto place = is_whole ? next : std::find(next, found->end(), event);
    if (place != found->end() && *place == event)
      next = place + 1;
    else if (is_whole || event.tick + kKnownAfter < reader.tick_count())
      return "the event '" + shown(event, model) + "' does not follow from its ticks";
  }
  if (is_whole && next != found->end()) return "the event '" + shown(*next, model) + "' is missing";
  return std::string();
}

}  // namespace

std::string WholeVerdict::text() const {
  return wrong_event.empty() || !ticks.same ? recordings::to_string(ticks) : "different: " + wrong_event;
}

Result<WholeVerdict> verify_whole(recordings::SessionReader& reader, const recordings::VerifyOptions& options) {
  NewsByTick news;
  std::mutex mutex;
  recordings::VerifyOptions watched = options;
  watched.from = 0, watched.to = -1;
  watched.look = [&](std::int64_t tick, const stepping::StepReport& report) {
    if (report.came_loose == 0 && report.inverted == 0) return;
    const std::lock_guard lock(mutex);
    news[tick] = {report.came_loose, report.inverted};
  };
  const Result<recordings::Verdict> ticks = recordings::verify_session(reader, watched);
  if (!ticks) return ticks.errors();
  WholeVerdict verdict{*ticks, ""};
  if (!ticks->same || reader.start().physics_revision != kPhysicsRevision) return verdict;
  Result<std::string> wrong = find_wrong_event(reader, news, CutEnds::with_contact);
  if (!wrong) return wrong.errors();
  if (!wrong->empty()) {
    const Result<std::string> as_before = find_wrong_event(reader, news, CutEnds::unsevered);
    if (!as_before) return as_before.errors();
    if (as_before->empty()) wrong->clear();
  }
  verdict.wrong_event = std::move(*wrong);
  return verdict;
}

}  // namespace ctpm::session
