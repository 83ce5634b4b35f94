#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "studio/render/cut_surface.h"
#include "studio/server/cut_key.h"

namespace ctpm::server {

/// What is drawn of one cut. It never changes.
struct DrawnCut {
  CutKey key;
  std::vector<Surface> surfaces;             ///< at rest, of every organ
  std::vector<std::size_t> outer_triangles;  ///< of each, which come first
  std::uint32_t topology = 0;                ///< number of the triangles; never reused
  std::string triangles;                     ///< message of that topology

  std::size_t bytes() const;  ///< of memory
};

/// Draws the cuts of States. A State is quick that has the cut of the one before, or more than that.
class CutFollower {
 public:
  /// `model` must outlive this. `stage`: where the page shows it. `whole`: what is drawn of no cut, if it is known.
  CutFollower(const Model& model, std::uint32_t stage, std::shared_ptr<const DrawnCut> whole = nullptr);

  /// What is drawn of the cut of `state`.
  std::shared_ptr<const DrawnCut> draw(const State& state);

  /// What was drawn last; null: nothing.
  const std::shared_ptr<const DrawnCut>& drawn() const { return drawn_; }

 private:
  void draw_surfaces(const State& state);

  std::uint32_t stage_;
  std::vector<render::CutSurface> surfaces_;
  std::shared_ptr<const DrawnCut> drawn_;
};

/// What was drawn of the cuts of one session, for all threads that show it.
class DrawnCuts {
 public:
  /// Begins with what is whole. `stage`: where the page shows it.
  DrawnCuts(const Model& model, std::uint32_t stage);

  /// What is drawn of no cut.
  std::shared_ptr<const DrawnCut> whole() const;

  /// What is drawn of a State's cut; null: it was not drawn yet, or is forgotten.
  std::shared_ptr<const DrawnCut> of(const State& state) const;

  /// The same, else what was drawn of the largest part of its cut.
  std::shared_ptr<const DrawnCut> nearest(const State& state) const;

  /// Keeps a cut among the last few.
  void keep(const std::shared_ptr<const DrawnCut>& drawn);

  /// Keeps it for good. The cuts must come in the order of time. False: the memory for them is used up.
  bool keep_for_good(const std::shared_ptr<const DrawnCut>& drawn);

  static constexpr std::size_t kMostBytes = 512u << 20;  ///< of those that are kept for good
  static constexpr std::size_t kMostRecent = 4;          ///< others

 private:
  std::vector<std::shared_ptr<const DrawnCut>> all() const;

  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const DrawnCut>> for_good_, recent_;  ///< the newest last
  std::size_t bytes_ = 0;                                           ///< of for_good_
};

}  // namespace ctpm::server
