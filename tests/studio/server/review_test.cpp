// What a client of the protocol sees of a session.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "core/contact/drawn_surfaces.h"
#include "recordings/replay.h"
#include "recordings/session_reader.h"
#include "studio/film/reel.h"
#include "studio/film/session_film.h"
#include "studio/render/renderer.h"
#include "studio/views/look.h"
#include "studio/views/view_of_scene.h"
#include "tests/studio/commands/running_program.h"
#include "tests/studio/server/reviewing.h"
#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::kCut, testing::kPress;
using testing::Reviewing;
using testing::Serving;
using testing::SocketClient;
using testing::value_at;

constexpr std::size_t kFrameHead = 128;

std::string frame_of(SocketClient& client, std::int64_t tick, std::uint32_t request) {
  client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", request}}}});
  for (;;) {
    std::string frame = client.frame();
    if (value_at<std::uint32_t>(frame, 16) == request) return frame;
  }
}

TEST_F(Reviewing, AFrameIsTheReplayedMoment) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json opened = client.call("session.open", {{"path", kPress}, {"stage", 0}});
  ASSERT_TRUE(opened.contains("result")) << opened;

  auto reader = recordings::SessionReader::open(file(kPress));
  const std::int64_t end = reader->tick_count();
  EXPECT_EQ(opened["result"]["info"]["ticks"], end);
  auto cursor = recordings::ReplayCursor::create(*reader);
  std::uint32_t request = 0;
  // Forwards, backwards, onto a keyframe, to both ends.
  for (const std::int64_t tick : {std::int64_t{1500}, std::int64_t{1510}, std::int64_t{900}, std::int64_t{2000},
                                  std::int64_t{1}, end, std::int64_t{0}}) {
    const std::string frame = frame_of(client, tick, ++request);
    ASSERT_TRUE(cursor->seek(std::max<std::int64_t>(0, tick - 1)));
    if (tick > 0) {
      ASSERT_TRUE(cursor->step());
    }
    EXPECT_EQ(value_at<double>(frame, 32), double(tick));
    EXPECT_EQ(value_at<std::uint32_t>(frame, 20) & 1u, 1u);
    const Vec3 force = tick > 0 ? cursor->report().tool_force : Vec3{};
    EXPECT_FLOAT_EQ(value_at<float>(frame, 72), float(force.x));
    EXPECT_FLOAT_EQ(value_at<float>(frame, 80), float(force.z));
    if (tick > 0) {
      EXPECT_FLOAT_EQ(value_at<float>(frame, 84), float(cursor->report().depth));
    }
    // Positions are exact to half a step of 16 bits in their box.
    const Model& model = reader->start().model;
    std::vector<Vec3> vertex;
    contact::DrawnSurfaces(model).place(0, model.surfaces[0], cursor->state(), vertex);
    ASSERT_EQ(value_at<std::uint32_t>(frame, 124), 1u);
    ASSERT_EQ(value_at<std::uint32_t>(frame, kFrameHead), vertex.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double least = value_at<float>(frame, kFrameHead + 4 + 4 * axis);
      const double size = value_at<float>(frame, kFrameHead + 16 + 4 * axis);
      double worst = 0;
      for (std::size_t v = 0; v < vertex.size(); ++v) {
        const double at = least + size * value_at<std::uint16_t>(frame, kFrameHead + 28 + 2 * (3 * v + axis)) / 65535;
        const double exact = axis == 0 ? vertex[v].x : axis == 1 ? vertex[v].y : vertex[v].z;
        worst = std::max(worst, std::abs(at - exact));
      }
      EXPECT_LT(worst, 0.51 * size / 65535 + 1e-8) << "tick " << tick;
    }
  }
}

