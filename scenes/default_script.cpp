#include <algorithm>
#include <cmath>

#include "scenes/script.h"

namespace ctpm {
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
      for (const Vec3& centre : organ.centre)
        points_.push_back(table.to_table(centre) + Vec3{0, 0, organ.spacing / 2});
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
  /// The place with the share `u` of the extent along x, on the ridge: where the top is highest across.
  Vec3 ridge(double u) const {
    const double x = least_.x + u * (most_.x - least_.x);
    Vec3 best{x, least_.y, least_.z};
    for (int i = 5; i <= 15; ++i) {
      const double y = least_.y + i / 20.0 * (most_.y - least_.y), z = height(x, y);
      if (z > best.z) best = {x, y, z};
    }
    return best;
  }
  Vec3 size() const { return most_ - least_; }

 private:
  double reach_;
  std::vector<Vec3> points_;
  Vec3 least_, most_;
};

ScriptStep take(const std::string& tool, Vec3 at, Vec3 pointing) {
  ScriptStep step;
  step.take = ScriptStep::Take{tool, at, pointing};
  return step;
}
ScriptStep wait(double seconds) {
  ScriptStep step;
  step.wait = seconds;
  return step;
}

void add_press(Script& script, const ToolSpec& ball, const Top& top, const Table& table, double depth) {
  const double clear = 0.010, radius = ball.radius.value_or(0);
  const Vec3 place = top.ridge(0.35), down = table.to_world({0, 0, -1});
  script.steps.push_back(take(ball.name, table.to_world(place + Vec3{0, 0, radius + clear}), down));
  ScriptStep press, release;
  press.press = ScriptStep::Press{clear + depth, down, 0.020};
  release.release = ScriptStep::Release{clear + depth + 0.02, -1.0 * down, 0.040};
  script.steps.insert(script.steps.end(), {press, wait(0.7), release, wait(0.5)});
}

void add_cut(Script& script, const ToolSpec& scalpel, const Top& top, const Table& table, double depth) {
  const double clear = 0.020;
  const Vec3 down = table.to_world({0, 0, -1});
  // A single column of spheres has no width to cut along; the blade then goes down in one place.
  const double width = top.size().x, length = std::min(0.30 * width, 0.060);
  const double step_share = width > 0 ? length / width / 4 : 0;
  ScriptStep cut, leave;
  cut.cut = ScriptStep::Cut{{}, 0.030};
  const double y = top.ridge(0.55).y;
  Vec3 first, last;
  for (int i = 0; i <= 4; ++i) {
    const double x = top.ridge(0.55 + (i - 2) * step_share).x;
    last = {x, y, top.height(x, y) - depth};
    if (i == 0) first = last;
    cut.cut->path.push_back(table.to_world(last));
  }
  script.steps.push_back(take(scalpel.name, table.to_world(first + Vec3{0, 0, depth + clear}), down));
  leave.move = ScriptStep::Move{table.to_world(last + Vec3{0, 0, depth + clear}), 0.060};
  ScriptStep away;
  away.put_away = true;
  script.steps.insert(script.steps.end(), {cut, wait(0.2), leave, wait(0.3), away, wait(1.5)});
}

}  // namespace

Script default_script(const SceneSpec& scene, std::span<const FilledOrgan> organs) {
  Script script;
  const Table table(scene.gravity);
  const Top top(organs.front(), table);
  // Deep enough to be seen, and never through the organ.
  const double height = top.size().z;
  const auto first_of = [&](ToolKind kind) {
    return std::find_if(scene.tools.begin(), scene.tools.end(),
                        [&](const ToolSpec& t) { return t.kind == kind; });
  };
  if (const auto ball = first_of(ToolKind::ball); ball != scene.tools.end())
    add_press(script, *ball, top, table, std::min(0.010, 0.2 * height));
  if (const auto scalpel = first_of(ToolKind::scalpel); scalpel != scene.tools.end())
    add_cut(script, *scalpel, top, table, std::min(0.022, 0.45 * height));
  if (script.steps.empty()) script.steps.push_back(wait(1));
  return script;
}

}  // namespace ctpm
