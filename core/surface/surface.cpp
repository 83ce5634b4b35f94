#include "core/surface/surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <future>
#include <limits>
#include <map>
#include <utility>

#include "core/model/result.h"
#include "core/surface/rigid_motion.h"

namespace ctpm::surface {
namespace {

constexpr std::size_t kFewestFollowed = 8;

/// C2 bump that falls from 1 at the point to almost 0 at the reach. It never vanishes, so that the nearest few spheres
/// span space wherever the point is.
double kernel(double distance, double reach) {
  constexpr double kBeyond = 1e-6;
  const double q = distance / reach, bump = std::max(1 - q * q, kBeyond);
  return bump * bump * bump;
}

/// A sphere and its distance from the point to be bound.
struct Candidate {
  double distance;
  std::int32_t sphere;
  friend bool operator<(const Candidate& a, const Candidate& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.sphere < b.sphere;
  }
};

/// Spheres by lattice row, so that a search for neighbours does not visit all spheres.
class CellIndex {
 public:
  explicit CellIndex(const FilledOrgan& organ) : organ_(organ), least_(organ.cell[0]), most_(organ.cell[0]) {
    origin_ = organ.centre[0] -
              organ.spacing * Vec3{double(organ.cell[0][0]), double(organ.cell[0][1]), double(organ.cell[0][2])};
    for (const auto& c : organ.cell)
      for (std::size_t axis = 0; axis < 3; ++axis)
        least_[axis] = std::min(least_[axis], c[axis]), most_[axis] = std::max(most_[axis], c[axis]);
    // Sorts the spheres of a row by i.
    first_.assign(std::size_t(rows(1)) * std::size_t(rows(2)) + 1, 0);
    for (const auto& c : organ.cell) ++first_[row_of(c[1], c[2]) + 1];
    for (std::size_t row = 1; row < first_.size(); ++row) first_[row] += first_[row - 1];
    in_row_.resize(organ.cell.size());
    std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t n = 0; n < organ.cell.size(); ++n)
      in_row_[std::size_t(next[row_of(organ.cell[n][1], organ.cell[n][2])]++)] = {organ.cell[n][0], std::int32_t(n)};
    for (std::size_t row = 0; row + 1 < first_.size(); ++row)
      std::sort(in_row_.begin() + first_[row], in_row_.begin() + first_[row + 1],
                [](const Entry& a, const Entry& b) { return a.i < b.i; });
  }

  /// Spheres within `rings` lattice cells of the point that are nearer than `reach`.
  void near(Vec3 point, int rings, double reach, std::vector<Candidate>& found) const {
    found.clear();
    const Vec3 q = (point - origin_) / organ_.spacing;
    const std::array<int, 3> centre{int(std::floor(q.x + 0.5)), int(std::floor(q.y + 0.5)), int(std::floor(q.z + 0.5))};
    const auto from = [&](std::size_t axis) { return std::max(centre[axis] - rings, least_[axis]); };
    const auto to = [&](std::size_t axis) { return std::min(centre[axis] + rings, most_[axis]); };
    for (int k = from(2); k <= to(2); ++k)
      for (int j = from(1); j <= to(1); ++j) {
        const std::size_t row = row_of(j, k);
        const auto end = in_row_.begin() + first_[row + 1];
        auto entry = std::lower_bound(in_row_.begin() + first_[row], end, from(0),
                                      [](const Entry& e, int i) { return e.i < i; });
        for (; entry != end && entry->i <= to(0); ++entry)
          if (const double d = norm(organ_.centre[std::size_t(entry->sphere)] - point); d < reach)
            found.push_back({d, entry->sphere});
      }
  }

 private:
  struct Entry {
    std::int32_t i, sphere;
  };
  std::int64_t rows(std::size_t axis) const { return std::int64_t(most_[axis]) - least_[axis] + 1; }
  std::size_t row_of(std::int32_t j, std::int32_t k) const {
    return std::size_t((k - least_[2]) * rows(1) + (j - least_[1]));
  }