TEST_F(Reviewing, ABladesDepthIsWhatTheTableOfAReplaySays) {
  ASSERT_EQ(testing::run_ctpm({"replay", kCut, "--csv", "replay.csv"}, folder_.path()).code, 0);
  std::ifstream table(file("replay.csv"));
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> head = cells_of(line);
  const auto column = std::size_t(std::find(head.begin(), head.end(), "blade_depth_mm") - head.begin());
  ASSERT_LT(column, head.size()) << line;
  std::vector<double> depth;  // of each tick [mm]
  while (std::getline(table, line)) depth.push_back(std::stod(cells_of(line)[column]));
  const auto deepest = std::max_element(depth.begin(), depth.end()) - depth.begin();
  EXPECT_GT(depth[std::size_t(deepest)], 5);

  const Serving serving(folder_.path());
  SocketClient client(serving);
  ASSERT_TRUE(client.call("session.open", {{"path", kCut}, {"stage", 0}}).contains("result"));
  std::uint32_t request = 0;
  for (const std::int64_t tick : {std::int64_t(deepest), std::int64_t(deepest / 2), std::int64_t(0)})
    EXPECT_NEAR(1e3 * value_at<float>(frame_of(client, tick + 1, ++request), 84), depth[std::size_t(tick)], 1e-3);
  // A curve of what balls press has a gap there.
  const nlohmann::json curve = client.call("session.timeline", {{"path", kCut}, {"points", 500}})["result"]["depth_m"];
  EXPECT_TRUE(curve[curve.size() * std::size_t(deepest) / depth.size()].is_null()) << curve;
}

TEST_F(Reviewing, TrianglesComeBeforeTheirFrameAndOnlyWhenACutChangedThem) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  client.call("session.open", {{"path", kCut}, {"stage", 0}});
  std::map<std::uint32_t, std::string> triangles;  // by topology
  std::vector<std::uint32_t> shown;                // number of triangles, each time that others came
  std::uint32_t request = 0, present = 0;
  int frames = 0;
  for (const int tick : {100, 200, 300, 4900, 5000, 100}) {
    client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", ++request}}}});
    for (bool done = false; !done;) {
      const auto message = client.receive();
      ASSERT_FALSE(message.is_text) << message.bytes;
      const std::uint32_t kind = value_at<std::uint32_t>(message.bytes, 0),
                          topology = value_at<std::uint32_t>(message.bytes, 8);
      if (kind == 1) {
        EXPECT_NE(topology, present);
        present = topology;
        if (const auto before = triangles.find(topology); before != triangles.end()) {
          EXPECT_EQ(before->second, message.bytes);  // the number means the same triangles
        }
        triangles[topology] = message.bytes;
        shown.push_back(value_at<std::uint32_t>(message.bytes, 16 + 8));
      } else if (kind == 2) {
        EXPECT_EQ(topology, present);
        if (SocketClient::is_glimpse(message.bytes)) continue;
        ++frames;
        done = value_at<std::uint32_t>(message.bytes, 16) == request;
      }
    }
  }
  EXPECT_EQ(frames, 6);
  // Whole, cut, whole again; a glimpse may come where the cut is not yet finished.
  ASSERT_GE(shown.size(), 3u);
  EXPECT_EQ(shown.front(), shown.back());
  EXPECT_GT(*std::max_element(shown.begin(), shown.end()), shown.front());
  EXPECT_EQ(value_at<std::uint32_t>(triangles.begin()->second, 16 + 8), shown.front());
  // The outside of what is cut has triangles of its own, and shines as the whole organ does: its normals are corrected.
  for (const auto& [topology, message] : triangles) {
    const auto head = [&](std::size_t n) { return std::size_t(value_at<std::uint32_t>(message, 16 + 4 * n)); };
    const std::size_t vertices = head(0), outer = head(1), at = 32 + 12 * head(2) + (2 * vertices + 3) / 4 * 4;
    const std::size_t corrected = value_at<std::uint32_t>(message, at);
    EXPECT_EQ(corrected, head(2) == shown.front() ? 0 : outer) << "topology " << topology;
    EXPECT_EQ(message.size(), at + 4 + 4 * corrected + (2 * corrected + 3) / 4 * 4);
  }
}

