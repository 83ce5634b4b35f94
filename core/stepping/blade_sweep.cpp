#include "core/stepping/blade_sweep.h"

namespace ctpm::stepping {

BladeSweep::BladeSweep(const Model& model) : model_(model), near_(model), pieces_(model) {
  crossings_.reserve(model.axial.size());
  pieces_.reserve();
}

void BladeSweep::sweep(const contact::Contacts& contacts, const Inputs& last, const Inputs& inputs,
                       contact::HeldTool& tool, State& state, StepReport& report) {
  crossings_.clear();
  tool.blade.from = cutting::blade_edge(*tool.tool, last), tool.blade.to = cutting::blade_edge(*tool.tool, inputs);
  if (!state.blade_trail.x.empty()) {
    if (state.last_inputs.tool != inputs.tool)
      state.blade_trail.set(0, tool.blade.to.tip), state.blade_trail.set(1, tool.blade.to.heel);
    contact::tow(*tool.tool, state.blade_trail, tool.blade);
  }
  near_.find(state.position, contacts.around(tool));
  report.severed =
      cutting::sever_swept_by_blade(model_, near_, tool.blade.from, tool.blade.to, state.position, state, crossings_);
  tool.near = &near_, tool.swept = crossings_;
}

void BladeSweep::sever_moved(const contact::HeldTool& tool, const Vec3Array& before, State& state, StepReport& report) {
  near_.follow(state.position);
  report.severed +=
      cutting::sever_moved_through_blade(model_, near_, tool.blade.to, before, state.position, state, crossings_);
}

void BladeSweep::report_pieces(const State& state, StepReport& report) {
  if (report.severed == 0) return;
  (void)pieces_.find(state);
  report.came_loose = pieces_.rejoin(crossings_);
}

}  // namespace ctpm::stepping
