#include "studio/views/look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/model/errors.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"
#include "studio/views/event_camera.h"

namespace ctpm::views {
namespace {

template <class T>
using Choices = std::array<std::pair<const char*, T>, 4>;

constexpr Choices<render::View> kViews{{{"surface", render::View::surface},
                                        {"spheres", render::View::spheres},
                                        {"both", render::View::both},
                                        {"elements", render::View::elements}}};

std::optional<render::View> find_view(const std::string& name, Errors& errors) {
  for (const auto& [known, view] : kViews)
    if (name == known) return view;
  errors.push_back(
      {output::option_name("look.view"), "got '" + name + "', must be surface, spheres, both or elements", ""});
  return std::nullopt;
}

/// The quantity that colours show; each view has its own quantities.
render::ElementQuantity find_quantity(const std::string& by, render::View view, Errors& errors) {
  if (view == render::View::elements) {
    if (by.empty() || by == "stretch") return render::ElementQuantity::stretch;
    if (by == "tilt") return render::ElementQuantity::tilt;
    if (by == "force") return render::ElementQuantity::force;
    errors.push_back(
        {output::option_name("look.by"), "got '" + by + "', elements are coloured by stretch, tilt or force", ""});
  } else if (view == render::View::surface) {
    if (!by.empty())
      errors.push_back({output::option_name("look.by"), "the surface has its own colours",
                        "give " + output::option_name("look.view") + " spheres or " + output::option_name("look.view") +
                            " elements"});
  } else if (!by.empty() && by != "layer") {
    errors.push_back({output::option_name("look.by"), "got '" + by + "', spheres are coloured by layer",
                      by == "stretch" || by == "tilt" || by == "force"
                          ? "give " + output::option_name("look.view") + " elements"
                          : std::string()});
  }
  return render::ElementQuantity::stretch;
}

/// The plane across `x`, `y` or `z`, through the scene's middle or a given position; it hides the side towards the eye.
render::Cutaway find_cutaway(const std::string& text, const render::SceneView& scene, Vec3 eye, Errors& errors) {
  if (text.empty()) return {};
  Vec3 axis{text[0] == 'x' ? 1.0 : 0.0, text[0] == 'y' ? 1.0 : 0.0, text[0] == 'z' ? 1.0 : 0.0};
  const render::Bounds bounds = render::rest_bounds(scene);
  double place = dot(bounds.centre(), axis);
  char* end = nullptr;
  if (text.size() > 2 && text[1] == '=') place = 1e-3 * std::strtod(text.c_str() + 2, &end);
  const bool is_read = text.size() == 1 || (end && *end == 0 && std::isfinite(place));
  if (axis == Vec3{} || !is_read) {
    errors.push_back({output::option_name("look.cutaway"),
                      "got '" + text + "', must be x, y or z, or one of them and a place in mm", "for example y=12.5"});
    return {};
  }
  const double least = dot(bounds.min, axis), most = dot(bounds.max, axis);
  if (place < least || place > most) {
    errors.push_back({output::option_name("look.cutaway"),
                      "got '" + text + "', the organs lie between " + output::fixed(1e3 * least, 1) + " and " +
                          output::fixed(1e3 * most, 1) + " mm",
                      ""});
    return {};
  }
  if (dot(eye, axis) < place) axis = -axis, place = -place;
  return {place * axis, axis};
}

/// Cameras are set up for 16:9; in a narrower picture they step back to keep the sides visible.
render::Camera stepped_back(render::Camera camera, double aspect) {
  camera.eye = camera.target + std::max(1.0, 16.0 / 9 / aspect) * (camera.eye - camera.target);
  return camera;
}

constexpr const char* kPlaceHelp = "a place and what it looks at in mm: 0,-300,200:0,0,20";

std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == between)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// Three numbers between commas. Error: what is wrong with them.
Result<Vec3> triple_of(const std::string& text, const char* what) {
  const std::vector<std::string> parts = parts_of(text, ',');
  const auto wrong = [&](const std::string& why) {
    return Error{"", std::string(what) + " '" + text + "' " + why, ""};
  };
  if (parts.size() != 3)
    return wrong("has " + std::to_string(parts.size()) + (parts.size() == 1 ? " number" : " numbers") +
                 " instead of 3");
  std::array<double, 3> number{};
  for (std::size_t i = 0; i < 3; ++i) {
    char* end = nullptr;
    number[i] = std::strtod(parts[i].c_str(), &end);
    if (parts[i].empty() || *end != 0 || !std::isfinite(number[i])) return wrong("has '" + parts[i] + "', no number");
  }
  return Vec3{number[0], number[1], number[2]};
}

/// Whether a camera is meant as places rather than by its name.
bool is_of_places(const std::string& camera) { return camera.find_first_of(",:") != std::string::npos; }

/// The field of view in degrees. Error: it is no angle that a picture can have.
Result<double> field_of_view_of(const std::string& text) {
  char* end = nullptr;
  const double angle = std::strtod(text.c_str(), &end);
  if (*end == 0 && angle >= 1 && angle <= 170) return angle;
  return Error{"", "the field of view '" + text + "' must be 1 to 170 degrees", ""};
}

/// A camera given by two or three places, and perhaps a field of view. Error: what is wrong with them.
Result<render::Camera> placed_camera(const std::string& text, Vec3 up, double aspect) {
  const auto wrong = [&](const std::string& why) {
    return Error{output::option_name("look.camera"), "got '" + text + "': " + why, std::string("give ") + kPlaceHelp};
  };
  std::vector<std::string> parts = parts_of(text, ':');
  std::optional<double> field_of_view;
  if (parts.size() > 2 && !parts.back().empty() && parts.back().find(',') == std::string::npos) {
    const Result<double> read = field_of_view_of(parts.back());
    if (!read) return wrong(read.errors()[0].message);
    field_of_view = *read;
    parts.pop_back();
  }
  if (parts.size() == 1) return wrong("one place, and what it looks at is missing");
  if (parts.size() > 3) return wrong(std::to_string(parts.size()) + " places, at most 3 are used, and a field of view");
  constexpr const char* kWhat[] = {"the eye", "what it looks at", "the upward direction"};
  std::array<Vec3, 3> place{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Result<Vec3> read = triple_of(parts[i], kWhat[i]);
    if (!read) return wrong(read.errors()[0].message);
    place[i] = *read;
  }
  render::Camera camera{1e-3 * place[0], 1e-3 * place[1], parts.size() == 3 ? place[2] : up};
  if (field_of_view) camera.fov_deg = *field_of_view;
  const Vec3 sight = camera.target - camera.eye;
  if (norm(sight) == 0) return wrong("the eye is at what it looks at");
  if (norm(camera.up) == 0) return wrong("the upward direction is 0");
  const auto is_along = [&](Vec3 v) { return norm(cross(sight, v)) < 1e-4 * norm(sight) * norm(v); };
  if (is_along(camera.up)) camera.up = is_along({0, 1, 0}) ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return stepped_back(camera, aspect);
}

/// The camera of that name. For an empty name: the scene's first, or one that frames everything. Error: no camera of
/// that name; lists the known names.
Result<render::Camera> find_camera(const scenes::SceneSpec& scene, const render::SceneView& view,
                                   const std::string& name, double aspect) {
  if (name.empty() && scene.cameras.empty()) return render::default_camera(view, aspect);
  std::string known;
  for (const scenes::CameraSpec& camera : scene.cameras) {
    if (name.empty() || camera.name == name) {
      // No farther back than shows the organs.
      const render::Camera stepped = stepped_back({camera.eye, camera.target, camera.up, camera.field_of_view}, aspect);
      const render::Camera whole =
          render::fitted_camera(view, camera.target - camera.eye, camera.up, camera.field_of_view, aspect);
      const auto distance = [](const render::Camera& c) { return norm(c.eye - c.target); };
      return aspect < 16.0 / 9 && distance(whole) < distance(stepped) ? whole : stepped;
    }
    known += (known.empty() ? "" : ", ") + camera.name;
  }
  return Error{output::option_name("look.camera"), "the scene has no camera '" + name + "'",
               "there are: fitted, wound, press, follow" + (known.empty() ? "" : ", " + known) + ", or " + kPlaceHelp};
}

bool is_axis(const std::string& cutaway) { return !cutaway.empty() && cutaway[0] >= 'x' && cutaway[0] <= 'z'; }

/// Rather straight onto the section across an axis, from the usual camera's side of it.
render::Camera section_camera(const render::SceneView& view, char axis, const render::Camera& usual, double aspect) {
  constexpr double kUsual = 0.6;  // share of the usual direction
  const Vec3 from = (usual.eye - usual.target) / norm(usual.eye - usual.target);
  Vec3 across{axis == 'x' ? 1.0 : 0.0, axis == 'y' ? 1.0 : 0.0, axis == 'z' ? 1.0 : 0.0};
  if (dot(from, across) < 0) across = -across;
  return render::fitted_camera(view, -(across + kUsual * from), usual.up, usual.fov_deg, aspect);
}

struct NamedCamera {
  std::string name;
  EventCamera found;
};

/// The camera on what a State tells: on its wound, or where there is none on its press; `only`: on that alone. Errors:
/// the one that is asked for is not there; no OpenGL 3.3.
Result<std::optional<NamedCamera>> find_event(const std::string& only, const render::SceneView& view, double aspect,
                                              const render::Camera& usual, const State* told) {
  struct Known {
    const char* name;
    Event event;
    const char* missing;
  };
  constexpr std::array<Known, 2> kEvents{
      {{"wound", Event::wound, "nothing is cut"}, {"press", Event::press, "nothing is pressed"}}};
  for (const auto& [name, event, missing] : kEvents) {
    if (!only.empty() && only != name) continue;
    if (told) {
      const Result<std::optional<EventCamera>> found = event_camera(event, view, *told, usual, aspect);
      if (!found) return found.errors();
      if (*found) return std::optional<NamedCamera>({name, **found});
    }
    if (only == name) return Error{output::option_name("look.camera"), "got '" + only + "', and " + missing, ""};
  }
  return std::optional<NamedCamera>();
}

/// Sets the camera of that name; see LookRequest::camera.
void choose_camera(const std::string& name, const std::string& cutaway, const scenes::SceneSpec& scene,
                   const render::SceneView& view, double aspect, const State* told, Look& look, Errors& errors) {
  bool is_the_scenes = false;
  for (const scenes::CameraSpec& camera : scene.cameras) is_the_scenes |= camera.name == name;
  const bool is_fitted = name == "fitted" && !is_the_scenes;
  const bool is_event = (name == "wound" || name == "press") && !is_the_scenes;
  look.camera = name, look.follows = name == "follow" && !is_the_scenes;
  if (is_fitted) {
    look.draw.camera = render::default_camera(view, aspect), look.is_found = true;
    return;
  }
  if (is_of_places(name) && !is_the_scenes) {
    const Result<render::Camera> placed = placed_camera(name, render::up_of(*view.model), aspect);
    if (!placed) return append(errors, placed);
    look.draw.camera = *placed;
    return;
  }
  const bool is_free = name.empty() || is_event || look.follows;
  const Result<render::Camera> usual = find_camera(scene, view, is_free ? "" : name, aspect);
  if (!usual) return append(errors, usual);
  look.draw.camera = *usual;
  if (name.empty())
    look.is_found = scene.cameras.empty(), look.camera = look.is_found ? "fitted" : scene.cameras.front().name;
  if (!is_free) return;
  if (name.empty() && is_axis(cutaway)) {
    look.draw.camera = section_camera(view, cutaway[0], *usual, aspect), look.camera = "section";
    look.is_found = true;
    return;
  }
  const Result<std::optional<NamedCamera>> found = find_event(is_event ? name : "", view, aspect, *usual, told);
  if (!found) return append(errors, found);
  if (!*found) return;
  const render::Camera& near = (*found)->found.camera;
  if (look.follows) {
    // It comes close by itself.
    render::Camera& camera = look.draw.camera;
    camera = render::fitted_camera(view, near.target - near.eye, near.up, near.fov_deg, aspect);
    camera.eye += near.target - camera.target, camera.target = near.target;
    return;
  }
  look.draw.camera = near, look.camera = (*found)->name, look.is_found = true;
  look.pieces = (*found)->found.pieces;
}

}  // namespace

