#include "studio/fidelity/references.h"

namespace ctpm::fidelity {
namespace {

constexpr const char* kFine = "CalculiX 2.20, C3D20R of 1.5 mm";

}  // namespace

const Indentation kIndentations[3] = {{1e-3, {0.2723370, kFine}, 0.2718136, 0.2436985, 0.249771775},
                                      {2e-3, {0.7954004, kFine}, 0.7960000, 0.6751856, 0.706461262},
                                      {4e-3, {2.3240464, kFine}, 2.3229548, 1.8096404, 1.998174196}};

}  // namespace ctpm::fidelity
