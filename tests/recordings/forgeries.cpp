#include "tests/recordings/forgeries.h"

#include <sys/resource.h>
#include <sys/wait.h>

#include <bit>
#include <random>

#include "core/cutbody/cut_body.h"
#include "recordings/internal/tick_codec.h"
#include "recordings/replay.h"
#include "tests/recordings/field_tree.h"
#include "tests/recordings/forge.h"

namespace ctpm::testing {

using namespace recordings::session_file;

namespace {

constexpr double most_seconds = 10;            // computing time of one file
constexpr std::int64_t most_memory = 1000000;  // of its process [kB]

constexpr std::int64_t ticks = 200;

/// A session in which a ball presses and a blade cuts, with events.
void record_to_forge(const std::string& path, bool meets, std::int32_t hands) {
  recordings::SessionStart start = small_start(4, 3, 3, hands);
  start.model.organs[0].meets_itself = meets;
  start.model.organs_meet = meets;
  auto writer = recordings::SessionWriter::create(path, start, {.wait_when_full = true, .keyframe_ticks = 50});
  CTPM_CHECK(bool(writer), "a session to forge");
  State state = start.initial_state;
  stepping::Stepper stepper(start.model);
  const double top = start.model.rest_position.z.back();
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const Inputs inputs = scripted_inputs(300 + tick, top, hands);
    const stepping::StepReport report = stepper.step(state, inputs);
    writer->append(state, recordings::make_record(inputs, report, 3e-4, recordings::state_hash(state), 1e-3));
    if (report.severed > 0)
      writer->event({.tick = tick, .kind = recordings::EventKind::cut, .tool = 1, .severed = report.severed});
  }
  writer->event({.tick = 3, .kind = recordings::EventKind::note, .text = "a note"});
  CTPM_CHECK(bool(writer->finish({{"a_number", 1}})), "a session to forge");
}

/// Changes one thing of a session file. Seeded.
class Forger {
 public:
  /// `hands`: of the session.
  Forger(unsigned seed, std::int32_t hands) : hands_(hands), random_(seed) {}

  /// Changes the file at `path`. True if what it now says is false for sure, so that it must not be "same".
  bool operator()(const std::string& path, std::string& what) {
    Forge forge(path);
    bool is_false = false;
    for (int changes = 1 + pick(3); changes > 0; --changes) is_false = change(forge, what) || is_false;
    return is_false;
  }

 private:
  std::int64_t pick(std::int64_t end) { return std::uniform_int_distribution<std::int64_t>(0, end - 1)(random_); }

  bool change(Forge& forge, std::string& what) {
    switch (pick(8)) {
      case 0:
      case 1:
      case 2:
        return change_tree(forge, "part", "model", what), false;
      case 3:
        return change_tree(forge, "part",
                           pick(2) == 0   ? "surfaces"
                           : pick(2) == 0 ? "metadata"
                                          : "session",
                           what),
               false;
      case 4:
        return change_keyframe(forge, what), false;
      case 5:
        return change_record(forge, what);
      case 6:
        return change_tree(forge, pick(2) == 0 ? "part" : "event", "", what), false;
      default:
        return change_row(forge, what);
    }
  }

  std::uint64_t strange(FieldNode::Type type) {
    static constexpr double numbers[] = {0,    -0.0, 1,   -1,   5e-324, 1e-300, 1e-18,  1e-9,     0.999, 1e3,
                                         -1e3, 1e6,  1e9, 1e18, -1e18,  1e300,  -1e300, INFINITY, NAN};
    static constexpr std::int64_t integers[] = {
        0, 1, -1, 2, 7, 100, 255, 1000, 65535, 1000000, INT32_MAX, INT32_MIN, INT64_MAX, INT64_MIN, 1ll << 40};
    if (type == FieldNode::Type::f64 && pick(8) > 0)
      return std::bit_cast<std::uint64_t>(numbers[pick(std::size(numbers))]);
    if (pick(8) > 0) return std::uint64_t(integers[pick(std::size(integers))]);
    return random_() | std::uint64_t(random_()) << 32;
  }

  /// Near enough to the old value to pass for it.
  std::uint64_t plausible(FieldNode::Type type, std::uint64_t old) {
    static constexpr double factors[] = {0.01, 0.5, 1 + 1e-15, 1.01, 2, 10, 1000, -1};
    if (type == FieldNode::Type::f64)
      return std::bit_cast<std::uint64_t>(std::bit_cast<double>(old) * factors[pick(std::size(factors))]);
    return pick(2) == 0 ? old + 1 : old - 1;
  }