double unit_of(render::ElementQuantity quantity) {
  switch (quantity) {
    case render::ElementQuantity::stretch:
      return 0.01;
    case render::ElementQuantity::tilt:
      return std::numbers::pi / 180;
    case render::ElementQuantity::force:
      return 1;
  }
  return 1;
}

render::DrawOptions Look::at(const render::SceneView& scene, std::span<const Inputs> moments) const {
  render::DrawOptions options = draw;
  if (follows) options.camera = render::following_camera(scene, draw.camera, moments);
  return options;
}

Result<Look> find_look(const LookRequest& request, const scenes::SceneSpec& scene, const render::SceneView& view,
                       double aspect, const State* told) {
  Errors errors;
  Look look;
  if (const std::optional<render::View> found = find_view(request.view, errors)) {
    look.draw.view = *found;
    look.draw.quantity = find_quantity(request.by, *found, errors);
  }
  if (!(request.full_scale >= 0 && std::isfinite(request.full_scale)))
    errors.push_back({output::option_name("look.full_scale"),
                      "got " + output::fixed(request.full_scale, 3) + ", must be more than 0", ""});
  look.draw.full_scale = request.full_scale * unit_of(look.draw.quantity);
  choose_camera(request.camera, request.cutaway, scene, view, aspect, told, look, errors);
  look.draw.cutaway = find_cutaway(request.cutaway, view, look.draw.camera.eye, errors);
  if (!errors.empty()) return errors;
  return look;
}

}  // namespace ctpm::views
