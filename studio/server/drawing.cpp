#include "studio/server/drawing.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "scenes/scene_file.h"
#include "studio/server/message_bytes.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::server {
namespace {

struct Found {
  render::SceneView view;
  views::Look look;
};

Result<Found> find(const recordings::SessionReader& reader, const DrawingRequest& request) {
  const Result<scenes::SceneText> scene = scenes::read_scene(reader.start().scene_text, reader.path() + " (its scene)");
  if (!scene) return scene.errors();
  Found found{views::view_of(scene->spec, reader.start().model), {}};
  const double aspect = double(request.size.width) / request.size.height;
  const Result<views::Look> look = views::find_look(request.look, scene->spec, found.view, aspect);
  if (!look) return look.errors();
  found.look = *look;
  return found;
}

/// What a following camera follows: the inputs of the last moments, oldest first.
Result<std::vector<Inputs>> moments_before(recordings::SessionReader& reader, std::int64_t tick) {
  const auto every = std::max<std::int64_t>(1, std::llround(render::kFollowedEvery / reader.start().model.tick));
  const std::int64_t from = std::max<std::int64_t>(0, tick - std::int64_t(render::kFollowedMoments) * every);
  const Result<std::vector<recordings::TickRecord>> records = reader.ticks(from, tick);
  if (!records) return records.errors();
  std::vector<Inputs> moments;
  for (std::int64_t back = 0; back < std::int64_t(records->size()); back += every)
    moments.push_back((*records)[records->size() - 1 - std::size_t(back)].inputs);
  std::reverse(moments.begin(), moments.end());
  return moments;
}

}  // namespace

Result<render::Legend> Drawing::check(const recordings::SessionReader& reader, const DrawingRequest& request) {
  const Result<Found> found = find(reader, request);
  if (!found) return found.errors();
  return render::legend_of(reader.start().model, found->look.draw);
}

Result<std::unique_ptr<Drawing>> Drawing::create(recordings::SessionReader& reader, const DrawingRequest& request) {
  Result<Found> found = find(reader, request);
  if (!found) return found.errors();
  Result<std::unique_ptr<render::Renderer>> renderer =
      render::Renderer::create(request.size.width, request.size.height, std::move(found->view));
  if (!renderer) return renderer.errors();
  return std::unique_ptr<Drawing>(new Drawing(reader, std::move(found->look), std::move(*renderer)));
}

Result<std::string> Drawing::draw(const State& state, std::int64_t tick, std::uint32_t stage, std::uint32_t request) {
  std::vector<Inputs> moments;
  if (look_.follows && tick > 0) {
    Result<std::vector<Inputs>> found = moments_before(reader_, tick);
    if (!found) return found.errors();
    moments = std::move(*found);
  }
  const render::Frame picture = renderer_->draw(state, look_.at(renderer_->scene(), moments));
  MessageBytes out;
  out.add(std::uint32_t(kDrawing)), out.add(stage), out.add(request);
  out.add(std::uint32_t(picture.width)), out.add(std::uint32_t(picture.height));
  out.add_all(picture.rgb.data(), picture.rgb.size());
  out.pad();
  return std::move(out.text);
}

}  // namespace ctpm::server
