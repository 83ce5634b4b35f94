#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>

#include "importers/mesh.h"
#include "importers/mesh_surgery.h"
#include "importers/nesting.h"
#include "importers/seams.h"
#include "importers/self_crossing.h"
#include "importers/text.h"
#include "importers/topology.h"

namespace ctpm::importers {
namespace {

constexpr double kCutShare = 0.25;     // of the diagonal: largest hole cut to remove a self-intersection
constexpr double kHoleShare = 0.1;     // of the diagonal: default limit of holes to fill
constexpr double kCrackShare = 1e-3;   // of the diagonal: widest crack to close at T-junctions
constexpr double kFlat = 1e-9;         // of the diagonal cubed: a smaller volume counts as none
constexpr double kSheetShare = 0.95;   // of the mesh's diagonal: a hole so wide is the rim of a sheet
constexpr double kRoundOff = 1.001;    // a limit that is written in whole millimetres still allows its hole
constexpr double kLeastOrgan = 0.01;   // of the largest part's volume: smaller ones are no organs
constexpr double kLeastCavity = 1e-4;  // of the volume around it
constexpr double kOpening = 0.5;       // of an open part's diagonal: a wider hole makes it a sheet
constexpr std::size_t kMostShown = 5;  // holes named one by one

/// Which parts a repair keeps.
enum class Keep { largest, all_in_one, each };

std::string hole_text(const Hole& hole) {
  return mm_text(hole.diameter) + " wide (" + counted(hole.edges, "edge") + ") at " + place_text(hole.centre);
}

const Hole& widest(const std::vector<Hole>& holes) {
  return *std::max_element(holes.begin(), holes.end(),
                           [](const Hole& a, const Hole& b) { return a.diameter < b.diameter; });
}

/// Extracts some triangles of a mesh with the vertices that they use. `new_index` is scratch memory: -1 for every
/// vertex, before and after.
Soup take(const Soup& soup, const std::vector<Triangle>& triangles, std::vector<std::int32_t>& new_index) {
  Soup piece{{}, triangles};
  for (Triangle& triangle : piece.triangle)
    for (std::int32_t& v : triangle) {
      if (new_index[std::size_t(v)] < 0) {
        new_index[std::size_t(v)] = std::int32_t(piece.vertex.size());
        piece.vertex.push_back(soup.vertex[std::size_t(v)]);
      }
      v = new_index[std::size_t(v)];
    }
  for (const Triangle& triangle : triangles)
    for (const std::int32_t v : triangle) new_index[std::size_t(v)] = -1;
  return piece;
}

/// A part of a mesh, and the volume that it encloses; that of an open part includes the cones over its holes.
struct Piece {
  Soup soup;
  double volume = 0;  ///< [m^3], >= 0
};

/// Splits a mesh into its parts, largest enclosed volume first.
std::vector<Piece> split_parts(const Soup& soup) {
  const Parts parts = find_parts(soup.triangle);
  std::vector<std::vector<Triangle>> triangles(std::size_t(parts.count));
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    triangles[std::size_t(parts.of_triangle[t])].push_back(soup.triangle[t]);
  std::vector<Piece> pieces;
  std::vector<std::int32_t> new_index(soup.vertex.size(), -1);
  for (const std::vector<Triangle>& part : triangles) {
    Piece& piece = pieces.emplace_back(take(soup, part, new_index));
    // Relative to its own centre, the volume of an open part includes the cones over its holes.
    piece.volume = std::abs(signed_volume(piece.soup.vertex, piece.soup.triangle, bounding_box(piece.soup).centre()));
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.volume > b.volume; });
  return pieces;
}

void append(Soup& to, const Soup& piece) {
  const std::int32_t first = std::int32_t(to.vertex.size());
  to.vertex.insert(to.vertex.end(), piece.vertex.begin(), piece.vertex.end());
  for (const Triangle& t : piece.triangle) to.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// One repair: the current soup and the findings so far.
class Repair {
 public:
  Repair(const RawMesh& mesh, double unit, const RepairOptions& options, Keep keep, std::size_t most)
      : path_(mesh.path), options_(options), keep_(keep), most_(most), parts_(mesh, unit) {
    soup_.triangle = mesh.triangle;
    soup_.vertex.reserve(mesh.vertex.size());
    for (const Vec3& p : mesh.vertex) soup_.vertex.push_back(unit * p);
    out_.before = count_mesh(soup_.vertex, soup_.triangle);
  }

  Result<std::vector<CheckedMesh>> run() {
    clean();
    if (soup_.triangle.empty()) return Error{path_, "holds only triangles without area", "export the surface again"};
    tell("looking for cracks and walls", 0.1);
    close_cracks();
    drop_inner_walls();
    welded_ = soup_;
    tell("orienting", 0.2);
    split_and_orient();
    tell("closing", 0.5);
    if (Errors errors = keep_closed_parts(); !errors.empty()) return errors;
    std::vector<CheckedMesh> meshes;
    for (Organ& organ : organs_) {
      soup_ = std::move(organ.soup), shells_ = organ.shells;
      organ = {};
      tell("looking for crossings", 0.7);
      treat_crossings();
      tell("turning outwards", 0.9);
      turn_outwards();
      Result<CheckedMesh> mesh = finish();
      if (!mesh) return mesh.errors();
      meshes.push_back(std::move(*mesh));
      out_ = {};
      out_.before = meshes.front().before;
    }
    return meshes;
  }

 private:
  void tell(const char* stage, double fraction) const {
    if (options_.progress) options_.progress(std::string("repair: ") + stage, fraction);
  }
  void note(Finding finding) { out_.findings.push_back(std::move(finding)); }

  void clean() {
    diagonal_ = bounding_box(soup_).diagonal();
    if (const std::int64_t n = weld(soup_, options_.weld_distance * diagonal_); n > 0)
      note({"unwelded", n, {}, counted(n, "vertex") + " in the place of another", "welded", ""});
    if (const std::int64_t n = drop_collapsed(soup_); n > 0)
      note({"degenerate", n, {}, counted(n, "triangle") + " with two corners in one place", "dropped", ""});
    if (const std::int64_t n = drop_duplicates(soup_); n > 0)
      note({"duplicate", n, {}, counted(n, "triangle") + " that another triangle covers exactly", "dropped", ""});
  }

  void close_cracks() {
    const std::vector<Vec3> places = split_t_junctions(soup_, kCrackShare * diagonal_);
    if (places.empty()) return;
    const auto n = std::int64_t(places.size());
    note({"t_junction", n, places[0],
          counted(n, "vertex") + " on the edge of a triangle that does not know of it, the first at " +
              place_text(places[0]),
          "the edge split there, so that the crack is closed", ""});
  }

  void drop_inner_walls() {
    const std::vector<std::int32_t> walls = find_inner_walls(soup_);
    if (walls.empty()) return;
    Vec3 place;
    for (const std::int32_t v : soup_.triangle[std::size_t(walls[0])]) place += soup_.vertex[std::size_t(v)] / 3;
    note({"inner_wall", std::int64_t(walls.size()), place,
          counted(std::int64_t(walls.size()), "triangle") + " of walls inside the mesh, the first at " +
              place_text(place),
          "dropped", ""});
    std::vector<char> goes(soup_.triangle.size(), 0);
    for (const std::int32_t t : walls) goes[std::size_t(t)] = 1;
    std::vector<Triangle> stays;
    for (std::size_t t = 0; t < goes.size(); ++t)
      if (!goes[t]) stays.push_back(soup_.triangle[t]);
    soup_.triangle = std::move(stays);
    drop_unused(soup_);
  }

  void split_and_orient() {
    const std::vector<Vec3> edges = find_non_manifold_edges(soup_);
    if (!edges.empty())
      note({"non_manifold_edge", std::int64_t(edges.size()), edges[0],
            counted(std::int64_t(edges.size()), "edge") + " with more than two triangles, the first at " +
                place_text(edges[0]),
            "split", ""});
    if (const std::vector<std::int32_t> pinched = find_pinched(soup_); !pinched.empty()) {
      const Vec3 place = soup_.vertex[std::size_t(pinched[0])];
      note({"non_manifold_vertex", std::int64_t(pinched.size()), place,
            counted(std::int64_t(pinched.size()), "vertex") + " where separate sheets touch, the first at " +
                place_text(place),
            "split", ""});
    }
    orient_and_stitch(soup_);
  }

  /// One mesh of the result: its shells, the outer one first.
  struct Organ {
    Soup outer;  ///< the outer shell alone
    double volume = 0;
    std::vector<Soup> cavities;
    Soup soup;  ///< all of them
    std::int64_t shells = 1;
  };

  /// Fills holes, part by part from the largest, and selects the parts to keep. Errors: no part can be closed, or,
  /// where only the largest is kept, that one.
  Errors keep_closed_parts() {
    const double largest_hole = options_.largest_hole.value_or(kHoleShare * diagonal_);
    const Vec3 size = bounding_box(soup_).most - bounding_box(soup_).least;
    const Errors is_sheet{{path_,
                           "the mesh bounds no volume in its box of " + mm_text(size.x) + " x " + mm_text(size.y) +
                               " x " + mm_text(size.z),
                           "it is a sheet, or a vertex lies far from the others; export a closed surface"}};
    std::vector<Hole> filled;
    Errors open;
    Refused refused;
    std::int64_t dropped = 0, dropped_triangles = 0, cavities = 0;
    Finding drop;
    for (Piece& piece : split_parts(soup_)) {
      Organ* around = keep_ == Keep::all_in_one ? nullptr : organ_around(piece);
      if (around != nullptr || is_wanted(piece)) {
        const Closing closing = fill_holes(piece.soup, largest_hole);
        Errors why = describe(closing, largest_hole);
        if (why.empty() && is_flat(piece.soup)) why = is_sheet;
        if (why.empty()) {
          filled.insert(filled.end(), closing.filled.begin(), closing.filled.end());
          if (around != nullptr) ++cavities;
          keep_piece(std::move(piece), around);
          continue;
        }
        if (organs_.empty() && keep_ == Keep::largest) return why;
        if (open.empty()) open = why;
        if (piece.volume > refused.volume && is_holed(piece, closing)) refused = {why, piece.volume};
      }
      ++dropped, dropped_triangles += std::int64_t(piece.soup.triangle.size());
      if (!drop.place) drop.place = bounding_box(piece.soup).centre();
    }
    // Nothing is left of sheets that meet at one edge: each is a wall to the others.
    if (organs_.empty() && open.empty()) return is_sheet;
    if (organs_.empty() || is_small_beside(open)) return open;
    if (organs_.front().volume < refused.volume) return refused.why;
    if (!filled.empty())
      note({"hole", std::int64_t(filled.size()), widest(filled).centre,
            counted(std::int64_t(filled.size()), "hole") + ", the widest " + hole_text(widest(filled)), "filled", ""});
    if (cavities > 0)
      note({"cavity", cavities, bounding_box(organs_.front().outer).centre(),
            counted(cavities, "shell") + " within another", "taken as the wall of a cavity, which stays empty", ""});
    if (dropped > 0) {
      const std::size_t kept = organs_.size() + std::size_t(organs_.front().shells) - 1;
      drop.code = "other_part", drop.count = dropped;
      drop.found = counted(dropped, "part") + " beside the " +
                   (kept > 1       ? "closed ones"
                    : open.empty() ? "largest"
                                   : "largest that is closed") +
                   " (" + counted(dropped_triangles, "triangle") + ", the largest at " + place_text(*drop.place) + ")";
      drop.done = "dropped";
      if (!open.empty()) drop.remains = open[0].message;
      note(drop);
    }
    if (keep_ == Keep::all_in_one && organs_.front().shells > 1)
      note({"parts",
            organs_.front().shells,
            {},
            counted(organs_.front().shells, "closed part"),
            "kept",
            "the organ is in pieces"});
    return {};
  }

  /// The largest part that is an organ but for holes that may not be filled.
  struct Refused {
    Errors why;
    double volume = 0;  ///< [m^3]
  };

  static bool is_holed(const Piece& piece, const Closing& closing) {
    const double most = kOpening * bounding_box(piece.soup).diagonal();
    const auto is_narrow = [&](const Hole& hole) { return hole.diameter < most; };
    return std::all_of(closing.too_large.begin(), closing.too_large.end(), is_narrow) &&
           std::all_of(closing.unfillable.begin(), closing.unfillable.end(), is_narrow) && !is_flat(piece.soup);
  }

  /// Whether all that could be closed is little beside what could not.
  bool is_small_beside(const Errors& open) const {
    constexpr double kCrumb = 0.1;  // of the diagonal of the file
    return !open.empty() && keep_ == Keep::each && bounding_box(organs_.front().outer).diagonal() < kCrumb * diagonal_;
  }

  /// Whether a part is an organ, or a part of the only one.
  bool is_wanted(const Piece& piece) const {
    if (organs_.empty() || keep_ == Keep::all_in_one) return true;
    return keep_ == Keep::each && organs_.size() < most_ && piece.volume >= kLeastOrgan * organs_.front().volume;
  }

  /// The organ within whose tissue a smaller part lies; null: none.
  Organ* organ_around(const Piece& piece) {
    for (Organ& organ : organs_) {
      if (piece.volume < kLeastCavity * organ.volume || !is_inside(piece.soup, organ.outer)) continue;
      const bool is_in_cavity = std::any_of(organ.cavities.begin(), organ.cavities.end(),
                                            [&](const Soup& cavity) { return is_inside(piece.soup, cavity); });
      return is_in_cavity ? nullptr : &organ;
    }
    return nullptr;
  }

  void keep_piece(Piece piece, Organ* around) {
    const bool is_new = around == nullptr && (organs_.empty() || keep_ == Keep::each);
    Organ& organ = is_new ? organs_.emplace_back() : around != nullptr ? *around : organs_.front();
    append(organ.soup, piece.soup);
    if (!is_new) ++organ.shells;
    if (around != nullptr)
      organ.cavities.push_back(std::move(piece.soup));
    else if (is_new)
      organ.volume = piece.volume, organ.outer = std::move(piece.soup);
  }

  /// Removes small self-intersections and reports the rest.
  void treat_crossings() {
    const std::vector<std::int32_t> crossing = find_crossing(soup_, options_.threads);
    if (crossing.empty()) return;
    const Triangle& first = soup_.triangle[std::size_t(crossing[0])];
    Vec3 place;
    for (const std::int32_t v : first) place += soup_.vertex[std::size_t(v)] / 3;
    Finding finding{"self_intersection",
                    std::int64_t(crossing.size()),
                    place,
                    counted(std::int64_t(crossing.size()), "triangle") + " passing through others, the first at " +
                        place_text(place),
                    "none",
                    "the organ is filled wherever the surface is around it at least once"};
    const double widest = kCutShare * diagonal_;
    if (const std::int64_t cut = shells_ == 1 ? cut_crossing(soup_, crossing, widest) : 0; cut > 0) {
      finding.done = "cut out with what is around them (" + counted(cut, "triangle") + ") and filled again";
      finding.remains = "";
    }
    note(finding);
  }

  Errors describe(const Closing& closing, double largest_hole) const {
    Errors errors;
    const auto say = [&](const std::vector<Hole>& holes, const std::string& ending, const std::string& hint) {
      std::vector<Hole> sorted = holes;
      std::stable_sort(sorted.begin(), sorted.end(),
                       [](const Hole& a, const Hole& b) { return a.diameter > b.diameter; });
      for (std::size_t i = 0; i < std::min(sorted.size(), kMostShown); ++i)
        errors.push_back({path_, "open beyond repair: a hole " + hole_text(sorted[i]) + " " + ending, hint});
      if (sorted.size() > kMostShown)
        errors.push_back(
            {path_, "open beyond repair: " + counted(std::int64_t(sorted.size() - kMostShown), "hole") + " more", ""});
    };
    if (closing.too_large.empty() && closing.unfillable.empty()) return {};
    const double wide = closing.too_large.empty() ? 0 : widest(closing.too_large).diameter;
    const std::string is_wider = "is wider than the " + mm_text(largest_hole) + " that may be filled";
    if (wide > kSheetShare * diagonal_)
      say(closing.too_large, is_wider + ", and as wide as the mesh: it is a sheet, which bounds no volume",
          "give it a thickness in a mesh editor");
    else
      say(closing.too_large, is_wider,
          "largest_hole_mm " + std::to_string(std::int64_t(std::ceil(1e3 * wide * kRoundOff))) +
              " allows it to be closed by a cap; else close it in a mesh editor");
    say(closing.unfillable, "cannot be closed by triangles", "close it in a mesh editor");
    return errors;
  }

  static bool is_flat(const Soup& piece) {
    const BoundingBox box = bounding_box(piece);
    const double volume = std::abs(signed_volume(piece.vertex, piece.triangle, box.centre()));
    return !(volume > kFlat * std::pow(box.diagonal(), 3));
  }

  void turn_outwards() {
    if (shells_ > 1) {
      orient_parts(soup_);
    } else if (signed_volume(soup_.vertex, soup_.triangle, bounding_box(soup_).centre()) < 0) {
      for (Triangle& t : soup_.triangle) std::swap(t[1], t[2]);
    }
    const Turned turned = count_turned(welded_, soup_);
    if (turned.turned > 0 && turned.kept == 0)
      note({"inside_out", turned.turned, {}, "the mesh is inside out", "turned", ""});
    else if (turned.turned > 0)
      note({"flipped", turned.turned, {}, counted(turned.turned, "triangle") + " facing the wrong way", "turned", ""});
  }

  Result<CheckedMesh> finish() {
    const BoundingBox box = bounding_box(soup_);
    out_.box_least = box.least, out_.box_most = box.most;
    out_.volume = signed_volume(soup_.vertex, soup_.triangle, box.centre());
    out_.area = surface_area(soup_.vertex, soup_.triangle);
    out_.after = count_mesh(soup_.vertex, soup_.triangle);
    out_.part = parts_.part_of(soup_.vertex);
    out_.vertex = std::move(soup_.vertex);
    out_.triangle = std::move(soup_.triangle);
    if (out_.after.open_edges > 0 || out_.after.non_manifold_edges > 0 || !(out_.volume > 0))
      return Error{path_,
                   "open beyond repair: " + counted(out_.after.open_edges, "edge") + " still open after all repairs",
                   "repair it in a mesh editor"};
    tell("done", 1.0);
    return std::move(out_);
  }

  std::string path_;
  const RepairOptions& options_;
  Keep keep_;
  std::size_t most_;  ///< organs
  PartVote parts_;
  Soup soup_, welded_;
  double diagonal_ = 0;
  std::vector<Organ> organs_;
  std::int64_t shells_ = 1;  ///< of the organ at hand
  CheckedMesh out_;
};

Result<std::vector<CheckedMesh>> repair(const RawMesh& mesh, double unit_in_metres, const RepairOptions& options,
                                        Keep keep, std::size_t most) {
  if (!(std::isfinite(unit_in_metres) && unit_in_metres > 0))
    return Error{mesh.path, "the unit must be a length above 0", "give the length of one unit in metres"};
  if (options.largest_hole && !(*options.largest_hole >= 0))
    return Error{mesh.path, "the largest hole to fill must be at least 0 mm", ""};
  if (!(options.weld_distance >= 0 && options.weld_distance < 0.1))
    return Error{mesh.path, "the welding distance must be in [0, 0.1) diagonals", ""};
  try {
    return Repair(mesh, unit_in_metres, options, keep, most).run();
  } catch (const std::exception& trouble) {
    return Error{mesh.path, std::string("cannot be repaired: ") + trouble.what(), "repair it in a mesh editor"};
  }
}

}  // namespace

Result<CheckedMesh> repair_mesh(const RawMesh& mesh, double unit_in_metres, const RepairOptions& options) {
  Result<std::vector<CheckedMesh>> one =
      repair(mesh, unit_in_metres, options, options.all_parts ? Keep::all_in_one : Keep::largest, 1);
  if (!one) return one.errors();
  return std::move(one->front());
}

Result<std::vector<CheckedMesh>> repair_parts(const RawMesh& mesh, double unit_in_metres, const RepairOptions& options,
                                              std::size_t most) {
  return repair(mesh, unit_in_metres, options, Keep::each, most);
}

}  // namespace ctpm::importers
