#include "studio/server/desk.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace ctpm::server {

Desk::~Desk() {
  // Another page may have uploaded another file of that name since.
  for (const auto& [file, stamp] : uploads_)
    if (KnownFiles::stamp_of(file) == stamp) drop_upload_(file);
}

Result<Done> Desk::open(const std::string& file, std::uint32_t number) {
  close(number);
  Result<std::unique_ptr<Stage>> opened = Stage::open(file, number, outbox_);
  if (!opened) return opened.errors();
  std::shared_ptr<Stage> before;  // ends outside of the lock
  const std::lock_guard lock(mutex_);
  before = std::exchange(stages_[number], std::move(*opened));
  return Done{};
}

void Desk::close(std::uint32_t number) {
  std::shared_ptr<Stage> closed;
  const std::lock_guard lock(mutex_);
  if (const auto it = stages_.find(number); it != stages_.end()) closed = std::move(it->second), stages_.erase(it);
}

std::shared_ptr<Stage> Desk::stage(std::uint32_t number) {
  const std::lock_guard lock(mutex_);
  const auto it = stages_.find(number);
  return it == stages_.end() ? nullptr : it->second;
}

void Desk::keep(std::uint32_t number, std::shared_ptr<KeptScene> scene) {
  const std::lock_guard lock(mutex_);
  kept_[number].swap(scene);
  showing_.insert(number);
}

void Desk::let_go(std::uint32_t number) {
  const std::lock_guard lock(mutex_);
  showing_.erase(number);
}

void Desk::hold(std::set<std::string> files) {
  const std::lock_guard lock(mutex_);
  held_ = std::move(files);
}

std::shared_ptr<KeptScene> Desk::kept(std::uint32_t number) {
  const std::lock_guard lock(mutex_);
  const auto it = kept_.find(number);
  return it == kept_.end() ? nullptr : it->second;
}

std::shared_ptr<KeptScene> Desk::kept(const std::string& file, const std::string& text) {
  const std::lock_guard lock(mutex_);
  for (const auto& [number, scene] : kept_)
    if (scene && scene->scene().path == file && scene->scene().scene.text == text) return scene;
  return nullptr;
}

bool Desk::shows_scene(const std::string& file) {
  const std::lock_guard lock(mutex_);
  return std::any_of(kept_.begin(), kept_.end(), [&](const auto& entry) {
    return entry.second && showing_.contains(entry.first) && entry.second->scene().path == file;
  });
}

bool Desk::holds_scene(const std::string& file) {
  const std::lock_guard lock(mutex_);
  return held_.contains(file);
}

bool Desk::trains_in(const std::string& file) {
  const std::shared_ptr<Training> running = training();
  return running && running->scene() == file && !running->has_ended();
}

void Desk::forget(const std::string& file) {
  std::vector<std::shared_ptr<KeptScene>> gone;  // end outside of the lock
  const std::lock_guard lock(mutex_);
  held_.erase(file);
  for (auto& [number, scene] : kept_)
    if (scene && scene->scene().path == file) gone.push_back(std::exchange(scene, nullptr));
}

void Desk::take_charge(const std::string& upload) {
  const std::optional<KnownFiles::Stamp> stamp = KnownFiles::stamp_of(upload);
  const std::lock_guard lock(mutex_);
  if (stamp) uploads_[upload] = *stamp;
}

void Desk::show(std::uint32_t number, std::int64_t tick, std::uint32_t request) {
  if (const std::shared_ptr<Stage> found = stage(number)) found->show(tick, request);
}

Result<DrawingPlan> Desk::draw_as(std::uint32_t number, const DrawingRequest& request) {
  const std::shared_ptr<Stage> found = stage(number);
  if (!found) return Error{"stage", "shows no session", ""};
  std::vector<std::shared_ptr<Stage>> shown;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [each, stage] : stages_) shown.push_back(stage);
  }
  return found->draw_as(request, shown);
}

double Desk::prepared(std::uint32_t number) {
  const std::shared_ptr<Stage> found = stage(number);
  return found ? found->prepared() : 0;
}

Result<std::string> Desk::train(std::shared_ptr<const recordings::SessionStart> start, const TrainingRequest& request,
                                std::uint32_t number) {
  end_training();
  Result<std::unique_ptr<Training>> begun = Training::begin(std::move(start), request, number, outbox_);
  if (!begun) return begun.errors();
  const std::lock_guard lock(mutex_);
  training_ = std::move(*begun);
  return training_->awaited();
}

void Desk::end_training() {
  std::shared_ptr<Training> ended;
  const std::lock_guard lock(mutex_);
  ended = std::exchange(training_, nullptr);
}

std::shared_ptr<Training> Desk::training() {
  const std::lock_guard lock(mutex_);
  return training_;
}

void Desk::ready(std::uint32_t number, std::uint32_t request) {
  if (const std::shared_ptr<Stage> found = stage(number)) found->ready(request);
  if (const std::shared_ptr<Training> running = training()) running->ready(number);
}

void Desk::move(const HandMoves& moves, double sent_s) {
  if (const std::shared_ptr<Training> running = training()) running->move(moves, sent_s);
}

}  // namespace ctpm::server
