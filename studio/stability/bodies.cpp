#include "studio/stability/bodies.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "scenes/build_model.h"
#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"
#include "studio/output/number_text.h"
#include "studio/stability/blocks.h"

namespace ctpm::stability {
namespace {

using fidelity::Body;

constexpr double kRadius = 4e-3;  ///< r of every filling [m]
constexpr double kOrgan = 40e-3;  ///< of the ball organs [m]
constexpr Vec3 kBlock{72e-3, 72e-3, 48e-3};
constexpr std::int32_t kLarge = 0, kMedium = 1;  ///< balls of 20 and 10 mm
constexpr std::int64_t kAlone = 4000;            ///< ticks after abuse

/// What is filled once, when the first run needs it; runs of several threads share it.
template <class T>
class Once {
 public:
  explicit Once(std::function<T()> make) : make_(std::move(make)) {}
  const T& get() {
    std::call_once(flag_, [&] { made_ = std::make_unique<T>(make_()); });
    return *made_;
  }

 private:
  std::function<T()> make_;
  std::once_flag flag_;
  std::unique_ptr<T> made_;
};

template <class T>
std::shared_ptr<Once<T>> once(std::function<Result<T>()> make) {
  return std::make_shared<Once<T>>([make] {
    Result<T> made = make();
    CTPM_CHECK(bool(made), "the bodies of the stability cases are valid");
    return *std::move(made);
  });
}

/// A block that is abused for `ticks` by a ball, and then left alone. `depth` and `along` say where the ball is [m] at
/// a time [s].
void add_abuse(std::vector<StabilityCase>& cases, const std::string& key, const std::string& title, std::int64_t ticks,
               std::int32_t ball, std::function<Vec3(double time)> place) {
  const auto body = once<Body>([] {
    return fidelity::make_body(fidelity::block(kBlock, kRadius, fidelity::Pace::live, {20e-3, 10e-3}));
  });
  StabilityCase what{.key = key,
                     .title = title,
                     .expectation =
                         "within 100 mm, no energy gained after that; 4 s later within 1 mm, at rest, and no "
                         "cell inside out",
                     .build = [=] { return body->get().model; }};
  what.hand = [=](std::int64_t tick) {
    if (tick >= ticks) return Inputs{};
    const Vec3 at = place(1e-3 * double(tick));  // x, y and the depth
    Inputs inputs;
    inputs.tool = ball;
    inputs.position = fidelity::ball_centre(body->get(), ball, {{at.x, at.y, kBlock.z}, {0, 0, -1}}, at.z);
    return inputs;
  };
  what.ticks = ticks + kAlone, what.free_from = ticks + 1;
  what.reach = 0.1, what.end_speed = 5e-3, what.end_distance = 1e-3;
  what.also = [=](const Model&, const State&, const State& last) {
    const std::int64_t cells = fidelity::count_cells(body->get(), last).inside_out;
    return cells == 0 ? std::string() : std::to_string(cells) + " cells stay inside out";
  };
  cases.push_back(what);
}

void add_recovery(std::vector<StabilityCase>& cases) {
  add_abuse(cases, "recovery-press", "a ball of 20 mm pressed 25 mm deep into a block of 48 mm, and gone", 1000, kLarge,
            [](double time) {
              return Vec3{0, 0, 25e-3 * std::min(1.0, time / 0.5)};
            });
  add_abuse(cases, "recovery-stroke", "a stroke of a ball of 10 mm, 20 mm deep at 100 mm/s", 880, kMedium,
            [](double time) {
              constexpr double kDeep = 20e-3, kHalf = 24e-3;
              const double way = 0.1 * time, along = std::clamp(way - kDeep, 0.0, 2 * kHalf);
              return Vec3{along - kHalf, 0, std::min(way, kDeep) - std::max(0.0, way - kDeep - 2 * kHalf)};
            });
}

/// Momentum of all spheres and about the origin.
struct Momentum {
  Vec3 linear, angular;
};

Momentum momentum_of(const Model& model, const State& state) {
  Momentum sum;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 p = model.mass[i] * state.velocity[i];
    sum.linear += p, sum.angular += cross(state.position[i], p);
  }
  return sum;
}

std::string lost(const char* what, Vec3 before, Vec3 after, double scale) {
  constexpr double kMost = 0.01;
  const double share = norm(after - before) / scale;
  return share <= kMost ? "" : std::string(what) + " changed by " + output::short_number(100 * share, 3) + " %";
}

void add_spin(std::vector<StabilityCase>& cases) {
  const auto body = once<Body>([] { return fidelity::make_body(fidelity::ball_organ(kRadius, fidelity::Pace::live)); });
  StabilityCase what{.key = "spin",
                     .title = "a ball organ of 40 mm spins freely at 10 rad/s",
                     .expectation = "keeps its angular momentum to 1 % in 1 s, no energy gained",
                     .build = [=] { return body->get().model; }};
  what.disturb = [](const Model& model, State& state) {
    const Vec3 centre = fidelity::centre_of_mass(model, state.position);
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      state.velocity.set(i, cross({0, 0, 10}, state.position[i] - centre));
  };
  what.ticks = 1000, what.free_from = 0, what.reach = 0.2;
  what.also = [](const Model& model, const State& first, const State& last) {
    const Vec3 before = momentum_of(model, first).angular;
    return lost("angular momentum", before, momentum_of(model, last).angular, norm(before));
  };
  cases.push_back(what);
}

/// A scene of two organs of liver from meshes in the world, which meet.
Result<Model> two_organs(scenes::SceneSpec scene, const std::array<importers::RawMesh, 2>& meshes) {
  std::vector<FilledOrgan> organs;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    scenes::OrganSpec& organ = scene.organs[i];
    organ.name = i == 0 ? "first" : "second", organ.mesh = meshes[i].path, organ.material.preset = "liver";
    organ.fill.radius = organ.fill.gap = kRadius;
    Result<importers::Filling> filling = fidelity::fill_mesh(organ, meshes[i]);
    if (!filling) return filling.errors();
    organs.push_back(std::move(filling->organ));
  }
  Result<scenes::BuiltScene> built = scenes::build_model(scene, organs);
  if (!built) return built.errors();
  return std::move(built->model);
}

