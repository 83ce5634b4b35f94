// Models and States written by earlier programs.

#include "recordings/internal/legacy_fields.h"

#include <numeric>

#include "recordings/internal/model_check.h"
#include "tests/recordings/earlier_fields.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using namespace ctpm::recordings::session_file;

constexpr std::uint64_t kBudget = 64 << 20;  // [bytes]

template <class S>
Bytes bytes_of(const S& structure) {
  Bytes bytes;
  put_fields(bytes, structure);
  return bytes;
}

template <class Get, class S>
std::string read(Get&& get, const Bytes& bytes, S& structure) {
  std::string problem;
  ByteReader in(bytes, kBudget);
  get(in, structure, problem);
  return problem;
}

/// A block with springs, Kelvin units, two-sphere TPMs, constraints and cut resistance.
Model tough_block(network::Structure structure, double viscosity = 5e6) {
  network::Material material = liver_material();
  material.viscosity = viscosity, material.fracture_toughness = 100, material.blade_friction = 2000;
  Model model = make_block_model(6, 5, 4, structure, material);
  model.tools = {scalpel(0.2)};
  return model;
}

TEST(LegacyFields, AModelOfTwoTablesReadsAsTheSameModel) {
  for (const network::Structure structure : {network::Structure::mass_spring, network::Structure::angle_mass_spring,
                                             network::Structure::tpm, network::Structure::ctpm})
    for (const double viscosity : {0.0, 5e6}) {
      const Model model = tough_block(structure, viscosity);
      Model read_back;
      ASSERT_EQ(read(get_model, earlier_bytes(model), read_back), "");
      EXPECT_TRUE(check_model(read_back).empty());
      EXPECT_TRUE(bytes_of(read_back) == bytes_of(model)) << "structure " << int(structure) << ", v1 " << viscosity;
    }
}

TEST(LegacyFields, AStateOfTwoTablesReadsAsTheSameState) {
  const Model model = tough_block(network::Structure::ctpm);
  ASSERT_GT(model.axial.internal_count(), 0u);
  State state = rest_state(model);
  stepping::Stepper stepper(model);
  for (int i = 0; i < 60; ++i) {
    Inputs inputs;
    inputs.tool = 0, inputs.position = {0.0002, -0.06 + 0.002 * i, -0.05};
    ASSERT_FALSE(stepping::is_refused(stepper.step(state, inputs).status));
  }
  const std::size_t edges = model.axial.size() - model.axial.internal_count();
  const auto severed_among = [&](std::size_t first, std::size_t last) {
    return std::accumulate(&state.axial_severed[first], &state.axial_severed[last], 0);
  };
  ASSERT_GT(severed_among(0, edges), 0);
  ASSERT_GT(severed_among(edges, model.axial.size()), 0);
  State read_back;
  ASSERT_EQ(read(get_state, earlier_bytes(state, edges), read_back), "");
  EXPECT_TRUE(check_state(model, read_back).empty());
  EXPECT_TRUE(bytes_of(read_back) == bytes_of(state));
}

TEST(LegacyFields, TheCellsOfATurnedOrganAreFound) {
  Model model = tough_block(network::Structure::ctpm);
  const Quat turn{0.5, 0.5, -0.5, 0.5};
  const Quat tilt{std::cos(0.3), 0.6 * std::sin(0.3), 0, 0.8 * std::sin(0.3)};
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    model.rest_position.set(i, rotate(tilt, rotate(turn, model.rest_position[i])) + Vec3{0.1, -0.2, 0.3});
  Model read_back;
  ASSERT_EQ(read(get_model, earlier_bytes(model), read_back), "");
  EXPECT_TRUE(read_back.cell == model.cell);
}

TEST(LegacyFields, TablesThatDoNotFitAreRefusedByName) {
  const Model model = tough_block(network::Structure::ctpm);
  // One stiffness too many in one table and one too few in the other: the total would fit.
  Model moved = model;
  std::size_t first_tpm = model.axial.size() - model.axial.internal_count();
  Bytes bytes;
  put_field_set(bytes, [&](FieldWriter& out) {
    put_common_fields(out, model);
    out("edges.a", head(model.axial.a, first_tpm)), out("edges.b", head(model.axial.b, first_tpm));
    out("edges.rest_length", head(model.axial.rest_length, first_tpm));
    out("edges.k", head(model.axial.k, first_tpm + 1)), out("edges.third", head(model.axial.third, first_tpm));
    out("tpms.spring_k", tail(model.axial.k, first_tpm + 1));
  });
  EXPECT_EQ(read(get_model, bytes, moved),
            "field edges.k has " + std::to_string(first_tpm + 1) + " entries, expected " + std::to_string(first_tpm));

  State state = rest_state(model);
  Bytes of_state = earlier_bytes(state, first_tpm - 1);
  EXPECT_EQ(read(get_state, of_state, state), "field tpm_severed has " +
                                                  std::to_string(model.axial.internal_count() + 1) +
                                                  " entries, expected " + std::to_string(model.axial.internal_count()));
}

TEST(LegacyFields, FieldsOfBothKindsAreRefused) {
  const Model model = tough_block(network::Structure::ctpm);
  Bytes bytes;
  put_field_set(bytes, [&](FieldWriter& out) {
    for_each_field(model, out);
    out("edges.a", model.axial.a);
  });
  Model read_back;
  EXPECT_NE(read(get_model, bytes, read_back), "");
}

}  // namespace
}  // namespace ctpm
