#include "studio/render/overlay.h"
#include "studio/render/plain_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/studio/render/glyph_reader.h"

namespace ctpm {
namespace {

render::OverlayData full_data() {
  render::OverlayData data;
  data.title = "Liver", data.model = "CTPM", data.session = "press";
  data.time = 12.345, data.tick = 12345, data.hand = {1.234, 0.0134}, data.damage_depth = 0.012;
  data.loose = 2, data.inside_out = 3, data.caption = "scalpel cuts";
  data.verdict = "Replay identical: 12345 of 12345 ticks", data.verdict_tone = render::VerdictTone::good;
  data.legend = {"stretch [%]", "-20", "+20", {{0.1, 0.2, 0.7}, {0.8, 0.8, 0.8}, {0.8, 0.1, 0.1}}, false};
  for (int i = 0; i <= 12345; i += 5) data.history.push_back({i * 1e-3, 1 + std::sin(i * 0.003)});
  return data;
}

TEST(PlainText, HasTheLettersOfPictures) {
  EXPECT_EQ(render::plain_text("kidney 3, 4.5 N"), "kidney 3, 4.5 N");
  EXPECT_EQ(render::plain_text("Jörg Müller – erster"), "Jorg Muller - erster");
  EXPECT_EQ(render::plain_text("Łukasz, Åse, François, Ștefan, Đặng"), "Lukasz, Ase, Francois, Stefan, Dang");
  EXPECT_EQ(render::plain_text("Печень"), "Pecen'");
  EXPECT_EQ(render::plain_text("肝"), "gan");
  EXPECT_EQ(render::plain_text("a \xf0\x9f\xab\x80"), "a ?") << "one sign for a letter without a form";
  EXPECT_EQ(render::plain_text("\xff"), "?") << "no UTF-8";
}

TEST(Overlay, TextsNeitherOverlapNorLeaveThePicture) {
  render::OverlayData long_winded = full_data();
  long_winded.title = std::string(200, 'W'), long_winded.verdict = std::string(300, 'M');
  long_winded.caption = std::string(100, 'W') + " " + std::string(99, 'W');
  long_winded.tick = 999999999, long_winded.time = 99999.999, long_winded.hand.force = 12345.678;
  render::OverlayData two_hands = long_winded;
  two_hands.second = render::HandLoad{12345.678, 0.0134, true}, two_hands.slip = 99.9;
  render::OverlayData blade = full_data();
  blade.hand.is_blade = true, blade.hand.depth = 0.01855, blade.slip = 12.3;
  blade.role = "trainee", blade.ghost = "kidney-cut-expert";
  blade.marks = {{{0.5, 0.75, 1}, "the expert's cut", true}, {{1, 0.7, 0.36}, "cut where the expert did not"}};
  for (const auto& [width, height] :
       {std::pair{1280, 720}, {640, 360}, {1920, 1080}, {1080, 1080}, {854, 480}, {640, 720}, {360, 640}})
    for (const render::OverlayData& data : {full_data(), long_winded, two_hands, blade}) {
      render::Overlay overlay(width, height);
      const auto texts = overlay.layout(data);
      EXPECT_GT(texts.size(), 10u);
      for (std::size_t i = 0; i < texts.size(); ++i) {
        const render::PixelBox& box = texts[i].box;
        EXPECT_TRUE(box.x >= 0 && box.y >= 0 && box.x + box.width <= width && box.y + box.height <= height)
            << texts[i].text;
        // Two of a row have a letter's room between them, where numbers are of this world.
        const int room = data.hand.force < 1e3 ? box.height / 3 : 0;
        const render::PixelBox wider{box.x - room, box.y, box.width + 2 * room, box.height};
        for (std::size_t j = 0; j < i; ++j)
          EXPECT_FALSE(wider.overlaps(texts[j].box))
              << texts[i].text << " and " << texts[j].text << " at " << width << "x" << height;
      }
    }
}

TEST(Overlay, ACaptionHasTheRoomBesideThePlot) {
  render::OverlayData data = full_data();
  data.caption = "tissue damage: deeper than 12 mm", data.legend = {};
  for (const auto& [width, height] : {std::pair{1280, 720}, {1920, 1080}}) {
    render::Overlay overlay(width, height);
    EXPECT_TRUE(std::ranges::any_of(overlay.layout(data), [&](const auto& text) { return text.text == data.caption; }));
    data.caption.resize(20);  // what fits stands in the middle
    for (const render::PlacedText& text : overlay.layout(data))
      if (text.text == data.caption) {
        EXPECT_NEAR(text.box.x + 0.5 * text.box.width, 0.5 * width, 2);
      }
    data.caption = "tissue damage: deeper than 12 mm";
  }
}

TEST(Overlay, ACaptionThatIsTooLongForALineHasTwo) {
  render::OverlayData told = full_data();
  told.caption = "cut where the expert did not: 12 elements, limit 0 elements";
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 720}, {240, 270}}) {
    std::string said;
    for (const render::PlacedText& text : render::Overlay(width, height).layout(told)) said += text.text + " ";
    EXPECT_NE(said.find(told.caption), std::string::npos) << width << ": " << said;
  }
  render::OverlayData data = full_data();
  data.caption = "3.10 s  tissue damage: deeper than 12 mm", data.level = render::OverlayLevel::caption;
  render::Overlay overlay(320, 240, 1.4);  // a picture of a contact sheet
  const auto texts = overlay.layout(data);
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0].text + " " + texts[1].text, data.caption);
  EXPECT_LE(texts[0].box.y + texts[0].box.height, texts[1].box.y);
  EXPECT_LE(texts[1].box.y + texts[1].box.height, 240);
  for (const render::PlacedText& text : texts) EXPECT_TRUE(text.box.x >= 0 && text.box.x + text.box.width <= 320);
}

