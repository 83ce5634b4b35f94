#include "scenes/presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "scenes/materials_file.h"

namespace ctpm {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Bao & Wu, section 5.1, as printed: r and R [mm], K1, K2, K' [kPa, with the depth in mm], v1 [Pa s].
struct Row {
  const char* organ;
  double sphere_radius, ball_radius, kelvin, spring, constraint, viscosity;
};
constexpr Row kPaper[] = {
    {"skin", 7, 2.8, 82, 82, 164, 3}, {"kidney", 4, 1.5, 58, 58, 106, 4}, {"liver", 4, 2.0, 15, 15, 20, 5}};

TEST(Presets, HoldThePapersNumbersInBothReadingsOfTheViscosity) {
  for (const Row& row : kPaper)
    for (const bool as_printed : {false, true}) {
      const std::string name = row.organ + std::string(as_printed ? "-pa-s" : "");
      const scenes::MaterialPreset* preset = scenes::find_preset(name);
      ASSERT_NE(preset, nullptr) << name;
      EXPECT_EQ(std::string(preset->organ), row.organ);
      EXPECT_DOUBLE_EQ(preset->sphere_radius, row.sphere_radius * 1e-3);
      EXPECT_DOUBLE_EQ(preset->ball_radius, row.ball_radius * 1e-3);
      const network::Material& m = preset->material;
      EXPECT_DOUBLE_EQ(m.kelvin, row.kelvin * 1e6);  // kPa/mm = 1e6 Pa/m
      EXPECT_DOUBLE_EQ(m.spring, row.spring * 1e6);
      EXPECT_DOUBLE_EQ(m.constraint, row.constraint * 1e6);
      EXPECT_DOUBLE_EQ(m.viscosity, row.viscosity * (as_printed ? 1e3 : 1e6));  // Pa s/mm, or kPa s/mm
      EXPECT_DOUBLE_EQ(m.calibration_area, kPi * std::pow(row.ball_radius * 1e-3, 2));
      EXPECT_DOUBLE_EQ(m.calibration_spacing, 3 * row.sphere_radius * 1e-3);
      EXPECT_DOUBLE_EQ(m.density, 1060);
      EXPECT_EQ(m.stiffness_scale, 1);
    }
  int of_paper = 0;
  for (const scenes::MaterialPreset& preset : scenes::material_presets()) of_paper += preset.is_of_paper;
  EXPECT_EQ(of_paper, 6);
}

TEST(Presets, CreepOverSecondsInOneReadingAndInMicrosecondsInTheOther) {
  for (const Row& row : kPaper) {
    const auto time_constant = [](const scenes::MaterialPreset* preset) {
      return preset->material.viscosity / (preset->material.kelvin + preset->material.spring);
    };
    const double slow = time_constant(scenes::find_preset(row.organ)),
                 fast = time_constant(scenes::find_preset(std::string(row.organ) + "-pa-s"));
    EXPECT_GT(slow, 0.018);
    EXPECT_LT(slow, 0.17);
    EXPECT_NEAR(fast, 1e-3 * slow, 1e-12);
  }
}

TEST(Presets, OnlyTheLiverHasAKnownDamageDepth) {
  EXPECT_EQ(scenes::find_preset("liver")->damage_depth, 0.012);
  EXPECT_EQ(scenes::find_preset("liver-pa-s")->damage_depth, 0.012);
  for (const char* name : {"kidney", "skin", "kidney-pa-s", "skin-pa-s"})
    EXPECT_EQ(scenes::find_preset(name)->damage_depth, 0);
}

TEST(Presets, EachIsFoundByItsNameAndNoOtherIs) {
  for (const scenes::MaterialPreset& preset : scenes::material_presets())
    EXPECT_EQ(scenes::find_preset(preset.name), &preset);
  EXPECT_EQ(scenes::preset_names().size(), scenes::material_presets().size());
  for (const char* name : {"", "Liver", "liver ", "pancreas"}) EXPECT_EQ(scenes::find_preset(name), nullptr);
}

/// Young's modulus of a filled lattice is 2.5 k / s (LatticeKind::cubic_18), k that of an edge: two triples in series.
TEST(Presets, OtherTissuesHaveTheYoungsModulusOfTheirSource) {
  struct Tissue {
    const char* name;
    double young;  // [Pa]
  };
  // Three times the shear stiffness of elastography, as tissue keeps its volume.
  for (const Tissue& tissue : {Tissue{"spleen", 3 * 3565}, {"lung", 3 * 1140}, {"fat", 3040}}) {
    const scenes::MaterialPreset* preset = scenes::find_preset(tissue.name);
    ASSERT_NE(preset, nullptr) << tissue.name;
    const network::Material& m = preset->material;
    for (const double s : {0.006, 0.012}) {
      const double edge = 2 * m.kelvin * m.spring / (m.kelvin + m.spring) * network::edge_area(m, s);
      EXPECT_NEAR(2.5 * edge / s, tissue.young, 0.005 * tissue.young) << tissue.name;
    }
    EXPECT_FALSE(preset->is_of_paper);
  }
  for (const scenes::MaterialPreset& preset : scenes::material_presets())
    EXPECT_GT(std::string(preset.source).size(), 20u);
}

TEST(Presets, AnOrganIsFoundInAName) {
  for (const auto& [name, organ] : {std::pair{"Left Kidney.stl", "kidney"},
                                    {"patient7_LIVER", "liver"},
                                    {"subcutaneous-fat", "fat"},
                                    {"MyHeart2", "heart"}}) {
    ASSERT_NE(scenes::preset_in_name(name), nullptr) << name;
    EXPECT_EQ(std::string(scenes::preset_in_name(name)->organ), organ);
  }
  for (const char* name : {"", "father", "fate", "elephant"}) EXPECT_EQ(scenes::preset_in_name(name), nullptr) << name;
}

TEST(Materials, AnAuthorsOwnAreReadAndEveryMistakeIsPlaced) {
  const std::string head = R"({"format": "ctpm-materials", "version": 1, "materials": [)";
  const auto own = scenes::read_materials(head + R"({"name": "tumour", "preset": "liver", "stiffness_scale": 4}]})",
                                          "materials.json");
  ASSERT_TRUE(own) << to_string(own.errors().front());
  ASSERT_EQ(own->size(), 1u);
  EXPECT_EQ(own->front().name, "tumour");
  EXPECT_EQ(own->front().material.preset, "liver");
  EXPECT_EQ(own->front().material.stiffness_scale, 4);
  const auto bad = scenes::read_materials(
      head + R"({"name": "liver", "preset": "liver"}, {"name": "x"}, {"name": "y", "preset": "livr"}]})", "m.json");
  ASSERT_FALSE(bad);
  std::string all;
  for (const Error& error : bad.errors()) all += to_string(error) + "\n";
  for (const char* part : {"which is a preset of the program", "spring_kpa_per_mm", "there is no preset", "m.json:1:"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in\n" << all;
}

TEST(Materials, OneIsAddedOrReplacedAndTheOthersStayAsTheyAreWritten) {
  scenes::NamedMaterial gel;
  gel.name = "gel", gel.material.preset = "liver", gel.material.spring = 16e6;
  const auto first = scenes::with_material("", "m.json", gel);
  ASSERT_TRUE(first) << to_string(first.errors().front());
  const auto read = scenes::read_materials(*first, "m.json");
  ASSERT_TRUE(read) << to_string(read.errors().front());
  EXPECT_EQ(*read, std::vector{gel});

  const std::string own = R"({"format": "ctpm-materials", "version": 1, "materials": [
  // measured in May
  {"name": "cyst",   "preset": "kidney", "density_kg_per_m3": 1010}
]}
)";
  const auto both = scenes::with_material(own, "m.json", gel);
  ASSERT_TRUE(both) << to_string(both.errors().front());
  for (const char* part :
       {"// measured in May", R"({"name": "cyst",   "preset": "kidney", "density_kg_per_m3": 1010})"})
    EXPECT_NE(both->find(part), std::string::npos) << part << " in\n" << *both;
  gel.material.spring = 20e6;
  const auto again = scenes::with_material(*both, "m.json", gel);
  ASSERT_TRUE(again) << to_string(again.errors().front());
  EXPECT_NE(again->find("// measured in May"), std::string::npos) << *again;
  const auto all = scenes::read_materials(*again, "m.json");
  ASSERT_TRUE(all) << to_string(all.errors().front());
  ASSERT_EQ(all->size(), 2u);
  EXPECT_EQ(all->front().name, "cyst");
  EXPECT_EQ(all->front().material.density, 1010);
  EXPECT_EQ(all->back(), gel);

