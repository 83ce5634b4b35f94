#include "studio/server/drawing.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "scenes/scene_file.h"
#include "studio/server/message_bytes.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::server {
namespace {

constexpr double kPageAspect = 16.0 / 9;  ///< for which a page's own cameras are set up

/// What a following camera follows: the inputs of the last moments, oldest first.
Result<std::vector<Inputs>> moments_before(recordings::SessionReader& reader, std::int64_t tick) {
  const double seconds = reader.start().model.tick;
  const std::int64_t from = std::max<std::int64_t>(0, tick - std::int64_t(render::followed_ticks(seconds)));
  const Result<std::vector<recordings::TickRecord>> records = reader.ticks(from, tick);
  if (!records) return records.errors();
  const auto of = [&](std::size_t i) -> const Inputs& { return (*records)[i].inputs; };
  return render::followed_moments(records->size(), seconds, of);
}

Result<scenes::SceneText> scene_of(const recordings::SessionReader& reader) {
  return scenes::read_scene(reader.start().scene_text, reader.path() + " (its scene)");
}

}  // namespace

Result<DrawingPlan> plan_drawing(const recordings::SessionReader& reader, const DrawingRequest& request,
                                 const State* told) {
  const Result<scenes::SceneText> scene = scene_of(reader);
  if (!scene) return scene.errors();
  const Model& model = reader.start().model;
  const double aspect = request.size ? double(request.size->width) / request.size->height : kPageAspect;
  Result<views::Look> look =
      views::find_look(request.look, scene->spec, views::view_of(scene->spec, model), aspect, told);
  if (!look) return look.errors();
  render::Legend legend = render::legend_of(model, look->draw);
  return DrawingPlan{std::move(*look), std::move(legend), request.size};
}

Result<Done> Drawing::follow(const DrawingPlan& plan) {
  if (!renderer_ || size_.width != plan.size->width || size_.height != plan.size->height) {
    const Result<scenes::SceneText> scene = scene_of(reader_);
    if (!scene) return scene.errors();
    Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(
        plan.size->width, plan.size->height, views::view_of(scene->spec, reader_.start().model));
    if (!renderer) return renderer.errors();
    renderer_ = std::move(*renderer), size_ = *plan.size;
  }
  look_ = plan.look;
  return Done{};
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