TEST(Overlay, WhatStandsBelowLeavesTheCornerToSmallPictures) {
  render::OverlayData data = full_data();
  data.worst.depth = 0.0186, data.caption = "tissue damage: deeper than 12 mm", data.taken_right = 360;
  int warnings = 0;
  for (const render::PlacedText& text : render::Overlay(1280, 720).layout(data)) {
    if (text.box.y < 360) continue;
    EXPECT_LE(text.box.x + text.box.width, 1280 - 360) << text.text;
    warnings += text.text == "TISSUE DAMAGE: 18.6 mm, limit 12.0 mm";
  }
  EXPECT_EQ(warnings, 1) << "and none is cut";
}

TEST(Overlay, AGhostIsNamedInItsColour) {
  render::OverlayData data = full_data();
  data.ghost = "kidney-cut-expert";
  render::Frame frame = render::blank_frame(1280, 720, 120, 130, 140);
  render::Overlay(1280, 720).draw(frame, data);
  int named = 0, blue = 0;
  for (const render::PlacedText& text : render::Overlay(1280, 720).layout(data)) {
    if (text.text != data.ghost) continue;
    ++named;
    for (int y = text.box.y; y < text.box.y + text.box.height; ++y)
      for (int x = text.box.x; x < text.box.x + text.box.width; ++x) {
        const std::uint8_t* p = &frame.rgb[std::size_t(y * 1280 + x) * 3];
        blue += p[2] > p[0] + 80;
      }
  }
  EXPECT_EQ(named, 1);
  EXPECT_GT(blue, 200);
}

TEST(Overlay, TimeThatTheSessionLostIsShown) {
  render::Overlay overlay(1280, 720);
  render::OverlayData data = full_data();
  const auto is_shown = [&] {
    const auto texts = overlay.layout(data);
    const auto shows = [&](const char* text) {
      return std::ranges::any_of(texts, [&](const render::PlacedText& placed) { return placed.text == text; });
    };
    return shows("clock behind") && shows("2.32 s");
  };
  EXPECT_FALSE(is_shown());
  data.slip = 2.324;
  EXPECT_TRUE(is_shown());
}

