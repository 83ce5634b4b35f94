#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/scene_spec.h"

// Places and directions that a scene or a script gives by their meaning instead of by coordinates. FORMAT.md.
namespace ctpm::scenes {

/// A place as it is written: "top of liver", "bottom of liver", "centre of liver", "surface of liver at 20 -30", the
/// name of a probe; each with " + 0 0 5" for a shift [mm] or " out 5" for a distance along the normal [mm] behind it. A
/// direction has "into " or "out of " before a place.
struct PlacePhrase {
  enum class Kind { top, bottom, centre, surface, probe } kind = Kind::probe;
  std::string name;           ///< of the organ or the probe
  double x = 0, y = 0;        ///< of the line through the surface [m]
  Vec3 shift;                 ///< [m]
  std::optional<double> out;  ///< along the outward normal [m]
  bool is_direction = false;
  double sign = 1;  ///< of a direction along the outward normal
};

/// Highest point of the surface on the line along the unit vector `up` through `point` [m]; none if the line misses it.
std::optional<Vec3> surface_above(const Surface& surface, Vec3 point, Vec3 up);

/// Error: what is wrong with it, without a place.
Result<PlacePhrase> parse_place(std::string_view text, bool is_direction);

/// Finds places on organs at rest, as they are before they settle.
class PlaceFinder {
 public:
  struct Organ {
    std::string name;
    const Surface* surface = nullptr;  ///< null: not known; must outlive the finder
  };
  PlaceFinder(std::vector<Organ> organs, Vec3 gravity);

  /// A place with a name; none: it is not known where.
  void add_probe(const std::string& name, std::optional<Vec3> at) { probes_[name] = at; }

  /// The place [m] or the direction of unit length. Errors: no such organ or probe, a line that misses the surface.
  /// None if the organ's surface or the probe's place is not known.
  Result<std::optional<Vec3>> find(const PlacePhrase& phrase) const;

 private:
  Vec3 normal_at(Vec3 point) const;

  std::vector<Organ> organs_;
  Vec3 up_;
  std::map<std::string, std::optional<Vec3>> probes_;
};

/// Finds places on the organs of a Model; probes are those of `scene`.
PlaceFinder finder_of(const Model& model, const SceneSpec& scene);

/// Knows the names of a scene's organs and probes, but no place.
PlaceFinder names_in(const SceneSpec& scene);

}  // namespace ctpm::scenes
