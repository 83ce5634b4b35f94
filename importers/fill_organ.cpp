#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <numeric>

#include "core/surface/surface.h"
#include "importers/coarsen.h"
#include "importers/cover_lattice.h"
#include "importers/fill.h"
#include "importers/in_pieces.h"
#include "importers/lattice.h"
#include "importers/refine.h"
#include "importers/scan_rows.h"
#include "importers/shape_error.h"
#include "importers/size.h"
#include "importers/surface_index.h"
#include "importers/text.h"
#include "importers/topology.h"
#include "importers/wall_thickness.h"

namespace ctpm::importers {
namespace {

constexpr double kMostRows = 6e5;  // lattice rows; bounds memory
// A surface point farther than this from every sphere with so much tissue marks a thin part.
constexpr double kThinInSpacings = 2, kFullShare = 0.6;
constexpr double kSpacingsAcross = 2;     // what carries tissue: one sheet of spheres folds like cloth
constexpr double kLongestEdge = 1.0 / 3;  // of the drawn surface, in spacings

constexpr std::int64_t kFewestTriangles = 100;  // a coarser surface no longer resembles its organ

Errors check(const CheckedMesh& mesh, const FillOptions& options) {
  Errors errors;
  const auto number = [](double value) { return mm_text(value); };
  if (!(std::isfinite(options.sphere_radius) && options.sphere_radius > 0))
    errors.push_back({"", "the sphere radius must be above 0 mm, got " + number(options.sphere_radius), ""});
  if (!std::isfinite(options.gap)) errors.push_back({"", "the gap must be a number of millimetres", ""});
  for (const double shift : {options.lattice_shift.x, options.lattice_shift.y, options.lattice_shift.z})
    if (!(std::abs(shift) <= 0.5)) errors.push_back({"", "the lattice can be shifted by half a spacing at most", ""});
  if (options.threads < 1)
    errors.push_back({"", "at least one thread is needed, got " + std::to_string(options.threads), ""});
  if (options.most_triangles != 0 && options.most_triangles < kFewestTriangles)
    errors.push_back({"",
                      "a drawn surface needs at least " + std::to_string(kFewestTriangles) + " triangles, got " +
                          std::to_string(options.most_triangles),
                      ""});
  if (options.most_spheres < 1) errors.push_back({"", "at least one sphere must be allowed", ""});
  CTPM_CHECK(!mesh.triangle.empty() && mesh.volume > 0, "filling needs a checked mesh");
  return errors;
}

/// A lattice of cubic cells that covers the mesh's box, symmetric about its centre but for the shift. Error: far more
/// spheres than allowed, more than kMostRows rows, or more than 1e6 cells along an axis.
Result<Lattice> lay_cells(const CheckedMesh& mesh, double spacing, const FillOptions& options) {
  const Vec3 extent = mesh.box_most - mesh.box_least, shift = options.lattice_shift;
  constexpr double kRounding = 1e-9;  // of a spacing: a box of whole spacings needs no further cell
  const auto cells = [&](double length, double moved) {
    return std::max(1.0, std::ceil(length / spacing - kRounding)) + (moved == 0 ? 0 : 2);
  };
  const double nx = cells(extent.x, shift.x), ny = cells(extent.y, shift.y), nz = cells(extent.z, shift.z);
  const double expected = expected_spheres(mesh, spacing);
  if (expected > 1.2 * double(options.most_spheres) || ny * nz > kMostRows || std::max({nx, ny, nz}) > 1e6) {
    char count[32];
    std::snprintf(count, sizeof count, "%.3g", expected);
    return Error{"",
                 "about " + std::string(count) + " spheres " + mm_text(spacing) + " apart would be needed; at most " +
                     std::to_string(options.most_spheres) + " are allowed",
                 "take a larger sphere radius, or check the unit of the mesh: it is " + mm_text(norm(extent)) +
                     " from corner to corner of its box"};
  }
  return Lattice{0.5 * (mesh.box_least + mesh.box_most) + spacing * shift,
                 spacing,
                 {std::int32_t(nx), std::int32_t(ny), std::int32_t(nz)}};
}

/// Depth of every sphere's centre below the surface [m]; negative outside.
std::vector<double> find_depths(const CheckedMesh& mesh, const Cover& cover, int threads) {
  const SurfaceIndex index(mesh.vertex, mesh.triangle);
  std::vector<double> depth(cover.cell.size());
  in_pieces(depth.size(), threads, [&](std::size_t begin, std::size_t end) {
    // Neighbours in a row have similar nearest triangles.
    std::int32_t guess = 0;
    for (std::size_t n = begin; n < end; ++n) {
      const auto nearest = index.nearest(cover.lattice.at(cover.cell[n]), guess);
      guess = nearest.block;
      depth[n] = -std::sqrt(nearest.squared_distance);
    }
  });
  const CellLookup lookup(cover.lattice, cover.cell);
  for (const Cell& cell : cells_inside(mesh.vertex, mesh.triangle, cover.lattice))
    if (const std::int32_t n = lookup.find(cell); n >= 0) depth[std::size_t(n)] *= -1;
  return depth;
}

struct Islands {
  std::vector<std::int32_t> of_cell;  ///< index of the island; islands are numbered by their first cell
  std::vector<std::int64_t> size;
};

/// Calls `visit(a, b)` for the two spheres of every element.
template <class Visit>
void for_each_element(const Cover& cover, const Visit& visit) {
  const CellLookup lookup(cover.lattice, cover.cell);
  for (std::size_t n = 0; n < cover.cell.size(); ++n)
    for (std::size_t d = 0; d < kLatticeDirections.size(); ++d) {
      if (cover.shares.element[d][n] == 0) continue;
      const Cell &c = cover.cell[n], &step = kLatticeDirections[d];
      visit(n, std::size_t(lookup.find({c[0] + step[0], c[1] + step[1], c[2] + step[2]})));
    }
}

/// Groups of spheres that elements join.
Islands find_islands(const Cover& cover) {
  std::vector<std::int32_t> lowest(cover.cell.size());
  std::iota(lowest.begin(), lowest.end(), 0);
  const auto root = [&](std::size_t n) {
    auto at = std::int32_t(n);
    while (lowest[std::size_t(at)] != at) at = lowest[std::size_t(at)] = lowest[std::size_t(lowest[std::size_t(at)])];
    return at;
  };
  for_each_element(cover, [&](std::size_t a, std::size_t b) {
    const std::int32_t p = root(a), q = root(b);
    lowest[std::size_t(std::max(p, q))] = std::min(p, q);
  });
  Islands islands;
  islands.of_cell.assign(cover.cell.size(), -1);
  for (std::size_t n = 0; n < cover.cell.size(); ++n) {
    const auto first = std::size_t(root(n));
    if (first == n) islands.of_cell[n] = std::int32_t(islands.size.size()), islands.size.push_back(0);
    islands.of_cell[n] = islands.of_cell[first];
    ++islands.size[std::size_t(islands.of_cell[n])];
  }
  return islands;
}

/// Drops all islands but the largest (the first of equal ones), or only reports them.
void treat_islands(Cover& cover, bool keeps_islands, std::vector<Finding>& findings) {
  const Islands islands = find_islands(cover);
  if (islands.size.size() < 2) return;
  const auto largest = std::int32_t(std::max_element(islands.size.begin(), islands.size.end()) - islands.size.begin());
  const std::int64_t loose = std::int64_t(cover.cell.size()) - islands.size[std::size_t(largest)];
  std::vector<char> is_kept(cover.cell.size());
  Finding finding;
  finding.code = "island";
  finding.count = std::int64_t(islands.size.size()) - 1;
  for (std::size_t n = 0; n < cover.cell.size(); ++n) {
    is_kept[n] = islands.of_cell[n] == largest;
    if (!is_kept[n] && !finding.place) finding.place = cover.lattice.at(cover.cell[n]);
  }
  finding.found = counted(finding.count, "group") + " of spheres (" + counted(loose, "sphere") +
                  ") not joined to the rest, the first at " + place_text(*finding.place);
  finding.done = keeps_islands ? "kept" : "dropped";
  if (keeps_islands) finding.remains = "the organ is not one connected network";
  findings.push_back(finding);
  if (!keeps_islands) keep_only(cover, is_kept);
}

/// Numbers the layers: 1 + the whole spacings of depth, renumbered without empty layers.
std::vector<std::int32_t> number_layers(const std::vector<double>& depth, double spacing,
                                        std::vector<std::int64_t>& spheres_per_layer) {
  std::vector<std::int32_t> layer;
  constexpr double kRounding = 1e-6;  // of a spacing: a sphere just at a whole depth belongs to the next layer
  for (const double d : depth) layer.push_back(1 + std::int32_t(std::floor(std::max(d, 0.0) / spacing + kRounding)));
  std::vector<std::int64_t> count(std::size_t(*std::max_element(layer.begin(), layer.end())) + 1, 0);
  for (const std::int32_t l : layer) ++count[std::size_t(l)];
  std::vector<std::int32_t> new_number(count.size(), 0);
  for (std::size_t l = 1; l < count.size(); ++l)
    if (count[l] > 0) {
      spheres_per_layer.push_back(count[l]);
      new_number[l] = std::int32_t(spheres_per_layer.size());
    }
  for (std::int32_t& l : layer) l = new_number[std::size_t(l)];
  return layer;
}

/// Number of groups of marked vertices that triangles connect.
std::int64_t count_groups(const std::vector<Triangle>& triangle, const std::vector<char>& is_marked) {
  std::vector<Triangle> marked;
  for (const Triangle& t : triangle) {
    // Replace unmarked corners by a marked one, so that only marked vertices are connected.
    Triangle kept{};
    int count = 0;
    for (const std::int32_t v : t)
      if (is_marked[std::size_t(v)]) kept[std::size_t(count++)] = v;
    for (int c = count; c < 3 && count > 0; ++c) kept[std::size_t(c)] = kept[0];
    if (count > 0) marked.push_back(kept);
  }
  return count_joined(marked);
}

/// Measures the distance from the surface to the spheres, and finds parts too thin to hold one full of tissue.
void measure_surface(const Cover& cover, const CheckedMesh& mesh, const FillOptions& options, FillReport& report) {
  const double spacing = cover.lattice.spacing;
  std::vector<Cell> full;
  for (std::size_t n = 0; n < cover.cell.size(); ++n)
    if (cover.shares.sphere[n] > kFullShare) full.push_back(cover.cell[n]);
  const CellLookup all(cover.lattice, cover.cell), inner(cover.lattice, full);
  std::vector<double> distance(mesh.vertex.size()), to_full(mesh.vertex.size());
  in_pieces(distance.size(), options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      distance[v] = std::sqrt(all.nearest_squared_distance(mesh.vertex[v]));
      to_full[v] = std::sqrt(inner.nearest_squared_distance(mesh.vertex[v]));
    }
  });
  report.largest_distance = *std::max_element(distance.begin(), distance.end());
  report.mean_distance = std::accumulate(distance.begin(), distance.end(), 0.0) / double(distance.size());
  std::vector<char> is_thin(distance.size(), 0);
  for (std::size_t v = 0; v < distance.size(); ++v) is_thin[v] = to_full[v] > kThinInSpacings * spacing;
  const std::int64_t thin = count_groups(mesh.triangle, is_thin);
  if (thin == 0) return;
  const auto worst = std::max_element(to_full.begin(), to_full.end()) - to_full.begin();
  const double share = double(std::count(is_thin.begin(), is_thin.end(), char{1})) / double(is_thin.size());
  const double thickness = wall_thickness(mesh, is_thin, spacing), fine = thickness / kSpacingsAcross;
  report.findings.push_back({"thin", thin, mesh.vertex[std::size_t(worst)],
                             counted(thin, "part") + " of the organ, " + std::to_string(std::lround(100 * share)) +
                                 " % of its vertices, thinner than about a spacing (" + mm_text(spacing) +
                                 "), mostly about " + roughly(1e3 * thickness) + " mm thick, one at " +
                                 place_text(mesh.vertex[std::size_t(worst)]),
                             "none",
                             "it bends too easily or too hard, and a cut finds no inside; spheres of radius " +
                                 roughly(1e3 * fine / spacing * options.sphere_radius) + " mm, " + roughly(1e3 * fine) +
                                 " mm apart, would lie two across it: about " + roughly(expected_spheres(mesh, fine))});
}

