#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/errors.h"
#include "scenes/places.h"
#include "scenes/script.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/flags.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/standing.h"
#include "studio/output/files.h"
#include "studio/render/frame.h"
#include "studio/render/marks.h"
#include "studio/render/picture_size.h"
#include "studio/render/renderer.h"
#include "studio/views/look.h"
#include "studio/views/scene_marks.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::commands {
namespace {

struct PreviewArguments {
  std::string scene, output, size = "1280x720";
  bool spheres = false, overwrite = false, marks = false, settled = false;
  std::string script;
  views::LookRequest look;
  scenes::LoadOptions load;
};

/// The given script on the scene's organs; none if none is given.
Result<std::optional<scenes::Script>> script_of(const PreviewArguments& arguments, const loading::LoadedScene& scene) {
  if (arguments.script.empty()) return std::optional<scenes::Script>();
  const Result<std::string> text = output::read_text_file(arguments.script);
  if (!text) return text.errors();
  std::vector<std::string> tools;
  for (const scenes::ToolSpec& tool : scene.scene.spec.tools) tools.push_back(tool.name);
  scenes::PlaceFinder finder = scenes::finder_of(scene.built.model, scene.scene.spec);
  const Result<scenes::Script> script = scenes::read_script(*text, arguments.script, tools, true, &finder);
  if (!script) return script.errors();
  return std::optional(*script);
}

int run_preview(PreviewArguments arguments) {
  const Result<render::PictureSize> size = render::parse_picture_size(arguments.size);
  Errors errors;
  append(errors, size);
  append(errors, output::check_new(arguments.output, arguments.overwrite));
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(arguments.scene, arguments.load);
  append(errors, scene);
  if (!errors.empty()) return print_errors(errors);
  print_warnings(scene->scene.warnings);
  // With --spheres the surface stands on the left half and the layered spheres on the right.
  const int width = arguments.spheres ? size->width / 2 : size->width;
  const Model& model = scene->built.model;
  render::SceneView view = views::view_of(scene->scene.spec, model);
  std::vector<std::string> legend;
  const std::string& drawn = arguments.look.view;
  if (arguments.look.by == "material" && (arguments.spheres || drawn == "spheres" || drawn == "both")) {
    legend = views::colour_by_material(scene->scene.spec, scene->organs, view);
    arguments.look.by.clear();
  }
  const Result<views::Look> look =
      views::find_look(arguments.look, scene->scene.spec, view, double(width) / size->height);
  if (!look) return print_errors(look.errors());
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(width, size->height, std::move(view));
  if (!renderer) return print_errors(renderer.errors());
  const Result<std::optional<scenes::Script>> script = script_of(arguments, *scene);
  if (!script) return print_errors(script.errors());
  const State state = arguments.settled ? loading::settle_scene(scene->scene.spec, model)->state : rest_state(model);
  render::DrawOptions options = look->at((*renderer)->scene(), {&state.last_inputs, 1});
  const auto draw = [&] {
    render::Frame picture = (*renderer)->draw(state, options);
    if (arguments.marks || *script)
      render::draw_marks(picture, options.camera, views::marks_of(scene->scene.spec, model, state, *script));
    return picture;
  };
  render::Frame picture = draw();
  if (arguments.spheres) {
    options.view = render::View::spheres;
    picture = render::join_beside(picture, draw());
  }
  if (const Result<Done> written = render::write_png(arguments.output, picture); !written)
    return print_errors(written.errors());
  print("%s: %dx%d\n", arguments.output.c_str(), picture.width, picture.height);
  for (const std::string& line : legend) print("  %s\n", line.c_str());
  return exit_good;
}

}  // namespace

Command add_preview(CLI::App& program) {
  auto arguments = std::make_shared<PreviewArguments>();
  CLI::App* app = program.add_subcommand("preview", "Draws a scene as its meshes are, or settled.");
  app->footer("Example: ctpm preview scenes/liver.json -o liver.png --spheres --by material --cutaway y");
  app->add_option("scene", arguments->scene, "Scene file (.json)")->required();
  app->add_option("-o,--output", arguments->output, "Picture (.png)")->required();
  app->add_flag("--spheres", arguments->spheres,
                "Beside the surface, the spheres coloured by layer, or with --by material by what they are made of");
  app->add_option("--size", arguments->size, "Width x height in pixels")->capture_default_str();
  app->add_flag("--overwrite", arguments->overwrite, "Replace an existing picture");
  app->add_flag("--marks", arguments->marks,
                "Show axes, anchors, probes, loads, forbidden zones, and where tools are taken up");
  app->add_option("--script", arguments->script, "Show the marks and the ways of this script's tools (.json)");
  app->add_flag("--settled", arguments->settled, "Draw the scene as it lies when a session begins");
  add_look(*app, arguments->look);
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_preview(*arguments); }};
}

}  // namespace ctpm::commands
