// The thickness of slabs and balls is found from the depths of their spheres.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>

#include "importers/fill.h"
#include "importers/mesh.h"
#include "studio/fidelity/body.h"
#include "studio/fidelity/meshes.h"
#include "studio/fidelity/thickness.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm::fidelity {
namespace {

using ctpm::testing::ProgramOutcome;
using ctpm::testing::run_ctpm;
using ctpm::testing::TemporaryFolder;

FilledOrgan fill(importers::RawMesh mesh, Quat turn = {}) {
  for (Vec3& v : mesh.vertex) v = rotate(turn, v);
  const Result<importers::CheckedMesh> checked = importers::repair_mesh(mesh, 1.0);
  EXPECT_TRUE(bool(checked));
  importers::FillOptions options;  // spheres of 4 mm, 12 mm apart
  Result<importers::Filling> filling = importers::fill_organ(*checked, options);
  EXPECT_TRUE(bool(filling));
  return std::move(filling->organ);
}

importers::RawMesh slab(double thickness) {
  return box_mesh({-0.06, -0.06, -0.5 * thickness}, {0.06, 0.06, 0.5 * thickness}, 6e-3);
}

TEST(Thickness, OfASlabIsItsThicknessAwayFromItsRim) {
  for (const double wanted : {14e-3, 20e-3, 30e-3, 45e-3}) {
    const FilledOrgan organ = fill(slab(wanted));
    const std::vector<double> thickness = local_thickness(organ);
    for (std::size_t i = 0; i < thickness.size(); ++i) {
      const bool is_inner =
          std::max(std::abs(organ.centre[i].x), std::abs(organ.centre[i].y)) < 0.06 - 0.5 * wanted - 0.012;
      if (!is_inner) continue;
      EXPECT_NEAR(thickness[i], wanted, 1e-6) << 1e3 * wanted << " mm";
    }
  }
}

TEST(Thickness, OfATurnedSlabIsKnownToHalfASpacing) {
  const double wanted = 30e-3;
  const Quat turn = turn_about({1, 0, 0}, std::numbers::pi / 8);
  const FilledOrgan organ = fill(slab(wanted), turn);
  const std::vector<double> thickness = local_thickness(organ);
  for (std::size_t i = 0; i < thickness.size(); ++i) {
    const Vec3 flat = rotate({turn.w, -turn.x, 0, 0}, organ.centre[i]);
    if (std::max(std::abs(flat.x), std::abs(flat.y)) > 0.03) continue;
    EXPECT_NEAR(thickness[i], wanted, 0.5 * organ.spacing);
  }
}

TEST(ThinParts, AreASlabOfLessThanTwoSpacingsAndNotOneOfThree) {
  const ThinParts thin = find_thin_parts(fill(slab(16e-3)));
  EXPECT_EQ(thin.share, 1);
  EXPECT_LE(thin.thinnest, 16e-3 + 1e-9);
  EXPECT_EQ(find_thin_parts(fill(slab(36e-3))).spheres, 0);
}

TEST(LocalThickness, IsNeverNegativeWhereTheLatticeLiesOutside) {
  for (const double height : {3e-3, 6e-3, 9e-3})
    for (const double thickness : local_thickness(fill(slab(height)))) EXPECT_GE(thickness, 0) << height;
}

TEST(ThinParts, AreNotTheCapsOfABall) { EXPECT_EQ(find_thin_parts(fill(ball_mesh(50e-3, 4e-3))).spheres, 0); }

TEST(PlanCommand, WarnsWhereAnOrganIsTooThinForItsSpheres) {
  const TemporaryFolder folder;
  const importers::RawMesh mesh = slab(16e-3);
  std::ofstream(folder.path() / "slab.obj") << importers::to_obj(mesh.vertex, mesh.triangle);
  const auto write = [&](const char* fill) {
    std::ofstream(folder.path() / "slab.json") << R"({"format": "ctpm-scene", "version": 1, "name": "slab",
  "organs": [{"name": "slab", "mesh": "slab.obj", "material": {"preset": "liver"},
              "fill": )" << fill << R"(, "anchors": [{"lowest_mm": 5}]}]})";
  };
  write(R"({"radius_mm": 4, "gap_mm": 4})");
  const ProgramOutcome coarse = run_ctpm({"plan", "slab.json"}, folder.path());
  EXPECT_EQ(coarse.code, 0) << coarse.err;
  EXPECT_NE(coarse.err.find("slab.json:3:23: warning: /organs/0/fill: 363 of 363 spheres lie in tissue thinner"),
            std::string::npos)
      << coarse.err;
  EXPECT_NE(coarse.err.find("16 mm"), std::string::npos) << coarse.err;
  write(R"({"radius_mm": 1.5, "gap_mm": 1})");
  const ProgramOutcome fine = run_ctpm({"plan", "slab.json"}, folder.path());
  EXPECT_EQ(fine.code, 0) << fine.err;
  EXPECT_EQ(fine.err.find("thinner"), std::string::npos) << fine.err;
}

}  // namespace
}  // namespace ctpm::fidelity
