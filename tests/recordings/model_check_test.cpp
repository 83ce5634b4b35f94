// Checks of a Model or a State from a file: every field must have its shape and range.

#include "recordings/internal/model_check.h"

#include <functional>
#include <limits>

#include "recordings/internal/field_codec.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using recordings::session_file::check_model;
using recordings::session_file::check_state;

/// A Model with an entry in every array.
Model rich_model() {
  Model model = make_block_model(5, 3, 3, network::Structure::ctpm, liver_material(), 0.012, 10);
  model.tools = {ball(0.006), scalpel(0.02), {"pin", ToolKind::pin, 0, 0, 3}};
  model.angle_springs.a = {0}, model.angle_springs.b = {1}, model.angle_springs.c = {2};
  model.angle_springs.k = {1}, model.angle_springs.edge[0] = {0}, model.angle_springs.edge[1] = {1};
  model.loads.sphere = {4}, model.loads.start = {0}, model.loads.ramp = {0.1};
  model.loads.force = Vec3Array(1);
  CutResistance& cut = model.cut_resistance;
  cut.energy.assign(model.axial.size(), 1), cut.friction.assign(model.axial.size(), 1);
  Obstacle mesh{"mesh", ObstacleKind::mesh, {}, {}, {}};
  for (const Vec3 v : {Vec3{}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) mesh.vertex.push_back(v);
  mesh.corner = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  model.obstacles = {mesh, {"box", ObstacleKind::box, {}, {}, {1, 1, 1}}};
  return model;
}

enum class Harm { not_a_number, another_length, far_too_large };

/// Damages field number `target`, counted over all fields and those of structures in lists.
class Spoiler {
 public:
  Spoiler(Harm harm, int target) : harm_(harm), target_(target) {}
  std::string spoiled;  ///< name of the field; empty if this damage does not apply to it
  bool is_over() const { return at_ <= target_; }

  template <class T>
  void operator()(std::string_view name, T& value) {
    if (at_++ == target_ && spoil(value)) spoiled = name;
  }

  template <class T>
  void operator()(std::string_view name, std::vector<T>& values) {
    if constexpr (recordings::session_file::Structure_<T>) {
      for (T& value : values) for_each_field(value, *this);
    } else {
      if (at_++ != target_) return;
      bool is_done = false;
      if (harm_ == Harm::another_length)
        values.push_back(values.empty() ? T{} : values.back()), is_done = true;
      else if (!values.empty())
        is_done = spoil(values.back());
      if (is_done) spoiled = name;
    }
  }

 private:
  template <class T>
  bool spoil(T& value) const {
    if constexpr (std::is_same_v<T, double>) {
      if (harm_ == Harm::not_a_number) return value = std::numeric_limits<double>::quiet_NaN(), true;
    } else if constexpr (std::is_same_v<T, Vec3>) {
      return spoil(value.y);
    } else if constexpr (std::is_same_v<T, std::int32_t> || std::is_same_v<T, std::uint8_t>) {
      if (harm_ == Harm::far_too_large) return value = T(1'100'000'200), true;
    } else if constexpr (std::is_enum_v<T>) {
      if (harm_ == Harm::far_too_large) return value = static_cast<T>(63), true;
    }
    return false;
  }

  Harm harm_;
  int target_, at_ = 0;
};

/// Names of the fields whose damage is not detected, and the number of damaged fields.
template <class S>
std::pair<std::set<std::string>, int> unnoticed(Harm harm, const S& whole,
                                                const std::function<bool(const S&)>& notices) {
  std::set<std::string> names;
  int harmed = 0;
  for (int target = 0;; ++target) {
    S copy = whole;
    Spoiler spoiler(harm, target);
    for_each_field(copy, spoiler);
    if (spoiler.is_over()) return {names, harmed};
    if (spoiler.spoiled.empty()) continue;
    ++harmed;
    if (!notices(copy)) names.insert(spoiler.spoiled);
  }
}

TEST(ModelCheck, NoFieldOfAModelTakesNaNAnotherLengthOrAnIndexBeyondItsArray) {
  const Model whole = rich_model();
  ASSERT_TRUE(check_model(whole).empty()) << text_of(check_model(whole));
  const std::function<bool(const Model&)> notices = [](const Model& m) { return !check_model(m).empty(); };
  const auto [with_nan, numbers] = unnoticed(Harm::not_a_number, whole, notices);
  EXPECT_EQ(with_nan, std::set<std::string>{});
  EXPECT_GT(numbers, 30);
  const auto [of_other_length, arrays] = unnoticed(Harm::another_length, whole, notices);
  EXPECT_EQ(of_other_length, std::set<std::string>{});
  EXPECT_GT(arrays, 40);
  const auto [too_large, integers] = unnoticed(Harm::far_too_large, whole, notices);
  EXPECT_EQ(too_large, std::set<std::string>{});
  EXPECT_GT(integers, 20);
}

TEST(ModelCheck, NoFieldOfAStateTakesNaNAnotherLengthOrAnIndexBeyondItsArray) {
  const Model model = rich_model();
  State whole = rest_state(model);
  whole.acceleration.resize(model.sphere_count());
  ASSERT_TRUE(check_state(model, whole).empty()) << text_of(check_state(model, whole));
  const std::function<bool(const State&)> notices = [&](const State& s) { return !check_state(model, s).empty(); };
  EXPECT_EQ(unnoticed(Harm::not_a_number, whole, notices).first, (std::set<std::string>{"last_inputs.position"}))
      << "only a tool's pose is looked at, and a refused one may be anything";
  EXPECT_EQ(unnoticed(Harm::another_length, whole, notices).first, std::set<std::string>{});
  EXPECT_EQ(unnoticed(Harm::far_too_large, whole, notices).first, (std::set<std::string>{"axial_crossing"}))
      << "every byte is a place on an element";
}

struct Case {
  const char* message;
  std::function<void(Model&)> spoil;
};

TEST(ModelCheck, NamesTheFieldAndWhatItMustBe) {
  const Case cases[] = {
      {"tick must be in [1e-07, 1]", [](Model& m) { m.tick = 0; }},
      {"mass[2] must be in [1e-18, 1e+18]", [](Model& m) { m.mass[2] = 0; }},
      {"held_axes[1] has unknown bits", [](Model& m) { m.held_axes[1] = 8; }},
      {"contact_friction must be in [0, 1000]", [](Model& m) { m.contact_friction = -0.1; }},
      {"gravity must be in [-10000, 10000]", [](Model& m) { m.gravity.z = -INFINITY; }},
      {"axial.k[0] must be in [1e-18, 1e+18]", [](Model& m) { m.axial.k[0] = -1; }},
      {"loads.ramp[0] must be in [0, 1000000000]", [](Model& m) { m.loads.ramp[0] = -1e-9; }},
      {"constraints.edge3[0] is -1, must be in [0, ", [](Model& m) { m.constraints.edge[3][0] = -1; }},
      {"tools[0].radius must be in [0, 1000]", [](Model& m) { m.tools[0].radius = -1; }},
      {"tools[2] is a pin that holds no sphere", [](Model& m) { m.tools[2].sphere = -1; }},
      {"tools[1].kind is of an unknown kind", [](Model& m) { m.tools[1].kind = static_cast<ToolKind>(3); }},
      {"organs[0] is not a range of spheres", [](Model& m) { ++m.organs[0].count; }},
      {"axial[0] joins a sphere with itself", [](Model& m) { m.axial.b[0] = m.axial.a[0]; }},
      {"obstacles[0].corner[1] is 4, must be in [0, 4)", [](Model& m) { m.obstacles[0].corner[1] = 4; }},
      {"obstacles[0].corner must have three entries", [](Model& m) { m.obstacles[0].corner.clear(); }},
      {"obstacles[1].corner must be empty but of a mesh",
       [](Model& m) {
         m.obstacles[1].corner = {0, 0, 0};
       }},
      {"obstacles[0].vertex.y[2] must be in [-1000, 1000]", [](Model& m) { m.obstacles[0].vertex.y[2] = INFINITY; }},
      {"solver.tolerance must be in (1e-16, 1)", [](Model& m) { m.solver.tolerance = 1; }},
      {"solver.sleep_bound must be in [0, 1000]", [](Model& m) { m.solver.sleep_bound = -1; }},
      {"solver.velocity_enough must be in [0, 1000]", [](Model& m) { m.solver.velocity_enough = -1; }},
      {"solver.max_iterations must be in [1, 1000000]", [](Model& m) { m.solver.max_iterations = 0; }},
      {"solver.substeps must be in [1, 10000]", [](Model& m) { m.solver.substeps = 10001; }},
      {"solver.integrator is of an unknown kind", [](Model& m) { m.solver.integrator = static_cast<Integrator>(3); }},
      {"tissue_cells.k[1] must be in [1e-18, 1e+18]", [](Model& m) { m.tissue_cells.k[1] = 0; }},
      {"tissue_cells.corner7[0] is 45, must be in [0, 45)", [](Model& m) { m.tissue_cells.corner[7][0] = 45; }},
      {"tissue_cells[2] is inside out or flat at rest",
       [](Model& m) { std::swap(m.tissue_cells.corner[0][2], m.tissue_cells.corner[1][2]); }},
      {"inversion_threshold must be in (0, 1)", [](Model& m) { m.inversion_threshold = 1; }},
      {"cut_resistance.friction has 0 entries, expected ", [](Model& m) { m.cut_resistance.friction.clear(); }},
  };
  for (const Case& one : cases) {
    Model model = rich_model();
    one.spoil(model);
    const Errors errors = check_model(model);
    ASSERT_FALSE(errors.empty()) << one.message;
    EXPECT_TRUE(errors[0].message.starts_with(one.message)) << errors[0].message << "\ninstead of " << one.message;
  }
  Model softening = rich_model();
  softening.has_softening = true, softening.axial.third.clear();
  EXPECT_FALSE(check_model(softening).empty());
}

}  // namespace
}  // namespace ctpm
