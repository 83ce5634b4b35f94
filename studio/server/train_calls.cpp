#include <algorithm>
#include <filesystem>

#include "recordings/session_reader.h"
#include "scenes/scene_file.h"
#include "studio/loading/loaded_scene.h"
#include "studio/server/call_table.h"
#include "studio/server/hand_limits.h"
#include "studio/server/scene_text.h"
#include "studio/server/session_scenes.h"
#include "studio/session/record_session.h"

namespace ctpm::server {
namespace {

/// The poses of a hand, in every `every`-th tick.
Result<Done> write_poses(recordings::SessionReader& reader, std::size_t hand, std::int64_t every,
                         output::JsonWriter& json) {
  constexpr std::int64_t kRead = 10000;  // ticks held in memory
  for (std::int64_t from = 0; from < reader.tick_count(); from += kRead) {
    const auto records = reader.ticks(from, std::min(from + kRead, reader.tick_count()));
    if (!records) return records.errors();
    for (std::int64_t tick = (from + every - 1) / every * every; tick < from + std::int64_t(records->size());
         tick += every) {
      const Hand& in = (*records)[std::size_t(tick - from)].inputs.hand(hand);
      const Quat q = in.world_from_tool;
      json.begin_list().value(in.tool);
      for (const double x : {in.position.x, in.position.y, in.position.z, q.w, q.x, q.y, q.z})
        json.value(double(float(x)));
      json.end_list();
    }
  }
  return Done{};
}

/// A device over OpenIGTLink, as the options of `record` describe it.
devices::DeviceRequest device_of(Parameters& parameters) {
  devices::DeviceRequest device;
  device.address = parameters.text_if("address").value_or("");
  if (const std::optional<double> port = parameters.number_if("listen_port", 0, 65535)) device.listen_port = int(*port);
  device.interface = parameters.text_if("bind").value_or(device.interface);
  device.allowed = parameters.texts_if("allow");
  device.name = parameters.text_if("name").value_or("");
  device.tool = parameters.text_if("tool").value_or("");
  device.buttons = parameters.texts_if("buttons");
  device.scale = parameters.number_if("scale", 1e-3, 1e3).value_or(device.scale);
  device.offset_mm = parameters.numbers_if("offset_m", 3);
  for (double& metres : device.offset_mm) metres *= 1e3;
  device.rotation = parameters.numbers_if("rotation", 4);
  device.tip = parameters.numbers_if("tip", 3);
  if (const auto speed = parameters.number_if("most_speed_m_per_s", 1e-3, 100))
    device.most_speed_mm_per_s = 1e3 * *speed;
  device.timeout_s = parameters.number_if("timeout_s", 0.2, 1e5).value_or(device.timeout_s);
  device.most_force_n = parameters.number_if("most_force_n", 1e-3, 1e3).value_or(device.most_force_n);
  device.stiffness_n_per_m = parameters.number_if("stiffness_n_per_m", 1, 1e5).value_or(device.stiffness_n_per_m);
  if (device.address.empty() == !device.listen_port.has_value())
    parameters.refuse("address", "give either an address or a listen_port");
  return device;
}

}  // namespace

Result<std::string> begin_training(Parameters& parameters, const CallContext& context) {
  const std::string scene_path = parameters.text("scene");
  const std::optional<std::string> output = parameters.text_if("output");
  scenes::LoadOptions options;
  options.text = parameters.text_if("text");
  const std::uint32_t stage = std::uint32_t(parameters.number("stage", 0, Desk::kMostStages - 1));
  TrainingRequest request;
  request.most_speed = parameters.number_if("most_speed_m_per_s", 0.01, 100).value_or(request.most_speed);
  if (std::optional<Parameters> device = parameters.object_if("device")) request.device = device_of(*device);
  if (!context.desk) parameters.refuse("stage", "only a page with a WebSocket has stages");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  if (const Errors errors = devices::check_device(request.device); !errors.empty()) return errors;
  context.desk->end_training();
  const Result<std::string> file = options.text ? context.folder.place(scene_path) : context.folder.find(scene_path);
  if (!file) return file.errors();
  request.scene = *file;
  if (output) {
    const Result<std::string> place = context.folder.place(*output);
    if (!place) return place.errors();
    std::error_code ignored;
    if (std::filesystem::path(*place).extension() != ".ctpm")
      return Error{*output, "a session's name must end in .ctpm", ""};
    if (std::filesystem::exists(*place, ignored)) return Error{*output, "exists already", "choose another name"};
    request.file = *place, request.shown = *output;
  }
  // What the page shows of this text need not be loaded again.
  std::shared_ptr<KeptScene> kept = options.text ? context.desk->kept(*file, *options.text) : nullptr;
  if (!kept) {
    Result<loading::LoadedScene> loaded = loading::load_whole_scene(*file, options, {}, context.should_stop);
    if (!loaded) return loaded.errors();
    kept = std::make_shared<KeptScene>(*std::move(loaded));
  }
  const std::shared_ptr<const recordings::SessionStart> start = kept->start(context.should_stop);
  if (!start) return Error{scene_path, "stopped", ""};
  const scenes::SceneText& scene = kept->scene().scene;
  const std::string view = view_json(scene.spec, start->model);
  request.limits = limits_of_hand(scene.spec, start->model);
  const Result<std::string> awaited = context.desk->train(start, request, stage);
  if (!awaited) return awaited.errors();
  output::JsonWriter warnings;
  write_errors(warnings, scene.warnings);
  output::JsonWriter way;
  way.begin_object().member("force_n", request.limits.force_n).member("depth_m", request.limits.depth_m).end_object();
  return "{\"scene\": " + json_text(scene_path) + ", \"view\": " + view + ", \"warnings\": " + warnings.text() +
         ", \"awaited\": " + json_text(*awaited) + ", \"gives_way\": " + way.text() +
         ", \"scene_key\": " + json_text(scene_key(start->model)) + "}";
}

Result<std::string> end_training(Parameters& parameters, const CallContext& context) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  if (context.desk) context.desk->end_training();
  return std::string("{}");
}

Result<std::string> session_motion(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  const double rate = parameters.number("rate_hz", 1, 1000);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  Result<recordings::SessionReader> reader = open_reader(context, path);
  if (!reader) return reader.errors();
  const std::int64_t every = std::max<std::int64_t>(1, std::llround(1 / (rate * reader->start().model.tick)));
  constexpr std::int64_t kMost = 200000;  // poses
  if (reader->tick_count() / every > kMost) return Error{path, "is too long for this rate", ""};
  output::JsonWriter json;
  json.begin_object().member("interval_s", double(every) * reader->start().model.tick);
  json.member("scene_key", std::string_view(scene_key(reader->start().model)));
  for (std::size_t hand = 0; hand < std::size_t(reader->start().model.hands); ++hand) {
    json.key(hand == 0 ? "poses" : "second_poses").begin_list();
    if (const Result<Done> written = write_poses(*reader, hand, every, json); !written) return written.errors();
    json.end_list();
  }
  return json.end_object().text();
}

}  // namespace ctpm::server
