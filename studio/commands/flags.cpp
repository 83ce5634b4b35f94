#include "studio/commands/flags.h"

#include <utility>

namespace ctpm::commands {
namespace {

/// Fields that libraries name in errors, and their flags.
constexpr std::pair<std::string_view, const char*> kFlags[] = {
    {"calibrate.specimen_mm", "--specimen-mm"},
    {"calibrate.sphere_radius_mm", "--sphere-radius-mm"},
    {"continue.at_s", "--at"},
    {"collect.incomplete", "--incomplete"},
    {"device.address", "--igtl"},
    {"device.allowed", "--igtl-allow"},
    {"device.buttons", "--device-button"},
    {"device.listen_port", "--igtl-listen"},
    {"device.most_force_n", "--device-force-n"},
    {"device.most_speed_mm_per_s", "--device-speed-mm-per-s"},
    {"device.offset_mm", "--device-offset-mm"},
    {"device.rotation", "--device-rotation"},
    {"device.scale", "--device-scale"},
    {"device.stiffness_n_per_m", "--device-stiffness-n-per-m"},
    {"device.timeout_s", "--device-timeout-s"},
    {"device.tip", "--device-tip"},
    {"device.tool", "--device-tool"},
    {"export.align", "--align"},
    {"export.allow_diverged", "--allow-diverged"},
    {"export.caption", "--caption"},
    {"export.fps", "--fps"},
    {"export.inset", "--inset"},
    {"export.overlay", "--overlay"},
    {"export.slow_at", "--slow-at"},
    {"export.speed", "--speed"},
    {"exchange.at_s", "--at-s"},
    {"export.at_s", "--at-s"},
    {"fidelity.recipes", "--only"},
    {"fit.organ", "--organ"},
    {"import.anchors", "--anchor"},
    {"import.largest_hole_mm", "--largest-hole-mm"},
    {"import.layers", "--layer"},
    {"import.organ", "--organ"},
    {"import.names", "--part"},
    {"import.size", "--size-mm"},
    {"import.spheres", "--spheres"},
    {"import.stiffness_scale", "--stiffness-scale"},
    {"look.by", "--by"},
    {"look.camera", "--camera"},
    {"look.cutaway", "--cutaway"},
    {"look.full_scale", "--full-scale"},
    {"look.view", "--view"},
    {"overwrite", "--overwrite"},
    {"picture.size", "--size"},
    {"report.folder", "-o"},
    {"second.address", "--igtl-second"},
    {"second.buttons", "--device-second-button"},
    {"second.listen_port", "--igtl-second-listen"},
    {"second.offset_mm", "--device-second-offset-mm"},
    {"second.rotation", "--device-second-rotation"},
    {"second.tip", "--device-second-tip"},
    {"second.tool", "--device-second-tool"},
    {"slurm.tasks_per_element", "--tasks-per-element"},
    {"studio.behind", "--behind"},
    {"studio.bind", "--bind"},
    {"studio.port", "--port"},
    {"time_range.from_s", "--from-s"},
    {"time_range.to_s", "--to-s"},
};

}  // namespace

std::string flag_of(std::string_view field) {
  for (const auto& [known, flag] : kFlags)
    if (field == known) return flag;
  return std::string(field);
}

void add_look(CLI::App& app, views::LookRequest& request) {
  app.add_option("--view", request.view, "surface, spheres, both or elements")->capture_default_str();
  app.add_option("--by", request.by,
                 "What colours show: layer of spheres, in previews also material; stretch, tilt or force of elements");
  app.add_option("--full-scale", request.full_scale, "Value of the last colour of elements [%, deg or N]");
  app.add_option("--cutaway", request.cutaway, "Leave out what is before a plane across x, y or z: y, or y=12.5 in mm");
  app.add_option(
      "--camera", request.camera,
      "A camera of the scene, fitted, wound or press where it is seen best, follow the tool, or a place and "
      "what it looks at in mm, as 0,-300,200:0,0,20, with an upward direction and a field of view in degrees "
      "if they are not the usual ones, as 0,-300,200:0,0,20:0,0,1:35; if not given one that sees the section, the "
      "wound or "
      "the deepest press, else the scene's first");
}

void add_time_range(CLI::App& app, session::TimeRange& range) {
  app.add_option("--from-s", range.from_s, "Where to begin [s]");
  app.add_option("--to-s", range.to_s, "Where to end [s]; the session's end if not given");
}

}  // namespace ctpm::commands
