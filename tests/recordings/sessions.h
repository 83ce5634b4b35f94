#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "core/stepping/step.h"
#include "core/surface/surface.h"
#include "recordings/session_reader.h"
#include "recordings/session_writer.h"
#include "recordings/state_hash.h"
#include "tests/core/skinned_block.h"

namespace ctpm::testing {

/// A temporary folder of one test, deleted at its end.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "ctpm-recordings-XXXXXX").string();
    CTPM_CHECK(::mkdtemp(pattern.data()), "a temporary folder");
    path_ = pattern;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename().string());
    return names;
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::vector<char> read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_bytes(const std::string& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

inline std::string text_of(const Errors& errors) {
  std::string text;
  for (const Error& error : errors) text += to_string(error) + "\n";
  return text;
}

/// Start of a session on a small block with a ball and a scalpel, and another ball for a second hand.
inline recordings::SessionStart small_start(int ni = 3, int nj = 3, int nk = 3, std::int32_t hands = 1) {
  recordings::SessionStart start;
  start.scene_text = "{ \"scene\": \"a block\" }\n";
  start.look = "block rose";
  start.model = make_skinned_block(ni, nj, nk, network::Structure::ctpm, 0.006);
  start.model.tools = {ball(0.006), scalpel(0.02)};
  if (hands > 1) start.model.tools.push_back(ball(0.005)), start.model.tools.back().name = "other ball";
  start.model.hands = hands;
  start.initial_state = rest_state(start.model);
  start.build_fingerprint = "test build";
  start.metadata = {{"user", "a trainee"}, {"empty", ""}};
  return start;
}

/// Inputs of these tests: the ball presses the block from above, then the scalpel sweeps through it. A second hand
/// presses beside it with the other ball, but for some ticks in which it is empty.
inline Inputs scripted_inputs(std::int64_t tick, double top, std::int32_t hands = 1) {
  Inputs inputs;
  const double t = 1e-3 * static_cast<double>(tick);
  if (tick % 700 < 400) {
    inputs.tool = 0;
    inputs.position = {0.001, 0.0005, top + 0.007 - 0.004 * std::sin(4 * t) * std::sin(4 * t)};
  } else {
    inputs.tool = 1;
    inputs.position = {-0.03 + 2e-4 * static_cast<double>(tick % 700 - 400), 0.0061, top - 0.01};
    inputs.buttons = 1;
  }
  if (hands > 1 && tick % 300 > 40) {
    inputs.second.tool = 2, inputs.second.buttons = 4;
    inputs.second.position = {-0.008, 0.004, top + 0.005 - 0.003 * std::sin(3 * t) * std::sin(3 * t)};
  }
  return inputs;
}

/// Records of a simulated session, in memory.
struct Lived {
  std::vector<recordings::TickRecord> records;
  State last;
};

/// Simulates `ticks` ticks from the start and calls `each(state, record)` after each.
template <class Each>
Lived live(const recordings::SessionStart& start, std::int64_t ticks, Each&& each) {
  Lived lived;
  lived.last = start.initial_state;
  stepping::Stepper stepper(start.model);
  const double top = start.model.rest_position.z.back();
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const Inputs inputs = scripted_inputs(tick, top, start.model.hands);
    const stepping::StepReport report = stepper.step(lived.last, inputs);
    lived.records.push_back(recordings::make_record(inputs, report, static_cast<double>(250000 + tick % 977) / 1e9,
                                                    recordings::state_hash(lived.last)));
    each(lived.last, lived.records.back());
  }
  return lived;
}

/// Records a whole session and ends it. The writer waits for the disk, because these sessions run faster than it.
inline Lived record_session(const std::string& path, const recordings::SessionStart& start, std::int64_t ticks,
                            std::int32_t keyframe_ticks = 250) {
  recordings::WriterOptions options;
  options.keyframe_ticks = keyframe_ticks;
  options.wait_when_full = true;
  auto writer = recordings::SessionWriter::create(path, start, options);
  CTPM_CHECK(bool(writer), "a test's session can be created");
  const Lived lived = live(start, ticks, [&](const State& after, const recordings::TickRecord& record) {
    writer->append(after, record);
    if (record.severed > 0)
      writer->event({.tick = after.tick - 1,
                     .kind = recordings::EventKind::cut,
                     .tool = record.inputs.tool,
                     .severed = record.severed});
  });
  CTPM_CHECK(bool(writer->finish({{"input_age_p50_s", 0.0005}})), "a test's session can be finished");
  return lived;
}

}  // namespace ctpm::testing
