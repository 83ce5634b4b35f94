// Sessions of two hands, and that those of one hand are written as before there were two.

#include <algorithm>

#include "recordings/internal/field_codec.h"
#include "recordings/internal/model_check.h"
#include "recordings/internal/tick_codec.h"
#include "recordings/recover.h"
#include "recordings/replay.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;
using namespace ctpm::recordings::session_file;

template <class S>
std::vector<std::string> names_written(const S& structure) {
  Bytes bytes;
  put_fields(bytes, structure);
  std::string problem;
  ByteReader in(bytes, 1 << 30);
  std::vector<std::string> names;
  const FieldSet set(in, problem);
  for (const FieldView& field : set.fields()) names.push_back(field.name);
  return names;
}

bool has(const std::vector<std::string>& names, const std::string& part) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return name.find(part) != std::string::npos; });
}

TEST(OneHand, WritesNothingOfASecondOne) {
  const recordings::SessionStart one = small_start(), two = small_start(3, 3, 3, 2);
  EXPECT_EQ(column_text(1).find("second"), std::string::npos);
  EXPECT_TRUE(column_text(1).ends_with("input_age_ns u64\nslip_ms u64\n"));
  EXPECT_TRUE(column_text(2).starts_with(column_text(1)));
  EXPECT_FALSE(has(names_written(one.model), "hands"));
  EXPECT_TRUE(has(names_written(two.model), "hands"));
  State state = two.initial_state;
  EXPECT_FALSE(has(names_written(state), "second"));
  EXPECT_EQ(recordings::state_hash(state), recordings::state_hash(one.initial_state));
  state.last_inputs.second.tool = 2;
  EXPECT_TRUE(has(names_written(state), "last_inputs.second.tool"));
  EXPECT_NE(recordings::state_hash(state), recordings::state_hash(one.initial_state));
  const Lived lived = live(one, 50, [](const State&, const recordings::TickRecord&) {});
  Bytes of_one, of_two;
  put_records(of_one, lived.records, 1), put_records(of_two, lived.records, 2);
  ASSERT_LT(of_one.size(), of_two.size());
  EXPECT_TRUE(std::equal(of_one.begin(), of_one.end(), of_two.begin()));
}

TEST(OneHand, ASecondHandInItsStateIsRefused) {
  const recordings::SessionStart start = small_start();
  State state = start.initial_state;
  EXPECT_TRUE(check_state(start.model, state).empty());
  state.last_inputs.second.tool = 1;
  EXPECT_NE(text_of(check_state(start.model, state)).find("last_inputs.second"), std::string::npos);
  Model model = small_start(3, 3, 3, 2).model;
  state.last_inputs.second.tool = 3;
  EXPECT_NE(text_of(check_state(model, state)).find("last_inputs.second.tool"), std::string::npos);
  for (const std::int32_t hands : {0, 3, -1}) {
    model.hands = hands;
    EXPECT_NE(text_of(check_model(model)).find("hands"), std::string::npos) << hands;
  }
}

