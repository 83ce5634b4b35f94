// The two tilings of the CTPM on a block that a ball enters, against Lee & Radok.

#include <algorithm>
#include <cmath>

#include "core/model/nearest_rank.h"
#include "studio/bench/bench.h"
#include "studio/fidelity/recipes.h"
#include "studio/fidelity/references.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

constexpr double kHeight = 60e-3, kBall = 20e-3, kDepth = 4e-3;  // [m]
constexpr double kHold = 1.5;                                    // [s], 9 time constants
/// Of a gas: Lee & Radok know no inertia.
constexpr double kDensity = 1;  // [kg/m^3]
constexpr double kPushed = 8;   ///< surface spheres along each side of the square that are pushed one by one
constexpr double kPush = 0.13;  // [N], for a tick

struct Kind {
  const char* name;
  scenes::TilingSpec tiling;
};
constexpr Kind kKinds[] = {{"three-spheres", scenes::TilingSpec::three_spheres},
                           {"two-spheres", scenes::TilingSpec::two_spheres}};

/// What one tiling does at one radius.
struct Tiled {
  std::size_t spheres = 0;
  std::vector<double> ratios;  ///< force at the ramp's end over that at the end, one a place
  double final_force = 0;      ///< mean over the places [N]
  double touch_spread = 0;     ///< largest over smallest way of a surface sphere that is pushed for a tick [1]
  std::vector<double> seconds;
};

BenchMotion ramp_and_hold(const fidelity::Body& body, Vec3 place, double ramp) {
  const fidelity::PressSite site{place, {0, 0, -1}};
  BenchMotion motion;
  const auto ticks = std::int64_t(std::llround(ramp / body.model.tick));
  motion.ticks = ticks + std::int64_t(std::llround(kHold / body.model.tick));
  motion.hand = [&body, site, ticks](std::int64_t tick) {
    const double depth = kDepth * std::min(1.0, double(tick + 1) / double(ticks));
    return fidelity::ball_at(0, fidelity::ball_centre(body, 0, site, depth));
  };
  return motion;
}

/// Way of a surface sphere under kPush after a tick, each of the kPushed^2 nearest the block's middle: the largest over
/// the smallest.
double touch_spread(const fidelity::Body& body) {
  const double top = kHeight - body.spacing(), half = 0.5 * kPushed * body.spacing();
  double least = INFINITY, most = 0;
  for (std::size_t i = 0; i < body.model.sphere_count(); ++i) {
    const Vec3 p = body.model.rest_position[i];
    if (p.z < top || p.z > kHeight || std::abs(p.x) > half || std::abs(p.y) > half) continue;
    Model model = body.model;
    model.loads.sphere = {std::int32_t(i)}, model.loads.start = {0}, model.loads.ramp = {0};
    model.loads.force = {}, model.loads.force.push_back({0, 0, -kPush});
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    (void)stepper.step(state, {});
    const double way = p.z - state.position.z[i];
    least = std::min(least, way), most = std::max(most, way);
  }
  return most / least;
}

Result<Tiled> press_tiled(const Kind& kind, double radius, double ramp) {
  fidelity::Specimen specimen = fidelity::block({96e-3, 96e-3, kHeight}, radius, fidelity::Pace::live, {kBall});
  specimen.friction = 0, specimen.tiling = kind.tiling;
  const Result<fidelity::Body> heavy = fidelity::make_body(specimen);
  specimen.density = kDensity;
  const Result<fidelity::Body> body = fidelity::make_body(specimen);
  if (!heavy) return heavy.errors();
  if (!body) return body.errors();
  Tiled tiled;
  tiled.spheres = body->model.sphere_count(), tiled.touch_spread = touch_spread(*heavy);
  const auto end = std::size_t(std::llround(ramp / body->model.tick)) - 1;
  for (const double share : {0.0, 0.25, 0.5}) {
    const Vec3 place{share * body->spacing(), share * body->spacing(), kHeight};
    const BenchRun run = run_motion(body->model, ramp_and_hold(*body, place, ramp));
    tiled.ratios.push_back(run.force[end].z / run.force.back().z);
    tiled.final_force += run.force.back().z / 3;
    // Run times are those of tissue with its own density.
    const BenchRun timed = run_motion(heavy->model, ramp_and_hold(*heavy, place, ramp));
    tiled.seconds.insert(tiled.seconds.end(), timed.seconds.begin(), timed.seconds.end());
  }
  return tiled;
}

}  // namespace

