// The cases: stiff, extreme or invalid values, and the conditions that must hold.

#include <array>
#include <cmath>
#include <numeric>

#include "core/network/network.h"
#include "core/stepping/step.h"
#include "scenes/build_model.h"
#include "scenes/presets.h"
#include "studio/output/number_text.h"
#include "studio/stability/blocks.h"
#include "studio/stability/bodies.h"

namespace ctpm::stability {
namespace {

using namespace stability;

std::string times(const char* what, double factor) { return std::string(what) + " x " + output::short_number(factor); }

void add_stiffness(std::vector<StabilityCase>& cases) {
  for (const double factor : {1e-3, 1.0, 1e3, 1e6}) {
    scenes::SceneSpec scene = block(5, 5, 5);
    scenes::MaterialSpec& m = scene.organs[0].material;
    m.spring = 15e6 * factor, m.kelvin = 15e6 * factor, m.constraint = 20e6 * factor;
    StabilityCase what = pressed("stiffness-" + output::short_number(factor), times("stiffness", factor), scene, 1);
    if (factor >= 1) what.end_speed = 1e-3, what.end_distance = 0.5e-3, what.expectation += ", back within 0.5 mm";
    cases.push_back(what);
  }
}

void add_viscosity(std::vector<StabilityCase>& cases) {
  // The springs beside the Kelvin units are not damped; only the organ's own viscosity brings it to rest soon.
  for (const double factor : {0.0, 1e-6, 1e-3, 1e3, 1e6}) {
    scenes::SceneSpec scene = block(5, 5, 5);
    scene.organs[0].material.viscosity = 5e6 * factor;
    cases.push_back(pressed("viscosity-" + output::short_number(factor), times("viscosity", factor), scene, 1));
  }
}

/// Every second sphere a thousand times as heavy, the others a thousandth.
void make_masses_uneven(Model& model) {
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 p = model.rest_position[i];
    const auto parity = std::llround((p.x + p.y + p.z) / kSpacing) & 1;
    model.mass[i] *= parity ? 1e3 : 1e-3;
  }
}

void add_masses(std::vector<StabilityCase>& cases) {
  const scenes::SceneSpec scene = block(5, 5, 5);
  StabilityCase what = pressed("mass-ratio-1e6", "mass ratio 1e6 between neighbours", scene, 2);
  what.build = [=] {
    Model model = build(scene);
    make_masses_uneven(model);
    return model;
  };
  cases.push_back(what);
}

void add_ticks(std::vector<StabilityCase>& cases, bool is_quick) {
  struct Length {
    double tick, seconds;
    const char* name;
  };
  for (const Length& length : {Length{1e-5, is_quick ? 0.02 : 0.2, "10 us"}, Length{1e-4, 0.2, "100 us"},
                               Length{1e-2, 3, "10 ms"}, Length{0.1, 20, "100 ms"}}) {
    scenes::SceneSpec scene = block(5, 5, 5);
    scene.tick = length.tick;
    const std::string title =
        std::string("ticks of ") + length.name + ", " + output::short_number(length.seconds) + " s";
    StabilityCase what =
        pressed("tick-" + output::short_number(length.tick * 1e6) + "us", title, scene, length.seconds);
    if (length.tick >= 1e-2) {
      what.end_speed = 1e-3, what.end_distance = 0.5e-3;
      what.expectation += ", back within 0.5 mm";
    }
    cases.push_back(what);
  }
}

void add_gravity(std::vector<StabilityCase>& cases) {
  for (const double factor : {1.0, 100.0}) {
    scenes::SceneSpec scene = block(5, 5, 5);
    scene.gravity = {0, 0, -kGravity * factor};
    StabilityCase what{.key = "gravity-" + output::short_number(factor),
                       .title = times("gravity", factor) + ", sudden",
                       .expectation = "sinks, no energy gained, at rest after 10 s",
                       .build = [=] { return build(scene); }};
    what.ticks = 10'000, what.free_from = 0, what.end_speed = 1e-3;
    what.reach = factor > 1 ? 0.3 : 10e-3;
    cases.push_back(what);
  }
}

/// A step load of 100 N on the sphere at `at`.
StabilityCase loaded(const std::string& key, const std::string& title, scenes::SceneSpec scene, Vec3 at, Vec3 force) {
  scene.loads.push_back({at, force, 0, 0});
  return {.key = key, .title = title, .expectation = {}, .build = [=] { return build(scene); }, .ticks = 3000};
}

/// Eq. 8 bounds the force of a sphere's springs, so 100 N tear a sphere out of a surface. Without softening they do
/// not.
void add_loads(std::vector<StabilityCase>& cases) {
  const scenes::SceneSpec softened = block(5, 5, 5);
  scenes::SceneSpec plain = softened;
  plain.organs[0].softening = false;
  const Vec3 top{0, 0, 4 * kSpacing};
  for (const bool is_push : {true, false}) {
    StabilityCase what = loaded(is_push ? "load-100n-push" : "load-100n-pull",
                                std::string("100 N on a surface sphere, ") + (is_push ? "pushed in" : "pulled out"),
                                plain, top, is_push ? Vec3{0, 0, -100} : Vec3{60, 0, 80});
    what.reach = 0.5, what.end_speed = 1e-3;
    what.expectation = "without softening: within 500 mm, at rest after 3 s";
    cases.push_back(what);
  }
  StabilityCase torn =
      loaded("load-100n-torn", "100 N on a surface sphere, with softening", softened, top, {60, 0, 80});
  torn.ticks = 50;
  torn.expectation = "Eq. 8 cannot hold 100 N: the sphere leaves, no faster than the force alone would drive it";
  torn.reach = 0.5 * 100 / build(softened).mass[0] * 0.05 * 0.05;
  cases.push_back(torn);
}

void add_teleports(std::vector<StabilityCase>& cases) {
  constexpr double kDepth = 50e-3;
  for (const std::int64_t stay : {std::int64_t(1), std::int64_t(100)}) {
    const scenes::SceneSpec scene = block(7, 7, 7);
    const Vec3 outside = touch(7);
    StabilityCase what{
        .key = "teleport-" + std::to_string(stay),
        .title = "tool 50 mm into the organ in one tick, out after " + std::to_string(stay),
        .expectation = "within 100 mm, no energy gained after that, back within 1 mm and at rest after 3 s",
        .build = [=] { return build(scene); }};
    what.hand = [=](std::int64_t tick) {
      if (tick > 20 + stay) return Inputs{};
      const bool is_inside = tick >= 10 && tick < 10 + stay;
      return ball_at(is_inside ? outside - Vec3{0, 0, kDepth} : outside);
    };
    what.ticks = 3000, what.free_from = 25 + stay;
    what.reach = 0.1, what.end_speed = 1e-3, what.end_distance = 1e-3;
    cases.push_back(what);
  }
}

/// A release from a deformed shape.
StabilityCase let_go(const std::string& key, const std::string& title,
                     std::function<void(const Model&, State&)> disturb) {
  const scenes::SceneSpec scene = block(5, 5, 5);
  StabilityCase what{.key = key,
                     .title = title,
                     .expectation = "within 150 mm, no energy gained, at rest after 3 s",
                     .build = [=] { return build(scene); },
                     .disturb = std::move(disturb)};
  what.ticks = 3000, what.free_from = 0, what.reach = 0.15, what.end_speed = 1e-3;
  return what;
}

void add_shapes(std::vector<StabilityCase>& cases) {
  const auto middle = [](const Model& model) {
    return std::size_t(scenes::nearest_sphere(model, {0, 0, 2 * kSpacing}));
  };
  StabilityCase pair = let_go("coincident-two", "two spheres at one place", [=](const Model& model, State& state) {
    state.position.set(middle(model), model.rest_position[middle(model) + 1]);
  });
  pair.end_distance = 1e-3, pair.expectation += ", back within 1 mm";
  cases.push_back(pair);
  StabilityCase point = let_go("coincident-all", "all free spheres at one place", [](const Model& model, State& state) {
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      if (model.held_axes[i] == 0) state.position.set(i, {0, 0, 2 * kSpacing});
  });
  cases.push_back(
      let_go("inverted-one", "one sphere pulled through its neighbour", [=](const Model& model, State& state) {
        state.position.add(middle(model), {2 * kSpacing, 0, 0});
      }));
  StabilityCase inverted = let_go("inverted-all", "the block turned inside out", [](const Model& model, State& state) {
    for (std::size_t i = 0; i < model.sphere_count(); ++i) {
      const Vec3 p = model.rest_position[i];
      if (model.held_axes[i] == 0) state.position.set(i, {-p.x, p.y, -p.z});
    }
  });
  for (StabilityCase* what : {&point, &inverted}) {
    // The organ unfolds slowly.
    what->ticks = 20'000;
    what->expectation = "within 150 mm, no energy gained, at rest after 20 s";
    cases.push_back(*what);
  }
}

/// Velocities of up to 0.5 m/s in all directions, the same everywhere (a 64-bit linear congruential
/// generator).
void kick(const Model& model, State& state) {
  std::uint64_t seed = 42;
  const auto next = [&] {
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return 0.5 * double(std::int64_t(seed) >> 11) / double(1ll << 52);
  };
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const double x = next(), y = next(), z = next();
    if (model.held_axes[i] == 0) state.velocity.set(i, {x, y, z});
  }
}