TEST(Overlay, EveryTextLeavesInkInItsPlace) {
  render::Overlay overlay(1280, 720);
  const render::OverlayData data = full_data();
  render::Frame frame = render::blank_frame(1280, 720, 120, 130, 140);
  overlay.draw(frame, data);
  for (const render::PlacedText& text : overlay.layout(data)) {
    int least = 255, most = 0;
    for (int y = text.box.y; y < text.box.y + text.box.height; ++y)
      for (int x = text.box.x; x < text.box.x + text.box.width; ++x) {
        const int red = frame.rgb[std::size_t(y * 1280 + x) * 3], green = frame.rgb[std::size_t(y * 1280 + x) * 3 + 1];
        least = std::min(least, std::max(red, green)), most = std::max(most, std::max(red, green));
      }
    EXPECT_GT(most - least, 60) << text.text;  // white on the red warning is the faintest
  }
}

TEST(Overlay, EveryTextStandsOnAPanel) {
  for (const auto& [width, height] : {std::pair{1280, 720}, {640, 720}, {640, 360}}) {
    render::Overlay overlay(width, height);
    render::OverlayData data = full_data();
    data.history = {{12, 0.04}};  // the plot's axis has its longest numbers
    render::Frame frame = render::blank_frame(width, height, 255, 255, 255);
    overlay.draw(frame, data);
    for (const render::PlacedText& text : overlay.layout(data))
      for (const int x : {text.box.x, text.box.x + text.box.width - 1})
        for (const int y : {text.box.y, text.box.y + text.box.height - 1})
          EXPECT_LT(frame.rgb[std::size_t(y * width + x) * 3 + 1], 200) << text.text << " " << width;
  }
}

