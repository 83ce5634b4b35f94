#include "studio/authoring/import_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "core/cutting/extent.h"
#include "core/model/errors.h"
#include "core/surface/surface.h"
#include "importers/mesh_file.h"
#include "importers/text.h"
#include "scenes/build_model.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"
#include "studio/authoring/anchor_choice.h"
#include "studio/authoring/as_written.h"
#include "studio/authoring/capsule.h"
#include "studio/authoring/filling_choice.h"
#include "studio/authoring/fit_stiffness.h"
#include "studio/authoring/named_file.h"
#include "studio/authoring/new_folder.h"
#include "studio/authoring/scene_parts.h"
#include "studio/authoring/script_choice.h"
#include "studio/authoring/tissue_choice.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/tick_time.h"
#include "studio/output/files.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::authoring {
namespace {

namespace fs = std::filesystem;

/// Larger organs [spheres] are imported without a fit, which would take longer than a few seconds.
constexpr std::size_t kMostFittedSpheres = 4000;
/// Depth of the fit's press, and the part of an organ's height that it may be.
constexpr double kFitDepth = 0.012, kDeepestShare = 1.0 / 3;
/// A fitted scale outside of this range says that the press is none of the paper's.
constexpr double kLeastScale = 0.1, kMostScale = 10;
/// More of an organ within another is told.
constexpr double kMostOverlap = 0.02;

/// One organ between its filling and the scene.
struct Draft {
  Tissue tissue;
  FilledOrgan filled;
  scenes::OrganSpec spec;
  scenes::Script script;
  ImportedPart part;
  double strain = 0;                        ///< of its capsule against what is below it
  double usual_work = 0, dearest_work = 0;  ///< of the script's ticks, as in loading::ScriptTrial [s]

  void note(const char* code, std::string found, std::string done, std::string remains) {
    part.report.findings.push_back({code, 1, {}, std::move(found), std::move(done), std::move(remains)});
  }
};

class Import {
 public:
  explicit Import(const ImportRequest& request)
      : request_(as_written(request)), place_(fs::path(request.scene).parent_path().string()) {}

  Result<ImportOutcome> run() {
    if (Errors errors = check_files(); !errors.empty()) return errors;
    std::optional<std::int64_t> fewer;
    for (int tries = 0; tries == 0 || (fewer && tries < 3); ++tries) {
      if (Errors errors = fill(fewer); !errors.empty()) return errors;
      for (Draft& draft : drafts_)
        if (Errors errors = finish(draft); !errors.empty()) return errors;
      fewer = count_that_holds();
    }
    if (request_.kilohertz && dearest_work() > 1e-3 / *request_.kilohertz)
      drafts_.front().note("too_slow",
                           "where tools press and cut, ticks take up to " +
                               output::short_number(1e3 * dearest_work(), 3) + " ms here (p99)",
                           "none", "it does not hold the rate that was asked for on this machine now");
    if (stops()) return Error{request_.mesh, "stopped", "nothing was written"};
    return write();
  }

 private:
  bool stops() const { return request_.should_stop && request_.should_stop(); }
  void tell(const char* stage, double fraction) const {
    if (request_.progress) request_.progress(stage, fraction);
  }

  /// Checks what can be checked before long work, and reads the scene to which organs are added.
  Errors check_files() {
    const Result<std::string> stem = stem_of_scene(request_.scene);
    if (!stem) return stem.errors();
    stem_ = *stem;
    if (Errors errors = folder_.make(place_); !errors.empty()) return errors;
    if (request_.into) {
      tell("reading the scene", 0);
      Result<loading::LoadedScene> scene = loading::load_whole_scene(request_.scene, {}, {}, request_.should_stop);
      if (!scene) return scene.errors();
      present_ = *std::move(scene);
      scene_ = present_.scene.spec;
      return {};
    }
    scene_.name = stem_, scene_.lips_meet = true;
    Errors errors = importers::check_file(request_.mesh);
    for (const std::string& file : files_of_import(request_.scene)) append(errors, check_new_file(file));
    return errors;
  }

