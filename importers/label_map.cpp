#include "importers/label_map.h"

#include <algorithm>
#include <string_view>

#include "importers/child_process.h"
#include "importers/label_surface.h"
#include "importers/label_text.h"
#include "importers/mesh_file.h"
#include "importers/wire.h"

namespace ctpm::importers {

std::string suffix_of_map(const std::string& path) {
  const std::string low = in_lower_case(path);
  for (const std::string_view end : {".nii", ".nii.gz"})
    if (low.ends_with(end)) return "nii";
  return low.ends_with(".nrrd") ? "nrrd" : "";
}

bool is_label_map(const std::string& path) { return !suffix_of_map(path).empty(); }

std::ptrdiff_t find_label(const std::vector<Label>& labels, const std::string& name) {
  const auto named = [&](const Label& label) { return label.name == name; };
  const auto numbered = [&](const Label& label) { return std::to_string(label.number) == name; };
  auto found = name.empty() ? labels.end() : std::find_if(labels.begin(), labels.end(), named);
  if (found == labels.end()) found = std::find_if(labels.begin(), labels.end(), numbered);
  return found == labels.end() ? -1 : found - labels.begin();
}

Result<std::vector<Label>> list_labels(const std::string& path) {
  if (Errors errors = check_file(path); !errors.empty()) return errors;
  const ChildResult child = run_in_child({}, [&](const Send& send) {
    const Result<LabelMap> map = read_label_map(path);
    wire::Writer message;
    if (!map) return send_refusal(map.errors().front(), send);
    message.put(wire::Kind::mesh);
    message.put<std::uint64_t>(map->labels.size());
    for (const Label& label : map->labels) {
      message.put_text(label.name);
      message.put(label.number), message.put(label.layer), message.put(label.voxels), message.put(label.volume);
    }
    send(message.bytes.data(), message.bytes.size());
  });
  if (!child.is_whole) return Error{path, "the reader " + child.trouble, "the file may be damaged; save it again"};
  const Error broken{path, "the reader's answer is broken", "the file may be damaged"};
  wire::Reader reader(child.output);
  wire::Kind kind{};
  std::string message, hint;
  if (!reader.get(kind)) return broken;
  if (kind == wire::Kind::refused) {
    if (!reader.get_text(message) || !reader.get_text(hint)) return broken;
    return Error{path, message, hint};
  }
  std::uint64_t count = 0;
  if (!reader.get(count)) return broken;
  std::vector<Label> labels;
  for (std::uint64_t i = 0; i < count; ++i) {
    Label& label = labels.emplace_back();
    if (!reader.get_text(label.name) || !reader.get(label.number) || !reader.get(label.layer) ||
        !reader.get(label.voxels) || !reader.get(label.volume))
      return broken;
  }
  return labels;
}

void send_label_map(const std::string& path, const std::string& part, const Send& send) {
  constexpr double kMillimetre = 1e-3;
  const Result<LabelMap> map = read_label_map(path);
  if (!map) return send_refusal(map.errors().front(), send);
  const std::ptrdiff_t found = part.empty() ? 0 : find_label(map->labels, part);
  if (part.empty() && map->labels.size() > 1) {
    std::string known;
    for (const Label& label : map->labels) known += (known.empty() ? "" : ", ") + label.text();
    return send_refusal({path, "holds " + std::to_string(map->labels.size()) + " labels", "choose one of " + known},
                        send);
  }
  std::vector<std::string> parts;
  for (const Label& label : map->labels) parts.push_back(label.text());
  if (found < 0) return send_no_such_part(parts, send);
  send_soup(parts, found, kMillimetre, label_surface(*map, map->labels[std::size_t(found)]), send);
}

}  // namespace ctpm::importers