/// Relative luminance (WCAG 2).
double luminance(const std::uint8_t* rgb) {
  const auto light = [](int c) {
    const double share = c / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * light(rgb[0]) + 0.7152 * light(rgb[1]) + 0.0722 * light(rgb[2]);
}

TEST(Overlay, EveryTextStandsOutFromItsPanel) {
  constexpr double kLegible = 4.5;  // contrast of WCAG 2, AA
  render::OverlayData data = full_data();
  data.worst.depth = 0.0186;
  for (const render::VerdictTone tone : {render::VerdictTone::good, render::VerdictTone::bad}) {
    data.verdict_tone = tone;
    render::Overlay overlay(1280, 720);
    render::Frame frame = render::blank_frame(1280, 720, 160, 172, 182);
    overlay.draw(frame, data);
    for (const render::PlacedText& text : overlay.layout(data)) {
      double darkest = 1, brightest = 0;
      for (int y = text.box.y; y < text.box.y + text.box.height; ++y)
        for (int x = text.box.x; x < text.box.x + text.box.width; ++x) {
          const double light = luminance(&frame.rgb[std::size_t(y * frame.width + x) * 3]);
          darkest = std::min(darkest, light), brightest = std::max(brightest, light);
        }
      EXPECT_GT((brightest + 0.05) / (darkest + 0.05), kLegible) << text.text;
    }
  }
}

TEST(Overlay, AWarningIsWholeInAPictureOfASheet) {
  render::OverlayData data;
  data.level = render::OverlayLevel::caption, data.verdict_tone = render::VerdictTone::bad;
  data.verdict = "TISSUE IS INSIDE OUT; replay same as recorded", data.caption = "12.34 s  ball touches the tissue";
  for (const auto& [width, height] : {std::pair{640, 480}, {852, 480}, {480, 360}}) {
    render::Overlay overlay(width, height, 1.4);
    std::string said;
    for (const render::PlacedText& text : overlay.layout(data)) {
      said += text.text + " ";
      EXPECT_LE(text.box.x + text.box.width, width) << text.text;
    }
    EXPECT_NE(said.find(data.verdict), std::string::npos) << said;
  }
}

TEST(Overlay, ItsNumbersAreReadBackFromThePicture) {
  const render_test::GlyphReader reader(1280, 720);
  render::OverlayData data = full_data();
  data.model = "CTPM", data.session = "expert-2";
  render::Overlay overlay(1280, 720);
  // Behind it a picture with much detail: stripes and blots.
  render::Frame frame = render::blank_frame(1280, 720, 0, 0, 0);
  for (std::size_t i = 0; i < frame.rgb.size(); ++i)
    frame.rgb[i] = std::uint8_t(125 + 60 * std::sin(double(i % 3840) * 0.09) * std::cos(double(i / 3840) * 0.31));
  EXPECT_EQ(reader.read_after(frame, "time"), "") << "nothing is written yet";
  overlay.draw(frame, data);
  EXPECT_EQ(reader.read_after(frame, "time"), "12.345 s");
  EXPECT_EQ(reader.read_after(frame, "tick"), "12345");
  EXPECT_EQ(reader.read_after(frame, "force"), "1.234 N");
  EXPECT_EQ(reader.read_after(frame, "depth"), "13.40 mm");
  EXPECT_EQ(reader.read_after(frame, "loose"), "2 pieces");
  EXPECT_EQ(reader.read_after(frame, "session"), "expert-2");
  EXPECT_EQ(reader.read_after(frame, "model"), "CTPM");
}

TEST(Overlay, LongNamesOfAPairCanBeToldApart) {
  const auto shown = [](const std::string& session, int width) {
    render::OverlayData data = full_data();
    data.session = session;
    const auto texts = render::Overlay(width, 720).layout(data);
    const auto label = std::find_if(texts.begin(), texts.end(), [](const auto& t) { return t.text == "session"; });
    return label == texts.end() ? "" : (label + 1)->text;
  };
  for (const int width : {1280, 640}) {
    EXPECT_EQ(shown("expert", width), "expert");
    const std::string expert = shown("kidney-cut-expert", width), clumsy = shown("kidney-cut-clumsy", width);
    EXPECT_EQ(expert, "kidney-cut-expert") << "a name is not cut where there is room";
    EXPECT_NE(expert, clumsy);
    const std::string long_name = shown("expert" + std::string(200, 'W') + "second", width);
    EXPECT_TRUE(long_name.starts_with("exp") && long_name.ends_with("nd")) << long_name;
  }
}

TEST(Overlay, WhoseHalfItIsStaysWhereAToolIsAndMarksAreNamed) {
  render::OverlayData data = full_data();
  data.role = "trainee", data.session = "ana-" + std::string(60, 'W') + "-second-try";
  data.marks = {{{0.5, 0.75, 1}, "the expert's cut", true}, {{1, 0.7, 0.36}, "cut where the expert did not"}};
  render::Overlay half(640, 720);
  render::Frame alone = render::blank_frame(640, 720, 90, 60, 50), under = alone;
  half.draw(alone, data);
  data.tools = {{60, 40, 1}, {60, 120, 1}};  // a handle in the corner of the names
  half.draw(under, data);
  const auto differs = [&](const std::string& words) {
    for (const render::PlacedText& text : half.layout(data)) {
      if (!text.text.starts_with(words)) continue;
      for (int y = text.box.y; y < text.box.y + text.box.height; ++y)
        for (int x = 3 * text.box.x; x < 3 * (text.box.x + text.box.width); ++x)
          if (const auto i = std::size_t(y * 640 * 3 + x); alone.rgb[i] != under.rgb[i]) return true;
      return false;
    }
    ADD_FAILURE() << words << " is not there";
    return false;
  };
  EXPECT_FALSE(differs("trainee"));
  EXPECT_FALSE(differs("ana-"));
  EXPECT_TRUE(differs("the expert's cut")) << "panels that the tool is behind fade";
  for (const render::PlacedText& text : half.layout(data))
    if (text.text.starts_with("ana-")) {
      EXPECT_TRUE(text.text.ends_with("try")) << text.text;
    }
  // A sample of each colour stands left of its words.
  for (const render::MarkMeaning& mark : data.marks) {
    int found = 0;
    for (const render::PlacedText& text : half.layout(data))
      for (int x = text.box.x - 40; text.text == mark.text && x < text.box.x; ++x) {
        const std::uint8_t* p = &alone.rgb[std::size_t((text.box.y + text.box.height / 3) * 640 + x) * 3];
        found += std::abs(p[0] - 255 * mark.colour[0]) < 2 && std::abs(p[2] - 255 * mark.colour[2]) < 2;
      }
    EXPECT_GT(found, 8) << mark.text;
  }
  data.level = render::OverlayLevel::none;
  EXPECT_TRUE(
      std::ranges::none_of(half.layout(data), [](const auto& text) { return text.text == "the expert's cut"; }));
}

TEST(Overlay, ShowsOnlyWhatThereIs) {
  render::Overlay overlay(1280, 720);
  render::OverlayData data = full_data();
  data.hand.depth = 0.002;
  const auto says = [&](const std::string& word) {
    for (const render::PlacedText& text : overlay.layout(data))
      if (text.text.find(word) != std::string::npos) return true;
    return false;
  };
  EXPECT_FALSE(says("DAMAGE"));
  data.hand.depth = 0.0121;
  EXPECT_TRUE(says("DAMAGE"));
  data.hand.is_blade = true;  // a cut is no damage
  EXPECT_FALSE(says("DAMAGE"));
  EXPECT_TRUE(says("deepest cut"));
  data.hand.is_blade = false;
  EXPECT_FALSE(says("deepest cut"));
  data.damage_depth = 0;  // a scene without a limit
  EXPECT_FALSE(says("DAMAGE"));
  data.damage_force = 1.2;
  EXPECT_TRUE(says("DAMAGE: 1.23 N, limit 1.20 N"));
  data.damage_force = 1.3;
  EXPECT_FALSE(says("DAMAGE"));
  EXPECT_TRUE(says("Replay identical"));
  data.verdict.clear();
  EXPECT_FALSE(says("Replay"));
  EXPECT_TRUE(says("2 pieces"));
  data.loose = 1;
  EXPECT_TRUE(says("1 piece"));
  data.loose = 0;
  EXPECT_FALSE(says("loose") || says("piece"));
  EXPECT_TRUE(says("inside out") && says("3 cells"));
  data.inside_out = 0;
  EXPECT_FALSE(says("inside out") || says("cell"));
  EXPECT_TRUE(says("12.345 s") && says("12345") && says("1.234 N") && says("12.10 mm"));
}

TEST(Overlay, ShowsForceAndDepthOfBothHands) {
  const render_test::GlyphReader reader(1280, 720);
  render::OverlayData data = full_data();
  const auto says = [&](int width, const std::string& word) {
    for (const render::PlacedText& text : render::Overlay(width, 720).layout(data))
      if (text.text.find(word) != std::string::npos) return true;
    return false;
  };
  EXPECT_FALSE(says(1280, "force 2") || says(1280, "hand 2")) << "a scene with one hand";
  data.second = render::HandLoad{0.567, 0.0089, false};
  for (render::ForcePoint& point : data.history) point.second = 0.5;
  render::Frame frame = render::blank_frame(1280, 720, 0, 0, 0);
  render::Overlay(1280, 720).draw(frame, data);
  EXPECT_EQ(reader.read_after(frame, "force"), "1.234 N");
  EXPECT_EQ(reader.read_after(frame, "force 2"), "0.567 N");
  EXPECT_EQ(reader.read_after(frame, "depth 2"), "8.90 mm");
  EXPECT_TRUE(says(640, "hand 1") && says(640, "hand 2")) << "the curves are named";
  EXPECT_TRUE(says(1280, "DAMAGE: 13.4 mm"));
  data.hand.depth = 0, data.second->depth = 0.0123;
  EXPECT_TRUE(says(1280, "DAMAGE: 12.3 mm")) << "either hand does damage";
  data.second->is_blade = true;
  EXPECT_TRUE(says(1280, "deepest 2"));
  EXPECT_FALSE(says(1280, "DAMAGE"));
}

TEST(Overlay, AWarningOfDamageStays) {
  render::OverlayData data = full_data();
  data.hand.depth = 0.002, data.worst.depth = 0.0186;
  const auto texts = render::Overlay(1280, 720).layout(data);
  EXPECT_TRUE(std::ranges::any_of(
      texts, [](const auto& placed) { return placed.text == "TISSUE DAMAGE: 18.6 mm, limit 12.0 mm"; }));
}

TEST(Overlay, LeavesOutWhatIsNotAskedForButNoBadVerdict) {
  const auto count = [](const render::OverlayData& data) { return render::Overlay(1280, 720).layout(data).size(); };
  render::OverlayData data = full_data();
  const std::size_t full = count(data);
  data.level = render::OverlayLevel::small;
  EXPECT_LT(count(data), full - 8);
  EXPECT_GT(count(data), 5u);
  data.level = render::OverlayLevel::none;
  EXPECT_EQ(count(data), 0u);
  data.verdict_tone = render::VerdictTone::bad;
  EXPECT_EQ(count(data), 1u);
}

TEST(Overlay, AToolShowsThroughThePanelBeforeItWhoseWordsAreStillRead) {
  render::OverlayData data = full_data();
  const auto change = [&](int x, int y) {
    const render::Frame before = render::blank_frame(1280, 720, 200, 120, 90);
    render::Frame frame = before;
    render::Overlay(1280, 720).draw(frame, data);
    const std::size_t i = std::size_t(y * 1280 + x) * 3;
    return std::abs(frame.rgb[i] - before.rgb[i]);
  };
  constexpr int kX = 200, kY = 31, kPlotX = 300, kPlotY = 540;  // in panels, beside letters
  const int facts = change(kX, kY), plot = change(kPlotX, kPlotY);
  ASSERT_GT(std::min(facts, plot), 80);
  data.tools = {{210, 100, 0.5}};
  EXPECT_LT(change(kX, kY), 0.5 * facts);
  render::Frame frame = render::blank_frame(1280, 720, 200, 120, 90);
  render::Overlay(1280, 720).draw(frame, data);
  const auto brightness = [&](int x, int y) { return int(frame.rgb[std::size_t(y * 1280 + x) * 3 + 1]); };
  int brightest = 0;
  for (int y = 40; y < 60; ++y)
    for (int x = 40; x < 200; ++x) brightest = std::max(brightest, brightness(x, y));
  EXPECT_GT(brightest - brightness(kX, kY), 60) << "of 255, letters before their panel";
  EXPECT_EQ(change(kPlotX, kPlotY), plot) << "the others stay";
  data.tools = {{800, 300, 0.5}};
  EXPECT_EQ(change(kX, kY), facts);
  constexpr int kVerdictX = 1255, kVerdictY = 30;
  const int verdict = change(kVerdictX, kVerdictY);
  data.tools = {{1200, 40, 0.5}};
  EXPECT_LT(change(kVerdictX, kVerdictY), 0.5 * verdict);
  data.verdict_tone = render::VerdictTone::bad;
  EXPECT_EQ(change(kVerdictX, kVerdictY), verdict) << "a bad verdict is on every frame";
}

TEST(Overlay, ACaptionOfAStillStaysBeforeATool) {
  render::OverlayData data = full_data();
  data.caption = "3.10 s", data.level = render::OverlayLevel::caption;
  render::Overlay overlay(320, 240, 1.4);
  const auto texts = overlay.layout(data);
  ASSERT_EQ(texts.size(), 1u);
  const auto drawn = [&] {
    render::Frame frame = render::blank_frame(320, 240, 200, 120, 90);
    overlay.draw(frame, data);
    return frame.rgb;
  };
  const auto alone = drawn();
  data.tools = {{texts[0].box.x + 10.0, texts[0].box.y + 5.0, 0.5}};
  EXPECT_EQ(drawn(), alone);
}

TEST(Overlay, SameDataGivesSamePixels) {
  render::Overlay one(640, 360), other(640, 360);
  render::Frame a = render::blank_frame(640, 360, 9, 9, 9), b = a, plain = a;
  render::OverlayData earlier = full_data();
  earlier.history.clear();
  one.draw(plain, earlier);
  one.draw(a, full_data()), other.draw(b, full_data());
  EXPECT_EQ(a, b);
  EXPECT_NE(a, plain);
}

}  // namespace
}  // namespace ctpm