  Result<Done> check_new_file(const std::string& file) const {
    std::error_code ignored;
    if (fs::equivalent(file, request_.mesh, ignored))
      return Error{file, "the repaired mesh would replace the mesh that is imported",
                   "give the scene another name or folder"};
    return output::check_new(file, request_.overwrite);
  }

  std::string beside(const std::string& name) const { return (fs::path(place_) / name).string(); }

  /// Reads, repairs and fills the file, once it has been repaired only the last, and makes a draft of each organ.
  /// `spheres`: in all; unset: as asked for.
  Errors fill(std::optional<std::int64_t> spheres) {
    importers::ImportOptions options;
    options.unit_in_metres = request_.unit_in_metres, options.size = request_.size, options.scale = request_.scale;
    options.all_parts = request_.parts == Parts::all_in_one, options.gap = request_.gap.value_or(-1);
    options.largest_hole = request_.largest_hole;
    options.most_triangles = request_.most_triangles.value_or(0);
    options.should_stop = request_.should_stop;
    if (request_.progress)
      options.progress = [&](const std::string& stage, double share) { request_.progress(stage, 0.5 * share); };
    if (!file_) {
      Result<NamedFile> repaired = repair_named(request_, place_, options);
      if (!repaired) return with_option_names(repaired.errors());
      file_ = *std::move(repaired);
    }
    std::optional<importers::RepairedFile> turned;
    if (request_.turn != Vec3{}) turned = importers::turned(file_->file, request_.turn);
    const importers::RepairedFile& lying = turned ? *turned : file_->file;
    options.usual_size = file_->tissue.usual_size();
    FillingWish wish{request_.sphere_radius, spheres ? spheres : request_.spheres};
    constexpr int kMostTries = 3;
    for (int tries = 0;; ++tries) {
      Result<std::vector<importers::ImportedOrgan>> filled =
          fill_all(lying, options, wish, file_->tissue.preset->sphere_radius);
      if (!filled) return filled.errors();
      if (Errors errors = make_drafts(file_->file, file_->tissue, *std::move(filled)); !errors.empty()) return errors;
      if (Errors errors = check_extent(); !errors.empty()) return errors;
      const std::optional<std::int64_t> better = spheres ? std::nullopt : better_count();
      if (!better || tries == kMostTries) return {};
      wish.spheres = better;
    }
  }

  /// Whether the scene can be recorded once the organs are in it.
  Errors check_extent() const {
    std::vector<FilledOrgan> organs = present_.organs;
    for (const Draft& draft : drafts_) organs.push_back(draft.filled);
    const std::string problem = cutting::extent_problem(organs);
    if (problem.empty()) return {};
    return {{request_.mesh, problem, "give a size with " + output::option_name("import.size")}};
  }

  /// The number of spheres that holds the wanted rate, if the drafts are too many or, where a rate was asked for, too
  /// few; none if they are right, or if the author chose.
  std::optional<std::int64_t> better_count() {
    if (request_.sphere_radius || request_.spheres) return {};
    // A press or a cut costs as much again as a tick at rest.
    constexpr double kRestShare = 0.5, kNear = 0.8, kMostSpheres = 20000, kGrowth = 4;
    const double budget = kRestShare * 1e-3 / request_.kilohertz.value_or(1);
    const std::optional<double> time = time_of_tick();
    if (!time) return {};
    std::int64_t count = 0;
    for (const Draft& draft : drafts_) count += draft.part.report.fill.spheres;
    const double wanted = std::min(kMostSpheres, double(count) * std::min(kGrowth, 0.9 * budget / *time));
    const bool is_slow = *time > budget, is_coarse = request_.kilohertz && *time < kNear * budget * kNear;
    if ((!is_slow && !is_coarse) || double(count) == wanted) return {};
    return std::max(std::int64_t(wanted), kFewestSpheres);
  }

  /// Processor time of a tick in which a script presses or cuts one of the drafts, p99 [s].
  double dearest_work() const {
    double usual = 0, more = 0;
    for (const Draft& draft : drafts_)
      usual += draft.usual_work, more = std::max(more, draft.dearest_work - draft.usual_work);
    return usual + more;
  }