  const FilledOrgan& organ_;
  Vec3 origin_;
  std::array<std::int32_t, 3> least_, most_;
  std::vector<std::int32_t> first_;  // where a row begins in `in_row_`
  std::vector<Entry> in_row_;
};

/// Finds the spheres of the binding of a vertex: all within reach, or the nearest few if the reach holds too few.
void find_followed(const FilledOrgan& organ, const CellIndex& index, Vec3 point, std::vector<Candidate>& found) {
  const double reach = kBindingReach * organ.spacing;
  const std::size_t fewest = std::min(organ.centre.size(), kFewestFollowed);
  int rings = int(std::ceil(kBindingReach)) + 1;
  index.near(point, rings, reach, found);
  if (found.size() < fewest) {
    found.clear();
    for (; found.size() < fewest; rings *= 2) index.near(point, rings, std::numeric_limits<double>::infinity(), found);
  }
  std::sort(found.begin(), found.end());
  std::size_t count = fewest;
  while (count < found.size() && found[count].distance < reach) ++count;
  found.resize(count);
}

/// Leaves out spheres that hardly count: each costs time in every tick and room in every session. All stay where the
/// rest would not span space.
void leave_out_weak(Vec3 vertex, double spacing, std::vector<Candidate>& followed, std::vector<Vec3>& centres,
                    std::vector<double>& trust, std::vector<double>& weights) {
  constexpr double kWeak = 0.02, kOff = 1e-10;  // of the largest weight; of a spacing
  double largest = 0;
  for (const double w : weights) largest = std::max(largest, std::abs(w));
  std::vector<Candidate> strong;
  std::vector<Vec3> strong_centres;
  std::vector<double> strong_trust;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (std::abs(weights[i]) > kWeak * largest)
      strong.push_back(followed[i]), strong_centres.push_back(centres[i]), strong_trust.push_back(trust[i]);
  if (strong.size() < kFewestFollowed || strong.size() == followed.size()) return;
  const std::vector<double> strong_weights =
      follow_weights(vertex, strong_centres, strong_trust, kBindingReach * spacing);
  Vec3 off = -vertex;
  for (std::size_t i = 0; i < strong.size(); ++i) off += strong_weights[i] * strong_centres[i];
  if (norm(off) > kOff * spacing) return;
  followed = strong, centres = strong_centres, trust = strong_trust, weights = strong_weights;
}

/// Bindings of a run of vertices; `binding.first` begins at 0.
void bind_run(const FilledOrgan& organ, const CellIndex& index, std::size_t begin, std::size_t end,
              SurfaceBinding& binding) {
  std::vector<Candidate> followed;
  std::vector<Vec3> centres;
  std::vector<double> trust;
  for (std::size_t v = begin; v < end; ++v) {
    const Vec3 vertex = organ.surface.vertex[v];
    find_followed(organ, index, vertex, followed);
    centres.clear(), trust.clear();
    for (const Candidate& c : followed) {
      centres.push_back(organ.centre[std::size_t(c.sphere)]);
      trust.push_back(organ.shares.of_sphere(std::size_t(c.sphere)));
    }
    std::vector<double> weights = follow_weights(vertex, centres, trust, kBindingReach * organ.spacing);
    leave_out_weak(vertex, organ.spacing, followed, centres, trust, weights);
    for (const Candidate& c : followed) binding.sphere.push_back(c.sphere);
    binding.weight.insert(binding.weight.end(), weights.begin(), weights.end());
    binding.first.push_back(std::int32_t(binding.sphere.size()));
  }
}

}  // namespace

