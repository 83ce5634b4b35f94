#include "studio/authoring/as_written.h"

#include <optional>

#include "studio/authoring/scene_parts.h"

namespace ctpm::authoring {

ImportRequest as_written(ImportRequest request) {
  for (std::optional<double>* length : {&request.sphere_radius, &request.gap, &request.largest_hole})
    if (*length) **length = whole_nanometres(**length);
  for (LayerWish& layer : request.layers) layer.to_depth = whole_nanometres(layer.to_depth);
  for (double* x : {&request.at.x, &request.at.y, &request.at.z}) *x = whole_nanometres(*x);
  return request;
}

}  // namespace ctpm::authoring
