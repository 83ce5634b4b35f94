#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/script.h"

namespace ctpm::scenes {
namespace {

/// Everything in the plane across gravity and the height above it, so that any scene can be treated as lying
/// on a table.
class Table {
 public:
  explicit Table(Vec3 gravity) {
    up_ = norm(gravity) > 0 ? -1.0 * gravity / norm(gravity) : Vec3{0, 0, 1};
    const Vec3 helper = std::abs(up_.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    along_ = helper - dot(helper, up_) * up_;
    along_ = along_ / norm(along_);
    across_ = cross(up_, along_);
  }
  Vec3 to_table(Vec3 p) const { return {dot(p, along_), dot(p, across_), dot(p, up_)}; }
  Vec3 to_world(Vec3 p) const { return p.x * along_ + p.y * across_ + p.z * up_; }

 private:
  Vec3 along_, across_, up_;
};

/// Top of an organ over a place of the table.
class Top {
 public:
  Top(const FilledOrgan& organ, const Table& table) : reach_(0.8 * organ.spacing) {
    for (const Vec3& vertex : organ.surface.vertex) points_.push_back(table.to_table(vertex));
    if (points_.empty())
      for (const Vec3& centre : organ.centre) points_.push_back(table.to_table(centre) + Vec3{0, 0, organ.spacing / 2});
    least_ = most_ = points_.front();
    for (const Vec3& p : points_) {
      least_ = {std::min(least_.x, p.x), std::min(least_.y, p.y), std::min(least_.z, p.z)};
      most_ = {std::max(most_.x, p.x), std::max(most_.y, p.y), std::max(most_.z, p.z)};
    }
  }

  double height(double x, double y) const {
    double height = least_.z;
    for (const Vec3& p : points_)
      if (std::hypot(p.x - x, p.y - y) < reach_) height = std::max(height, p.z);
    return height;
  }
  /// Whether there is tissue below the place.
  bool is_over(double x, double y) const {
    return std::any_of(points_.begin(), points_.end(), [&](Vec3 p) { return std::hypot(p.x - x, p.y - y) < reach_; });
  }
  /// The place with the share `u` of the extent along x, on the ridge: where the top is highest across, or in
  /// the middle of a flat top.
  Vec3 ridge(double u) const {
    const double x = least_.x + u * (most_.x - least_.x);
    Vec3 best{x, least_.y, least_.z};
    double lowest = most_.z;
    for (int i = 5; i <= 15; ++i) {
      const double y = least_.y + i / 20.0 * (most_.y - least_.y), z = height(x, y);
      if (z > best.z) best = {x, y, z};
      lowest = std::min(lowest, z);
    }
    if (lowest == best.z) best.y = 0.5 * (least_.y + most_.y);
    return best;
  }
  Vec3 size() const { return most_ - least_; }
  Vec3 middle() const { return 0.5 * (least_ + most_); }

