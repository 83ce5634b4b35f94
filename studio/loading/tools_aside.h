#pragma once

#include <utility>
#include <vector>

#include "core/model/model.h"

namespace ctpm::loading {

/// Lays a Model's tools aside while nobody holds one: a Stepper made meanwhile does the same ticks, but needs no grids
/// of the surfaces for tools that touch them, which take a second of a million triangles. The Stepper may not outlive
/// it.
class ToolsAside {
 public:
  explicit ToolsAside(Model& model) : model_(model), tools_(std::exchange(model.tools, {})) {}
  ~ToolsAside() { model_.tools = std::move(tools_); }
  ToolsAside(const ToolsAside&) = delete;
  ToolsAside& operator=(const ToolsAside&) = delete;

 private:
  Model& model_;
  std::vector<Tool> tools_;
};

}  // namespace ctpm::loading
