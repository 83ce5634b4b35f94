// Hostile content behind valid checksums, as in a forged session file. Each case decodes many damaged copies of a real
// block. Decoders must refuse a copy or return data that is safe to use; sanitizers check this.

#include <cstring>
#include <random>

#include "recordings/internal/field_codec.h"
#include "recordings/internal/legacy_fields.h"
#include "recordings/internal/model_check.h"
#include "recordings/internal/tick_codec.h"
#include "tests/recordings/earlier_fields.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using namespace ctpm::recordings::session_file;

constexpr std::uint64_t budget = 64 << 20;  // [bytes]

/// Changes some bytes in a way that often breaks parsers. Seeded, so that failures are reproducible.
class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  Bytes operator()(Bytes bytes) {
    for (int changes = 1 + pick(3); changes > 0 && !bytes.empty(); --changes) change(bytes);
    return bytes;
  }

 private:
  int pick(std::size_t end) {
    return static_cast<int>(std::uniform_int_distribution<std::size_t>(0, end - 1)(random_));
  }

  void change(Bytes& bytes) {
    static constexpr std::uint64_t extremes[] = {0,
                                                 1,
                                                 0x7f,
                                                 0xff,
                                                 0x7fffffff,
                                                 0x80000000,
                                                 0xffffffff,
                                                 1ull << 40,
                                                 0x7fffffffffffffff,
                                                 0x8000000000000000,
                                                 ~0ull,
                                                 0x7ff0000000000000};
    const std::size_t place = pick(bytes.size());
    switch (pick(6)) {
      case 0:
        bytes[place] = static_cast<std::uint8_t>(pick(256));
        break;
      case 1:
        bytes[place] ^= static_cast<std::uint8_t>(1 << pick(8));
        break;
      case 2:
        bytes.resize(place);
        break;
      case 3:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place), pick(64) + 1,
                     static_cast<std::uint8_t>(pick(256)));
        break;
      case 4: {
        const std::uint64_t extreme = extremes[pick(std::size(extremes))];
        std::memcpy(&bytes[place], &extreme, std::min<std::size_t>(sizeof extreme, bytes.size() - place));
        break;
      }
      default: {
        const std::size_t from = pick(bytes.size()),
                          count = std::min(bytes.size() - std::max(from, place), std::size_t(pick(64) + 1));
        std::memmove(&bytes[place], &bytes[from], count);
      }
    }
  }

  std::mt19937 random_;
};

template <class S>
Bytes bytes_of(const S& structure) {
  Bytes bytes;
  put_fields(bytes, structure);
  return bytes;
}

/// Decodes as the reader does; empty if refused.
template <class S>
std::optional<S> decoded(const Bytes& bytes) {
  S structure;
  std::string problem;
  ByteReader in(bytes, budget);
  if constexpr (std::is_same_v<S, Model>)
    get_model(in, structure, problem);
  else if constexpr (std::is_same_v<S, State>)
    get_state(in, structure, problem);
  else
    get_fields(in, structure, problem);
  if (!problem.empty()) return std::nullopt;
  return structure;
}

/// Small enough to simulate thousands of variants.
recordings::SessionStart tiny_start() {
  recordings::SessionStart start = small_start(5, 2, 2);
  start.model.solver.max_iterations = 20;
  return start;
}

