#pragma once

#include <string>
#include <vector>

#include "core/model/model.h"
#include "importers/mesh.h"
#include "scenes/scene_spec.h"
#include "studio/output/json_writer.h"
#include "studio/render/camera.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::server {

/// A text as JSON.
std::string json_text(const std::string& text);

/// Writes what an import found in a mesh: code, found, done, remains.
void write_findings(output::JsonWriter& json, const std::vector<importers::Finding>& findings);

/// Writes the tissues of an organ: text, spheres, colour.
void write_tissues(output::JsonWriter& json, const views::OrganTissues& organ);

/// Writes a camera: name, eye, target, up, fov_deg.
void write_camera(output::JsonWriter& json, const std::string& name, const render::Camera& camera);

/// What a page needs to draw a scene: its organs' looks, tools, cameras, limits, box and direction up, as JSON.
std::string view_json(const scenes::SceneSpec& scene, const Model& model);

}  // namespace ctpm::server