  void change_tree(Forge& forge, const std::string& table, std::string key, std::string& what) {
    if (key.empty()) key = table == "part" ? "finish" : "0";
    forge.change(table, key, [&](Bytes& content) {
      FieldTree tree = read_tree(content);
      if (tree.empty()) return;
      what += " " + table + " " + key + ":";
      pick(5) == 0 ? change_shape(tree, what) : change_numbers(tree, what);
      content = write_tree(tree);
    });
  }

  void change_keyframe(Forge& forge, std::string& what) {
    const std::vector<std::int64_t> ticks = forge.integers("SELECT tick FROM keyframe ORDER BY tick");
    if (!ticks.empty())
      change_tree(forge, "keyframe", std::to_string(ticks[std::size_t(pick(std::int64_t(ticks.size())))]), what);
  }

  void change_numbers(FieldTree& tree, std::string& what) {
    std::vector<FieldNode*> numbers;
    collect_numbers(tree, numbers);
    if (numbers.empty()) return;
    FieldNode& node = *numbers[std::size_t(pick(std::int64_t(numbers.size())))];
    what += " numbers of " + node.name;
    if (node.bits.empty()) {
      node.bits.assign(std::size_t(1 + pick(3)), strange(node.type));
      return;
    }
    std::uint64_t& old = node.bits[std::size_t(pick(std::int64_t(node.bits.size())))];
    if (pick(2) == 0) {
      old = plausible(node.type, old);
      return;
    }
    const std::uint64_t value = strange(node.type);
    switch (pick(4)) {
      case 0:
        std::fill(node.bits.begin(), node.bits.end(), value);
        break;
      case 1:
        old ^= 1ull << pick(64);
        break;
      default:
        old = value;
    }
  }

  void change_shape(FieldTree& tree, std::string& what) {
    FieldNode& node = tree[std::size_t(pick(std::int64_t(tree.size())))];
    what += " shape of " + node.name;
    switch (pick(6)) {
      case 0:
        tree.erase(tree.begin() + (&node - tree.data()));
        break;
      case 1:
        node.list.clear(), node.bits.clear();
        break;
      case 2:
        if (node.is_number()) node.declared = 1ull << (10 + pick(40));
        break;
      case 3:  // many entries that weigh nothing in the file
        if (!node.list.empty()) node.list.resize(std::size_t(1) << (4 + pick(14)), node.list.front());
        break;
      case 4:
        if (!node.list.empty()) node.list.resize(std::size_t(1) << (4 + pick(14)));
        break;
      default:
        if (!node.bits.empty()) node.bits.resize(std::size_t(pick(2 * std::int64_t(node.bits.size()) + 1)));
    }
  }

  /// Another outcome of a tick than the one that was computed is false, whatever it is.
  bool change_record(Forge& forge, std::string& what) {
    bool is_false = false;
    forge.change("chunk", "0", [&](Bytes& content) {
      const auto decoder = RecordDecoder::create(column_text(hands_));
      // A busy machine closes chunks before they are full.
      std::int64_t count = 100;
      while (count > 0 && !decoder->decode(content, count)) --count;
      if (count == 0) return;
      auto records = decoder->decode(content, count);
      recordings::TickRecord& record = (*records)[std::size_t(pick(count))];
      const recordings::TickRecord before = record;
      const double number = std::bit_cast<double>(strange(FieldNode::Type::f64));
      const auto integer = std::int32_t(strange(FieldNode::Type::i32));
      // Those of the second hand come last.
      double* const doubles[] = {&record.tool_force.x,
                                 &record.tool_force.z,
                                 &record.depth,
                                 &record.inputs.position.x,
                                 &record.inputs.position.z,
                                 &record.inputs.world_from_tool.w,
                                 &record.second.tool_force.y,
                                 &record.second.depth,
                                 &record.inputs.second.position.y,
                                 &record.inputs.second.world_from_tool.x};
      std::int32_t* const integers[] = {
          &record.status,      &record.iterations,      &record.contacts,          &record.severed,
          &record.inputs.tool, &record.second.contacts, &record.inputs.second.tool};
      const std::int64_t double_count = hands_ > 1 ? 10 : 6, integer_count = hands_ > 1 ? 7 : 5;
      const std::int64_t choice = pick(double_count + integer_count + 1);
      if (choice < double_count)
        *doubles[choice] = number;
      else if (choice < double_count + integer_count)
        *integers[choice - double_count] = integer;
      else
        record.state_hash = strange(FieldNode::Type::u64);
      what += " record field " + std::to_string(choice);
      is_false = std::memcmp(&before, &record, sizeof record) != 0;
      content.clear();
      put_records(content, *records, hands_);
    });
    return is_false;
  }

