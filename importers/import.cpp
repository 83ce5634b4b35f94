#include "importers/import.h"

#include <cmath>
#include <cstdio>

#include "importers/size.h"
#include "importers/text.h"
#include "importers/topology.h"

namespace ctpm::importers {
namespace {

// Fraction of an import done after reading and after repairing, measured on scanner meshes.
constexpr double kReadShare = 0.3, kRepairShare = 0.7;

/// Checks options that are invalid for every mesh.
Errors check(const ImportOptions& options) {
  Errors errors;
  const auto must = [&](bool is_right, const std::string& message) {
    if (!is_right) errors.push_back({"options", message, ""});
  };
  must(!options.unit_in_metres || (std::isfinite(*options.unit_in_metres) && *options.unit_in_metres > 0),
       "the unit must be a length above 0");
  must(!options.size || (std::isfinite(*options.size) && *options.size > 0), "the size must be a length above 0");
  must(std::isfinite(options.scale) && options.scale > 0, "the scale must be a number above 0");
  must(options.usual_size.least > 0 && options.usual_size.most > options.usual_size.least,
       "the usual size must be a range above 0");
  must(!options.largest_hole || *options.largest_hole >= 0, "the largest hole to fill must be at least 0 mm");
  must(std::isfinite(options.sphere_radius) && options.sphere_radius > 0,
       "the sphere radius must be above 0 mm, got " + mm_text(options.sphere_radius));
  must(std::isfinite(options.gap), "the gap must be a number of millimetres");
  must(options.most_spheres > 0, "at least one sphere must be allowed");
  must(options.most_triangles >= 0, "the drawn surface cannot have fewer than 0 triangles");
  must(options.threads >= 1, "at least one thread is needed, got " + std::to_string(options.threads));
  must(options.time_limit_s > 0, "the time limit must be above 0 s");
  return errors;
}

std::string range_text(UsualSize usual) { return mm_text(usual.least) + " to " + mm_text(usual.most); }

/// Adds a finding if the unit was guessed or the size is unusual.
void note_unit(const UnitChoice& unit, double unit_of_file, double diagonal, UsualSize usual,
               std::vector<Finding>& findings) {
  const std::string across = mm_text(diagonal) + " from corner to corner of its box (usual: " + range_text(usual) + ")";
  Finding guess{
      "unit_guessed", 1, {}, "the file does not say its unit", "", "give the unit or the size if that is wrong"};
  if (unit_of_file > 0)
    guess.code = "unit_doubted",
    guess.found = "the file says that its unit is " + unit_name(unit_of_file) + ", which no such organ would fit";
  if (unit.source == UnitSource::guessed) {
    guess.done = "taken as " + unit_name(unit.in_metres) + ", which makes the organ " + across;
    findings.push_back(guess);
  }
  if (unit.source == UnitSource::scaled) {
    guess.code = "without_scale";
    guess.found += unit_of_file > 0 ? "" : ", and no unit makes the organ as large as usual";
    guess.done = "scaled so that the organ is " + across;
    findings.push_back(guess);
  }
  // The guess used the whole file; this check uses only the parts kept.
  if (diagonal < usual.least || diagonal > usual.most)
    findings.push_back(
        {"unusual_size",
         1,
         {},
         "the organ is " + mm_text(diagonal) + " from corner to corner of its box; usual is " + range_text(usual),
         "none",
         "check the unit"});
}

/// Adds a finding if the spheres stand for more or less than the mesh encloses.
void note_volume(double filled, double enclosed, std::vector<Finding>& findings) {
  constexpr double kKept = 0.05;
  if (std::abs(filled / enclosed - 1) <= kKept) return;
  char text[160];
  std::snprintf(text, sizeof text, "the spheres stand for %.1f ml, the mesh encloses %.1f ml", 1e6 * filled,
                1e6 * enclosed);
  findings.push_back({"volume",
                      1,
                      {},
                      text,
                      "none",
                      "tissue that overlaps itself counts once, and groups of spheres apart from the rest are lost"});
}

/// The unit of a file, as asked for, said or guessed.
UnitChoice unit_of(const RawMesh& mesh, const ImportOptions& options) {
  const double diagonal = bounding_box({mesh.vertex, mesh.triangle}).diagonal();
  std::optional<double> given = options.unit_in_metres;
  if (options.size && diagonal > 0) given = *options.size / diagonal;
  UnitChoice unit = choose_unit(mesh, given, options.usual_size);
  unit.in_metres *= options.scale;
  return unit;
}

/// Whether the largest part alone would be given another unit than the whole file was, in which crumbs may lie far away
/// or many organs beside each other; `unit` is then its own.
bool is_other_for(const CheckedMesh& largest, const RawMesh& mesh, const ImportOptions& options, UnitChoice& unit) {
  if (unit.source != UnitSource::guessed && unit.source != UnitSource::scaled) return false;
  const double diagonal = norm(largest.box_most - largest.box_least) / unit.in_metres;
  UnitChoice own = choose_unit(diagonal, mesh.unit_in_metres, {}, options.usual_size);
  own.in_metres *= options.scale;
  const bool is_other = std::abs(own.in_metres / unit.in_metres - 1) > 1e-6;
  unit = own;
  return is_other;
}

/// Maps the progress of one stage to the whole import.
Progress share_of(const Progress& whole, double begin, double end) {
  return [whole, begin, end](const std::string& stage, double fraction) {
    whole(stage, begin + (end - begin) * fraction);
  };
}

/// Ends an import from within the progress of one of its stages; stays in this file.
struct Stopped {};

/// The progress that the stages get: it tells the caller, and ends the import when the caller asks for that.
Progress told_to(const ImportOptions& options) {
  return [&options](const std::string& stage, double fraction) {
    if (options.should_stop && options.should_stop()) throw Stopped{};
    if (options.progress) options.progress(stage, fraction);
  };
}

/// Refuses, before the work of filling it, an organ of a wrong size that would need many spheres: it has a wrong unit,
/// and would settle for minutes or hours.
Result<Done> check_size(const CheckedMesh& mesh, UsualSize usual, const FillOptions& fill) {
  constexpr double kMost = 20'000;
  const Vec3 size = mesh.box_most - mesh.box_least;
  const double spacing = spacing_of(fill), expected = expected_spheres(mesh, spacing);
  if (norm(size) <= kWrongSize * usual.most || expected <= kMost) return Done{};
  char lengths[64];
  std::snprintf(lengths, sizeof lengths, "%.0f x %.0f x %.0f mm", 1e3 * size.x, 1e3 * size.y, 1e3 * size.z);
  return Error{"",
               std::string("the organ is ") + lengths + " large (usual: " + range_text(usual) +
                   " from corner to corner of its box), and about " + roughly(expected) + " spheres " +
                   mm_text(spacing) + " apart would fill it",
               "check the unit of the mesh (mesh_unit in a scene), or take a larger sphere radius"};
}

Errors with_place(Errors errors, const std::string& path) {
  for (Error& error : errors)
    if (error.where.empty()) error.where = path;
  return errors;
}

}  // namespace

Result<RepairedFile> repair_file(const std::string& path, const ImportOptions& options, std::size_t most) try {
  if (Errors errors = check(options); !errors.empty()) return errors;
  const Progress tell = told_to(options);
  tell("read", 0);
  ReadOptions reading;
  reading.part = options.part;
  reading.time_limit_s = options.time_limit_s;
  Result<RawMesh> raw = read_mesh(path, reading);
  if (!raw) return raw.errors();
  raw->vertex = turned(std::move(raw->vertex), options.turn);

  RepairedFile file;
  ImportReport& report = file.report;
  report.path = path;
  report.format = raw->format;
  report.parts = raw->parts;
  report.unit = unit_of(*raw, options);
  file.part_colour = raw->part_colour;
  RepairOptions repair;
  repair.all_parts = options.all_parts;
  repair.largest_hole = options.largest_hole;
  repair.threads = options.threads;
  repair.progress = share_of(tell, kReadShare, kRepairShare);
  if (most > 1) {
    Result<std::vector<CheckedMesh>> meshes = repair_parts(*raw, report.unit.in_metres, repair, most);
    if (meshes && is_other_for(meshes->front(), *raw, options, report.unit))
      meshes = repair_parts(*raw, report.unit.in_metres, repair, most);
    if (!meshes) return meshes.errors();
    file.mesh = std::move(*meshes);
  } else {
    Result<CheckedMesh> mesh = repair_mesh(*raw, report.unit.in_metres, repair);
    if (mesh && !options.all_parts && is_other_for(*mesh, *raw, options, report.unit))
      mesh = repair_mesh(*raw, report.unit.in_metres, repair);
    if (!mesh) return mesh.errors();
    file.mesh.push_back(std::move(*mesh));
  }
  const CheckedMesh& first = file.mesh.front();
  note_unit(report.unit, raw->unit_in_metres, norm(first.box_most - first.box_least), options.usual_size,
            report.findings);
  return file;
} catch (const Stopped&) {
  return Error{path, "stopped", ""};
}

RepairedFile turned(RepairedFile file, Vec3 turn) {
  for (CheckedMesh& mesh : file.mesh) {
    mesh.vertex = turned(std::move(mesh.vertex), turn);
    const BoundingBox box = bounding_box({mesh.vertex, mesh.triangle});
    mesh.box_least = box.least, mesh.box_most = box.most;
  }
  return file;
}

Result<ImportedOrgan> fill_repaired(const RepairedFile& file, std::size_t index, const ImportOptions& options) try {
  const Progress tell = told_to(options);
  ImportedOrgan imported;
  imported.mesh = file.mesh[index];
  const CheckedMesh& mesh = imported.mesh;
  ImportReport& report = imported.report;
  report = file.report;
  if (index > 0) report.findings.clear();
  report.findings.insert(report.findings.end(), mesh.findings.begin(), mesh.findings.end());
  report.before = mesh.before, report.after = mesh.after;
  report.mesh_volume = mesh.volume, report.mesh_area = mesh.area;
  report.box_least = mesh.box_least, report.box_most = mesh.box_most;

  FillOptions fill;
  fill.sphere_radius = options.sphere_radius;
  fill.gap = options.gap;
  fill.lattice_shift = options.lattice_shift;
  fill.keep_islands = options.all_parts;
  fill.most_spheres = options.most_spheres;
  fill.most_triangles = options.most_triangles;
  fill.threads = options.threads;
  fill.progress = share_of(tell, kRepairShare, 1);
  if (const Result<Done> sized = check_size(mesh, options.usual_size, fill); !sized)
    return with_place(sized.errors(), report.path);
  Result<Filling> filling = fill_organ(mesh, fill);
  if (!filling) return with_place(filling.errors(), report.path);
  imported.organ = std::move(filling->organ);
  report.sphere_radius = imported.organ.sphere_radius, report.spacing = imported.organ.spacing;
  report.fill = std::move(filling->report);
  report.findings.insert(report.findings.end(), report.fill.findings.begin(), report.fill.findings.end());
  note_volume(report.fill.filled_volume, report.mesh_volume, report.findings);
  return imported;
} catch (const Stopped&) {
  return Error{file.report.path, "stopped", ""};
}

Result<ImportedOrgan> import_organ(const std::string& path, const ImportOptions& options) {
  const Result<RepairedFile> file = repair_file(path, options);
  if (!file) return file.errors();
  return fill_repaired(*file, 0, options);
}

Result<CheckedMesh> import_mesh(const std::string& path, double unit_in_metres) {
  const Result<RawMesh> raw = read_mesh(path);
  if (!raw) return raw.errors();
  RepairOptions repair;
  repair.all_parts = true;
  return repair_mesh(*raw, unit_in_metres, repair);
}

}  // namespace ctpm::importers