TEST(TwoHands, AreReadAndReplayedToTheBit) {
  const Folder folder;
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::backward_euler, Integrator::sdirk2}) {
    recordings::SessionStart start = small_start(3, 3, 3, 2);
    if (integrator == Integrator::leapfrog) {
      network::Material soft = liver_material();
      soft.viscosity = 5e3, soft.stiffness_scale = 0.05;
      Model model = make_skinned_block(3, 3, 3, network::Structure::mass_spring, 0.006, soft);
      model.tools = start.model.tools, model.hands = 2;
      start.model = std::move(model);
    }
    start.model.solver.integrator = integrator, start.model.solver.substeps = 1;
    start.initial_state = rest_state(start.model);
    const std::string path = folder / ("a" + std::to_string(int(integrator)) + ".ctpm");
    const Lived lived = record_session(path, start, 900, 100);
    auto reader = recordings::SessionReader::open(path);
    ASSERT_TRUE(reader) << text_of(reader.errors());
    EXPECT_EQ(reader->start().model.hands, 2);
    const auto ticks = reader->ticks(0, 900);
    ASSERT_TRUE(ticks);
    EXPECT_EQ(*ticks, lived.records);
    double most = 0;
    std::int32_t both = 0;
    for (const recordings::TickRecord& record : *ticks) {
      most = std::max({most, norm(record.tool_force), norm(record.second.tool_force)});
      both += record.contacts > 0 && record.second.contacts > 0;
    }
    EXPECT_GT(both, 50) << "both hands touch the tissue";
    const auto statistics = reader->statistics();
    ASSERT_TRUE(statistics);
    EXPECT_EQ(statistics->max_force, most);
    for (const int threads : {1, 2}) {
      const auto verdict = recordings::verify_session(*reader, {.threads = threads});
      ASSERT_TRUE(verdict) << text_of(verdict.errors());
      EXPECT_TRUE(verdict->same) << recordings::to_string(*verdict);
    }
  }
}

TEST(TwoHands, AForgedForceOrToolOfTheSecondHandIsFound) {
  const recordings::SessionStart start = small_start(3, 3, 3, 2);
  for (const bool is_tool : {false, true}) {
    const Folder folder;
    auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
    ASSERT_TRUE(writer);
    live(start, 200, [&](const State& after, const recordings::TickRecord& record) {
      recordings::TickRecord told = record;
      if (after.tick == 100) is_tool ? void(told.inputs.second.tool = 77) : void(told.second.tool_force.y += 1e-9);
      writer->append(after, told);
    });
    ASSERT_TRUE(writer->finish());
    auto reader = recordings::SessionReader::open(folder / "a.ctpm");
    ASSERT_TRUE(reader);
    const auto verdict = recordings::verify_session(*reader);
    ASSERT_TRUE(verdict) << text_of(verdict.errors());
    EXPECT_FALSE(verdict->same);
    EXPECT_EQ(verdict->first_tick, 99);
    EXPECT_EQ(verdict->quantity, is_tool ? verdict->quantity : "second.tool_force.y");
  }
}

TEST(TwoHands, AnUnfinishedSessionIsRecoveredAndGoesOn) {
  const Folder folder;
  const recordings::SessionStart start = small_start(3, 3, 3, 2);
  Lived lived;
  {
    auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {.wait_when_full = true});
    ASSERT_TRUE(writer);
    lived = live(start, 300,
                 [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  }
  const auto report = recordings::recover_session(folder / "a.ctpm", folder / "b.ctpm");
  ASSERT_TRUE(report) << text_of(report.errors());
  EXPECT_TRUE(report->verdict.same) << recordings::to_string(report->verdict);
  EXPECT_EQ(report->ticks_saved, 300);
  auto reader = recordings::SessionReader::open(folder / "b.ctpm");
  ASSERT_TRUE(reader);
  const auto ticks = reader->ticks(0, 300);
  ASSERT_TRUE(ticks);
  EXPECT_EQ(*ticks, lived.records);
  const auto continued = recordings::continue_session(*reader, 250);
  ASSERT_TRUE(continued) << text_of(continued.errors());
  EXPECT_EQ(continued->model.hands, 2);
  EXPECT_EQ(continued->initial_state.last_inputs, lived.records[249].inputs);
}

TEST(TwoHands, AnEventTellsWhoseItIs) {
  const Model model = small_start().model;
  recordings::Event event{.kind = recordings::EventKind::device_lost, .reason = "the connection ended"};
  EXPECT_FALSE(has(names_written(event), "hand"));
  EXPECT_EQ(recordings::describe(event, model), "the connection ended; the pose is held");
  event.hand = 1;
  EXPECT_TRUE(has(names_written(event), "hand"));
  EXPECT_EQ(recordings::describe(event, model), "second hand: the connection ended; the pose is held");
}

}  // namespace
}  // namespace ctpm