  bool change_row(Forge& forge, std::string& what) {
    static const char* const changes[] = {
        "DELETE FROM keyframe WHERE tick = (SELECT max(tick) FROM keyframe)",
        "DELETE FROM chunk WHERE first = (SELECT max(first) FROM chunk)",
        "DELETE FROM event WHERE first = 0",
        "UPDATE chunk SET first = 9223372036854775807 WHERE first = (SELECT max(first) FROM chunk)",
        "UPDATE chunk SET count = -1 WHERE first = 0",
        "UPDATE keyframe SET tick = -9223372036854775808 WHERE tick = (SELECT max(tick) FROM keyframe)",
        "UPDATE event SET count = 9223372036854775807",
        "DELETE FROM part WHERE name = 'model'",
        "DELETE FROM keyframe",
        "PRAGMA user_version = 0"};
    const char* sql = changes[pick(std::size(changes))];
    what += std::string(" ") + sql;
    forge.run(sql);
    return true;
  }

  std::int32_t hands_;
  std::mt19937 random_;
};

/// What a process that read a file said, by its exit code.
enum Said : int { said_same = 0, said_different = 1, said_refused = 2, said_not_opened = 3, threw };

/// Makes the drawn surfaces of the last keyframe, as a video does.
void draw(recordings::SessionReader& reader) {
  const Model& model = reader.start().model;
  const auto keyframe = reader.keyframe_at_or_before(reader.tick_count());
  for (std::size_t organ = 0; keyframe && organ < model.surfaces.size(); ++organ) {
    if (model.surfaces[organ].triangle.empty() || !model.has_scalpel()) continue;
    cutbody::CutBody body(model, organ);
    body.update(keyframe->state);
  }
}

int read_everything(const std::string& path) {
  auto reader = recordings::SessionReader::open(path);
  if (!reader) return said_not_opened;
  (void)reader->statistics();
  if (const auto events = reader->events())
    for (const recordings::Event& event : *events) (void)recordings::describe(event, reader->start().model);
  const auto verdict = recordings::verify_session(*reader);
  draw(*reader);
  if (!verdict) return said_refused;
  return verdict->same ? said_same : said_different;
}

std::int32_t hands_of(const std::string& path) {
  const auto reader = recordings::SessionReader::open(path);
  CTPM_CHECK(bool(reader), "a session to forge");
  return reader->start().model.hands;
}

}  // namespace

bool forge_session(const std::string& path, unsigned seed, std::string& what) {
  what = "seed " + std::to_string(seed) + ":";
  return Forger(seed, hands_of(path))(path, what);
}

void verify_forgeries(int count, unsigned seed) {
  const Folder folder;
  const char* const names[] = {"meets.ctpm", "two-hands.ctpm", "plain.ctpm", "plain.ctpm"};
  record_to_forge(folder / "plain.ctpm", false, 1), record_to_forge(folder / "meets.ctpm", true, 1);
  record_to_forge(folder / "two-hands.ctpm", false, 2);
  for (const char* name : names) ASSERT_EQ(read_everything(folder / name), said_same) << name;
  int said[threw] = {};
  double longest = 0;
  std::int64_t largest = 0;
  for (int i = 0; i < count; ++i) {
    const std::string path = folder / "forged.ctpm";
    std::filesystem::copy_file(folder / names[i % 4], path, std::filesystem::copy_options::overwrite_existing);
    std::string what;
    bool is_false = false;
    try {
      is_false = forge_session(path, seed + unsigned(i), what);
    } catch (const std::exception& problem) {
      FAIL() << what << problem.what();
    }
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ::alarm(120);
      try {
        ::_exit(read_everything(path));
      } catch (...) {
        ::_exit(threw);
      }
    }
    int status = 0;
    rusage used{};
    ASSERT_EQ(::wait4(child, &status, 0, &used), child);
    ASSERT_TRUE(WIFEXITED(status)) << what << " ended by signal " << WTERMSIG(status);
    ASSERT_LE(WEXITSTATUS(status), int(said_not_opened)) << what;
    ++said[WEXITSTATUS(status)];
    EXPECT_FALSE(is_false && WEXITSTATUS(status) == said_same) << what << " is said to be the same";
    const double seconds = double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                           1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    EXPECT_LT(seconds, most_seconds) << what;
    EXPECT_LT(used.ru_maxrss, most_memory) << what;
    longest = std::max(longest, seconds), largest = std::max<std::int64_t>(largest, used.ru_maxrss);
  }
  std::printf("%d forged files: %d not opened, %d refused, %d different, %d same; at most %.2f s and %lld MB each\n",
              count, said[said_not_opened], said[said_refused], said[said_different], said[said_same], longest,
              (long long)largest / 1000);
  // Each kind of answer is met, so that the forgeries reach all of the reading.
  for (const int answers : said) EXPECT_GT(answers, 0);
}

}  // namespace ctpm::testing