  /// The number of spheres that holds the rate that was asked for where tools press and cut; none if the drafts do.
  std::optional<std::int64_t> count_that_holds() const {
    constexpr double kSpare = 0.9;
    const double share = request_.kilohertz ? 1e-3 / *request_.kilohertz / dearest_work() : 1;
    std::int64_t spheres = 0;
    for (const Draft& draft : drafts_) spheres += draft.part.report.fill.spheres;
    if (share >= 1 || spheres <= kFewestSpheres) return {};
    return std::max(std::int64_t(kSpare * share * double(spheres)), kFewestSpheres);
  }

  /// Time of a tick of all drafts at rest, or of the whole scene [s]; none if they cannot be built.
  std::optional<double> time_of_tick(bool is_whole = false) const {
    scenes::SceneSpec scene = scene_;
    scene.organs.clear();
    std::vector<FilledOrgan> organs;
    if (is_whole) scene.organs = present_.scene.spec.organs, organs = present_.organs;
    for (const Draft& draft : drafts_) scene.organs.push_back(draft.spec), organs.push_back(draft.filled);
    scene.probes.clear(), scene.loads.clear(), scene.obstacles.clear(), scene.tools = tools_for(organs);
    Result<scenes::BuiltScene> built = scenes::build_model(scene, organs);
    if (!built) return {};
    organs.clear();
    return loading::measure_tick_work(built->model, request_.should_stop);
  }

  Errors make_drafts(const importers::RepairedFile& file, const Tissue& whole,
                     std::vector<importers::ImportedOrgan> filled) {
    drafts_.clear();
    std::vector<std::string> names;
    const std::string from_mesh = fs::path(request_.mesh).stem().string();
    const Vec3 at = place_of(filled);
    for (const scenes::OrganSpec& organ : scene_.organs) names.push_back(organ.name);
    for (std::size_t i = 0; i < filled.size(); ++i) {
      importers::ImportedOrgan& one = filled[i];
      loading::move_organ(one.organ, at);
      Draft draft;
      const std::int32_t part = one.mesh.part;
      const std::string part_name = part >= 0 ? file.report.parts[std::size_t(part)] : "";
      draft.tissue = whole;
      const bool is_one_of_file = filled.size() > 1 || !request_.names.empty();
      if (request_.organ.empty() && is_one_of_file) {
        const Result<Tissue> own = choose_tissue(place_, "", {part_name, from_mesh});
        if (!own) return own.errors();
        draft.tissue = *own;
      }
      const bool is_alone = filled.size() == 1 && !request_.into;
      const std::string apart = file_name_of(is_one_of_file ? part_name : from_mesh);
      draft.part.name = free_name(is_one_of_file ? apart : name_alone(request_.organ, is_alone ? stem_ : apart), names);
      names.push_back(draft.part.name);
      const std::string mesh = (is_alone ? stem_ : stem_ + "-" + file_name_of(draft.part.name)) + ".obj";
      draft.part.mesh_file = beside(mesh);
      std::optional<Vec3> colour = part >= 0 ? file.part_colour[std::size_t(part)] : std::nullopt;
      draft.filled = std::move(one.organ), draft.part.report = std::move(one.report);
      draft.spec = organ_spec(draft.part.name, mesh, draft.tissue, draft.filled, colour);
      draft.spec.all_parts = request_.parts == Parts::all_in_one, draft.spec.most_triangles = request_.most_triangles;
      draft.spec.anchors = request_.anchors, draft.spec.at = draft.part.at = at, draft.spec.turn = request_.turn;
      if (Errors errors = add_layers(draft); !errors.empty()) return errors;
      if (request_.stiffness_scale) draft.spec.material.stiffness_scale = request_.stiffness_scale;
      if (const Result<Done> is_new = check_new_file(draft.part.mesh_file); !is_new) return is_new.errors();
      drafts_.push_back(std::move(draft));
    }
    return {};
  }

  /// Where the file's origin comes to lie: as asked for, or so that its organs lie right of those of the scene.
  Vec3 place_of(const std::vector<importers::ImportedOrgan>& filled) const {
    if (!request_.beside) return request_.at;
    std::vector<FilledOrgan> organs;
    for (const importers::ImportedOrgan& one : filled) organs.push_back(one.organ);
    return place_beside(present_.organs, organs);
  }

