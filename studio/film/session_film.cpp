#include "studio/film/session_film.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "scenes/scene_file.h"
#include "studio/film/captions.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/session/run_session.h"

namespace ctpm::film {
namespace {

constexpr std::int64_t kPlotPoints = 600;  ///< largest number of points of the running force plot

}  // namespace

std::string structure_name(const scenes::SceneSpec& scene) {
  if (scene.organs.empty()) return "";
  switch (scene.organs.front().structure) {
    case network::Structure::mass_spring:
      return "mass-spring";
    case network::Structure::angle_mass_spring:
      return "angle-mass-spring";
    case network::Structure::tpm:
      return "TPM";
    case network::Structure::ctpm:
      return "CTPM";
  }
  return "";
}

SessionFilm::SessionFilm(recordings::SessionReader& reader, scenes::SceneSpec scene, const session::TickRange& range,
                         bool allow_diverged, Between between, recordings::ReplayCursor cursor)
    : reader_(reader),
      scene_(std::move(scene)),
      range_(range),
      allow_diverged_(allow_diverged),
      between_(between),
      cursor_(std::move(cursor)),
      cut_(reader.start().model) {}

Result<std::unique_ptr<SessionFilm>> SessionFilm::create(recordings::SessionReader& reader,
                                                         const session::TickRange& range, bool allow_diverged,
                                                         Between between) {
  Result<scenes::SceneText> scene = scenes::read_scene(reader.start().scene_text, reader.path() + " (its scene)");
  if (!scene) return scene.errors();
  Result<recordings::ReplayCursor> cursor = recordings::ReplayCursor::create(reader);
  if (!cursor) return cursor.errors();
  std::unique_ptr<SessionFilm> film(
      new SessionFilm(reader, std::move(scene->spec), range, allow_diverged, between, std::move(*cursor)));
  if (const Result<Done> begun = film->begin(); !begun) return begun.errors();
  return film;
}

Result<Done> SessionFilm::begin() {
  const Model& model = this->model();
  overlay_.title = scene_.name;
  if (model.hands > 1) overlay_.second.emplace();
  overlay_.model = structure_name(scene_);
  overlay_.session = name_of(reader_);
  overlay_.damage_force = loading::damage_force_of(scene_);
  for (const OrganRange& organ : model.organs)
    if (organ.damage_depth > 0 && (overlay_.damage_depth == 0 || organ.damage_depth < overlay_.damage_depth))
      overlay_.damage_depth = organ.damage_depth;
  plot_every_ = std::max<std::int64_t>(1, std::llround(overlay_.plot_span / model.tick) / kPlotPoints);
  if (between_ == Between::left_out) return Done{};
  if (allow_diverged_) {
    const Result<recordings::Verdict> verdict = recordings::verify_session(reader_, {range_.from, range_.to});
    if (!verdict) return verdict.errors();
    first_different_ = verdict->first_tick;
  }
  return start_at(range_.from);
}

/// Goes there without a shot on the way. What was before is told from the recording.
Result<Done> SessionFilm::start_at(std::int64_t tick) {
  const Model& model = this->model();
  // Fill the plot and the camera's moments.
  const std::int64_t needed = std::max(kPlotPoints * plot_every_, std::int64_t(render::followed_ticks(model.tick)));
  const std::int64_t before = std::max<std::int64_t>(0, tick - needed);
  const Result<std::vector<recordings::TickRecord>> earlier = reader_.ticks(before, tick);
  overlay_.history.clear(), inputs_.clear();
  // What is damaged before the part is not shown; the part itself is read by the replay.
  for (std::int64_t t = before + 1; earlier && t <= tick; ++t) {
    const recordings::TickRecord& record = (*earlier)[std::size_t(t - before - 1)];
    keep_inputs(record.inputs);
    if (t % plot_every_ == 0)
      overlay_.history.push_back({double(t) * model.tick, norm(record.tool_force), norm(record.second.tool_force)});
  }
  if (earlier && !earlier->empty()) show_loads(earlier->back().of_hand(0), earlier->back().of_hand(1));
  const Result<std::vector<recordings::Event>> events = reader_.events();
  if (!events) return events.errors();
  overlay_.loose = recordings::pieces_came_loose(*events, tick);
  overlay_.inside_out = recordings::cells_inside_out(*events, tick);
  overlay_.tick = tick, overlay_.time = double(tick) * model.tick;
  look_back(*events, cursor_.tick(), tick);
  return cursor_.seek(tick);
}

/// On to the last keyframe that leaves a tick to compare, if it lies ahead.
Result<Done> SessionFilm::leap_towards(std::int64_t tick) {
  const Result<std::vector<std::int64_t>> keyframes = reader_.keyframe_ticks();
  if (!keyframes) return keyframes.errors();
  const auto after = std::ranges::lower_bound(*keyframes, tick);
  const std::int64_t last = after == keyframes->begin() ? 0 : *std::prev(after);
  return last > cursor_.tick() ? start_at(last) : Done{};
}

/// Only what is beyond a limit counts; a blade's depth has none.
void SessionFilm::keep_worst(double force, double depth) {
  if (force > overlay_.damage_force) overlay_.worst.force = std::max(overlay_.worst.force, force);
  if (depth > overlay_.damage_depth) overlay_.worst.depth = std::max(overlay_.worst.depth, depth);
}

/// What did damage in a part that is not shown.
void SessionFilm::look_back(const std::vector<recordings::Event>& events, std::int64_t begin, std::int64_t end) {
  constexpr std::int64_t kReadTicks = 10000;  // held in memory at a time
  if (overlay_.damage_force <= 0 && overlay_.damage_depth <= 0) return;
  for (std::int64_t from = begin; from < end; from += kReadTicks) {
    const std::int64_t to = std::min(from + kReadTicks, end);
    const auto records = reader_.ticks(from, to);
    if (!records) {
      // Damaged: its events tell at least how each damage began.
      for (const recordings::Event& event : events)
        if (event.tick >= from && event.tick < to) keep_worst(event.force, event.depth);
      continue;
    }
    for (const recordings::TickRecord& record : *records)
      for (std::size_t hand = 0; hand < std::size_t(model().hands); ++hand) {
        const stepping::HandReport report = record.of_hand(hand);
        keep_worst(norm(report.tool_force), holds_blade(record.inputs.hand(hand)) ? 0 : report.depth);
      }
  }
}

void SessionFilm::show_loads(const stepping::HandReport& first, const stepping::HandReport& second) {
  const auto load_of = [](const stepping::HandReport& report) {
    return render::HandLoad{norm(report.tool_force), report.depth};
  };
  overlay_.hand = load_of(first);
  if (overlay_.second) overlay_.second = load_of(second);
}

/// Updates the overlay from the last simulated tick.
void SessionFilm::take_tick() {
  overlay_.tick = cursor_.tick();
  overlay_.time = double(overlay_.tick) * model().tick;
  show_loads(cursor_.report(), cursor_.report().second);
  overlay_.slip = cursor_.record().slip;
  const Inputs& inputs = cursor_.record().inputs;
  keep_worst(overlay_.hand.force, holds_blade(inputs) ? 0 : overlay_.hand.depth);
  if (overlay_.second) keep_worst(overlay_.second->force, holds_blade(inputs.second) ? 0 : overlay_.second->depth);
  overlay_.loose += cursor_.report().came_loose;
  overlay_.inside_out = cursor_.report().inverted;
  keep_inputs(cursor_.record().inputs);
  std::vector<render::ForcePoint>& history = overlay_.history;
  if (overlay_.tick % plot_every_ == 0)
    history.push_back({overlay_.time, overlay_.hand.force, overlay_.second.value_or(render::HandLoad{}).force});
  if (history.size() > 2 * kPlotPoints) history.erase(history.begin(), history.end() - kPlotPoints - 1);
  if (first_different_ < 0 && !cursor_.same_so_far()) first_different_ = overlay_.tick - 1;
}

void SessionFilm::keep_inputs(const Inputs& inputs) {
  inputs_.push_back(inputs);
  if (inputs_.size() > render::followed_ticks(model().tick)) inputs_.pop_front();
}

std::string SessionFilm::verdict() const {
  if (is_same() && overlay_.inside_out > 0) return "TISSUE IS INSIDE OUT; replay same as recorded";
  return is_same() ? "replay same as recorded"
                   : "REPLAY DIFFERS from the recording since " +
                         output::fixed(double(first_different_) * model().tick, 3) + " s";
}

Error SessionFilm::differs() const {
  return {reader_.path(),
          "the replay differs from the recording since " + output::fixed(double(first_different_) * model().tick, 3) +
              " s; no video was written",
          "verify the session to see what differs; " + output::option_name("export.allow_diverged") +
              " exports all the same and says so on every frame"};
}

bool SessionFilm::holds_blade(const Hand& hand) const { return model().is_scalpel(hand.tool); }

/// While a blade is held, and after it was put away after a cut, the depth is that of the cut, along the blade.
void SessionFilm::show_cut_depth() {
  cut_.measure(cursor_.state());
  const double depth = cut_.size().value_or(session::CutSize{}).along_blade;
  const Inputs& inputs = cursor_.state().last_inputs;
  const bool is_empty = inputs.tool < 0 && inputs.second.tool < 0;
  overlay_.hand.is_blade = is_empty ? cut_.size().has_value() : holds_blade(inputs);
  if (overlay_.hand.is_blade) overlay_.hand.depth = depth;
  if (!overlay_.second) return;
  overlay_.second->is_blade = holds_blade(inputs.second);
  if (overlay_.second->is_blade) overlay_.second->depth = depth;
}

Result<Shot> SessionFilm::shoot(std::int64_t tick) {
  if (between_ == Between::left_out)
    if (const Result<Done> leapt = leap_towards(tick); !leapt) return leapt.errors();
  while (cursor_.tick() < tick) {
    const Result<bool> went_on = cursor_.step();
    if (!went_on) return went_on.errors();
    if (!*went_on) break;
    take_tick();
    if (!is_same() && !allow_diverged_) return differs();
  }
  show_cut_depth();
  overlay_.verdict = verdict();
  const bool is_good = is_same() && overlay_.inside_out == 0;
  overlay_.verdict_tone = is_good ? render::VerdictTone::good : render::VerdictTone::bad;
  const auto of = [&](std::size_t i) -> const Inputs& { return inputs_[i]; };
  Shot shot{cursor_.state(), overlay_, render::followed_moments(inputs_.size(), model().tick, of)};
  if (reader_.tick_count() > 0) shot.share = double(cursor_.tick()) / double(reader_.tick_count());
  return shot;
}

}  // namespace ctpm::film
