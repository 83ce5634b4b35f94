#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <future>
#include <limits>
#include <numeric>

#include "core/surface/surface.h"
#include "importers/coarsen.h"
#include "importers/fill.h"
#include "importers/lattice.h"
#include "importers/scan_rows.h"
#include "importers/surface_index.h"
#include "importers/text.h"
#include "importers/topology.h"

namespace ctpm::importers {
namespace {

constexpr double kOnSurface = 1e-6;      // of the spacing: a centre nearer to the surface does not count as inside
constexpr double kMostRows = 1e7;        // lattice rows; bounds memory
constexpr double kThinInSpacings = 2.0;  // a surface point farther than this from every sphere marks a thin part

constexpr std::int64_t kFewestTriangles = 100;  // a coarser surface no longer resembles its organ

/// Calls `work(begin, end)` for ranges of 0 .. count on several threads. The ranges do not depend on the number of
/// threads.
template <class Work>
void in_pieces(std::size_t count, int threads, const Work& work) {
  constexpr std::size_t kPiece = 2048;
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t begin; (begin = next.fetch_add(kPiece)) < count;) work(begin, std::min(begin + kPiece, count));
  };
  std::vector<std::future<void>> others;
  for (int t = 1; t < threads && std::size_t(t) * kPiece < count; ++t)
    others.push_back(std::async(std::launch::async, run));
  run();
  for (auto& other : others) other.get();
}