  /// Spheres take the material of the depth at which they lie: those of a thin layer lie in it by chance.
  void note_thin_layer(Draft& draft, const LayerWish& wish) const {
    const double above = draft.spec.layers.empty() ? 0 : draft.spec.layers.back().to_depth;
    const double thickness = wish.to_depth - above, spacing = draft.filled.spacing;
    if (thickness < spacing * (1 - 1e-9))
      draft.note("thin_layer",
                 "the layer of " + wish.tissue + " is " + importers::mm_text(thickness) +
                     " thick, and the spheres are " + importers::mm_text(spacing) + " apart",
                 "none",
                 "some of it lies between spheres; a radius of " +
                     importers::mm_text(thickness / spacing * draft.filled.sphere_radius) + " resolves it");
  }

  Errors add_layers(Draft& draft) const {
    for (const LayerWish& wish : request_.layers) {
      const Result<Tissue> tissue = choose_tissue(place_, wish.tissue, {});
      if (!tissue) {
        Errors errors = tissue.errors();
        errors.front().where = output::option_name("import.layers");
        return errors;
      }
      note_thin_layer(draft, wish);
      draft.spec.layers.push_back({wish.to_depth, tissue->material});
    }
    return {};
  }

  /// A scene of one organ alone.
  scenes::SceneSpec alone(const Draft& draft) const {
    scenes::SceneSpec scene;
    scene.name = scene_.name;
    scene.gravity = scene_.gravity, scene.tick = scene_.tick, scene.settle = scene_.settle;
    scene.solver = scene_.solver, scene.lips_meet = scene_.lips_meet;
    scene.organs = {draft.spec};
    scene.tools = tools_for({&draft.filled, 1});
    return scene;
  }

  /// Fits one organ, lets it stand and tries its script.
  Errors finish(Draft& draft) {
    tell("fitting the stiffness", 0.5 + 0.1);
    note_tissue(draft);
    const scenes::MaterialSpec unfitted = draft.spec.material;
    fit(draft);
    put_under_tension(draft);
    tell("settling", 0.7);
    Result<AnchorChoice> choice = choose_anchors(alone(draft), draft.filled, request_.should_stop);
    if (!choice) return with_option_names(choice.errors());
    if (!choice->standing.stands() && draft.part.stiffness_scale) {
      // The ball of the fit is felt near the surface only; the whole organ may need more than it asks for.
      draft.spec.material = unfitted;
      put_under_tension(draft);
      Result<AnchorChoice> again = choose_anchors(alone(draft), draft.filled, request_.should_stop);
      if (!again) return again.errors();
      if (again->standing.stands()) {
        draft.part.fit_problem = "with the fitted scale of " + output::short_number(*draft.part.stiffness_scale) +
                                 " the organ folds over under its own weight";
        draft.part.stiffness_scale.reset();
      }
      choice = std::move(again);
    }
    const loading::OrganStanding& standing = choice->standing.organ[0];
    note_tension(draft);
    if (!choice->standing.stands())
      return {{request_.mesh,
               "organ " + draft.spec.name + " folds over under its own weight: it sags by " +
                   importers::mm_text(standing.sag) + ", " + output::short_number(100 * standing.share(), 2) +
                   " % of its size" + (request_.anchors.empty() ? ", even where half of it is held" : ""),
               "hold more of it with " + output::option_name("import.anchors") + ", make it smaller with " +
                   output::option_name("import.size") + ", or stiffer with " +
                   output::option_name("import.stiffness_scale")}};
    draft.spec.anchors = choice->anchors;
    draft.part.anchored = choice->held, draft.part.sag = standing.sag, draft.part.size = standing.size;
    tell("trying the script", 0.85);
    return try_script(draft, *choice);
  }

