// One build in a comparison of builds; cross_builds.sh compiles this file in several ways.
//   cross_build record FROM TO     simulates the inputs of session FROM in this build and records them as TO
//   cross_build verify FILE...     replays sessions in this build; exit code 1 if any differs
//   cross_build verify-end TICKS FILE   the same of the last ticks of one, from the keyframe before them

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/stepping/step.h"
#include "recordings/replay.h"
#include "recordings/session_writer.h"
#include "recordings/state_hash.h"

namespace ctpm {
namespace {

constexpr std::int64_t kReadTicks = 1000;

int fail(const Errors& errors) {
  for (const Error& error : errors) std::fprintf(stderr, "%s\n", to_string(error).c_str());
  return 2;
}

int record(const std::string& from, const std::string& to) {
  auto session = recordings::SessionReader::open(from);
  if (!session) return fail(session.errors());
  recordings::SessionStart start = session->start();
  start.physics_revision = kPhysicsRevision;
  auto writer = recordings::SessionWriter::create(to, start, {.overwrite = true, .wait_when_full = true});
  if (!writer) return fail(writer.errors());
  stepping::Stepper stepper(session->start().model);
  State state = session->start().initial_state;
  for (std::int64_t first = 0; first < session->tick_count(); first += kReadTicks) {
    const auto records = session->ticks(first, std::min(first + kReadTicks, session->tick_count()));
    if (!records) return fail(records.errors());
    for (const recordings::TickRecord& lived : *records) {
      const stepping::StepReport report = stepper.step(state, lived.inputs);
      writer->append(state, recordings::make_record(lived.inputs, report, 0, recordings::state_hash(state)));
    }
  }
  const auto ended = writer->finish();
  if (!ended) return fail(ended.errors());
  std::printf("%s: %lld ticks recorded\n", to.c_str(), static_cast<long long>(ended->ticks));
  return 0;
}

int verify(const std::string& file, std::int64_t last = INT64_MAX) {
  auto session = recordings::SessionReader::open(file);
  if (!session) return fail(session.errors());
  recordings::VerifyOptions options;
  options.from = std::max<std::int64_t>(0, session->tick_count() - last);
  const auto verdict = recordings::verify_session(*session, options);
  if (!verdict) return fail(verdict.errors());
  std::printf("%s: %s\n", file.c_str(), recordings::to_string(*verdict).c_str());
  return verdict->same ? 0 : 1;
}

}  // namespace
}  // namespace ctpm

int main(int argc, char** argv) {
  const std::string action = argc > 1 ? argv[1] : "";
  if (action == "record" && argc == 4) return ctpm::record(argv[2], argv[3]);
  if (action == "verify-end" && argc == 4) return ctpm::verify(argv[3], std::atoll(argv[2]));
  if (action != "verify" || argc < 3)
    return std::fprintf(stderr, "usage: cross_build record FROM TO | verify FILE... | verify-end TICKS FILE\n"), 2;
  int worst = 0;
  for (int i = 2; i < argc; ++i) worst = std::max(worst, ctpm::verify(argv[i]));
  return worst;
}
