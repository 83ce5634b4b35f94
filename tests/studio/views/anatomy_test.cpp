// What organs show where they are cut: as in a body, unless the scene says what they are made of.

#include <gtest/gtest.h>

#include "studio/views/view_of_scene.h"

namespace ctpm {
namespace {

scenes::MaterialSpec preset(const std::string& name, std::optional<double> prestrain = {}) {
  scenes::MaterialSpec material;
  material.preset = name, material.prestrain = prestrain;
  return material;
}

struct Layer {
  double end = 0;  ///< [m]
  scenes::MaterialSpec material;
};

render::OrganLook look_of(const std::string& name, const std::vector<Layer>& layers = {},
                          const scenes::MaterialSpec& material = {}) {
  scenes::SceneSpec scene;
  scenes::OrganSpec& organ = scene.organs.emplace_back();
  organ.name = name, organ.material = material;
  for (const Layer& layer : layers) organ.layers.push_back({layer.end, layer.material});
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
  const render::OrganLook kidney =
      look_of("kidney", {{0.002, preset("skin")}, {0.012, preset("fat")}}, preset("kidney"));
  ASSERT_EQ(kidney.layers.size(), 2u);
  EXPECT_EQ(kidney.layers[0].to_depth, 0.002);
  EXPECT_EQ(kidney.layers[1].to_depth, 0.012);
}

TEST(Anatomy, TissueUnderMoreTensionLooksAsTheTissueBelowIt) {
  const scenes::MaterialSpec liver = preset("liver", -0.07), tense = preset("liver", 0.05);
  scenes::MaterialSpec stiff = preset("liver");
  stiff.stiffness_scale = 4;
  EXPECT_EQ(look_of("liver", {{0.012, tense}}, liver).layers, look_of("liver").layers);
  ASSERT_EQ(look_of("liver", {{0.012, stiff}}, liver).layers.size(), 1u);
  EXPECT_EQ(look_of("liver", {{0.012, stiff}}, liver).layers[0].to_depth, 0.012);
  const render::OrganLook both = look_of("liver", {{0.002, stiff}, {0.012, tense}}, liver);
  ASSERT_EQ(both.layers.size(), 1u);
  EXPECT_EQ(both.layers[0].to_depth, 0.002);
}

}  // namespace
}  // namespace ctpm
