#include "studio/authoring/anchor_choice.h"

#include <algorithm>
#include <cmath>

#include "core/model/box.h"
#include "importers/text.h"
#include "scenes/anchors.h"
#include "scenes/build_model.h"

namespace ctpm::authoring {
namespace {

/// A share of an organ's spheres that is held, on the side that `towards` points to.
struct Hold {
  Vec3 towards;
  double share;
};

constexpr Vec3 kDown{0, 0, -1}, kUp{0, 0, 1}, kBack{0, 1, 0}, kLeft{-1, 0, 0}, kRight{1, 0, 0};

/// In the order in which they are tried: what lies on a table first, then what hangs, least first. The front stays free
/// for hands.
constexpr Hold kHolds[] = {{kDown, 0.125}, {kDown, 0.25},   {kBack, 0.25}, {kDown, 0.375},
                           {kLeft, 0.25},  {kRight, 0.25},  {kUp, 0.25},   {kBack, 0.375},
                           {kLeft, 0.375}, {kRight, 0.375}, {kDown, 0.5},  {kBack, 0.5},
                           {kUp, 0.375},   {kLeft, 0.5},    {kRight, 0.5}, {kUp, 0.5}};

/// The anchor of a hold: everything from the far end to a whole millimetre, or tenth in a small organ, beyond which at
/// least that share of spheres lies.
scenes::AnchorSpec anchor_of(const Hold& hold, const FilledOrgan& organ) {
  std::vector<double> heights;
  for (const Vec3& centre : organ.centre) heights.push_back(-dot(centre, hold.towards));
  std::sort(heights.begin(), heights.end());
  const double last = heights[std::size_t(hold.share * double(heights.size() - 1))];
  const double steps = organ.spacing > 4e-3 ? 1e3 : 1e4;  // of a metre
  const auto rounded_up = [&](double length) { return std::ceil(length * steps + 0.1) / steps; };
  scenes::AnchorSpec anchor;
  if (hold.towards == kDown) {
    anchor.lowest = rounded_up(last - heights.front());
    return anchor;
  }
  const double to = rounded_up(last);
  anchor.plane = scenes::PlaneRegion{-to * hold.towards, -1.0 * hold.towards};
  return anchor;
}

Result<AnchorChoice> try_anchors(scenes::SceneSpec& scene, const FilledOrgan& organ,
                                 std::vector<scenes::AnchorSpec> anchors, std::optional<double> most_sag,
                                 const std::function<bool()>& should_stop) {
  AnchorChoice choice;
  choice.anchors = std::move(anchors);
  scene.organs[0].anchors = choice.anchors;
  const Result<std::vector<std::int32_t>> held =
      scenes::select_anchored(organ, choice.anchors, scene.gravity, "organ " + scene.organs[0].name);
  if (!held) return held.errors();
  choice.held = held->size();
  Result<scenes::BuiltScene> built = scenes::build_model(scene, std::span(&organ, 1));
  if (!built) return built.errors();
  choice.model = std::move(built->model);
  std::optional<loading::Standing> standing = loading::settle_without_tools(scene, choice.model, most_sag, should_stop);
  if (!standing) return Error{"organ " + scene.organs[0].name, "stopped", ""};
  choice.standing = *std::move(standing);
  return choice;
}

/// The diagonal of the box around an organ's spheres.
std::string size_text(const FilledOrgan& organ) {
  Box box(organ.centre.front());
  for (const Vec3& p : organ.centre) box.add(p);
  return importers::mm_text(norm(box.high - box.low) + 2 * organ.sphere_radius);
}

}  // namespace

scenes::AnchorSpec usual_anchor(const FilledOrgan& organ) { return anchor_of(kHolds[0], organ); }

Result<AnchorChoice> choose_anchors(scenes::SceneSpec scene, const FilledOrgan& organ,
                                    const std::function<bool()>& should_stop) {
  if (!scene.organs[0].anchors.empty()) {
    std::vector<scenes::AnchorSpec> own = scene.organs[0].anchors;
    return try_anchors(scene, organ, std::move(own), {}, should_stop);
  }
  std::optional<AnchorChoice> best;
  Errors why;
  for (const Hold& hold : kHolds) {
    Result<AnchorChoice> choice = try_anchors(scene, organ, {anchor_of(hold, organ)}, loading::kMostSag, should_stop);
    if (!choice) {
      why = choice.errors();  // in a tiny organ, a hold may miss all spheres or leave two that are no neighbours
      continue;
    }
    if (choice->held == organ.centre.size()) continue;  // nothing of it could move
    const bool is_better =
        !best || (!choice->standing.is_refused && choice->standing.organ[0].share() < best->standing.organ[0].share());
    if (choice->standing.stands()) return choice;
    if (is_better) best = *std::move(choice);
  }
  if (should_stop && should_stop()) return Error{"organ " + scene.organs[0].name, "stopped", ""};
  if (!best && !why.empty()) return why;
  if (!best)
    return Error{"organ " + scene.organs[0].name, "is so small in spheres that any anchor holds all of them",
                 "a smaller radius gives it more; with the unit that was taken it is " + size_text(organ) + " long"};
  return *std::move(best);
}

}  // namespace ctpm::authoring