/// Damaged copies of a Model must be refused or simulate safely.
void expect_safe_models(const Bytes& whole) {
  ASSERT_TRUE(decoded<Model>(whole));
  Mutator mutate(1);
  int refused = 0, simulated = 0;
  for (int i = 0; i < 6000; ++i) {
    const auto model = decoded<Model>(mutate(whole));
    if (!model || !check_model(*model).empty()) {
      ++refused;
      continue;
    }
    // A file may ask for much work per tick within the limits; this test limits it.
    if (model->solver.max_iterations > 1000 || model->solver.substeps > 10) continue;
    State state = rest_state(*model);
    ASSERT_TRUE(check_state(*model, state).empty());
    stepping::Stepper stepper(*model);
    for (std::int64_t tick : {0, 401, 402}) stepper.step(state, scripted_inputs(tick, 0.012));
    ++simulated;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(simulated, 100);
}

TEST(Fuzz, AModelIsRefusedOrCanBeSimulated) { expect_safe_models(bytes_of(tiny_start().model)); }

TEST(Fuzz, AModelOfAnEarlierProgramIsRefusedOrCanBeSimulated) { expect_safe_models(earlier_bytes(tiny_start().model)); }

TEST(Fuzz, AStateIsRefusedOrCanBeSimulated) {
  const recordings::SessionStart start = tiny_start();
  State moved = start.initial_state;
  shake(moved, 1e-4, 1e-2);
  const Bytes whole = bytes_of(moved);
  stepping::Stepper stepper(start.model);
  Mutator mutate(2);
  int refused = 0, simulated = 0;
  for (int i = 0; i < 6000; ++i) {
    auto state = decoded<State>(mutate(whole));
    if (!state || !check_state(start.model, *state).empty()) {
      ++refused;
      continue;
    }
    for (std::int64_t tick : {0, 401, 402}) stepper.step(*state, scripted_inputs(tick, 0.012));
    ++simulated;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(simulated, 100);
}

TEST(Fuzz, ASurfaceIsRefusedOrCanBeDrawn) {
  const recordings::SessionStart start = tiny_start();
  const Bytes whole = bytes_of(start.model.surfaces[0]);
  Mutator mutate(3);
  int refused = 0, drawn = 0;
  std::vector<Vec3> vertex;
  for (int i = 0; i < 6000; ++i) {
    const auto surface = decoded<Surface>(mutate(whole));
    if (!surface || !check_surfaces(start.model, {*surface}).empty()) {
      ++refused;
      continue;
    }
    surface::deform_surface(*surface, start.initial_state.position, start.model.organs[0].first, vertex);
    for (const auto& triangle : surface->triangle)
      for (const std::int32_t corner : triangle) ASSERT_LT(static_cast<std::size_t>(corner), vertex.size());
    ++drawn;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(drawn, 100);
}

TEST(Fuzz, RecordsAndEventsAreRefusedOrDecoded) {
  recordings::SessionStart start = tiny_start();
  start.model.hands = 2, start.model.tools.push_back(ball(0.005));
  const Lived lived = live(start, 100, [](const State&, const recordings::TickRecord&) {});
  Bytes records;
  put_records(records, lived.records, 2);
  const auto decoder = RecordDecoder::create(column_text(2));
  ASSERT_TRUE(decoder);
  ASSERT_TRUE(decoder->decode(records, 100));
  const Bytes event = bytes_of(recordings::Event{
      .tick = 7, .kind = recordings::EventKind::cut, .tool = 1, .severed = 3, .text = "severed", .values = {1, 2, 3}});
  Mutator mutate(4);
  int refused = 0, taken = 0;
  for (int i = 0; i < 6000; ++i) {
    const auto some = decoder->decode(mutate(records), 100);
    (some ? taken : refused)++;
    EXPECT_TRUE(!some || some->size() == 100u);
    (decoded<recordings::Event>(mutate(event)) ? taken : refused)++;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(taken, 100);
  for (const std::int64_t count :
       {std::int64_t{-1}, std::int64_t{0}, std::int64_t{99}, std::int64_t{101}, std::int64_t{1} << 60})
    EXPECT_FALSE(decoder->decode(records, count)) << count;
}

TEST(Fuzz, AListOfColumnsIsRefusedOrKnown) {
  const std::string known = column_text(2);
  Mutator mutate(5);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const Bytes bytes = mutate(Bytes(known.begin(), known.end()));
    refused += RecordDecoder::create(std::string(bytes.begin(), bytes.end())) ? 0 : 1;
  }
  EXPECT_GT(refused, 1000);
}

TEST(Fuzz, AFewBytesCannotAskForMuchMemory) {
  // A constant array of 2^40 values needs no planes, so 12 bytes declare terabytes.
  Bytes bytes;
  put_field_set(bytes, [](FieldWriter&) {});
  bytes.clear();
  put(bytes, std::uint32_t{1});
  put(bytes, std::uint16_t{4});
  put_raw(bytes, "mass", 4);
  put(bytes, static_cast<std::uint8_t>(FieldType::f64));
  put(bytes, std::uint64_t{1} << 40);
  put(bytes, std::uint8_t{1});
  put(bytes, 1.0);
  put(bytes, std::uint8_t{0});
  EXPECT_FALSE(decoded<Model>(bytes));
}

}  // namespace
}  // namespace ctpm
