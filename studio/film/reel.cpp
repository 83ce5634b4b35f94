#include "studio/film/reel.h"

#include <algorithm>
#include <cmath>

#include "core/model/errors.h"
#include "studio/film/beside_panels.h"
#include "studio/film/session_strip.h"
#include "studio/loading/loaded_scene.h"
#include "studio/render/element_values.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::film {
namespace {

/// The largest element values of a session [1, rad or N], but for a few, rounded up: the range of their colours. From
/// keyframes of the whole session, so that a part has the colours of the whole.
Result<double> range_of(recordings::SessionReader& session, render::ElementQuantity quantity) {
  constexpr std::size_t kMoments = 12;
  constexpr double kShown = 0.995;  // of the elements of a moment
  const Result<std::vector<std::int64_t>> keyframes = session.keyframe_ticks();
  if (!keyframes) return keyframes.errors();
  const std::size_t every = std::max<std::size_t>(1, keyframes->size() / kMoments);
  double largest = 0;
  std::vector<render::ElementValue> values;
  for (std::size_t i = 0; i < keyframes->size(); i += every) {
    const Result<recordings::Keyframe> keyframe = session.keyframe_at_or_before((*keyframes)[i]);
    if (!keyframe) continue;  // damaged: a replay says so where it comes there
    render::measure_elements(session.start().model, keyframe->state, quantity, values);
    if (values.empty()) continue;
    const auto shown = values.begin() + std::ptrdiff_t(kShown * double(values.size() - 1));
    std::nth_element(values.begin(), shown, values.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.value) < std::abs(b.value); });
    largest = std::max(largest, std::abs(shown->value));
  }
  return largest;
}

/// Whether that is how a scene of the same size and place is seen.
bool is_of(const render::SceneView& view, const Seen& seen) {
  const render::Bounds rest = render::rest_bounds(view);
  return seen.rest.min == rest.min && seen.rest.max == rest.max;
}

/// As the first one is seen, if that is of the same scene.
Result<views::Look> look_of(recordings::SessionReader& session, const SessionFilm& film, const render::SceneView& view,
                            const render::PictureSize& size, const ExportOptions& options,
                            const std::vector<Moment>& all, const std::optional<Seen>& first) {
  if (first && is_of(view, *first)) return first->look;
  const Result<State> told = telling_state(session, film.range(), all);
  if (!told) return told.errors();
  return views::find_look(options.look, film.scene(), view, double(size.width) / size.height, &*told);
}

/// Points along the held tools at moments of the whole session [m]; fewer where it is damaged.
std::vector<Vec3> places_of_tools(recordings::SessionReader& session) {
  constexpr std::int64_t kMoments = 60;
  constexpr int kAlong = 20;
  constexpr double kApart = 5e-3;  // [m]
  std::vector<Vec3> places;
  for (std::int64_t i = 0; i < kMoments; ++i) {
    const std::int64_t tick = i * session.tick_count() / kMoments;
    const auto record = session.ticks(tick, tick + 1);
    if (!record || record->empty()) continue;
    for (std::size_t number = 0; number < kMostHands; ++number) {
      const Hand& hand = record->front().inputs.hand(number);
      for (int k = 0; hand.tool >= 0 && k < kAlong; ++k)
        places.push_back(hand.position + rotate(hand.world_from_tool, {0, 0, k * kApart}));
    }
  }
  return places;
}

/// Points of what a view draws of the organs at rest [m].
std::vector<Vec3> drawn_points(const render::SceneView& scene, render::View view) {
  if (view == render::View::surface) return render::rest_points(scene);
  const Model& model = *scene.model;
  std::vector<Vec3> points;
  for (const OrganRange& organ : model.organs)
    for (std::int32_t i = organ.first; i < organ.first + organ.count; ++i)
      for (const double side : {-1.0, 1.0})
        for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
          points.push_back(Vec3(model.rest_position[std::size_t(i)]) + side * organ.sphere_radius * axis);
  return points;
}

/// Whether a film may warn of damage. Of a pair only one session is known here, and both are seen from one place.
bool may_warn(const Reel& reel, const render::OverlayData& data, bool is_pair) {
  const bool has_limit = data.damage_force > 0 || data.damage_depth > 0;
  return (is_pair && has_limit) ||
         std::ranges::any_of(reel.moments, [](const Moment& moment) { return moment.kind == Moment::Kind::damage; });
}

/// What the marks of an expert's cut mean.
std::vector<render::MarkMeaning> meanings_of(const render::ExpertCut& expert, bool has_strays) {
  std::vector<render::MarkMeaning> meanings;
  if (!expert.line().empty()) meanings.push_back({render::kExpertColour, render::kExpertMeaning, true});
  if (has_strays) meanings.push_back({render::kStrayColour, render::kStrayMeaning});
  return meanings;
}

