#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "studio/server/kept_scene.h"
#include "studio/server/known_files.h"
#include "studio/server/outbox.h"
#include "studio/server/stage.h"
#include "studio/server/training.h"

namespace ctpm::server {

/// What one page has open.
class Desk {
 public:
  /// `page`: the name that the page gave itself; empty: none. `drop_upload` is called in the end for each upload that
  /// the page is in charge of.
  using DropUpload = std::function<void(const std::string& file)>;
  Desk(std::string page, std::shared_ptr<Outbox> outbox, DropUpload drop_upload)
      : page_(std::move(page)), outbox_(std::move(outbox)), drop_upload_(std::move(drop_upload)) {}
  ~Desk();
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  const std::string& page() const { return page_; }

  /// The way to the page.
  Outbox& outbox() { return *outbox_; }

  /// Opens a session as stage `number`, in place of what was there. Errors: the session cannot be read.
  Result<Done> open(const std::string& file, std::uint32_t number);
  void close(std::uint32_t number);

  /// Keeps the scene that stage `number` shows at rest. kept() returns it, or the one that was loaded from that text as
  /// that file; null: there is none. let_go(): the stage shows it no longer, but it is kept until another one comes, so
  /// that its author can try it at once.
  void keep(std::uint32_t number, std::shared_ptr<KeptScene> scene);
  std::shared_ptr<KeptScene> kept(std::uint32_t number);
  std::shared_ptr<KeptScene> kept(const std::string& file, const std::string& text);
  void let_go(std::uint32_t number);

  /// The files of scenes of which the page has changes that are not saved, in place of those before.
  void hold(std::set<std::string> files);

  /// Whether a stage shows the scene of that file at rest, whether there are changes of it that are not saved, and
  /// whether a session of it runs. forget(): none of the first two, for the file is about to be gone.
  bool shows_scene(const std::string& file);
  bool holds_scene(const std::string& file);
  bool trains_in(const std::string& file);
  void forget(const std::string& file);

  /// The page uses an upload, as it is now: it may try again with it as long as it is there.
  void take_charge(const std::string& upload);

  /// Asks a stage for a moment; nothing happens without such a stage.
  void show(std::uint32_t number, std::int64_t tick, std::uint32_t request);

  /// See Stage::draw_as(). Error: there is no such stage.
  Result<DrawingPlan> draw_as(std::uint32_t number, const DrawingRequest& request);

  /// See Stage::prepared(); 0 without such a stage.
  double prepared(std::uint32_t number);

  /// Begins a session that the page or a device leads, in place of one that runs. Returns Training::awaited(). Errors:
  /// those of Training::begin().
  Result<std::string> train(std::shared_ptr<const recordings::SessionStart> start, const TrainingRequest& request,
                            std::uint32_t number);

  /// Ends it, if one runs, and waits until it is saved.
  void end_training();

  /// The page is done with the picture of a request, and would draw the next one at once; of a running session none was
  /// asked for. See PicturePace, Stage::ready().
  void ready(std::uint32_t number, std::uint32_t request);

  /// Moves the hands of a running session; called from one thread.
  void move(const HandMoves& moves, double sent_s);

  static constexpr std::uint32_t kMostStages = 4;

 private:
  std::shared_ptr<Stage> stage(std::uint32_t number);
  std::shared_ptr<Training> training();

  std::string page_;
  std::shared_ptr<Outbox> outbox_;
  DropUpload drop_upload_;
  std::mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<Stage>> stages_;
  std::map<std::uint32_t, std::shared_ptr<KeptScene>> kept_;
  std::set<std::uint32_t> showing_;  ///< stages that show what is kept of them
  std::set<std::string> held_;
  std::map<std::string, KnownFiles::Stamp> uploads_;
  std::shared_ptr<Training> training_;
};

}  // namespace ctpm::server