Result<BenchStudy> run_bench_tiling(const BenchOptions& options, const BenchProgress& progress) {
  const fidelity::Ramp& ramp = fidelity::kRamps[1];
  BenchStudy study;
  reports::Section& section = study.section;
  section.key = "tiling", section.title = "Tiling: triples of three spheres, or a whole unit in every edge";
  study.points = bench_layout();
  reports::Table table;
  table.columns = {{"tiling", "tiling"},
                   {"radius_mm", "r [mm]", 3},
                   {"spheres", "spheres"},
                   {"ratio", "force after 50 ms over final force", 4},
                   {"off_percent", "off Lee & Radok [%]", 3},
                   {"scatter_percent", "scatter over places [%]", 3},
                   {"final_n", "final force [N]", 4},
                   {"touch_spread", "way of a pushed sphere, most over least", 3},
                   {"tick_p50_ms", "tick p50 [ms]", 3},
                   {"tick_p99_ms", "p99 [ms]", 3}};
  const std::vector<double> radii = options.is_quick ? std::vector<double>{4e-3} : std::vector<double>{4e-3, 2e-3};
  std::int64_t done = 0;
  for (const double radius : radii)
    for (const Kind& kind : kKinds) {
      const Result<Tiled> tiled = press_tiled(kind, radius, ramp.time);
      if (!tiled) return tiled.errors();
      const fidelity::Spread spread = fidelity::spread_of(tiled->ratios);
      const double off = spread.mean / ramp.ratio.value - 1;
      const double p50 = 1e3 * percentile(tiled->seconds, 0.5), p99 = 1e3 * percentile(tiled->seconds, 0.99);
      table.rows.push_back({std::string(kind.name), 1e3 * radius, std::int64_t(tiled->spheres), spread.mean, 100 * off,
                            100 * (spread.most - spread.least) / spread.mean, tiled->final_force, tiled->touch_spread,
                            p50, p99});
      study.points.rows.push_back({std::string("tiling"), std::string("block"), std::string(kind.name), reports::Cell(),
                                   reports::Cell(), reports::Cell(), 1e3 * radius, reports::Cell(),
                                   std::int64_t(tiled->spheres), reports::Cell(), std::abs(off), reports::Cell(), p50,
                                   p99, reports::Cell(), reports::Cell(), reports::Cell(), reports::Cell()});
      study.sentences.push_back("tiling " + std::string(kind.name) + ", r = " + output::short_number(1e3 * radius) +
                                " mm: " + output::short_number(100 * std::abs(off)) +
                                " % off Lee & Radok after 50 ms, pushed surface spheres differ " +
                                output::short_number(tiled->touch_spread) + " times, tick p50 " +
                                output::short_number(p50) + " ms");
      progress(++done, std::int64_t(2 * radii.size()));
    }
  section.paragraphs = {
      "A block of liver, 96 x 96 x 60 mm, that a ball of 20 mm enters by 4 mm in 50 ms and holds, at three places over "
      "a "
      "lattice cell. Lee & Radok's ratio of the force then to the final force is " +
      output::short_number(ramp.ratio.value) +
      ". In the paper's tiling some spheres have only elements without a dashpot and others only such with one, so a "
      "surface sphere that is pushed by 0.13 N for a tick gives way or hardly moves; the default of organs from meshes "
      "has a spring and a Kelvin unit in every edge, of the same static stiffness."};
  section.tables = {table};
  return study;
}

}  // namespace ctpm::bench
