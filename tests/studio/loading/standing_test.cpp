// Settling, with the tools on the table and laid aside.

#include "studio/loading/standing.h"

#include <gtest/gtest.h>

#include "recordings/state_hash.h"
#include "scenes/script.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/script_trial.h"
#include "studio/loading/tick_time.h"

namespace ctpm {
namespace {

loading::LoadedScene kidney() {
  Result<loading::LoadedScene> loaded = loading::load_whole_scene(std::string(CTPM_SOURCE_DIR) + "/scenes/kidney.json");
  if (!loaded) throw std::runtime_error(loaded.errors().front().message);
  loaded->scene.spec.settle = 0.4;
  return *std::move(loaded);
}

TEST(Standing, IsTheSameToTheBitWithTheToolsLaidAside) {
  loading::LoadedScene scene = kidney();
  Model& model = scene.built.model;
  ASSERT_TRUE(model.has_scalpel());
  const std::size_t tools = model.tools.size();
  const scenes::SceneSpec& spec = scene.scene.spec;
  const auto with = loading::settle_scene(spec, model), without = loading::settle_without_tools(spec, model);
  ASSERT_TRUE(with && without);
  EXPECT_EQ(recordings::state_hash(with->state), recordings::state_hash(without->state))
      << "and what a later cut needs in State is there";
  EXPECT_NE(recordings::state_hash(without->state), recordings::state_hash(rest_state(model)));
  EXPECT_EQ(model.tools.size(), tools);
  const std::vector<std::string> names{model.tools.front().name, model.tools.back().name};
  EXPECT_GT(loading::measure_tick_work(model).value_or(0), 0);
  EXPECT_EQ(model.tools.size(), tools);
  EXPECT_EQ(names, (std::vector<std::string>{model.tools.front().name, model.tools.back().name}));
}

TEST(ScriptTrial, DoesNotDependOnWhatItsStepperDidBefore) {
  loading::LoadedScene scene = kidney();
  Model& model = scene.built.model;
  const auto standing = loading::settle_without_tools(scene.scene.spec, model);
  ASSERT_TRUE(standing);
  const scenes::Script script =
      scenes::organ_script(scene.scene.spec, std::span<const FilledOrgan>(scene.organs), 0, {});
  stepping::Stepper stepper(model), fresh(model);
  const auto first = loading::try_script(model, stepper, standing->state, script, 0);
  const auto again = loading::try_script(model, stepper, standing->state, script, 0);
  const auto other = loading::try_script(model, fresh, standing->state, script, 0);
  ASSERT_TRUE(first && again && other);
  EXPECT_GT(first->severed, 0);
  for (const auto& trial : {again, other}) {
    EXPECT_EQ(trial->most_force, first->most_force);
    EXPECT_EQ(trial->severed, first->severed);
    EXPECT_EQ(trial->was_cut, first->was_cut);
    EXPECT_GT(trial->dearest_work, trial->usual_work);
  }
}

}  // namespace
}  // namespace ctpm
