#include "studio/session/anonymise.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/model/errors.h"
#include "recordings/rewrite.h"
#include "recordings/session_reader.h"
#include "recordings/signature.h"
#include "scenes/presets.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"

namespace ctpm::session {
namespace {

namespace fs = std::filesystem;
using recordings::PseudonymKey;
using recordings::SessionReader;

constexpr std::size_t kIdDigits = 32;

bool is_id(const std::string& text) {
  return text.size() == kIdDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Takes the names out of one session and remembers what it took.
class Scrubber {
 public:
  Scrubber(const SessionReader& session, const AnonymiseRequest& request, const PseudonymKey& key)
      : session_(session), request_(request), key_(key) {}

  /// The scrubber must outlive what it returns.
  recordings::RewrittenSession rewritten(double elapsed_s) {
    recordings::RewrittenSession as;
    as.start = session_.start();
    as.id = key_.digits("session", session_.session_id(), kIdDigits);
    as.created_unix_s = elapsed_s;
    as.keeps_values = false;
    as.change_event = [this](recordings::Event& event) { scrub(event); };
    if (const auto signature = recordings::check_signature(session_.path()); !signature || *signature)
      removed_.insert("the signature");
    scrub_metadata(as.start.metadata);
    scrub_scene(as.start.scene_text);
    const auto rename = [&](const char* kind, auto& things) {
      for (auto& thing : things) thing.name = named(kind, thing.name);
    };
    rename("organ", as.start.model.organs);
    rename("tool", as.start.model.tools);
    rename("obstacle", as.start.model.obstacles);
    clear(as.start.look, "the look's text");
    clear(as.start.build_fingerprint, "the build's text");
    return as;
  }

  /// In words; ask after the session was written.
  std::vector<std::string> removed() const {
    std::vector<std::string> all;
    if (names_ > 0)
      all.push_back(std::to_string(names_) + (names_ == 1 ? " name, now a pseudonym" : " names, now pseudonyms"));
    all.insert(all.end(), removed_.begin(), removed_.end());
    all.push_back("the session's number and the time of day");
    return all;
  }

 private:
  /// The program's own words tell nothing about anybody.
  static bool is_own_word(const std::string& name) {
    return scenes::find_preset(name) != nullptr || name == "ball" || name == "scalpel" || name == "pin";
  }

  std::string named(const char* kind, const std::string& name) {
    if (name.empty() || request_.keep_names || is_own_word(name)) return name;
    if (known_.insert(std::string(kind) + " " + name).second) ++names_;
    return key_.name(kind, name);
  }

  void clear(std::string& text, const std::string& what) {
    if (text.empty()) return;
    text.clear();
    removed_.insert(what);
  }

  /// A mesh is in the session already; its path is only a name.
  void scrub_scene(std::string& text) {
    const Result<scenes::SceneText> scene = scenes::read_scene(text, session_.path());
    if (!scene) return clear(text, "the scene's text, which this version cannot read (no pictures are drawn of it)");
    scenes::SceneSpec spec = scene->spec;
    spec.name = named("scene", spec.name);
    clear(spec.task, "the scene's task");
    for (scenes::OrganSpec& organ : spec.organs) {
      organ.name = named("organ", organ.name);
      scrub_path(organ.mesh);
    }
    for (scenes::ObstacleSpec& obstacle : spec.obstacles) {
      obstacle.name = named("obstacle", obstacle.name);
      scrub_path(obstacle.mesh);
    }
    for (scenes::ToolSpec& tool : spec.tools) tool.name = named("tool", tool.name);
    for (scenes::CameraSpec& camera : spec.cameras) camera.name = named("camera", camera.name);
    for (scenes::ProbeSpec& probe : spec.probes) probe.name = named("probe", probe.name);
    for (scenes::ZoneSpec& zone : spec.forbidden) zone.name = named("zone", zone.name);
    // Comments are not in the spec.
    if (text.find("//") != std::string::npos || text.find("/*") != std::string::npos)
      removed_.insert("comments of the scene");
    text = scenes::write_scene(spec);
  }

  void scrub_path(std::string& path) {
    if (path.empty()) return;
    path = key_.name("mesh", path);
    removed_.insert("paths of meshes");
  }

  /// Keeps what is known to be harmless, and nothing else.
  void scrub_metadata(std::map<std::string, std::string>& metadata) {
    static const std::set<std::string> kSources{"script", "motion", "igtl", "igtl-listen", "studio"};
    std::map<std::string, std::string> kept{{elapsed_key, elapsed_word}};
    for (const auto& [key, value] : metadata) {
      const bool is_source = (key == "source" || key == "second_source") && kSources.contains(value);
      const bool is_number = key == recordings::parent_tick_key &&
                             value.find_first_not_of("0123456789") == std::string::npos && value.size() < 19;
      if (is_source || is_number)
        kept[key] = value;
      else if ((key == recordings::parent_session_key || key == "recovered_from") && is_id(value))
        kept[key] = key_.digits("session", value, kIdDigits);
      else if (key == "scene_name")
        kept[key] = named("scene", value);
      else if (key == trainee_key)
        kept[key] = key_.name("trainee", value);
      else if (key == "script")
        scrub_script(value, kept);
      else if (key != elapsed_key)
        removed_.insert("metadata '" + key + "'");
    }
    if (!request_.trainee.empty()) kept[trainee_key] = key_.name("trainee", request_.trainee);
    metadata = std::move(kept);
  }

  void scrub_script(const std::string& text, std::map<std::string, std::string>& kept) {
    Result<scenes::Script> script = scenes::read_script_for(text, session_.path(), session_.start().model);
    if (!script) {
      removed_.insert("the script, which this version cannot read");
      return;
    }
    for (scenes::ScriptStep& step : script->steps)
      if (step.take) step.take->tool = named("tool", step.take->tool);
    kept["script"] = scenes::write_script(*script);
  }

  void scrub(recordings::Event& event) {
    // A sentence about the loss of a device may name its address.
    clear(event.reason, "why a device was lost");
    if (event.kind == recordings::EventKind::device_lost) event.reason = "device lost";
    if (event.text.empty()) return;
    event.text = "(removed)";
    removed_.insert(event.kind == recordings::EventKind::note ? "texts of notes" : "texts of events");
  }

  const SessionReader& session_;
  const AnonymiseRequest& request_;
  const PseudonymKey& key_;
  std::set<std::string> known_, removed_;
  std::size_t names_ = 0;
};

bool is_folder(const AnonymiseRequest& request) {
  std::error_code ignored;
  return request.sessions.size() > 1 || request.output.ends_with('/') || fs::is_directory(request.output, ignored);
}

Result<std::vector<SessionReader>> open_all(const std::vector<std::string>& files) {
  std::vector<SessionReader> sessions;
  Errors errors;
  for (const std::string& file : files) {
    Result<SessionReader> session = SessionReader::open(file);
    if (session)
      sessions.push_back(std::move(*session));
    else
      append(errors, session);
  }
  if (!errors.empty()) return errors;
  return sessions;
}

/// Where each session goes: named by its pseudonym, because the name of a file may tell who made it.
Result<std::vector<std::string>> places_of(const AnonymiseRequest& request, const std::vector<SessionReader>& sessions,
                                           const PseudonymKey& key) {
  std::vector<std::string> places;
  Errors errors;
  std::set<std::string> taken;
  for (const SessionReader& session : sessions) {
    const std::string name = key.name("session", session.session_id()) + ".ctpm";
    places.push_back(is_folder(request) ? (fs::path(request.output) / name).string() : request.output);
    std::error_code ignored;
    if (!taken.insert(places.back()).second)
      errors.push_back({session.path(), "is the same session as another one that is named", "name it once"});
    else if (fs::exists(places.back(), ignored))
      errors.push_back({places.back(), "exists already", "choose another name"});
  }
  if (!errors.empty()) return errors;
  return places;
}

}  // namespace

bool begins_at_elapsed_time(const recordings::SessionReader& session) {
  const auto times = session.start().metadata.find(elapsed_key);
  return times != session.start().metadata.end() && times->second == elapsed_word;
}

std::vector<std::string> what_stays() {
  return {"the shape of the organs: a mesh of somebody's face or body shows them",
          "the motion of the tool and its times, by which a hand may be known again",
          "computing times of the ticks, which tell about the machine",
          "numbers of the scene, and names that are the program's own words (liver, ball)",
          "what lies beside the session (notes, tables, videos) is neither read nor copied"};
}

Result<std::vector<AnonymisedSession>> anonymise(const AnonymiseRequest& request, const PseudonymKey& key) {
  Result<std::vector<SessionReader>> sessions = open_all(request.sessions);
  if (!sessions) return sessions.errors();
  std::error_code ignored;
  if (sessions->size() > 1 && request.output.ends_with(".ctpm") && !fs::is_directory(request.output, ignored))
    return Error{request.output, "is the name of one session, and " + std::to_string(sessions->size()) + " are given",
                 "give a folder"};
  const Result<std::vector<std::string>> places = places_of(request, *sessions, key);
  if (!places) return places.errors();
  std::error_code failure;
  if (is_folder(request) && !fs::is_directory(request.output, failure) &&
      (fs::create_directories(request.output, failure), failure))
    return Error{request.output, "cannot be created: " + failure.message(), ""};
  double first = INFINITY;
  for (const SessionReader& session : *sessions) first = std::min(first, session.created_unix_s());
  std::vector<AnonymisedSession> done;
  for (std::size_t i = 0; i < sessions->size(); ++i) {
    SessionReader& session = (*sessions)[i];
    Scrubber scrubber(session, request, key);
    const recordings::RewrittenSession as = scrubber.rewritten(session.created_unix_s() - first);
    if (const Result<Done> written = recordings::rewrite_session(session, (*places)[i], as); !written) {
      for (const AnonymisedSession& before : done) fs::remove(before.to, failure);
      return written.errors();
    }
    const auto trainee = as.start.metadata.find(trainee_key);
    done.push_back(
        {session.path(), (*places)[i], trainee == as.start.metadata.end() ? "" : trainee->second, scrubber.removed()});
  }
  return done;
}

}  // namespace ctpm::session