/// Moves a camera that nobody placed so that the panels of this film hide little.
void make_room(Reel& reel, recordings::SessionReader& session, const render::PictureSize& size, bool is_pair) {
  render::OverlayData data = reel.film->overlay();
  data.level = reel.level;
  data.history.push_back({});
  data.hand.is_blade = true;  // it has the longest name of a depth
  data.caption = reel.caption;
  for (const Moment& moment : reel.moments)
    if (reel.caption.empty() && moment.text.size() > data.caption.size()) data.caption = moment.text;
  data.legend = render::legend_of(reel.film->model(), reel.look.draw);
  data.taken_right = reel.taken_right, data.has_insets = !reel.insets.empty();
  if (reel.look.draw.expert) {
    data.marks = meanings_of(*reel.look.draw.expert, true);
    data.verdict = reel.film->verdict(), data.verdict_tone = render::VerdictTone::good;  // they stand below it
  }
  if (may_warn(reel, data, is_pair)) data.worst = {2 * data.damage_force, 2 * data.damage_depth};
  std::vector<render::PixelBox> panels = reel.overlay->standing_panels(data);
  for (std::size_t i = 0; i < reel.insets.size(); ++i) panels.push_back(Inset::box(size, int(i)));
  if (panels.empty()) return;
  std::vector<Vec3> organs = drawn_points(reel.renderer->scene(), reel.look.draw.view);
  organs.insert(organs.end(), reel.look.pieces.begin(), reel.look.pieces.end());
  reel.look.draw.camera = beside_panels(reel.look.draw.camera, size, panels, {organs, places_of_tools(session)});
}

}  // namespace

std::optional<render::OverlayLevel> level_of(const std::string& name) {
  if (name == "none") return render::OverlayLevel::none;
  if (name == "small") return render::OverlayLevel::small;
  if (name == "full") return render::OverlayLevel::full;
  return std::nullopt;
}

Result<State> telling_state(recordings::SessionReader& session, const session::TickRange& part,
                            const std::vector<Moment>& all) {
  Result<recordings::Keyframe> late = session.keyframe_at_or_before(session.tick_count());
  if (!late) late = session.keyframe_at_or_before(part.to);
  if (!late) return late.errors();
  const auto deepest =
      std::find_if(all.begin(), all.end(), [](const Moment& m) { return m.kind == Moment::Kind::deepest; });
  if (deepest == all.end()) return std::move(late->state);
  const auto records = session.ticks(deepest->tick, deepest->tick + 1);
  if (!records) return std::move(late->state);  // damaged there
  if (late->state.swept.size() == 0)
    if (Result<recordings::Keyframe> before = session.keyframe_at_or_before(deepest->tick)) late = std::move(before);
  late->state.last_inputs = records->front().inputs;
  return std::move(late->state);
}

Result<Shot> Reel::shoot(std::int64_t frame) const {
  Result<Shot> shot = film->shoot(ticks.tick(frame));
  if (!shot) return shot;
  shot->overlay.level = level, shot->overlay.role = role;
  shot->overlay.caption = caption.empty() ? words_at(moments, ticks.tick(frame), told) : caption;
  shot->overlay.stands = frame < ticks.begun    ? render::Stands::before_start
                         : frame >= ticks.ended ? render::Stands::after_end
                                                : render::Stands::no;
  shot->overlay.taken_right = taken_right, shot->overlay.has_insets = !insets.empty();
  if (ghost) shot->ghost = ghost->hand[std::size_t(frame)], shot->overlay.ghost = ghost->session;
  if (shows_pace) shot->overlay.pace = speed * ticks.share(frame);
  return shot;
}

Seen seen_in(const Reel& reel) { return {render::rest_bounds(reel.renderer->scene()), reel.look}; }

Result<Reel> make_reel(recordings::SessionReader& session, FrameTicks ticks, const render::PictureSize& size,
                       const ExportOptions& options, const std::optional<Seen>& first, Between between) {
  Reel reel;
  const Result<std::vector<Moment>> all = all_moments(session, ticks.range);
  if (!all) return all.errors();
  Result<std::unique_ptr<SessionFilm>> film =
      SessionFilm::create(session, ticks.range, options.allow_diverged, between);
  if (!film) return film.errors();
  reel.film = std::move(*film);
  const Model& model = reel.film->model();
  render::SceneView view = views::view_of(reel.film->scene(), model);
  const Result<views::Look> look = look_of(session, *reel.film, view, size, options, *all, first);
  if (!look) return look.errors();
  reel.look = *look;
  reel.look.draw.expert = options.expert;
  if (options.strip) reel.strip_height = strip_height(size.height);
  const int height = size.height - reel.strip_height;
  const Result<std::vector<Inset::Kind>> insets = insets_of(options.inset);
  if (!insets) return insets.errors();
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(size.width, height, std::move(view));
  if (!renderer) return renderer.errors();
  reel.renderer = std::move(*renderer);
  for (const Inset::Kind kind : *insets) {
    Result<Inset> inset = Inset::create(kind, {size.width, height}, reel.renderer->scene());
    if (!inset) return inset.errors();
    reel.insets.push_back(std::move(*inset));
    reel.taken_right = Inset::taken_right({size.width, height});
  }
  reel.overlay = std::make_unique<render::Overlay>(size.width, height);
  const std::string title = reel.film->scene().name + ": " + name_of(session);
  reel.moments = told_moments(*all, title, model.tick, ticks.range.from), reel.caption = options.caption;
  if (options.strip) reel.strip = strip_of(session, *all, loading::damage_force_of(reel.film->scene()));
  reel.told = std::llround(kCaptionSeconds * options.speed / model.tick);
  reel.ticks = std::move(ticks), reel.speed = options.speed;
  reel.shows_pace = options.speed != 1 || !options.matched.empty() || !options.slow_at.empty();
  reel.level = level_of(options.overlay).value_or(reel.level);
  const bool is_as_first = first && is_of(reel.renderer->scene(), *first);
  if (reel.look.is_found && !is_as_first)
    make_room(reel, session, {size.width, height}, size.width < options.size.width);
  return reel;
}