/// Coarsens a drawn surface that has more triangles than requested.
void coarsen_surface(const CheckedMesh& mesh, std::int64_t most_triangles, Soup& surface,
                     std::vector<Finding>& findings) {
  if (most_triangles == 0 || std::int64_t(mesh.triangle.size()) <= most_triangles) return;
  surface = coarsen(surface, most_triangles);
  // Distance of the mesh's vertices from the coarser surface.
  const SurfaceIndex index(surface.vertex, surface.triangle);
  double off = 0;
  for (const Vec3& p : mesh.vertex) off = std::max(off, index.nearest(p).squared_distance);
  const std::int64_t count = std::int64_t(surface.triangle.size());
  findings.push_back({"coarsened",
                      std::int64_t(mesh.triangle.size()) - count,
                      {},
                      std::to_string(mesh.triangle.size()) + " triangles are more than the " +
                          std::to_string(most_triangles) + " that may be drawn",
                      "drawn with " + std::to_string(count) + ", at most " + mm_text(std::sqrt(off)) + " off",
                      count > most_triangles ? "fewer would turn triangles over" : ""});
}

/// The drawn surface: the mesh, coarser if requested, with edges short enough to bend around a tool unless that takes
/// more triangles than requested.
Surface take_surface(const CheckedMesh& mesh, double spacing, std::int64_t most_triangles,
                     std::vector<Finding>& findings) {
  Soup soup{mesh.vertex, mesh.triangle};
  coarsen_surface(mesh, most_triangles, soup, findings);
  if (Soup fine = refine(soup, kLongestEdge * spacing);
      most_triangles == 0 || std::int64_t(fine.triangle.size()) <= most_triangles)
    soup = std::move(fine);
  Surface surface;
  surface.vertex = std::move(soup.vertex);
  surface.triangle = std::move(soup.triangle);
  return surface;
}

