#pragma once

namespace ctpm {

/// What a tick is busy with.
enum class Stage {
  solve,        ///< forces, contacts and motion
  cut,          ///< a blade's sweep and what it severs; following the swept surface
  cut_surface,  ///< waiting for the surface of a cut that something may touch, or making it
};

/// Is told when a tick goes over to another stage, so that whoever has a clock can measure them. Changes no bit of it.
class StageWatch {
 public:
  /// Returns the stage that was left.
  virtual Stage enter(Stage stage) = 0;

 protected:
  ~StageWatch() = default;
};

/// A stage for as long as it lives; then the one before goes on. Without a watch it does nothing.
class InStage {
 public:
  InStage(StageWatch* watch, Stage stage) : watch_(watch), before_(watch ? watch->enter(stage) : stage) {}
  ~InStage() {
    if (watch_) watch_->enter(before_);
  }
  InStage(const InStage&) = delete;
  InStage& operator=(const InStage&) = delete;

 private:
  StageWatch* watch_;
  Stage before_;
};

}  // namespace ctpm
