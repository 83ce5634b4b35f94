#include "importers/import.h"

#include <cmath>

#include "importers/text.h"

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
void note_unit(const UnitChoice& unit, double diagonal, UsualSize usual, std::vector<Finding>& findings) {
  if (unit.source == UnitSource::guessed)
    findings.push_back({"unit_guessed",
                        1,
                        {},
                        "the file does not say its unit",
                        "taken as " + unit_name(unit.in_metres) + ", which makes the organ " + mm_text(diagonal) +
                            " across (usual: " + range_text(usual) + ")",
                        "give the unit if that is wrong"});
  // The guess used the whole file; this check uses only the parts kept.
  if (diagonal < usual.least || diagonal > usual.most)
    findings.push_back({"unusual_size",
                        1,
                        {},
                        "the organ is " + mm_text(diagonal) + " across; usual is " + range_text(usual),
                        "none",
                        "check the unit"});
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

Errors with_place(Errors errors, const std::string& path) {
  for (Error& error : errors)
    if (error.where.empty()) error.where = path;
  return errors;
}

}  // namespace

Result<ImportedOrgan> import_organ(const std::string& path, const ImportOptions& options) try {
  if (Errors errors = check(options); !errors.empty()) return errors;
  const Progress tell = told_to(options);
  tell("read", 0);
  ReadOptions reading;
  reading.part = options.part;
  reading.time_limit_s = options.time_limit_s;
  const Result<RawMesh> raw = read_mesh(path, reading);
  if (!raw) return raw.errors();

  ImportedOrgan imported;
  ImportReport& report = imported.report;
  report.path = path;
  report.format = raw->format;
  report.parts = raw->parts;
  report.unit = choose_unit(*raw, options.unit_in_metres, options.usual_size);
  RepairOptions repair;
  repair.all_parts = options.all_parts;
  repair.largest_hole = options.largest_hole;
  repair.progress = share_of(tell, kReadShare, kRepairShare);
  Result<CheckedMesh> mesh = repair_mesh(*raw, report.unit.in_metres, repair);
  if (!mesh) return mesh.errors();
  note_unit(report.unit, norm(mesh->box_most - mesh->box_least), options.usual_size, report.findings);
  report.findings.insert(report.findings.end(), mesh->findings.begin(), mesh->findings.end());
  report.before = mesh->before, report.after = mesh->after;
  report.mesh_volume = mesh->volume, report.mesh_area = mesh->area;
  report.box_least = mesh->box_least, report.box_most = mesh->box_most;

  FillOptions fill;
  fill.sphere_radius = options.sphere_radius;
  fill.gap = options.gap;
  fill.keep_islands = options.all_parts;
  fill.most_spheres = options.most_spheres;
  fill.most_triangles = options.most_triangles;
  fill.threads = options.threads;
  fill.progress = share_of(tell, kRepairShare, 1);
  Result<Filling> filling = fill_organ(*mesh, fill);
  if (!filling) return with_place(filling.errors(), path);
  imported.organ = std::move(filling->organ);
  report.sphere_radius = imported.organ.sphere_radius, report.spacing = imported.organ.spacing;
  report.fill = std::move(filling->report);
  imported.mesh = std::move(*mesh);
  report.findings.insert(report.findings.end(), report.fill.findings.begin(), report.fill.findings.end());
  return imported;
} catch (const Stopped&) {
  return Error{path, "stopped", ""};
}

Result<CheckedMesh> import_mesh(const std::string& path, double unit_in_metres) {
  const Result<RawMesh> raw = read_mesh(path);
  if (!raw) return raw.errors();
  RepairOptions repair;
  repair.all_parts = true;
  return repair_mesh(*raw, unit_in_metres, repair);
}

}  // namespace ctpm::importers