/// Finds places whose bound spheres lie in one sheet or row. The drawn surface has no thickness there, even at rest.
/// The finding explains what looks like a defect of the mesh.
void note_flat(const FilledOrgan& organ, std::vector<Finding>& findings) {
  constexpr double kOff = 1e-3;  // of the spacing; far above rounding errors
  Vec3Array rest(organ.centre.size());
  for (std::size_t n = 0; n < organ.centre.size(); ++n) rest.set(n, organ.centre[n]);
  std::vector<Vec3> drawn;
  surface::deform_surface(organ.surface, rest, 0, drawn);
  std::int64_t count = 0;
  std::size_t worst = 0;
  const auto off = [&](std::size_t v) { return norm(drawn[v] - organ.surface.vertex[v]); };
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    count += off(v) > kOff * organ.spacing;
    if (off(v) > off(worst)) worst = v;
  }
  if (count == 0) return;
  const Vec3 place = organ.surface.vertex[worst];
  findings.push_back({"flat", count, place,
                      counted(count, "surface vertex") + " beside a single sheet or row of spheres, drawn up to " +
                          mm_text(off(worst)) + " off their place, the worst at " + place_text(place),
                      "none", "a smaller sphere radius gives the organ more than one sphere there"});
}

}  // namespace

double radius_for(const CheckedMesh& mesh, std::int64_t spheres) {
  // The number falls with the spacing cubed inside and squared at the surface; a step between both converges for
  // either.
  constexpr double kPower = 0.4, kNear = 0.03;
  constexpr int kMostSteps = 12;
  double spacing = std::cbrt(mesh.volume / double(spheres)), best = spacing, least = INFINITY;
  for (int step = 0; step < kMostSteps; ++step) {
    const Result<Lattice> cells = lay_cells(mesh, spacing, {});
    if (!cells) {
      spacing *= 2;
      continue;
    }
    const double count = std::max<double>(1, double(cover_with_cells(mesh, *cells).cell.size()));
    const double off = std::abs(std::log(count / double(spheres)));
    if (off < least) best = spacing, least = off;
    if (off < kNear) break;
    spacing *= std::pow(count / double(spheres), kPower);
  }
  return best / 3;
}