/// Free oscillation: without external work, energy must not grow in any structure.
void add_swings(std::vector<StabilityCase>& cases) {
  struct Kind {
    network::Structure structure;
    bool has_softening;
    double viscosity;
    const char* name;
  };
  for (const Kind& kind : {Kind{network::Structure::mass_spring, false, 0, "mass-spring"},
                           Kind{network::Structure::angle_mass_spring, false, 0, "angle mass-spring"},
                           Kind{network::Structure::tpm, false, 0, "tpm without viscosity"},
                           Kind{network::Structure::tpm, false, 5e6, "tpm"},
                           Kind{network::Structure::ctpm, false, 5e6, "ctpm without softening"},
                           Kind{network::Structure::ctpm, true, 5e6, "ctpm"},
                           Kind{network::Structure::ctpm, true, 0, "ctpm without viscosity"}}) {
    scenes::SceneSpec scene = block(5, 5, 5);
    scenes::OrganSpec& organ = scene.organs[0];
    organ.structure = kind.structure, organ.softening = kind.has_softening, organ.material.viscosity = kind.viscosity;
    std::string key = std::string("swing-") + kind.name;
    for (char& c : key) c = c == ' ' ? '-' : c;
    cases.push_back({.key = key,
                     .title = std::string("free swing, ") + kind.name,
                     .expectation = "starts in shape at up to 0.9 m/s: no energy gained in 2 s",
                     .build = [=] { return build(scene); },
                     .disturb = kick,
                     .ticks = 2000,
                     .reach = 30e-3,
                     .free_from = 0});
  }
}