  void note_tissue(Draft& draft) const {
    if (draft.tissue.is_assumed)
      draft.note("tissue_assumed", "no name says which organ it is", "taken as " + draft.spec.material.preset,
                 "an estimate; name the organ to have its own values");
    else if (!draft.tissue.is_own && std::string(draft.tissue.preset->source).starts_with("estimate"))
      draft.note("tissue_estimated", "the values of " + draft.spec.material.preset + " are an estimate", "none",
                 draft.tissue.preset->source);
    for (const scenes::OrganSpec& other : present_.scene.spec.organs)
      if (const double share =
              overlap(draft.filled, present_.organs[std::size_t(&other - &present_.scene.spec.organs[0])]);
          share > kMostOverlap)
        draft.note("overlap",
                   std::to_string(std::lround(100 * share)) + " % of the organ lies within organ " + other.name, "none",
                   "they pass through each other; lay it beside, or give it another place");
  }

  void put_under_tension(Draft& draft) const {
    if (draft.tissue.is_own || !request_.layers.empty()) return;
    draft.spec.layers.clear(), draft.spec.material.prestrain.reset(), draft.strain = 0;
    const std::optional<Tension> tension = tension_of(draft.spec.material, draft.filled);
    if (!tension) return;
    draft.spec.layers = {tension->capsule}, draft.spec.material.prestrain = tension->inside;
    draft.strain = tension->strain;
  }

  void note_tension(Draft& draft) const {
    if (!(draft.strain > 0)) return;
    draft.note("tension", std::string("in the body it is under tension: ") + draft.tissue.preset->in_situ.source,
               "a layer of " + importers::mm_text(draft.spec.layers.front().to_depth) + " under a strain of " +
                   output::short_number(draft.strain, 2) + " against the tissue below",
               "cuts gape; without the layer and the prestrain it is as if excised");
  }

  /// Fits the organ's stiffness and stores it; an organ that cannot be fitted keeps its moduli.
  void fit(Draft& draft) const {
    ImportedPart& part = draft.part;
    double least = INFINITY, most = -INFINITY;
    for (const Vec3& p : draft.filled.surface.vertex) least = std::min(least, p.z), most = std::max(most, p.z);
    if (request_.stiffness_scale) {
      part.fit_problem = "the scale was given";
    } else if (draft.tissue.is_own) {
      part.fit_problem = "the material is the author's own";
    } else if (!draft.tissue.preset->is_of_paper) {
      part.fit_problem = "the paper has no forces of this tissue";
    } else if (!request_.layers.empty()) {
      part.fit_problem = "the paper has no forces of layered tissue";
    } else if (kFitDepth > kDeepestShare * (most - least)) {
      draft.note("press_too_deep", "the organ is " + importers::mm_text(most - least) + " high", "not fitted",
                 "the press of 12 mm to which a scale is fitted is deeper than a third of it");
      part.fit_problem = "a press of 12 mm is deeper than a third of the organ, which is " +
                         importers::mm_text(most - least) + " high";
    } else if (draft.filled.centre.size() > kMostFittedSpheres) {
      part.fit_problem = "with " + std::to_string(draft.filled.centre.size()) + " spheres it takes long";
      part.can_be_fitted_later = true;
    }
    if (!part.fit_problem.empty()) return;
    const Result<StiffnessFit> fit = fit_stiffness(alone(draft), 0, draft.filled, request_.should_stop);
    if (!fit) {
      part.fit_problem = fit.errors().front().message;
    } else if (!(fit->scale >= kLeastScale && fit->scale <= kMostScale)) {
      part.fit_problem = "the press would need a scale of " + output::short_number(fit->scale, 3) +
                         ", outside of 0.1 to 10: the organ is not one of the paper's";
      draft.note("stiffness_scale", part.fit_problem, "none", "check the organ's unit and size");
    } else {
      apply_fit(draft.spec, *fit);
      part.stiffness_scale = fit->scale;
    }
  }