scenes::SceneSpec meeting(double gravity) {
  scenes::SceneSpec scene;
  scene.name = "meeting", scene.gravity = {0, 0, -gravity};
  scene.organs.resize(2), scene.organs_meet = true;
  return scene;
}

importers::RawMesh ball_organ_at(Vec3 centre) {
  importers::RawMesh mesh = fidelity::ball_mesh(kOrgan, 0.75 * kRadius);
  for (Vec3& v : mesh.vertex) v += centre;
  return mesh;
}

/// Height of the centre of mass of the first organ [m].
double height_of(const Model& model, const State& state) {
  double mass = 0, sum = 0;
  for (std::size_t i = 0; i < std::size_t(model.organs[0].count); ++i)
    mass += model.mass[i], sum += model.mass[i] * state.position.z[i];
  return sum / mass;
}

void add_meetings(std::vector<StabilityCase>& cases, bool is_quick) {
  constexpr double kDrop = 10e-3;
  const auto fall = once<Model>([] {
    scenes::SceneSpec scene = meeting(kGravity);
    scene.organs[1].anchors.resize(1);
    scene.organs[1].anchors[0].plane = scenes::PlaneRegion{{0, 0, -42e-3}, {0, 0, 1}};
    return two_organs(scene, {ball_organ_at({3e-3, 2e-3, kOrgan + kDrop}),
                              fidelity::box_mesh({-60e-3, -60e-3, -48e-3}, {60e-3, 60e-3, 0}, 0.75 * kRadius)});
  });
  StabilityCase rests{.key = "meeting-fall",
                      .title = "an organ falls 10 mm onto another, which is held",
                      .expectation = std::string("rests on it after ") + (is_quick ? "2" : "4") +
                                     " s: sunk by 10 to 20 mm, no energy gained",
                      .build = [=] { return fall->get(); }};
  rests.ticks = is_quick ? 2000 : 4000, rests.free_from = 0, rests.reach = 0.1, rests.end_speed = 10e-3;
  rests.also = [](const Model& model, const State& first, const State& last) {
    const double sunk = height_of(model, first) - height_of(model, last);
    return sunk > 0.9 * kDrop && sunk < 2 * kDrop ? std::string()
                                                  : "sank by " + output::short_number(1e3 * sunk, 3) + " mm";
  };
  cases.push_back(rests);

  const auto fly = once<Model>([] {
    const double aside = 0.5 * kOrgan, apart = std::sqrt(4 * kOrgan * kOrgan - aside * aside) + 2e-3;
    return two_organs(meeting(0), {ball_organ_at({}), ball_organ_at({aside, 1e-3, apart})});
  });
  StabilityCase meets{.key = "meeting-collision",
                      .title = "two organs fly at each other at 0.3 m/s each, off centre",
                      .expectation = "keep both momenta to 1 % in 0.4 s, no energy gained",
                      .build = [=] { return fly->get(); }};
  constexpr double kSpeed = 0.3;
  meets.disturb = [](const Model& model, State& state) {
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      state.velocity.z[i] = i < std::size_t(model.organs[0].count) ? kSpeed : -kSpeed;
  };
  meets.ticks = 400, meets.free_from = 0, meets.reach = 0.3;
  meets.also = [](const Model& model, const State& first, const State& last) {
    const Momentum before = momentum_of(model, first), after = momentum_of(model, last);
    double scale = 0;
    for (std::size_t i = 0; i < std::size_t(model.organs[0].count); ++i) scale += model.mass[i] * kSpeed;
    const std::string linear = lost("momentum", before.linear, after.linear, scale);
    return linear.empty() ? lost("angular momentum", before.angular, after.angular, norm(before.angular)) : linear;
  };
  cases.push_back(meets);
}

}  // namespace

void add_bodies(std::vector<StabilityCase>& cases, bool is_quick) {
  add_recovery(cases), add_spin(cases), add_meetings(cases, is_quick);
}

}  // namespace ctpm::stability
