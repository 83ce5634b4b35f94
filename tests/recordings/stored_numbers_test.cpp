// Numbers stored in session files are permanent. This test lists every number ever used with its meaning. It fails if a
// number gets another meaning or a retired one is reused.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/stepping/step.h"
#include "recordings/event.h"
#include "recordings/internal/field_codec.h"
#include "recordings/internal/legacy_values.h"

namespace ctpm {
namespace {

using recordings::session_file::FieldType;
using Numbers = std::map<int, std::string>;

// One switch for each enumeration, without a default: a new enumerator does not compile until it is named here.

const char* name_in_file(Integrator value) {
  switch (value) {
    case Integrator::backward_euler:
      return "backward_euler";
    case Integrator::leapfrog:
      return "leapfrog";
    case Integrator::sdirk2:
      return "sdirk2";
  }
  return nullptr;
}

const char* name_in_file(ToolKind value) {
  switch (value) {
    case ToolKind::ball:
      return "ball";
    case ToolKind::scalpel:
      return "scalpel";
    case ToolKind::pin:
      return "pin";
  }
  return nullptr;
}

const char* name_in_file(AxialLaw value) {
  switch (value) {
    case AxialLaw::spring:
      return "spring";
    case AxialLaw::kelvin_unit:
      return "kelvin_unit";
    case AxialLaw::two_sphere_tpm:
      return "two_sphere_tpm";
  }
  return nullptr;
}

const char* name_in_file(stepping::StepStatus value) {
  switch (value) {
    case stepping::StepStatus::ok:
      return "ok";
    case stepping::StepStatus::not_converged:
      return "not_converged";
    case stepping::StepStatus::bad_input:
      return "bad_input";
    case stepping::StepStatus::diverged:
      return "diverged";
    case stepping::StepStatus::too_long:
      return "too_long";
  }
  return nullptr;
}

const char* name_in_file(recordings::EventKind value) {
  switch (value) {
    case recordings::EventKind::contact_begins:
      return "contact_begins";
    case recordings::EventKind::contact_ends:
      return "contact_ends";
    case recordings::EventKind::cut:
      return "cut";
    case recordings::EventKind::damage:
      return "damage";
    case recordings::EventKind::late_tick:
      return "late_tick";
    case recordings::EventKind::device_lost:
      return "device_lost";
    case recordings::EventKind::device_back:
      return "device_back";
    case recordings::EventKind::note:
      return "note";
    case recordings::EventKind::piece_came_loose:
      return "piece_came_loose";
    case recordings::EventKind::press_reached_force:
      return "press_reached_force";
    case recordings::EventKind::press_gave_up:
      return "press_gave_up";
    case recordings::EventKind::step_refused:
      return "step_refused";
    case recordings::EventKind::turned_inside_out:
      return "turned_inside_out";
    case recordings::EventKind::came_back:
      return "came_back";
  }
  return nullptr;
}

const char* name_in_file(FieldType value) {
  switch (value) {
    case FieldType::u8:
      return "u8";
    case FieldType::i32:
      return "i32";
    case FieldType::u32:
      return "u32";
    case FieldType::i64:
      return "i64";
    case FieldType::u64:
      return "u64";
    case FieldType::f64:
      return "f64";
    case FieldType::text:
      return "text";
    case FieldType::list:
      return "list";
  }
  return nullptr;
}

/// All numbers in [0, 255] that have a meaning now.
template <class E>
Numbers numbers_of() {
  Numbers numbers;
  for (int number = 0; number < 256; ++number)
    if (const char* name = name_in_file(static_cast<E>(number))) numbers[number] = name;
  return numbers;
}

TEST(StoredNumbers, OfIntegratorsKeepTheirMeaning) {
  EXPECT_EQ(numbers_of<Integrator>(), (Numbers{{2, "backward_euler"}, {4, "leapfrog"}, {5, "sdirk2"}}));
  const Numbers retired{{0, "automatic"}, {1, "symplectic Euler"}, {3, "extrapolated Euler"}};
  for (int number = 0; number < 256; ++number) {
    const char* name = recordings::session_file::retired_integrator(number);
    EXPECT_EQ(name != nullptr, retired.contains(number)) << number;
    if (!name) continue;
    EXPECT_EQ(name, retired.at(number));
    EXPECT_EQ(name_in_file(static_cast<Integrator>(number)), nullptr) << number << " is used again";
  }
}

TEST(StoredNumbers, OfToolsKeepTheirMeaning) {
  EXPECT_EQ(numbers_of<ToolKind>(), (Numbers{{0, "ball"}, {1, "scalpel"}, {2, "pin"}}));
}

TEST(StoredNumbers, OfAxialLawsKeepTheirMeaning) {
  EXPECT_EQ(numbers_of<AxialLaw>(), (Numbers{{0, "spring"}, {1, "kelvin_unit"}, {2, "two_sphere_tpm"}}));
}

TEST(StoredNumbers, OfStepReportsKeepTheirMeaning) {
  EXPECT_EQ(numbers_of<stepping::StepStatus>(),
            (Numbers{{0, "ok"}, {1, "not_converged"}, {2, "bad_input"}, {3, "diverged"}, {4, "too_long"}}));
}

TEST(StoredNumbers, OfEventsKeepTheirMeaning) {
  EXPECT_EQ(numbers_of<recordings::EventKind>(), (Numbers{{1, "contact_begins"},
                                                          {2, "contact_ends"},
                                                          {3, "cut"},
                                                          {4, "damage"},
                                                          {5, "late_tick"},
                                                          {6, "device_lost"},
                                                          {7, "device_back"},
                                                          {8, "note"},
                                                          {9, "piece_came_loose"},
                                                          {10, "press_reached_force"},
                                                          {11, "press_gave_up"},
                                                          {12, "step_refused"},
                                                          {13, "turned_inside_out"},
                                                          {14, "came_back"}}));
}

// A session from before these fields has none of them and gets the defaults: the constants that its program computed
// with. Since physics revision 4 the first three of a tool mean something else.
TEST(StoredNumbers, DefaultsOfFieldsThatEarlierSessionsLackAreForEver) {
  const Model model;
  EXPECT_EQ(model.contact_damping, 50);
  EXPECT_EQ(model.cut_face_stiffening, 8);
  EXPECT_EQ(model.tissue_cells.size(), 0u);
  EXPECT_EQ(model.inversion_threshold, 0.4);
  EXPECT_EQ(model.hands, 1);
  const Tool tool;
  EXPECT_EQ(tool.trail_distance, 0.2e-3);
  EXPECT_EQ(tool.blade_reach, 15e-3);
  EXPECT_EQ(tool.blade_reach_spacings, 1.5);
  EXPECT_EQ(tool.flank_height, 6e-3);
  EXPECT_EQ(tool.blade_thickness, 1e-3);
  EXPECT_EQ(tool.slowest_slip, 1e-3);
}

TEST(StoredNumbers, OfFieldTypesKeepTheirMeaning) {
  EXPECT_EQ(numbers_of<FieldType>(),
            (Numbers{{1, "u8"}, {2, "i32"}, {3, "u32"}, {4, "i64"}, {5, "u64"}, {6, "f64"}, {7, "text"}, {8, "list"}}));
}

}  // namespace
}  // namespace ctpm
