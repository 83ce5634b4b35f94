// Files of motion: what is read, how it is sampled, and every error by its place.

#include "studio/sources/motion_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "studio/sources/odd_motion.h"
#include "studio/sources/rotation.h"

namespace ctpm {
namespace {

std::vector<Tool> tools() {
  std::vector<Tool> tools(2);
  tools[0].name = "ball", tools[1].name = "scalpel";
  return tools;
}

std::string errors_of(const std::string& text) {
  const Result<sources::Motion> motion = sources::read_motion(text, "m.csv", tools());
  if (motion) return "no error";
  std::string all;
  for (const Error& error : motion.errors()) all += to_string(error) + "\n";
  return all;
}

sources::Motion read_good(const std::string& text) {
  Result<sources::Motion> motion = sources::read_motion(text, "m.csv", tools());
  if (motion) return *motion;
  ADD_FAILURE() << to_string(motion.errors().front());
  return {};
}

const std::string kHeader = "time_s,tool_x_mm,tool_y_mm,tool_z_mm,tool_qw,tool_qx,tool_qy,tool_qz,buttons,tool\n";

std::string text_of(const Error& odd) { return odd.where + ": " + odd.message + " (" + odd.hint + ")"; }

/// Rows every 10 ms of a ball that goes down at 20 mm/s; `change` may change the time [s] and the height [mm] of row i.
template <class Change>
std::string oddities_of(Change change, int rows = 200) {
  std::string text = "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n";
  for (int i = 0; i < rows; ++i) {
    double time = 0.01 * i, height = 80 - 0.2 * i;
    change(i, time, height);
    text += std::to_string(time) + ",10,0," + std::to_string(height) + "\n";
  }
  std::string all;
  for (const Error& odd : sources::find_odd_motion(read_good(text), "m.csv")) all += text_of(odd) + "\n";
  return all;
}

TEST(OddMotion, IsToldWithItsLine) {
  EXPECT_EQ(oddities_of([](int, double&, double&) {}), "");
  EXPECT_EQ(oddities_of([](int i, double&, double& height) { height += i == 100 ? 50 : 0; }),
            "m.csv:102: the tool goes 49.8 mm in 10 ms, 4.98 m/s (no hand is so fast)\n");
  EXPECT_EQ(oddities_of([](int i, double& time, double&) { time += i >= 100 ? 0.5 : 0; }),
            "");  // it moved by 0.2 mm meanwhile
  EXPECT_EQ(oddities_of([](int i, double& time, double& height) {
              if (i >= 100) time += 0.5, height -= 10;
            }),
            "m.csv:102: nothing was written for 0.51 s, in which the tool went 10.2 mm (it is taken to have gone "
            "straight)\n");
  EXPECT_EQ(oddities_of([](int, double& time, double&) { time *= 1000; }),
            "m.csv: its rows are 10 s apart (time_s is in seconds)\n");
}

TEST(OddMotion, InMetresIsSuspected) {
  std::string text = "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n";
  for (int i = 0; i < 200; ++i)
    text += std::to_string(0.01 * i) + ",0.01,0," + std::to_string(0.08 - 0.0002 * i) + "\n";
  const Errors odd = sources::find_odd_motion(read_good(text), "m.csv");
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_EQ(text_of(odd[0]),
            "m.csv: all its places lie within 2 mm of the scene's origin (tool_x_mm, tool_y_mm and "
            "tool_z_mm are in millimetres)");
}

TEST(ReadMotion, ColumnsMayStandInAnyOrderAndOthersAreNamedAsUnused) {
  const sources::Motion motion = read_good(
      "\xEF\xBB\xBFtool_z_mm, force_n ,time_s,tool_y_mm,\"tool_x_mm\"\r\n3, 0.5 ,10.5,2,1\r\n\r\n6,0,11,5,4\n");
  ASSERT_EQ(motion.samples.size(), 2u);
  EXPECT_EQ(motion.samples[0].time, 10.5);
  EXPECT_EQ(motion.samples[0].inputs.position, (Vec3{0.001, 0.002, 0.003}));
  EXPECT_EQ(motion.samples[1].inputs.position, (Vec3{0.004, 0.005, 0.006}));
  EXPECT_EQ(motion.samples[0].inputs.tool, 0);  // the first tool, since no column names another
  EXPECT_EQ(motion.samples[0].inputs.world_from_tool, Quat{});
  EXPECT_EQ(motion.unused_columns, std::vector<std::string>{"force_n"});
}

TEST(ReadMotion, ToolsButtonsAndOrientationsAreRead) {
  const sources::Motion motion = read_good(kHeader + "0,0,0,0,0,0.99,0,0,5,scalpel\n1,0,0,0,1,0,0,0,0,\n");
  EXPECT_EQ(motion.samples[0].inputs.tool, 1);
  EXPECT_EQ(motion.samples[0].inputs.buttons, 5u);
  EXPECT_EQ(motion.samples[0].inputs.world_from_tool, (Quat{0, 1, 0, 0}));  // brought to length 1
  EXPECT_EQ(motion.samples[1].inputs.tool, -1);
}

TEST(ReadMotion, AllErrorsAreToldAtOnceWithLineAndColumn) {
  EXPECT_EQ(errors_of("time_s,tool_x_mm,tool_y_mm,tool_z_mm\n"
                      "0,1,2,3\n"
                      "1,nan,2,3\n"
                      "2,1, 2x,inf\n"
                      "0.5,1,2,3\n"
                      "-1,1,2,3\n"
                      "3,1,2\n"
                      "4,1,2,3,4\n"
                      "5,1,2,\n"
                      "6,1,2,999999\n"
                      "0.5,1,2,3\n"),
            "m.csv:3:3: error: tool_x_mm: got 'nan', must be a finite number\n"
            "m.csv:4:6: error: tool_y_mm: got '2x', must be a finite number\n"
            "m.csv:4:9: error: tool_z_mm: got 'inf', must be a finite number\n"
            "m.csv:6:1: error: time_s: got -1, time must rise from row to row (it goes back here)\n"
            "m.csv:7:1: error: got 3 values, must be 4, as many as names in the first row\n"
            "m.csv:8:1: error: got 5 values, must be 4, as many as names in the first row\n"
            "m.csv:9:7: error: tool_z_mm: got '', must be a finite number\n"
            "m.csv:10:7: error: tool_z_mm: got 999999, is out of range\n"
            "m.csv:11:1: error: time_s: got 0.5, time must rise from row to row (it stands still here)\n");
}

TEST(ReadMotion, AHeaderThatDoesNotFitIsRefusedWithEverythingThatIsWrong) {
  EXPECT_EQ(errors_of("time,tool_x_mm,tool_x_mm,tool_qw\n0,1,2,3\n"),
            "m.csv:1:16: error: the column tool_x_mm stands twice\n"
            "m.csv:1:1: error: missing columns: time_s, tool_y_mm, tool_z_mm (the first row names the columns)\n"
            "m.csv:1:1: error: an orientation needs all of tool_qw, tool_qx, tool_qy, tool_qz; 1 are there\n");
  EXPECT_EQ(errors_of(""), "m.csv: error: is empty (the first row names the columns: time_s, tool_x_mm ...)\n");
  EXPECT_EQ(errors_of("time_s,tool_x_mm,tool_y_mm,tool_z_mm\n"),
            "m.csv:2:1: error: there is no row after the names of the columns\n");
  EXPECT_EQ(errors_of("time_s;tool_x_mm;tool_y_mm;tool_z_mm\n0;1;2;3\n"),
            "m.csv:1:1: error: semicolons or tabs part the values (save it with commas between the values, and points "
            "in the numbers)\n");
}

TEST(ReadMotion, AnOrientationAButtonSetOrAToolThatIsNoneIsRefusedWhereItStands) {
  EXPECT_EQ(errors_of(kHeader + "0,0,0,0,0.5,0.5,0,0,-1,saw\n"),
            "m.csv:2:9: error: tool_qw, tool_qx, tool_qy, tool_qz: must have length 1\n"
            "m.csv:2:21: error: buttons: got '-1', must be a whole number in [0, 4294967295]\n"
            "m.csv:2:24: error: tool: the scene has no tool 'saw' (its tools: ball, scalpel)\n");
}

TEST(ReadMotion, OfVeryManyErrorsTheFirstHundredAreToldAndTheOthersCounted) {
  std::string text = "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n";
  for (int i = 0; i < 250; ++i) text += "x,1,2,3\n";
  const Result<sources::Motion> motion = sources::read_motion(text, "m.csv", tools());
  ASSERT_FALSE(motion);
  ASSERT_EQ(motion.errors().size(), 101u);
  EXPECT_EQ(motion.errors().back().message, "and 150 more errors");
}

TEST(ReadMotion, NoCutOrChangedFileDoesAnythingButReadOrRefuse) {
  const std::string whole = kHeader + "0,1.5,2,3,0,1,0,0,5,scalpel\n0.01,1,2,3,1,0,0,0,0,\n";
  for (std::size_t length = 0; length < whole.size(); ++length)
    (void)sources::read_motion(whole.substr(0, length), "m.csv", tools());
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const int change : {1, 2, 4, 8, 16, 32, 64, 128}) {
      std::string changed = whole;
      changed[i] = char(changed[i] ^ change);
      if (const Result<sources::Motion> motion = sources::read_motion(changed, "m.csv", tools()); motion)
        for (const sources::MotionSample& sample : motion->samples) {
          EXPECT_TRUE(is_finite(sample.inputs.position));
          EXPECT_NEAR(sources::length_of(sample.inputs.world_from_tool), 1, 1e-12);
        }
    }
}

TEST(MotionAt, PositionsLieOnTheStraightLineAndTurnsAreEvenWhateverTheRate) {
  // A quarter turn about z in 0.1 s, sampled at its ends alone.
  const double half = std::sqrt(0.5);
  sources::Motion motion;
  motion.samples = {{5.0, {{0, {0, 0, 0}, {1, 0, 0, 0}, 1}, {}}},
                    {5.1, {{0, {0.02, 0, -0.01}, {-half, 0, 0, -half}, 2}, {}}}};
  EXPECT_EQ(sources::motion_tick_count(motion, 1e-3), 101);
  for (int tick = 0; tick < 100; ++tick) {
    const Inputs inputs = sources::motion_at(motion, tick * 1e-3);
    EXPECT_NEAR(norm(inputs.position - tick / 100.0 * Vec3{0.02, 0, -0.01}), 0, 1e-12);
    EXPECT_NEAR(sources::angle_between(Quat{}, inputs.world_from_tool), tick / 100.0 * std::numbers::pi / 2, 1e-6)
        << tick;
    EXPECT_EQ(inputs.buttons, 1u) << "buttons are held until the next sample";
  }
  EXPECT_EQ(sources::motion_at(motion, 0.1).buttons, 2u);
  EXPECT_EQ(sources::motion_at(motion, 7), motion.samples.back().inputs);
  EXPECT_EQ(sources::motion_at(motion, -1), motion.samples.front().inputs);
}

/// Else the replayed blade would go through the tissue on a way on which no hand moved it.
TEST(MotionAt, AToolStaysWhereItWasLastSeenUntilAnotherOrNoneIsHeld) {
  sources::Motion motion;
  motion.samples = {{0, {{0, {0.05, 0, 0.1}, {1, 0, 0, 0}, 0}, {}}},
                    {0.015, {{1, {-0.05, 0, 0.1}, {1, 0, 0, 0}, 0}, {}}},
                    {0.03, {{-1, {0, 0, 0}, {1, 0, 0, 0}, 0}, {}}}};
  for (int tick = 0; tick < 15; ++tick) {
    const Inputs first = sources::motion_at(motion, tick * 1e-3),
                 second = sources::motion_at(motion, 0.015 + tick * 1e-3);
    EXPECT_EQ(first, motion.samples[0].inputs) << tick;
    EXPECT_EQ(second, motion.samples[1].inputs) << tick;
  }
  EXPECT_EQ(sources::motion_at(motion, 0.03).tool, -1);
}

TEST(MotionAt, AMotionSampledAtTheTicksIsTakenAsItIs) {
  sources::Motion motion;
  for (int i = 0; i < 5000; ++i)
    motion.samples.push_back(
        {17 + i * 1e-3, {{0, {std::sin(i * 0.7), std::cos(i * 1.3), i * 1e-3}, {1, 0, 0, 0}, 0}, {}}});
  ASSERT_EQ(sources::motion_tick_count(motion, 1e-3), 5000);
  for (int i = 0; i < 5000; ++i)
    ASSERT_EQ(sources::motion_at(motion, i * 1e-3), motion.samples[std::size_t(i)].inputs) << i;
}

}  // namespace
}  // namespace ctpm
