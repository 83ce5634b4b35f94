#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/scene_spec.h"
#include "scenes/script.h"
#include "studio/authoring/tissue_choice.h"

namespace ctpm::authoring {

/// The organ of a scene, without anchors. `colour`: of its surface; unset: that of the tissue.
scenes::OrganSpec organ_spec(const std::string& name, const std::string& mesh, const Tissue& tissue,
                             const FilledOrgan& filled, std::optional<Vec3> colour);

/// A ball and a scalpel in proportion to the organs, within the ranges of their keys.
std::vector<scenes::ToolSpec> tools_for(std::span<const FilledOrgan> organs);

/// A camera that sees all organs from the front, a little from above.
scenes::CameraSpec front_camera(const std::vector<FilledOrgan>& organs);

/// Where the origin of `added` lies so that they are right of all of `present`, clear of them, as deep in the scene as
/// their middle and on the same ground [m].
Vec3 place_beside(const std::vector<FilledOrgan>& present, const std::vector<FilledOrgan>& added);

/// The share of an organ's spheres that lie within another organ, by its spheres, in [0, 1].
double overlap(const FilledOrgan& organ, const FilledOrgan& other);

/// A length as an author writes it, without what arithmetic leaves behind: in whole nanometres [m].
double whole_nanometres(double length);

/// The name of a scene's file without its end. Error: a name that a scene cannot have, for its text says it.
Result<std::string> stem_of_scene(const std::string& path);

/// What an import of one organ writes: its mesh, the scene and the script beside it.
std::vector<std::string> files_of_import(const std::string& scene);

/// A name that a file may have everywhere: letters, digits, - and _ of `name`, others as -.
std::string file_name_of(const std::string& name);

/// What the only organ of a file is called: what its author says that it is, else `other`.
std::string name_alone(const std::string& tissue, const std::string& other);

/// `name`, with a number behind it if it is taken; never empty.
std::string free_name(std::string name, const std::vector<std::string>& taken);

/// Gives a script of `tools` the names of the scene's own of the same kind, and the scene those that it lacks.
void name_tools(scenes::Script& script, std::vector<scenes::ToolSpec> tools, scenes::SceneSpec& scene);

}  // namespace ctpm::authoring
