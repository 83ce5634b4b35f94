#pragma once

#include <string>
#include <vector>

#include "core/model/model.h"
#include "studio/exchange/shapes.h"

// The texts and bytes of the files that export_shapes() writes.
namespace ctpm::exchange {

/// VTK's XML of the surfaces (PolyData) and of the network (UnstructuredGrid) at a moment.
std::string to_vtp(const Model& model, const Moment& moment);
std::string to_vtu(const Model& model, const Moment& moment);

/// A member of a series: its time [s], part and file, relative to the series.
struct SeriesMember {
  double time = 0;
  int part = 0;
  std::string file;
};
std::string to_pvd(const std::vector<SeriesMember>& members);

/// Binary glTF 2.0 of the surfaces at a moment.
std::string to_glb(const Moment& moment);

/// Collects the moments of a session and writes them as USD.
class UsdWriter {
 public:
  /// `per_second`: time codes of a second; moment n has the time code n.
  UsdWriter(const Model& model, double per_second) : model_(model), per_second_(per_second) {}
  void add(const Moment& moment);
  std::string text() const;

 private:
  /// An organ while its triangles stay the same.
  struct Piece {
    std::string name, organ;
    std::array<double, 3> colour{};
    std::int32_t revision = 0;
    std::int64_t from = 0, to = 0;  ///< time codes
    std::vector<std::array<std::int32_t, 3>> triangle;
    std::vector<std::string> points;  ///< of each time code
    Vec3 least, most;
  };
  const Model& model_;
  double per_second_;
  std::int64_t moments_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> current_;  ///< piece of each organ
  std::vector<Inputs> inputs_;        ///< of each time code
};

}  // namespace ctpm::exchange