  gel.name = "kidney";
  EXPECT_FALSE(scenes::with_material(own, "m.json", gel)) << "a preset";
  EXPECT_FALSE(scenes::with_material("{", "m.json", gel)) << "no JSON";
}

TEST(ResolveMaterial, OwnValuesTakeThePresetsPlace) {
  scenes::MaterialSpec spec;
  spec.preset = "liver";
  spec.spring = 16e6, spec.density = 1000, spec.calibration_ball = 0.003;
  const scenes::ResolvedMaterial resolved = scenes::resolve_material(spec);
  EXPECT_TRUE(resolved.missing.empty());
  EXPECT_EQ(resolved.material.spring, 16e6);
  EXPECT_EQ(resolved.material.kelvin, 15e6);
  EXPECT_EQ(resolved.material.density, 1000);
  EXPECT_DOUBLE_EQ(resolved.material.calibration_area, kPi * 9e-6);
  EXPECT_DOUBLE_EQ(resolved.material.calibration_spacing, 0.012);
}

TEST(ResolveMaterial, WithoutAPresetNamesWhatIsMissing) {
  scenes::MaterialSpec spec;
  spec.spring = 1e6, spec.kelvin = 1e6;
  EXPECT_EQ(scenes::resolve_material(spec).missing,
            (std::vector<std::string>{"constraint_kpa_per_mm", "viscosity_kpa_s_per_mm", "calibration_ball_radius_mm",
                                      "calibration_spacing_mm"}));
  spec.constraint = 1e6, spec.viscosity = 0, spec.calibration_ball = 0.002, spec.calibration_spacing = 0.012;
  const scenes::ResolvedMaterial whole = scenes::resolve_material(spec);
  EXPECT_TRUE(whole.missing.empty());
  EXPECT_EQ(whole.material.density, 1060);
  EXPECT_EQ(whole.material.stiffness_scale, 1);
}

}  // namespace
}  // namespace ctpm