  /// Finds a script that touches and cuts the organ where it has settled.
  Errors try_script(Draft& draft, const AnchorChoice& standing) const {
    scenes::SceneSpec scene = alone(draft);
    scene.tools = tools_for({&draft.filled, 1});
    std::optional<ScriptChoice> choice =
        choose_script(scene, draft.filled, standing, request_.kilohertz.has_value(), request_.should_stop);
    if (!choice) return {{request_.mesh, "stopped", "nothing was written"}};
    draft.script = std::move(choice->script);
    draft.usual_work = choice->usual_work, draft.dearest_work = choice->dearest_work;
    draft.part.most_force = choice->most_force, draft.part.was_cut = choice->was_cut;
    if (!choice->was_cut || !(choice->most_force > 0))
      draft.note("script_misses",
                 choice->most_force > 0 ? "the script touches the organ but does not cut it"
                                        : "the script does not touch the organ",
                 "none", "edit the script: its places are those of the scene");
    if (choice->drags)
      draft.note("blade_drags",
                 choice->is_inside_out ? "the script's blade turns soft tissue inside out before it cuts"
                                       : "the script's blade takes the organ along by up to " +
                                             importers::mm_text(choice->dragged) + " before it cuts",
                 "the gentlest cut of those tried was taken", "hold more of the organ, or name the tissue that it is");
    return {};
  }

  Result<ImportOutcome> write() {
    ImportOutcome outcome;
    outcome.scene_file = request_.scene;
    std::vector<FilledOrgan> organs;
    scenes::Script script;
    for (Draft& draft : drafts_) {
      organs.push_back(draft.filled);
      scene_.organs.push_back(draft.spec);
      script.steps.insert(script.steps.end(), draft.script.steps.begin(), draft.script.steps.end());
    }
    std::vector<scenes::ToolSpec> tools = tools_for(organs);
    if (!request_.into) scene_.tools = tools, scene_.cameras = {front_camera(organs)};
    name_tools(script, std::move(tools), scene_);
    // A camera that an import placed shall see the new organs too; one of the author's own stays.
    if (request_.into && scene_.cameras == std::vector{front_camera(present_.organs)}) {
      organs.insert(organs.end(), present_.organs.begin(), present_.organs.end());
      scene_.cameras = {front_camera(organs)};
    }
    organs.clear();  // copies of large meshes
    const std::string script_name = request_.into ? stem_ + "-" + file_name_of(drafts_.front().part.name) : stem_;
    outcome.script_file = beside(script_name + ".script.json");
    if (const Result<Done> is_new = output::check_new(outcome.script_file, request_.overwrite); !is_new)
      return is_new.errors();
    outcome.tick_time = time_of_tick(true).value_or(0), outcome.dearest_time = dearest_work();
    for (Draft& draft : drafts_) {
      const importers::CheckedMesh& mesh = file_->file.mesh[std::size_t(&draft - drafts_.data())];
      if (const Result<Done> written = importers::write_obj(draft.part.mesh_file, mesh.vertex, mesh.triangle); !written)
        return written.errors();
      outcome.organs.push_back(std::move(draft.part));
    }
    if (const Result<Done> written = output::write_text_file(outcome.script_file, scenes::write_script(script));
        !written)
      return written.errors();
    const std::string text = request_.into ? scenes::rewrite_scene(present_.scene.text, present_.scene.spec, scene_)
                                           : scenes::write_scene(scene_);
    if (const Result<Done> written = output::write_text_file(request_.scene, text); !written) return written.errors();
    folder_.keep();
    return outcome;
  }

  /// Errors of importers/ and scenes/, which know no options, with the option that helps.
  Errors with_option_names(Errors errors) const {
    for (Error& error : errors) {
      if (const std::size_t at = error.hint.find("largest_hole_mm"); at != std::string::npos)
        error.hint.replace(at, 15, output::option_name("import.largest_hole_mm"));
      if (error.message.find("/layers/") != std::string::npos || error.where.find("/layers/") != std::string::npos)
        error.where = request_.mesh, error.hint = "give " + output::option_name("import.layers") +
                                                  " another depth, or more spheres with " +
                                                  output::option_name("import.spheres");
    }
    return errors;
  }

  const ImportRequest request_;
  std::string place_, stem_;
  NewFolder folder_;
  loading::LoadedScene present_;  ///< to which organs are added; empty: a new scene
  scenes::SceneSpec scene_;
  std::optional<NamedFile> file_;
  std::vector<Draft> drafts_;
};

}  // namespace

Result<ImportOutcome> import_scene(const ImportRequest& request) { return Import(request).run(); }

}  // namespace ctpm::authoring
