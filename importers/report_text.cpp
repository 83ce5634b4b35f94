#include <cstdarg>
#include <cstdio>

#include "importers/import.h"
#include "importers/text.h"

namespace ctpm::importers {
namespace {

std::string formatted(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string formatted(const char* format, ...) {
  char line[256];
  va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

std::string source_text(UnitSource source) {
  switch (source) {
    case UnitSource::given:
      return "as given";
    case UnitSource::file:
      return "as the file says";
    case UnitSource::guessed:
      return "guessed from the size";
    case UnitSource::scaled:
      return "scaled to a usual size";
  }
  return "";
}

std::string counts_line(const char* when, const MeshCounts& c) {
  return formatted("  %-8s %lld vertices, %lld triangles, %s, %s, %s\n", when, static_cast<long long>(c.vertices),
                   static_cast<long long>(c.triangles), counted(c.parts, "part").c_str(),
                   counted(c.open_edges, "open edge").c_str(),
                   counted(c.non_manifold_edges, "non-manifold edge").c_str());
}

std::string finding_lines(const Finding& finding) {
  std::string text = "  - " + finding.found + ": " + (finding.done == "none" ? "left as it is" : finding.done) + "\n";
  if (!finding.remains.empty()) text += "    note: " + finding.remains + "\n";
  return text;
}

}  // namespace

std::string to_text(const ImportReport& report) {
  constexpr double kMillilitre = 1e-6;  // [m^3]
  const FillReport& fill = report.fill;
  const Vec3 size = report.box_most - report.box_least;
  std::string text = report.path + "\n";
  text += "unit: " + unit_name(report.unit.in_metres) + " (" + source_text(report.unit.source) + ")\n";
  text += formatted("size: %.1f x %.1f x %.1f mm, %.1f ml\n", 1e3 * size.x, 1e3 * size.y, 1e3 * size.z,
                    report.mesh_volume / kMillilitre);
  text += "mesh:\n" + counts_line("as read", report.before) + counts_line("as kept", report.after);
  text += report.findings.empty() ? "found: nothing wrong\n" : "found:\n";
  for (const Finding& finding : report.findings) text += finding_lines(finding);
  text += formatted("filling: %s of radius %s, %s apart, in %s\n", counted(fill.spheres, "sphere").c_str(),
                    mm_text(report.sphere_radius).c_str(), mm_text(report.spacing).c_str(),
                    counted(std::int64_t(fill.spheres_per_layer.size()), "layer").c_str());
  text += "  spheres per layer, from the outside:";
  for (const std::int64_t n : fill.spheres_per_layer) text += " " + std::to_string(n);
  text += formatted("\n  volume filled: %.1f ml, %.0f %% of the mesh\n", fill.filled_volume / kMillilitre,
                    100 * fill.filled_volume / report.mesh_volume);
  text += formatted("  edges: %lld, %.1f per sphere\n", static_cast<long long>(fill.edges),
                    double(fill.edges) / double(fill.spheres));
  text += "  drawn with " + counted(fill.surface_triangles, "triangle") + "\n";
  text += "  from the surface to the nearest sphere: mean " + mm_text(fill.mean_distance) + ", at most " +
          mm_text(fill.largest_distance) + "\n";
  text += "  " + to_text(fill.shape) + "\n";
  return text;
}

}  // namespace ctpm::importers
