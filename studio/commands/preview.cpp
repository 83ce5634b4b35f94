#include <memory>
#include <string>

#include "core/stepping/step.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/commands/flags.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/files.h"
#include "studio/render/frame.h"
#include "studio/render/picture_size.h"
#include "studio/render/renderer.h"
#include "studio/views/look.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::commands {
namespace {

struct PreviewArguments {
  std::string scene, output, size = "1280x720";
  bool spheres = false, overwrite = false;
  views::LookRequest look;
  scenes::LoadOptions load;
};

int run_preview(const PreviewArguments& arguments) {
  const Result<render::PictureSize> size = render::parse_picture_size(arguments.size);
  if (!size) return print_errors(size.errors());
  if (const Result<Done> writable = output::check_new(arguments.output, arguments.overwrite); !writable)
    return print_errors(writable.errors());
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(arguments.scene, arguments.load);
  if (!scene) return print_errors(scene.errors());
  print_warnings(scene->scene.warnings);
  // With --spheres the surface stands on the left half and the layered spheres on the right.
  const int width = arguments.spheres ? size->width / 2 : size->width;
  const Model& model = scene->built.model;
  render::SceneView view = views::view_of(scene->scene.spec, model);
  const Result<views::Look> look =
      views::find_look(arguments.look, scene->scene.spec, view, double(width) / size->height);
  if (!look) return print_errors(look.errors());
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(width, size->height, std::move(view));
  if (!renderer) return print_errors(renderer.errors());
  const State state = rest_state(model);
  render::DrawOptions options = look->at((*renderer)->scene(), {&state.last_inputs, 1});
  render::Frame picture = (*renderer)->draw(state, options);
  if (arguments.spheres) {
    options.view = render::View::spheres;
    picture = render::join_beside(picture, (*renderer)->draw(state, options));
  }
  if (const Result<Done> written = render::write_png(arguments.output, picture); !written)
    return print_errors(written.errors());
  print("%s: %dx%d\n", arguments.output.c_str(), picture.width, picture.height);
  return exit_good;
}

}  // namespace

Command add_preview(CLI::App& program) {
  auto arguments = std::make_shared<PreviewArguments>();
  CLI::App* app = program.add_subcommand("preview", "Draws a scene as it is at rest.");
  app->footer("Example: ctpm preview scenes/liver.json -o liver.png --spheres");
  app->add_option("scene", arguments->scene, "Scene file (.json)")->required();
  app->add_option("-o,--output", arguments->output, "Picture (.png)")->required();
  app->add_flag("--spheres", arguments->spheres, "Beside the surface, the spheres coloured by layer");
  app->add_option("--size", arguments->size, "Width x height in pixels")->capture_default_str();
  app->add_flag("--overwrite", arguments->overwrite, "Replace an existing picture");
  add_look(*app, arguments->look);
  app->add_flag("--allow-outside-paths", arguments->load.allow_outside_paths,
                "Meshes may lie outside the scene's folder");
  return {app, [arguments] { return run_preview(*arguments); }};
}

}  // namespace ctpm::commands