/// A row of spheres along x; the first one anchored if asked.
scenes::SceneSpec chain(int count) {
  scenes::SceneSpec scene = block(count, 1, 1);
  scene.gravity = {0, 0, -kGravity};
  scene.organs[0].anchors[0] = {};
  const double end = -0.5 * kSpacing * (count - 1);
  scene.organs[0].anchors[0].sphere = scenes::SphereRegion{{end, 0, 0}, 1e-3};
  return scene;
}

std::string falls_freely(const Model& model, const State& first, const State& last) {
  const double time = double(last.tick - first.tick) * model.tick, way = 0.5 * norm(model.gravity) * time * time;
  double worst = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    worst = std::max(worst, norm(last.position[i] - first.position[i] - Vec3{0, 0, -way}));
  return worst <= 0.01 * way ? "" : "is " + output::short_number(1e3 * worst) + " mm from where it must have fallen";
}

/// One sphere without elements.
Model single_sphere() {
  scenes::SceneSpec scene = block(1, 1, 1);
  scene.gravity = {0, 0, -kGravity};
  const scenes::OrganSpec& organ = scene.organs[0];
  network::OrganSettings settings;
  settings.name = organ.name, settings.material = scenes::resolve_material(organ.material).material;
  Model model;
  model.gravity = scene.gravity;
  const Result<Done> added = network::add_organ(model, scenes::fill_rig(organ), settings);
  CTPM_CHECK(bool(added), "one sphere is an organ");
  return model;
}

