// What organs show where they are cut: as in a body, unless the scene says what they are made of.

#include <gtest/gtest.h>

#include "studio/views/view_of_scene.h"

namespace ctpm {
namespace {

render::OrganLook look_of(const std::string& name, std::vector<double> layer_ends = {}) {
  scenes::SceneSpec scene;
  scene.organs.emplace_back().name = name;
  for (const double end : layer_ends) scene.organs[0].layers.emplace_back().to_depth = end;
  const Model model;
  return views::view_of(scene, model).looks.at(0);
}

TEST(Anatomy, AnOrganWithoutLayersShowsThoseOfItsKindAndItsOwnInside) {
  const render::OrganLook kidney = look_of("left kidney"), skin = look_of("skin"), liver = look_of("liver");
  ASSERT_EQ(kidney.layers.size(), 2u) << "capsule and cortex, around the medulla";
  ASSERT_EQ(skin.layers.size(), 2u) << "epidermis and dermis, above the fat";
  ASSERT_EQ(liver.layers.size(), 1u);
  for (const render::OrganLook& look : {kidney, skin, liver}) {
    double end = 0;
    for (const render::LayerLook& layer : look.layers) EXPECT_GT(layer.to_depth, end), end = layer.to_depth;
    EXPECT_LT(end, 0.01);
    const scenes::OrganSpec plain;
    EXPECT_EQ(look.inner, (render::Colour{plain.inner_color.x, plain.inner_color.y, plain.inner_color.z}));
  }
  EXPECT_TRUE(look_of("block").layers.empty());
}

TEST(Anatomy, LayersOfTheSceneStay) {
  const render::OrganLook kidney = look_of("kidney", {0.002, 0.012});
  ASSERT_EQ(kidney.layers.size(), 2u);
  EXPECT_EQ(kidney.layers[0].to_depth, 0.002);
  EXPECT_EQ(kidney.layers[1].to_depth, 0.012);
}

}  // namespace
}  // namespace ctpm