TEST_F(Reviewing, TheReplayFollowsAGlimpseWhetherOrNotThePageSaysThatItIsDrawn) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  client.call("session.open", {{"path", kPress}, {"stage", 0}});
  std::uint32_t request = 0;
  int glimpses = 0;
  // A page that never says it, one that does, and one that no longer does, as if it were hidden.
  for (const auto& [tick, says_so] : {std::pair{1720, false}, std::pair{2720, true}, std::pair{820, false}}) {
    client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", ++request}}}});
    std::string frame = client.any_frame();
    if (SocketClient::is_glimpse(frame)) {
      ++glimpses;
      if (says_so) client.send({{"ready", {{"stage", 0}, {"request", request}}}});
      frame = client.frame();
    }
    EXPECT_EQ(value_at<std::uint32_t>(frame, 16), request);
    EXPECT_EQ(value_at<double>(frame, 32), double(tick));
  }
  EXPECT_GT(glimpses, 0);
}

TEST_F(Reviewing, AGlimpseIsAtTheRecordedPoseAndTheReplayFollows) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  client.call("session.open", {{"path", kPress}, {"stage", 0}});
  auto reader = recordings::SessionReader::open(file(kPress));
  const std::int64_t tick = 1720;  // far from a keyframe
  client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", 1}}}});
  const std::string glimpse = client.any_frame(), replayed = client.frame();
  ASSERT_TRUE(SocketClient::is_glimpse(glimpse));
  const recordings::TickRecord record = reader->ticks(tick - 1, tick)->front();
  for (const std::string* frame : {&glimpse, &replayed}) {
    EXPECT_EQ(value_at<std::uint32_t>(*frame, 16), 1u);
    EXPECT_EQ(value_at<double>(*frame, 32), double(tick));
    EXPECT_EQ(value_at<std::int32_t>(*frame, 40), record.inputs.tool);
    EXPECT_EQ(value_at<float>(*frame, 52), float(record.inputs.position.z));
    EXPECT_EQ(value_at<float>(*frame, 80), float(record.tool_force.z));
    EXPECT_EQ(value_at<float>(*frame, 84), float(record.depth));
  }
  ASSERT_EQ(glimpse.size(), replayed.size());
  EXPECT_NE(glimpse.substr(kFrameHead), replayed.substr(kFrameHead));
  // The moment was kept: asked again, it is replayed at once. Of a moment that is not kept a glimpse always comes
  // first; of a kept one it comes only where other programs hold up its picture, so that one of several is enough.
  bool was_kept = false;
  for (std::uint32_t request = 2; request < 40 && !was_kept; request += 2) {
    frame_of(client, 3000, request);
    client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", request + 1}}}});
    std::string frame = client.any_frame();
    was_kept = !SocketClient::is_glimpse(frame);
    if (!was_kept) frame = client.frame();
    EXPECT_EQ(value_at<std::uint32_t>(frame, 16), request + 1);
  }
  EXPECT_TRUE(was_kept);
}

TEST_F(Reviewing, APageThatDoesNotReadHoldsUpNobodyAndIsToldWhatItMissed) {
  const Serving serving(folder_.path());
  SocketClient slow(serving), other(serving);
  slow.keep_little();
  slow.call("session.open", {{"path", kPress}, {"stage", 0}});
  other.call("session.open", {{"path", kPress}, {"stage", 0}});
  std::uint32_t request = 0;
  for (int i = 0; i < 400; ++i) {
    slow.send({{"show", {{"stage", 0}, {"tick", 1000 + i % 100}, {"request", ++request}}}});
    frame_of(other, 1000 + i % 100, request);  // the moment is replayed by now
  }
  std::uint64_t missed = 0, frames = 0, newest = 0;
  while (newest < 400) {
    const std::string frame = slow.any_frame();
    ++frames, missed += value_at<std::uint32_t>(frame, 12);
    newest = std::max<std::uint64_t>(newest, value_at<std::uint32_t>(frame, 16));
  }
  EXPECT_LT(frames, 400u);
  EXPECT_GE(frames, 1u);
  EXPECT_GT(missed, 0u);  // of those that were made and never sent
  std::printf("%d frames came, %d were missed\n", int(frames), int(missed));
}