void add_holds(std::vector<StabilityCase>& cases) {
  cases.push_back({.key = "chain",
                   .title = "a chain one sphere thick, held at one end, under gravity",
                   .expectation = "swings down and stays within 0.6 m",
                   .build = [] { return build(chain(20)); },
                   .ticks = 3000,
                   .reach = 0.6,
                   .free_from = 0});
  scenes::SceneSpec hung = block(5, 5, 5);
  hung.gravity = {0, 0, -kGravity};
  hung.organs[0].anchors[0] = {};
  hung.organs[0].anchors[0].sphere = scenes::SphereRegion{{0, 0, 4 * kSpacing}, 1e-3};
  cases.push_back({.key = "one-anchor",
                   .title = "one anchored sphere holds the block, under gravity",
                   .expectation = "hangs within 0.3 m, no energy gained",
                   .build = [=] { return build(hung); },
                   .ticks = 3000,
                   .reach = 0.3,
                   .free_from = 0});
  scenes::SceneSpec loose = hung;
  loose.organs[0].anchors.clear();
  cases.push_back({.key = "no-anchor",
                   .title = "no anchored sphere, under gravity",
                   .expectation = "falls as a free body, to 1 % in 1 s",
                   .build = [=] { return build(loose); },
                   .ticks = 1000,
                   .reach = 5.5,
                   .free_from = 0,
                   .also = falls_freely});
  cases.push_back({.key = "single",
                   .title = "a single sphere, under gravity",
                   .expectation = "falls as a free body, to 1 % in 1 s",
                   .build = single_sphere,
                   .ticks = 1000,
                   .reach = 5.5,
                   .free_from = 0,
                   .also = falls_freely});
  cases.push_back({.key = "empty",
                   .title = "no sphere at all",
                   .expectation = "nothing happens",
                   .build = [] { return Model{}; },
                   .ticks = 10,
                   .reach = 0.001,
                   .free_from = 0});
}

/// Number of pieces: parts that no unsevered axial element joins.
std::int64_t count_pieces(const Model& model, const State& state) {
  std::vector<std::size_t> parent(model.sphere_count());
  std::iota(parent.begin(), parent.end(), std::size_t(0));
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const AxialElements& axial = model.axial;
  for (std::size_t e = 0; e < axial.size(); ++e)
    if (!state.axial_severed[e]) parent[root(std::size_t(axial.a[e]))] = root(std::size_t(axial.b[e]));
  std::int64_t pieces = 0;
  for (std::size_t i = 0; i < parent.size(); ++i) pieces += root(i) == i;
  return pieces;
}

/// Eleven planes through a block of 10 x 10 x 8 spheres leave 5 x 5 x 4 pieces. Each plane takes three ticks:
/// empty hand, blade beside the block, blade at its other side.
Inputs dice(std::int64_t tick) {
  constexpr std::int64_t kPlanes = 4 + 4 + 3;
  if (tick >= 3 * kPlanes || tick % 3 == 0) return {};
  const std::int64_t plane = tick / 3;
  const double side = tick % 3 == 1 ? -0.2 : 0.2;
  Inputs inputs;
  inputs.tool = kScalpel;
  if (plane < 8) {
    // Upright blade between every second layer of spheres.
    const double at = kSpacing * (2.0 * double(plane % 4) - 3);
    inputs.position = plane < 4 ? Vec3{at, side, -0.2} : Vec3{side, at, -0.2};
  } else {
    const double at = kSpacing * (2.0 * double(plane - 8) + 1.5), half = std::sqrt(0.5);
    inputs.position = {-0.2, side, at};
    inputs.world_from_tool = {half, 0, half, 0};  // the edge along +x
  }
  return inputs;
}

void add_cut(std::vector<StabilityCase>& cases) {
  scenes::SceneSpec scene = block(10, 10, 8);
  scene.gravity = {0, 0, -kGravity};
  cases.push_back({.key = "hundred-pieces",
                   .title = "a cut into a hundred pieces, under gravity",
                   .expectation = "100 pieces, none falls further than freely in 0.3 s",
                   .build = [=] { return build(scene); },
                   .hand = dice,
                   .ticks = 300,
                   .reach = 0.5 * kGravity * 0.09 * 1.05 + 0.03,
                   .also =
                       [](const Model& model, const State&, const State& last) {
                         const std::int64_t pieces = count_pieces(model, last);
                         return pieces == 100 ? std::string() : "there are " + std::to_string(pieces) + " pieces";
                       }});
}

/// Pressed and let go under gravity, long enough for the whole to answer; of the largest, where a wave goes through
/// it once: until that comes from below, its top falls freely.
void add_many(std::vector<StabilityCase>& cases, bool is_quick) {
  const auto add = [&](const char* key, double n, double seconds) {
    scenes::SceneSpec scene = block(n, n, n);
    scene.gravity = {0, 0, -kGravity};
    const std::string count = std::to_string(std::int64_t(n * n * n)) + " spheres";
    cases.push_back(pressed(key, count + ", pressed and let go, under gravity", scene, seconds));
  };
  constexpr double kWave = 0.1, kPressed = 6e-3;  // [s], [m]
  if (!is_quick) {
    add("many", 47, kWave);
    cases.back().reach = 0.5 * kGravity * kWave * kWave * 1.05 + kPressed;
    cases.back().expectation =
        "pressed 6 mm and let go: none sinks further than by that and freely in 0.1 s, no energy gained after that";
  }
  add("many-4096", 16, is_quick ? 0.5 : 3);
}

