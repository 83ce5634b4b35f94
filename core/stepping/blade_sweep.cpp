#include "core/stepping/blade_sweep.h"

namespace ctpm::stepping {

BladeSweep::BladeSweep(const Model& model) : front_(model), pieces_(model) {
  crossings_.reserve(model.axial.size());
  pieces_.reserve();
}

void BladeSweep::begin_tick(const Hand& last, const Hand& hand, bool is_taken, contact::HeldTool& tool, State& state) {
  crossings_.clear();
  tool.edge_from = cutting::blade_edge(*tool.tool, last), tool.edge_to = cutting::blade_edge(*tool.tool, hand);
  tool.front = &front_;
  front_.begin_tick(*tool.tool, tool.edge_from, tool.edge_to, is_taken, state);
}

void BladeSweep::end_substep(const contact::HeldTool& tool, double share, State& state, StepReport& report) {
  report.severed += front_.follow(*tool.tool, tool.edge_at(share), state, crossings_);
}

void BladeSweep::report_pieces(const State& state, StepReport& report) {
  if (report.severed == 0) return;
  (void)pieces_.find(state);
  report.came_loose = pieces_.rejoin(crossings_);
}

}  // namespace ctpm::stepping