TEST_F(Reviewing, TimelineInfoAndComparisonAreThoseOfTheCommands) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const nlohmann::json timeline = client.call("session.timeline", {{"path", kPress}, {"points", 500}})["result"];
  const testing::ProgramOutcome info = testing::run_ctpm({"info", kPress, "--json"}, folder_.path());
  const nlohmann::json said = nlohmann::json::parse(info.out);
  const auto most = [&](const char* key) {
    double value = 0;
    for (const double v : timeline[key]) value = std::max(value, v);
    return value;
  };
  EXPECT_FLOAT_EQ(most("force_n"), said["max_force_n"].get<double>());
  EXPECT_FLOAT_EQ(most("depth_m"), said["max_depth_m"].get<double>());
  EXPECT_EQ(client.call("session.open", {{"path", kPress}})["result"]["info"], said);

  const nlohmann::json compared = client.call("session.compare", {{"expert", kCut}, {"trainee", kCut}})["result"];
  const testing::ProgramOutcome compare = testing::run_ctpm({"compare", kCut, kCut, "--json"}, folder_.path());
  nlohmann::json page = compared["comparison"], command = nlohmann::json::parse(compare.out);
  for (nlohmann::json* json : {&page, &command}) (*json)["expert"].erase("file"), (*json)["trainee"].erase("file");
  EXPECT_EQ(nlohmann::json::diff(page, command).dump(), "[]");

  const nlohmann::json verdict = client.call("session.verify", {{"path", kCut}})["result"];
  const testing::ProgramOutcome verify = testing::run_ctpm({"verify", kCut}, folder_.path());
  EXPECT_NE(verify.out.find(verdict["text"].get<std::string>()), std::string::npos) << verify.out;
}

TEST_F(Reviewing, NotesLieBesideTheSessionWhichNeverChanges) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  const std::string before = testing::slurp(file(kCut));
  const nlohmann::json none = client.call("notes.read", {{"path", kCut}})["result"];
  EXPECT_EQ(none["notes"].size(), 0u);
  const nlohmann::json notes = {{{"time_s", 1.25}, {"text", "too \"deep\" <b>here</b>\n\xc3\xa4"}}};
  const nlohmann::json written =
      client.call("notes.write", {{"path", kCut}, {"revision", none["revision"]}, {"notes", notes}});
  ASSERT_TRUE(written.contains("result")) << written;
  EXPECT_EQ(client.call("notes.read", {{"path", kCut}})["result"]["notes"], notes);
  // Who read an older version does not overwrite the newer one.
  EXPECT_TRUE(
      client.call("notes.write", {{"path", kCut}, {"revision", none["revision"]}, {"notes", nlohmann::json::array()}})
          .contains("errors"));
  EXPECT_EQ(client.call("notes.read", {{"path", kCut}})["result"]["notes"], notes);
  EXPECT_EQ(testing::slurp(file(kCut)), before);
  EXPECT_TRUE(fs::exists(folder_.path() / "kidney-cut-expert.notes.json"));
  // A broken file is named, and left alone.
  std::ofstream(folder_.path() / "liver-press-expert.notes.json") << "{";
  const nlohmann::json broken = client.call("notes.read", {{"path", kPress}});
  EXPECT_NE(broken["errors"].dump().find("liver-press-expert.notes.json"), std::string::npos) << broken;
  EXPECT_TRUE(
      client.call("notes.write", {{"path", kPress}, {"revision", "none"}, {"notes", notes}}).contains("errors"));
  EXPECT_EQ(testing::slurp(folder_.path() / "liver-press-expert.notes.json"), "{");
}

