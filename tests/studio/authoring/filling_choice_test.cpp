// What a filling must keep of its mesh.

#include "studio/authoring/filling_choice.h"

#include <gtest/gtest.h>

namespace ctpm {
namespace {

importers::ImportReport filled_with(double volume, bool has_islands = false) {
  importers::ImportReport report;
  report.fill.filled_volume = volume;
  if (has_islands) report.findings.push_back({"island", 1, {}, "1 group of spheres", "dropped", ""});
  return report;
}

TEST(FillingChoice, AFillingThatDoesNotStandForTheMeshIsAProblem) {
  using authoring::problem_of_volume;
  constexpr double kEnclosed = 10e-6;
  for (const double kept : {0.96, 1.0, 1.04}) {
    EXPECT_EQ(problem_of_volume(filled_with(kept * kEnclosed), kEnclosed), "");
    EXPECT_EQ(problem_of_volume(filled_with(kept * kEnclosed, true), kEnclosed), "");
  }
  EXPECT_EQ(problem_of_volume(filled_with(8e-6), kEnclosed), "") << "tissue that overlaps itself counts once";
  EXPECT_EQ(problem_of_volume(filled_with(8e-6, true), kEnclosed),
            "falls apart where it is thin: the spheres that hang together stand for 8 ml, the mesh encloses 10 ml");
  EXPECT_EQ(
      problem_of_volume(filled_with(21.3e-6), kEnclosed),
      "passes through itself, so that its volume is not certain: its triangles surround 21.3 ml, the mesh encloses "
      "10 ml");
}

TEST(FillingChoice, ASurfaceFarFromItsSpheresIsAProblem) {
  importers::ImportReport report;
  report.spacing = 3e-3;
  report.fill.mean_distance = 2.59e-3;
  EXPECT_EQ(authoring::problem_of_surface(report), "");
  report.fill.mean_distance = 2.61e-3;
  EXPECT_EQ(
      authoring::problem_of_surface(report),
      "is mostly too thin for spheres: its surface is 2.61 mm from the nearest of them on average, and none of it "
      "may be farther than 2.598 mm where it is filled");
}

}  // namespace
}  // namespace ctpm
