#pragma once

#include <cstdint>
#include <vector>

#include "core/cutting/rest_map.h"
#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// The plane of a cutaway as a net of triangles over one organ, wider than the organ: which pixels of it are tissue is
/// counted while it is drawn. Each vertex knows its place at rest, so that colours and relief stay with the tissue.
/// Over it lie the lines in which the plane meets the walls of cuts.
class Section {
 public:
  /// `model` and `map`, of the same Model, must outlive the Section.
  Section(const Model& model, const cutting::RestMap& map, std::size_t organ);

  /// `surface` is the drawn one, with its walls from triangle `outer_count` on, and `position` its vertices [m]. Empty
  /// where the plane misses the organ. `line_width` [m], > 0.
  void update(const State& state, const Cutaway& cutaway, const Surface& surface, std::size_t outer_count,
              const std::vector<Vec3>& position, double line_width);

  const std::vector<float>& vertices() const { return vertex_; }        ///< kOrganVertexFloats each
  const std::vector<std::uint32_t>& indices() const { return index_; }  ///< the net's, then the lines'

 private:
  struct Net;
  void add_net(const State& state, const Net& net);
  void add_lines(const Net& net, const Surface& surface, std::size_t outer_count, const std::vector<Vec3>& position,
                 double width);
  std::uint32_t add_vertex(Vec3 position, Vec3 normal, Vec3 rest, float hollow, float rind);
  float rind_at(Vec3 rest) const;

  const Model& model_;
  const cutting::RestMap& map_;
  const std::size_t organ_;
  std::vector<double> above_;  ///< of the drawn vertices, over the plane [m]
  std::vector<float> vertex_;
  std::vector<std::uint32_t> index_;
};

}  // namespace ctpm::render
