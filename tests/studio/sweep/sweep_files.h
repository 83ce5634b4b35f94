#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/studio/commands/run_program.h"

namespace ctpm::testing {

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// The paper's rig and a press of it in `folder`: sessions of some milliseconds of processor time.
inline void write_rig(const std::filesystem::path& folder, const std::string& wait_s = "0.1") {
  std::filesystem::copy_file(std::string(CTPM_SOURCE_DIR) + "/scenes/paper/rig-liver.json", folder / "rig.json",
                             std::filesystem::copy_options::overwrite_existing);
  write(folder / "press.json", R"({"format": "ctpm-script", "version": 1, "steps": [
    {"take": {"tool": "pin", "at_mm": [0, 0, 0]}},
    {"press": {"distance_mm": 4, "speed_mm_per_s": 40}},
    {"wait_s": )" + wait_s + "}]}");
}

/// A sweep of the rig; `more` are keys of it, of which "vary" is one.
inline void write_sweep(const std::filesystem::path& folder, const std::string& more) {
  write(folder / "sweep.json",
        "{\"format\": \"ctpm-sweep\", \"version\": 1, \"name\": \"rig\", \"scene\": "
        "\"rig.json\",\n \"script\": \"press.json\",\n " +
            more + "}");
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    lines.push_back(line);
    from = end + 1;
  }
  return lines;
}

/// The cells of a line of CSV without quotes.
inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

}  // namespace ctpm::testing
