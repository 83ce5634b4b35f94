#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// Of the line of an expert's cut, and of what a trainee cut elsewhere: those of the two sessions on the page.
inline constexpr Colour kExpertColour{0.486, 0.753, 1.0}, kStrayColour{1.0, 0.702, 0.361};

/// What both are called where a picture says what its marks mean.
inline constexpr const char *kExpertMeaning = "the expert's cut", *kStrayMeaning = "cut where the expert did not";

/// Where an expert cut, to be seen on the organs of a trainee in the same scene.
class ExpertCut {
 public:
  /// `end`: a State of the expert's session that has all of its cuts.
  ExpertCut(const Model& model, const State& end);

  /// A part of the line in which the blade went through an organ's own surface, at rest [m].
  struct Piece {
    std::int32_t organ;
    Vec3 from, to;
    Vec3 side;  ///< along the surface to one side of the cut, the same along all of a cut, unit length
  };
  const std::vector<Piece>& line() const { return line_; }

  /// Whether the expert severed an axial element.
  bool severed(std::size_t element) const { return element < severed_.size() && severed_[element] != 0; }

 private:
  std::vector<Piece> line_;
  std::vector<std::uint8_t> severed_;
};

/// The same in a moment of the trainee's session [m].
struct ExpertMarks {
  std::vector<std::array<Vec3, 2>> line;  ///< ends of its parts, on what is drawn of the organs' outside
  std::vector<Vec3> strays;               ///< where the blade crossed elements that the expert left whole
};

/// Places that the trainee's blade crossed so far in elements that the expert left whole. Constraints and angle springs
/// are severed with one of them.
std::vector<Vec3> strays_of(const Model& model, const ExpertCut& expert, const State& state);

/// An organ as it is drawn in that moment.
struct DrawnOrgan {
  const Surface* surface;          ///< at rest, outer triangles first
  std::size_t outer_triangles;     ///< what follows is walls of cuts
  const std::vector<Vec3>* place;  ///< of its vertices [m]
};

/// Lays the line of a cut on organs as they are drawn: their triangles change with each cut, and a line that went along
/// with other ones would stand off the tissue.
class ExpertMarker {
 public:
  /// `version`: of the triangles of all organs; the same number says that they are those of the last call.
  ExpertMarks place(const Model& model, const std::shared_ptr<const ExpertCut>& expert,
                    std::span<const DrawnOrgan> organs, std::uint64_t version, const State& state);

 private:
  struct End {
    std::int32_t triangle = -1;  ///< -1: none is near
    std::array<double, 3> weight{};
  };
  void bind(std::span<const DrawnOrgan> organs);

  std::shared_ptr<const ExpertCut> expert_;
  std::optional<std::uint64_t> version_;
  std::vector<std::array<End, 2>> ends_;  ///< of each part of the line
};

}  // namespace ctpm::render