Result<Filling> fill_organ(const CheckedMesh& mesh, const FillOptions& options) try {
  if (Errors errors = check(mesh, options); !errors.empty()) return errors;
  const double radius = options.sphere_radius, spacing = spacing_of(options);
  const auto tell = [&](const char* stage, double fraction) {
    if (options.progress) options.progress(std::string("fill: ") + stage, fraction);
  };
  tell("lattice", 0);
  const Result<Lattice> laid = lay_cells(mesh, spacing, options);
  if (!laid) return laid.errors();
  Cover cover = cover_with_cells(mesh, *laid);
  if (cover.cell.empty())
    return Error{"",
                 "no sphere fits: the mesh is " + mm_text(norm(mesh.box_most - mesh.box_least)) +
                     " across and the spheres are " + mm_text(spacing) + " apart",
                 "take a smaller sphere radius, or check the unit of the mesh"};
  if (std::int64_t(cover.cell.size()) > options.most_spheres)
    return Error{"",
                 std::to_string(cover.cell.size()) + " spheres are needed, but at most " +
                     std::to_string(options.most_spheres) + " are allowed",
                 "take a larger sphere radius, or check the unit of the mesh"};

  Filling filling;
  FillReport& report = filling.report;
  treat_islands(cover, options.keep_islands, report.findings);
  tell("depth", 0.2);
  FilledOrgan& organ = filling.organ;
  organ.sphere_radius = radius;
  organ.spacing = spacing;
  for (const Cell& c : cover.cell) organ.centre.push_back(cover.lattice.at(c));
  organ.depth = find_depths(mesh, cover, options.threads);
  organ.layer = number_layers(organ.depth, spacing, report.spheres_per_layer);
  report.spheres = std::int64_t(cover.cell.size());
  for_each_element(cover, [&](std::size_t, std::size_t) { ++report.edges; });
  for (const double share : cover.shares.sphere) report.filled_volume += share * spacing * spacing * spacing;
  measure_surface(cover, mesh, options, report);
  report.shape = measure_shape(mesh, cover, organ.depth, radius, options.threads);
  organ.cell = std::move(cover.cell);
  organ.shares = std::move(cover.shares);
  tell("surface", 0.7);
  organ.surface = take_surface(mesh, spacing, options.most_triangles, report.findings);
  report.surface_triangles = std::int64_t(organ.surface.triangle.size());
  tell("binding", 0.8);
  surface::bind_surface(organ, options.threads);
  note_flat(organ, report.findings);
  tell("done", 1);
  return filling;
} catch (const std::bad_alloc&) {
  return Error{"", "filling needs more memory than there is", "take a larger sphere radius"};
} catch (const std::exception& trouble) {
  return Error{"", std::string("cannot be filled: ") + trouble.what(), "leave the drawn surface as fine as it is"};
}

}  // namespace ctpm::importers