TEST_F(Reviewing, OfTwoThatWriteNotesAtTheSameTimeOneIsRefused) {
  const Serving serving(folder_.path());
  SocketClient clients[2] = {SocketClient(serving), SocketClient(serving)};
  for (int round = 0; round < 20; ++round) {
    const nlohmann::json revision = clients[0].call("notes.read", {{"path", kCut}})["result"]["revision"];
    nlohmann::json answers[2];
    const auto write = [&](int who) {
      const nlohmann::json notes = {{{"time_s", who}, {"text", std::to_string(round) + " by " + std::to_string(who)}}};
      answers[who] = clients[who].call("notes.write", {{"path", kCut}, {"revision", revision}, {"notes", notes}});
    };
    std::thread first(write, 0);
    write(1), first.join();
    ASSERT_NE(answers[0].contains("result"), answers[1].contains("result")) << answers[0] << answers[1];
    const nlohmann::json& written = answers[answers[0].contains("result") ? 0 : 1];
    EXPECT_EQ(clients[0].call("notes.read", {{"path", kCut}})["result"], written["result"]);
  }
}

/// The picture of a moment as the program draws it.
std::string drawing_of(SocketClient& client, std::int64_t tick, std::uint32_t request) {
  client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", request}}}});
  for (;;)
    if (const auto message = client.receive(); !message.is_text && value_at<std::uint32_t>(message.bytes, 0) == 5)
      return message.bytes;
}

TEST_F(Reviewing, ADrawingIsWhatAVideoShows) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  client.call("session.open", {{"path", kCut}, {"stage", 0}});
  const std::int64_t tick = 2600;
  auto reader = recordings::SessionReader::open(file(kCut));
  auto film = film::SessionFilm::create(*reader, {tick - 1, tick}, false);
  ASSERT_TRUE(film);
  const auto shot = (*film)->shoot(tick);
  ASSERT_TRUE(shot);
  const auto late = reader->keyframe_at_or_before(reader->tick_count());
  ASSERT_TRUE(late);
  render::SceneView view = views::view_of((*film)->scene(), (*film)->model());
  auto renderer = render::Renderer::create(320, 180, view);
  std::uint32_t number = 0;
  // Following, one that the program chooses, one that a reviewer turned, a section at a place.
  for (const views::LookRequest& request : {views::LookRequest{"elements", "force", 0, "y", "follow"},
                                            {"both", "", 0, "", ""},
                                            {"spheres", "", 0, "", "-80,-250,200:0,0,20"},
                                            {"spheres", "", 0, "y=-6.5", ""}}) {
    const nlohmann::json answer = client.call("session.draw", {{"stage", 0},
                                                               {"size", "320x180"},
                                                               {"view", request.view},
                                                               {"by", request.by},
                                                               {"cutaway", request.cutaway},
                                                               {"camera", request.camera}});
    ASSERT_TRUE(answer.contains("result")) << answer;
    const std::string drawing = drawing_of(client, tick, ++number);
    EXPECT_EQ(value_at<std::uint32_t>(drawing, 8), number);
    EXPECT_EQ(value_at<std::uint32_t>(drawing, 12), 320u);
    EXPECT_EQ(value_at<std::uint32_t>(drawing, 16), 180u);
    views::LookRequest in_a_film = request;  // elements have the colours of the whole session
    if (request.view == "elements") {
      in_a_film.full_scale = *film::full_scale_of({&*reader}, render::ElementQuantity::force);
      EXPECT_GT(in_a_film.full_scale, 0);
      EXPECT_NE(in_a_film.full_scale, render::default_full_scale(render::ElementQuantity::force));
    }
    const auto found = views::find_look(in_a_film, (*film)->scene(), view, 320.0 / 180, &late->state);
    ASSERT_TRUE(found);
    const render::Frame frame = (*renderer)->draw(shot->state, found->at(view, shot->moments));
    EXPECT_TRUE(drawing.substr(20, frame.rgb.size()) == std::string(frame.rgb.begin(), frame.rgb.end()))
        << request.view << " from " << found->camera;
    EXPECT_EQ(answer["result"]["camera"]["name"], found->camera);
    EXPECT_EQ(answer["result"]["camera"]["eye"][0], found->draw.camera.eye.x);
  }
  // Without a size the page draws, and is told from where.
  const nlohmann::json page = client.call("session.draw", {{"stage", 0}});
  EXPECT_EQ(page["result"]["camera"]["name"], "wound") << page;
  client.send({{"show", {{"stage", 0}, {"tick", tick}, {"request", ++number}}}});
  EXPECT_EQ(value_at<std::uint32_t>(client.receive().bytes, 0), 2u);

  const nlohmann::json wrong = client.call("session.draw", {{"stage", 0}, {"size", "320x180"}, {"camera", "none"}});
  EXPECT_NE(wrong.dump().find("no camera 'none'"), std::string::npos) << wrong;
  EXPECT_TRUE(client.call("session.draw", {{"stage", 0}, {"size", "8192x64"}}).contains("errors"));
  EXPECT_TRUE(client.call("session.draw", {{"stage", 2}, {"size", "320x180"}}).contains("errors"));
}