Errors check(const CheckedMesh& mesh, const FillOptions& options) {
  Errors errors;
  const auto number = [](double value) { return mm_text(value); };
  if (!(std::isfinite(options.sphere_radius) && options.sphere_radius > 0))
    errors.push_back({"", "the sphere radius must be above 0 mm, got " + number(options.sphere_radius), ""});
  if (!std::isfinite(options.gap)) errors.push_back({"", "the gap must be a number of millimetres", ""});
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

/// A lattice that covers the mesh's box, symmetric about its centre. Error: far more spheres than allowed, more than
/// kMostRows rows, or more than 1e6 cells along an axis.
Result<Lattice> lay_lattice(const CheckedMesh& mesh, double spacing, const FillOptions& options) {
  const Vec3 extent = mesh.box_most - mesh.box_least;
  const auto cells = [&](double length) { return std::max(1.0, std::ceil(length / spacing)); };
  const double nx = cells(extent.x), ny = cells(extent.y), nz = cells(extent.z);
  const double expected = mesh.volume / (spacing * spacing * spacing);
  if (expected > 1.2 * double(options.most_spheres) || ny * nz > kMostRows || std::max({nx, ny, nz}) > 1e6) {
    char count[32];
    std::snprintf(count, sizeof count, "%.3g", expected);
    return Error{
        "",
        "about " + std::string(count) + " spheres " + mm_text(spacing) + " apart would be needed; at most " +
            std::to_string(options.most_spheres) + " are allowed",
        "take a larger sphere radius, or check the unit of the mesh: it is " + mm_text(norm(extent)) + " across"};
  }
  return Lattice{
      0.5 * (mesh.box_least + mesh.box_most), spacing, {std::int32_t(nx), std::int32_t(ny), std::int32_t(nz)}};
}

/// Depth of every cell centre below the surface [m].
std::vector<double> find_depths(const SurfaceIndex& index, const Lattice& lattice, const std::vector<Cell>& cell,
                                int threads) {
  std::vector<double> depth(cell.size());
  in_pieces(cell.size(), threads, [&](std::size_t begin, std::size_t end) {
    // Neighbours in a row have similar nearest triangles.
    std::int32_t guess = 0;
    for (std::size_t n = begin; n < end; ++n) {
      const auto nearest = index.nearest(lattice.at(cell[n]), guess);
      guess = nearest.block;
      depth[n] = std::sqrt(nearest.squared_distance);
    }
  });
  return depth;
}

/// Keeps the cells for which `keep` is true, and their depths.
template <class Keep>
void keep_only(std::vector<Cell>& cell, std::vector<double>& depth, const Keep& keep) {
  std::size_t next = 0;
  for (std::size_t n = 0; n < cell.size(); ++n)
    if (keep(n)) cell[next] = cell[n], depth[next] = depth[n], ++next;
  cell.resize(next);
  depth.resize(next);
}

struct Islands {
  std::vector<std::int32_t> of_cell;  ///< index of the island; islands are numbered by their first cell
  std::vector<std::int64_t> size;
};

/// Connected groups of neighbouring cells.
Islands find_islands(const CellLookup& lookup, const std::vector<Cell>& cell) {
  Islands islands;
  islands.of_cell.assign(cell.size(), -1);
  std::vector<std::int32_t> waiting;
  for (std::size_t start = 0; start < cell.size(); ++start) {
    if (islands.of_cell[start] >= 0) continue;
    const std::int32_t island = std::int32_t(islands.size.size());
    islands.size.push_back(0);
    islands.of_cell[start] = island;
    waiting.push_back(std::int32_t(start));
    while (!waiting.empty()) {
      const Cell c = cell[std::size_t(waiting.back())];
      waiting.pop_back();
      ++islands.size.back();
      for (const Cell& d : kLaterNeighbours)
        for (const int sign : {1, -1}) {
          const std::int32_t n = lookup.find({c[0] + sign * d[0], c[1] + sign * d[1], c[2] + sign * d[2]});
          if (n < 0 || islands.of_cell[std::size_t(n)] >= 0) continue;
          islands.of_cell[std::size_t(n)] = island;
          waiting.push_back(n);
        }
    }
  }
  return islands;
}

/// Drops all islands but the largest (the first of equal ones), or only reports them.
void treat_islands(const Lattice& lattice, std::vector<Cell>& cell, std::vector<double>& depth, bool keeps_islands,
                   std::vector<Finding>& findings) {
  const Islands islands = find_islands(CellLookup(lattice, cell), cell);
  if (islands.size.size() < 2) return;
  const auto largest = std::int32_t(std::max_element(islands.size.begin(), islands.size.end()) - islands.size.begin());
  const std::int64_t loose = std::int64_t(cell.size()) - islands.size[std::size_t(largest)];
  Finding finding;
  finding.code = "island";
  finding.count = std::int64_t(islands.size.size()) - 1;
  for (std::size_t n = 0; n < cell.size() && !finding.place; ++n)
    if (islands.of_cell[n] != largest) finding.place = lattice.at(cell[n]);
  finding.found = counted(finding.count, "group") + " of spheres (" + counted(loose, "sphere") +
                  ") not joined to the rest, the first at " + place_text(*finding.place);
  finding.done = keeps_islands ? "kept" : "dropped";
  if (keeps_islands) finding.remains = "the organ is not one connected network";
  findings.push_back(finding);
  if (!keeps_islands) keep_only(cell, depth, [&](std::size_t n) { return islands.of_cell[n] == largest; });
}

/// Numbers the layers: 1 + the whole spacings of depth, renumbered without empty layers.
std::vector<std::int32_t> number_layers(const std::vector<double>& depth, double spacing,
                                        std::vector<std::int64_t>& spheres_per_layer) {
  std::vector<std::int32_t> layer;
  for (const double d : depth) layer.push_back(1 + std::int32_t(std::floor(d / spacing)));
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

std::int64_t count_edges(const CellLookup& lookup, const std::vector<Cell>& cell) {
  std::int64_t edges = 0;
  for (const Cell& c : cell)
    for (const Cell& d : kLaterNeighbours) edges += lookup.find({c[0] + d[0], c[1] + d[1], c[2] + d[2]}) >= 0;
  return edges;
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

/// Measures the distance from the surface to the spheres, and finds parts too thin to hold spheres.
void measure_surface(const CellLookup& lookup, const CheckedMesh& mesh, double spacing, int threads,
                     FillReport& report) {
  std::vector<double> distance(mesh.vertex.size());
  in_pieces(distance.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) distance[v] = std::sqrt(lookup.nearest_squared_distance(mesh.vertex[v]));
  });
  const auto worst = std::max_element(distance.begin(), distance.end());
  report.largest_distance = *worst;
  report.mean_distance = std::accumulate(distance.begin(), distance.end(), 0.0) / double(distance.size());
  std::vector<char> is_thin(distance.size(), 0);
  for (std::size_t v = 0; v < distance.size(); ++v) is_thin[v] = distance[v] > kThinInSpacings * spacing;
  const std::int64_t thin = count_groups(mesh.triangle, is_thin);
  if (thin == 0) return;
  const Vec3 place = mesh.vertex[std::size_t(worst - distance.begin())];
  report.findings.push_back({"thin", thin, place,
                             counted(thin, "part") + " of the surface too thin for a sphere, the farthest point " +
                                 mm_text(*worst) + " from one, at " + place_text(place),
                             "none", "what is thin follows the nearest spheres; a smaller sphere radius fills it"});
}

/// The drawn surface: the mesh, or a coarser one if requested.
Surface take_surface(const CheckedMesh& mesh, std::int64_t most_triangles, std::vector<Finding>& findings) {
  Surface surface;
  surface.vertex = mesh.vertex;
  surface.triangle = mesh.triangle;
  if (most_triangles == 0 || std::int64_t(mesh.triangle.size()) <= most_triangles) return surface;
  Soup coarse = coarsen({mesh.vertex, mesh.triangle}, most_triangles);
  // Distance of the mesh's vertices from the coarser surface.
  const SurfaceIndex index(coarse.vertex, coarse.triangle);
  double off = 0;
  for (const Vec3& p : mesh.vertex) off = std::max(off, index.nearest(p).squared_distance);
  surface.vertex = std::move(coarse.vertex);
  surface.triangle = std::move(coarse.triangle);
  const std::int64_t count = std::int64_t(surface.triangle.size());
  findings.push_back({"coarsened",
                      std::int64_t(mesh.triangle.size()) - count,
                      {},
                      std::to_string(mesh.triangle.size()) + " triangles are more than the " +
                          std::to_string(most_triangles) + " that may be drawn",
                      "drawn with " + std::to_string(count) + ", at most " + mm_text(std::sqrt(off)) + " off",
                      count > most_triangles ? "fewer would turn triangles over" : ""});
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

Result<Filling> fill_organ(const CheckedMesh& mesh, const FillOptions& options) try {
  if (Errors errors = check(mesh, options); !errors.empty()) return errors;
  const double radius = options.sphere_radius;
  const double spacing = 2 * radius + (options.gap < 0 ? radius : options.gap);
  const auto tell = [&](const char* stage, double fraction) {
    if (options.progress) options.progress(std::string("fill: ") + stage, fraction);
  };
  tell("lattice", 0);
  const Result<Lattice> laid = lay_lattice(mesh, spacing, options);
  if (!laid) return laid.errors();
  const Lattice& lattice = *laid;
  std::vector<Cell> cell = cells_inside(mesh.vertex, mesh.triangle, lattice);
  tell("depth", 0.2);
  const SurfaceIndex index(mesh.vertex, mesh.triangle);
  std::vector<double> depth = find_depths(index, lattice, cell, options.threads);
  keep_only(cell, depth, [&](std::size_t n) { return depth[n] > kOnSurface * spacing; });
  if (cell.empty())
    return Error{"",
                 "no sphere fits: the mesh is " + mm_text(norm(mesh.box_most - mesh.box_least)) +
                     " across and the spheres are " + mm_text(spacing) + " apart",
                 "take a smaller sphere radius, or check the unit of the mesh"};
  if (std::int64_t(cell.size()) > options.most_spheres)
    return Error{"",
                 std::to_string(cell.size()) + " spheres fit, but at most " + std::to_string(options.most_spheres) +
                     " are allowed",
                 "take a larger sphere radius, or check the unit of the mesh"};

  Filling filling;
  FillReport& report = filling.report;
  tell("network", 0.6);
  treat_islands(lattice, cell, depth, options.keep_islands, report.findings);
  FilledOrgan& organ = filling.organ;
  organ.sphere_radius = radius;
  organ.spacing = spacing;
  for (const Cell& c : cell) organ.centre.push_back(lattice.at(c));
  organ.layer = number_layers(depth, spacing, report.spheres_per_layer);
  const CellLookup lookup(lattice, cell);
  report.spheres = std::int64_t(cell.size());
  report.edges = count_edges(lookup, cell);
  report.filled_volume = double(report.spheres) * spacing * spacing * spacing;
  measure_surface(lookup, mesh, spacing, options.threads, report);
  organ.cell = cell;
  organ.depth = std::move(depth);
  tell("surface", 0.7);
  organ.surface = take_surface(mesh, options.most_triangles, report.findings);
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