 private:
  double reach_;
  std::vector<Vec3> points_;
  Vec3 least_, most_;
};

/// To a tenth of a millimetre, so that an author can read the script.
double whole_tenths(double length) { return std::round(length * 1e4) / 1e4 + 0.0; }
Vec3 whole_tenths(Vec3 p) { return {whole_tenths(p.x), whole_tenths(p.y), whole_tenths(p.z)}; }

ScriptStep take(const std::string& tool, Vec3 at, Vec3 pointing) {
  ScriptStep step;
  step.take = ScriptStep::Take{tool, whole_tenths(at), pointing, {}};
  return step;
}
ScriptStep wait(double seconds) {
  ScriptStep step;
  step.wait = seconds;
  return step;
}

ScriptStep put_away() {
  ScriptStep step;
  step.put_away = true;
  return step;
}

/// A ball comes down on `place`, presses `depth` beyond it, stays for `hold` seconds and leaves.
void add_press(Script& script, const ToolSpec& ball, const Table& table, Vec3 place, double depth, double hold) {
  const double clear = 0.010, radius = ball.radius.value_or(0);
  const Vec3 down = table.to_world({0, 0, -1});
  script.steps.push_back(take(ball.name, table.to_world(place + Vec3{0, 0, radius + clear}), down));
  ScriptStep press, release;
  press.press = ScriptStep::Press{whole_tenths(clear + depth), down, 0.020, {}};
  release.release = ScriptStep::Release{whole_tenths(clear + depth + 0.02), table.to_world({0, 0, 1}), 0.040};
  script.steps.insert(script.steps.end(), {press, wait(hold), release, wait(0.3), put_away()});
}

/// Ways of a blade's tip over the top that stay in the tissue: from `first` towards the viewer, or along the organ. Of
/// the two the one that has more tissue under it; `length` long, `depth` below the top.
std::vector<Vec3> cut_path(const Top& top, Vec3 first, double length, double depth) {
  constexpr int kPoints = 5;
  std::vector<Vec3> best;
  int best_inside = -1;
  for (const Vec3 way : {Vec3{0, -1, 0}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}}) {
    std::vector<Vec3> path;
    int inside = 0;
    for (int i = 0; i < kPoints; ++i) {
      const Vec3 at = first + length * i / (kPoints - 1) * way;
      const double height = top.height(at.x, at.y);
      if (height < first.z - 2 * depth) break;
      path.push_back({at.x, at.y, height - depth});
      ++inside;
    }
    if (inside > best_inside) best = path, best_inside = inside;
  }
  return best;
}

/// A straight way of a blade's tip under the organ or near its bottom, from behind it to its front, at the share `u` of
/// its length.
std::vector<Vec3> path_through(const Top& top, double u) {
  constexpr double kBeyond = 0.6, kDeep = 0.9;  // of the size, from the middle and from the top
  const Vec3 size = top.size(), ridge = top.ridge(u);
  const double middle = top.middle().y, low = ridge.z - kDeep * size.z;
  return {{ridge.x, middle + kBeyond * size.y, low}, {ridge.x, middle - kBeyond * size.y, low}};
}

/// A blade goes in at the path's start and is drawn along it; `depth` below the top.
void add_cut(Script& script, const ToolSpec& scalpel, const Table& table, const std::vector<Vec3>& path, double depth) {
  const Vec3 down = table.to_world({0, 0, -1}), clear{0, 0, depth + 0.020};
  ScriptStep cut, leave;
  cut.cut = ScriptStep::Cut{{}, 0.040, {}, {}};
  for (const Vec3& tip : path) cut.cut->path.push_back(whole_tenths(table.to_world(tip)));
  script.steps.push_back(take(scalpel.name, table.to_world(path.front() + clear), down));
  const Vec3 way = path.back() - path.front();
  if (way.x != 0 || way.y != 0)
    script.steps.back().take->facing = whole_tenths(table.to_world(Vec3{way.x, way.y, 0} / norm(way)));
  leave.move = ScriptStep::Move{whole_tenths(table.to_world(path.back() + clear)), 0.080};
  script.steps.insert(script.steps.end(), {cut, wait(0.2), leave, wait(0.2), put_away(), wait(0.5)});
}

}  // namespace

Script default_script(const SceneSpec& scene, std::span<const FilledOrgan> organs) {
  Script script;
  for (std::size_t i = 0; i < organs.size(); ++i)
    for (ScriptStep& step : organ_script(scene, organs, i).steps) script.steps.push_back(std::move(step));
  return script;
}

Script organ_script(const SceneSpec& scene, std::span<const FilledOrgan> organs, std::size_t index, ScriptPlace at) {
  Script script;
  const Table table(scene.gravity);
  const Top top(organs[index], table);
  // Deep enough to be seen, never through the organ nor to where it is damaged, and no deeper than a hand would cut at
  // once: the force on a blade is the toughness times its length in the tissue, 4 N in liver at 25 mm.
  const Vec3 size = top.size();
  const double limit = scene.organs[index].damage_depth, deepest = limit > 0 ? 0.8 * limit : size.z;
  const double depth = std::min({0.010, 0.2 * size.z, deepest}),
               cut_depth = at.depth_share * std::min(0.025, 0.45 * size.z);
  const double cut_length = std::min(0.6 * size.y, 0.080);
  // A little in front of the ridge, where a viewer before the organ can see it, unless the organ is too thin there.
  const auto seen = [&](double share, double forward) {
    const Vec3 ridge = top.ridge(share);
    Vec3 place = ridge;
    for (const double part : {1.0, 0.5}) {
      const double y = ridge.y - part * forward * size.y;
      place = {ridge.x, y, top.height(ridge.x, y)};
      if (place.z > ridge.z - 0.15 * size.z) return place;
    }
    return ridge;
  };
  const auto first_of = [&](ToolKind kind) {
    return std::find_if(scene.tools.begin(), scene.tools.end(), [&](const ToolSpec& t) { return t.kind == kind; });
  };
  const auto ball = first_of(ToolKind::ball), scalpel = first_of(ToolKind::scalpel), none = scene.tools.end();
  if (ball != none && !(at.cuts_first && scalpel != none))
    add_press(script, *ball, table, seen(0.35 + at.along, 0.12), depth, 0.5);
  if (scalpel != none && at.cuts_through)
    add_cut(script, *scalpel, table, path_through(top, 0.42 + at.along), size.z);
  else if (scalpel != none)
    add_cut(script, *scalpel, table, cut_path(top, seen(0.42 + at.along, 0.0), cut_length, cut_depth), cut_depth);
  // Pressing beside the cut opens it.
  if (ball != none && scalpel != none)
    add_press(script, *ball, table, seen(0.50 + at.along, 0.18), std::min(1.6 * depth, deepest), 1.0);
  if (script.steps.empty()) script.steps.push_back(wait(1));
  return script;
}

}  // namespace ctpm::scenes