TEST_F(Reviewing, APressIsSeenFromWhereAFilmSeesIt) {
  const Serving serving(folder_.path());
  SocketClient client(serving);
  client.call("session.open", {{"path", kPress}, {"stage", 0}});
  auto reader = recordings::SessionReader::open(file(kPress));
  const session::TickRange whole{0, reader->tick_count()};
  auto film = film::SessionFilm::create(*reader, whole, false);
  const auto all = film::all_moments(*reader, whole);
  ASSERT_TRUE(film && all);
  const auto told = film::telling_state(*reader, whole, *all);
  ASSERT_TRUE(told);
  const render::SceneView view = views::view_of((*film)->scene(), (*film)->model());
  const auto found = views::find_look({}, (*film)->scene(), view, 16.0 / 9, &*told);
  ASSERT_TRUE(found);
  for (int i = 0; i < 2; ++i) {
    const nlohmann::json page = client.call("session.draw", {{"stage", 0}});
    EXPECT_EQ(page["result"]["camera"]["name"], "press") << page;
    EXPECT_EQ(page["result"]["camera"]["eye"][0], found->draw.camera.eye.x);
  }
}

TEST_F(Reviewing, ADamagedSessionIsSaidSo) {
  const Serving serving(folder_.path());
  std::ofstream(folder_.path() / "broken.ctpm") << "this is no session";
  SocketClient client(serving);
  EXPECT_TRUE(client.call("session.open", {{"path", "broken.ctpm"}, {"stage", 0}}).contains("errors"));
  EXPECT_TRUE(client.call("session.open", {{"path", "none.ctpm"}, {"stage", 0}}).contains("errors"));
  EXPECT_TRUE(client.call("session.open", {{"path", kCut}, {"stage", 0}}).contains("result"));
}

TEST(StudioProgram, PrintsItsAddressOpensItAndEndsByCtrlC) {
  const testing::TemporaryFolder folder;
  // What a desktop opens addresses with.
  const fs::path opener = folder.path() / "xdg-open", opened = folder.path() / "opened";
  std::ofstream(opener) << "#!/bin/sh\necho \"$1\" >" << opened.string() << ".part; mv " << opened.string() << ".part "
                        << opened.string() << "\n";
  fs::permissions(opener, fs::perms::owner_all);
  setenv("DISPLAY", ":0", 1);
  setenv("PATH", (folder.path().string() + ":" + getenv("PATH")).c_str(), 1);
  testing::RunningProgram program({"studio", "--port", "0"}, folder.path());
  EXPECT_TRUE(program.wait_until([&] { return fs::exists(opened); }));
  program.interrupt();
  const testing::ProgramOutcome ended = program.outcome();
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(ended.out.starts_with("http://127.0.0.1:")) << ended.out;
  EXPECT_EQ(testing::slurp(opened), ended.out);
  const testing::ProgramOutcome missing = testing::run_ctpm({"studio", "nowhere", "--no-open"}, folder.path());
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("nowhere: error: does not exist"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace ctpm
