#include "studio/compare/way.h"

#include <algorithm>

namespace ctpm::compare {
namespace {

constexpr std::size_t kPoints = 400;  // of a way: what is asked is its direction
constexpr double kCloser = 0.5;       // share of the distance that another way must leave

/// The places at which a tool meets tissue, or all where it never does.
Path way_in_tissue(const SessionTrack& track) {
  Path all, inside;
  for (const Spell& stroke : track.strokes)
    for (std::size_t i = stroke.first; i < stroke.last; ++i) {
      all.push_back(track.tip[i]);
      if (track.works(i)) inside.push_back(track.tip[i]);
    }
  const Path& way = inside.size() > 1 ? inside : all;
  const std::size_t step = std::max<std::size_t>(1, way.size() / kPoints);
  Path thinned;
  for (std::size_t i = 0; i < way.size(); i += step) thinned.push_back(way[i]);
  return thinned;
}

Path mirrored(Path path, double Vec3::*axis, Vec3 middle) {
  for (Vec3& p : path) p.*axis = 2 * middle.*axis - p.*axis;
  return path;
}

}  // namespace

Way way_of(const SessionTrack& expert, const SessionTrack& trainee, Vec3 middle, double noticeable) {
  const Path a = way_in_tissue(expert), b = way_in_tissue(trainee);
  const double apart = align_paths(a, b).mean;
  if (apart <= noticeable) return Way::same;
  Way way = Way::same;
  double least = kCloser * apart;
  const auto try_way = [&](Way other, const Path& path) {
    // A straight stroke that is mirrored runs backwards as well: what is said first stays, unless it is much worse.
    if (const double left = align_paths(a, path).mean; left < least) way = other, least = kCloser * left;
  };
  try_way(Way::backwards, Path(b.rbegin(), b.rend()));
  try_way(Way::mirrored_x, mirrored(b, &Vec3::x, middle));
  try_way(Way::mirrored_y, mirrored(b, &Vec3::y, middle));
  return way;
}

const char* to_word(Way way) {
  switch (way) {
    case Way::same:
      return "";
    case Way::backwards:
      return "the way runs backwards: from the expert's end to the expert's start";
    case Way::mirrored_x:
      return "the way is mirrored: left and right (x) are exchanged";
    case Way::mirrored_y:
      return "the way is mirrored: front and back (y) are exchanged";
  }
  return "";
}

}  // namespace ctpm::compare