std::vector<recordings::SessionReader*> in_step_with(std::vector<recordings::SessionReader*> sessions,
                                                     const ExportOptions& options) {
  if (options.ghost) sessions.push_back(options.ghost);
  return sessions;
}

Result<std::vector<Reel>> make_reels(const std::vector<recordings::SessionReader*>& sessions,
                                     std::vector<FrameTicks> ticks, const ExportOptions& options, Between between) {
  const render::PictureSize size{options.size.width / int(sessions.size()), options.size.height};
  std::vector<Reel> reels;
  Errors errors;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    ExportOptions own = options;
    if (i + 1 < sessions.size()) own.caption.clear();
    Result<Reel> reel = make_reel(*sessions[i], std::move(ticks[i]), size, own,
                                  reels.empty() ? std::nullopt : std::optional(seen_in(reels[0])), between);
    if (reel)
      reels.push_back(std::move(*reel));
    else
      append(errors, reel);
  }
  if (!errors.empty()) return errors;
  if (reels.size() == 2) {
    reels[0].role = "expert", reels[1].role = "trainee";
    reels[0].look.draw.expert.reset();  // it made room for what stands in the other half
  }
  if (options.ghost) {
    Result<Ghost> ghost = ghost_of(*options.ghost, ticks.back());
    if (!ghost) return ghost.errors();
    reels[0].ghost = std::move(*ghost);
  }
  if (const Result<Done> alike = colour_alike(reels, sessions); !alike) return alike.errors();
  return reels;
}

Result<double> full_scale_of(const std::vector<recordings::SessionReader*>& sessions,
                             render::ElementQuantity quantity) {
  double largest = 0;
  for (recordings::SessionReader* session : sessions) {
    const Result<double> found = range_of(*session, quantity);
    if (!found) return found.errors();
    largest = std::max(largest, *found);
  }
  return largest > 0 ? render::round_up(largest / views::unit_of(quantity)) : 0.0;  // the legend's numbers are round
}

Result<Done> colour_alike(std::span<Reel> reels, const std::vector<recordings::SessionReader*>& sessions) {
  const render::DrawOptions& first = reels[0].look.draw;
  if (first.view != render::View::elements || first.full_scale > 0) return Done{};
  const Result<double> full_scale = full_scale_of(sessions, first.quantity);
  if (!full_scale) return full_scale.errors();
  for (Reel& reel : reels)
    if (*full_scale > 0) reel.look.draw.full_scale = views::unit_of(reel.look.draw.quantity) * *full_scale;
  return Done{};
}

double largest_force(const std::vector<recordings::SessionReader*>& sessions) {
  double largest = 0;
  for (recordings::SessionReader* session : sessions) {
    const Result<recordings::SessionStatistics> statistics = session->statistics();
    if (!statistics) continue;  // a damaged one without an end
    largest = std::max(largest, statistics->max_force);
  }
  return largest;
}

render::Frame draw_shot(Reel& reel, Shot& shot, double top_force) {
  render::DrawOptions draw = reel.look.at(reel.renderer->scene(), shot.moments);
  draw.ghost = shot.ghost;
  render::Frame picture = reel.renderer->draw(shot.state, draw);
  if (reel.ghost) render::draw_marks(picture, draw.camera, reel.ghost->way);
  shot.overlay.tools = reel.renderer->tool_points(shot.state, draw);
  shot.overlay.legend = render::legend_of(reel.film->model(), draw);
  if (draw.expert)
    shot.overlay.marks =
        meanings_of(*draw.expert, !render::strays_of(reel.film->model(), *draw.expert, shot.state).empty());
  shot.overlay.least_top_force = std::max(shot.overlay.least_top_force, top_force);
  reel.overlay->draw(picture, shot.overlay);
  for (std::size_t i = 0; i < reel.insets.size(); ++i)
    reel.insets[i].add(picture, int(i), shot.state, draw, shot.moments);
  if (!reel.strip) return picture;
  reel.strip->now = shot.share, reel.strip->top_force = std::max(reel.strip->top_force, top_force);
  return render::with_strip(picture, reel.strip_height, *reel.strip);
}

render::Frame draw_shots(std::vector<Reel>& reels, std::vector<Shot>& shots, double top_force) {
  render::Frame picture = draw_shot(reels[0], shots[0], top_force);
  for (std::size_t i = 1; i < reels.size(); ++i)
    picture = render::join_beside(picture, draw_shot(reels[i], shots[i], top_force));
  return picture;
}

}  // namespace ctpm::film