/// Inputs that a faulty device may send, each in one tick, with good ticks between them.
Inputs broken(std::int64_t kind, Inputs inputs) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = INFINITY;
  switch (kind) {
    case 0:
      inputs.position.x = kNan;
      break;
    case 1:
      inputs.position.y = kInf;
      break;
    case 2:
      inputs.position.z = -kInf;
      break;
    case 3:
      inputs.world_from_tool.w = kNan;
      break;
    case 4:
      inputs.world_from_tool = {0, 0, 0, 0};
      break;
    case 5:
      inputs.world_from_tool = {kInf, 0, 0, 0};
      break;
    case 6:
      inputs.world_from_tool.x = 3;
      break;
    case 7:
      inputs.tool = 99;
      break;
    case 8:
      inputs.tool = -7;
      break;
    default:
      break;
  }
  return inputs;
}

void add_device(std::vector<StabilityCase>& cases) {
  const scenes::SceneSpec scene = block(5, 5, 5);
  StabilityCase what = pressed("device-nan", "NaN, infinity and unknown tools from the device", scene, 1);
  const auto good = what.hand;
  what.is_bad_input = [](std::int64_t tick) { return tick < 90 && tick % 10 == 5; };
  what.hand = [good, is_bad = what.is_bad_input](std::int64_t tick) {
    return is_bad(tick) ? broken(tick / 10, good(tick)) : good(tick);
  };
  what.expectation = "those ticks are refused and leave the State as it was; the press goes on: " + what.expectation;
  cases.push_back(what);

  StabilityCase far = pressed("device-far", "the device jumps to 1e3, 1e100 and 1e300 m and back", scene, 1);
  far.hand = [good](std::int64_t tick) {
    Inputs inputs = good(tick);
    const double jump = tick == 20 ? 1e3 : tick == 30 ? 1e100 : tick == 40 ? 1e300 : 0;
    if (jump > 0) inputs.position = {jump, -jump, jump};
    return inputs;
  };
  cases.push_back(far);
}

/// The block hangs in equilibrium; nothing may drift.
void add_rest(std::vector<StabilityCase>& cases, bool is_quick) {
  scenes::SceneSpec scene = block(2, 2, 3);
  scene.gravity = {0, 0, -kGravity};
  constexpr double kDrift = 5e-6;  // allowed by the solver's velocity floor of 1e-6 m/s, also over an hour
  StabilityCase what{.key = "rest",
                     .title = is_quick ? "10 s at rest under gravity" : "an hour at rest under gravity",
                     .expectation = "after 5 s of settling, nothing drifts by more than 0.005 mm",
                     .build = [=] { return build(scene); }};
  what.disturb = [](const Model& model, State& state) {
    stepping::Stepper stepper(model);
    for (int i = 0; i < 5000; ++i) stepper.step(state, {});
  };
  what.ticks = is_quick ? 10'000 : 3'600'000, what.reach = 10e-3, what.free_from = 0;
  what.end_speed = 1e-4;
  what.also = [](const Model& model, const State& first, const State& last) {
    double drift = 0;
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      drift = std::max(drift, norm(last.position[i] - first.position[i]));
    return drift <= kDrift ? std::string() : "drifted by " + output::short_number(1e3 * drift) + " mm";
  };
  cases.push_back(what);
}

}  // namespace

std::vector<StabilityCase> stability_cases(bool is_quick) {
  std::vector<StabilityCase> cases;
  add_many(cases, is_quick);  // the longest first, to balance the threads
  add_rest(cases, is_quick);
  add_stiffness(cases);
  add_viscosity(cases);
  add_masses(cases);
  add_ticks(cases, is_quick);
  add_gravity(cases);
  add_loads(cases);
  add_teleports(cases);
  add_shapes(cases);
  add_swings(cases);
  add_holds(cases);
  add_cut(cases);
  add_device(cases);
  add_bodies(cases, is_quick);
  return cases;
}

}  // namespace ctpm::stability