std::vector<double> follow_weights(Vec3 point, std::span<const Vec3> candidates, std::span<const double> trust,
                                   double reach) {
  CTPM_CHECK(!candidates.empty() && candidates.size() == trust.size() && reach > 0,
             "a point needs something to follow");
  std::vector<double> weight(candidates.size());
  double total = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    total += weight[i] = kernel(norm(candidates[i] - point), reach) * trust[i];
  // Moments of the kernel in the basis (1, p - point), lengths in units of the reach.
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  const auto basis = [&](std::size_t i) {
    const Vec3 d = (candidates[i] - point) / reach;
    return Eigen::Vector4d(1, d.x, d.y, d.z);
  };
  for (std::size_t i = 0; i < candidates.size(); ++i) moments += weight[i] / total * basis(i) * basis(i).transpose();
  const Eigen::FullPivLU<Eigen::Matrix4d> lu(moments);
  constexpr double kSpansSpace = 1e-8;  // smallest pivot relative to the largest; below it the weights would explode
  const bool spans_space = std::abs(lu.matrixLU()(3, 3)) > kSpansSpace * std::abs(lu.matrixLU()(0, 0));
  const Eigen::Vector4d correction =
      spans_space ? Eigen::Vector4d(lu.solve(Eigen::Vector4d::UnitX())) : Eigen::Vector4d::UnitX();
  double sum = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) sum += weight[i] *= correction.dot(basis(i)) / total;
  for (double& w : weight) w /= sum;  // away with rounding
  return weight;
}

void bind_surface(FilledOrgan& organ, int threads) {
  CTPM_CHECK(!organ.centre.empty(), "binding needs spheres");
  const CellIndex index(organ);
  // Runs have equal length on any number of threads; each thread takes the next free one.
  constexpr std::size_t kRun = 4096;
  const std::size_t vertex_count = organ.surface.vertex.size(), run_count = (vertex_count + kRun - 1) / kRun;
  std::vector<SurfaceBinding> runs(run_count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t run; (run = next.fetch_add(1)) < run_count;)
      bind_run(organ, index, run * kRun, std::min((run + 1) * kRun, vertex_count), runs[run]);
  };
  std::vector<std::future<void>> others;
  for (int t = 1; t < threads && std::size_t(t) < run_count; ++t)
    others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& other : others) other.get();

  SurfaceBinding& binding = organ.surface.binding;
  binding = {};
  std::size_t entries = 0;
  for (const SurfaceBinding& run : runs) entries += run.sphere.size();
  binding.first.reserve(vertex_count + 1), binding.sphere.reserve(entries), binding.weight.reserve(entries);
  binding.first.push_back(0);
  for (SurfaceBinding& run : runs) {
    const std::int32_t start = std::int32_t(binding.sphere.size());
    for (const std::int32_t end : run.first) binding.first.push_back(start + end);
    binding.sphere.insert(binding.sphere.end(), run.sphere.begin(), run.sphere.end());
    binding.weight.insert(binding.weight.end(), run.weight.begin(), run.weight.end());
    run = {};
  }
}

std::vector<std::int32_t> welded(const Surface& surface) {
  std::map<std::pair<std::array<double, 3>, std::vector<double>>, std::int32_t> known;
  std::vector<std::int32_t> number;
  const SurfaceBinding& b = surface.binding;
  for (std::size_t v = 0; v < surface.vertex.size(); ++v) {
    const Vec3 p = surface.vertex[v];
    std::vector<double> followed;
    for (auto e = std::size_t(b.first[v]); e < std::size_t(b.first[v + 1]); ++e)
      followed.push_back(b.sphere[e]), followed.push_back(b.weight[e]);
    number.push_back(
        known.try_emplace({{p.x, p.y, p.z}, std::move(followed)}, std::int32_t(known.size())).first->second);
  }
  return number;
}

void deform_surface(const Surface& surface, const Vec3Array& position, std::int32_t first_sphere,
                    std::vector<Vec3>& vertex) {
  const SurfaceBinding& binding = surface.binding;
  vertex.assign(surface.vertex.size(), Vec3{});
  for (std::size_t v = 0; v < vertex.size(); ++v)
    for (std::int32_t entry = binding.first[v]; entry < binding.first[v + 1]; ++entry)
      vertex[v] +=
          binding.weight[std::size_t(entry)] * position[std::size_t(first_sphere + binding.sphere[std::size_t(entry)])];
  std::vector<Turn> turn;
  for (const TissueFrame& frame : binding.frame)
    turn.push_back(turn_of(frame, [&](std::int32_t sphere) { return position[std::size_t(first_sphere + sphere)]; }));
  for (const TurnedOffset& offset : binding.turned)
    vertex[std::size_t(offset.vertex)] += turn[std::size_t(offset.frame)](offset.offset);
}

}  // namespace ctpm::surface
