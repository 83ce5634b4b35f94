#include "core/elements/sweeps.h"

#include <algorithm>
#include <array>
#include <limits>

namespace ctpm::elements {
namespace {

/// What a chunk costs beside its pieces, in pieces.
constexpr std::int32_t kOwnCost = 4;

/// A batch with its ends in order.
struct Ordered {
  std::int32_t a, b, place, count;  ///< a < b
};

/// The batches with both ends in the slab.
std::vector<Ordered> inside(const std::vector<AxialBatch>& batches) {
  std::vector<Ordered> ordered;
  for (const AxialBatch& batch : batches)
    if (batch.adds_a && batch.adds_b)
      ordered.push_back({std::min(batch.a, batch.b), std::max(batch.a, batch.b), batch.place, batch.count});
  return ordered;
}

/// First spheres of the chunks of spheres [begin, end), and `end`: the partition with the fewest pieces, by dynamic
/// programming.
std::vector<std::int32_t> find_bounds(const std::vector<Ordered>& batches, std::int32_t begin, std::int32_t end) {
  const auto size = std::size_t(end - begin);
  // A bound costs a piece of each row of spheres that goes on across it.
  std::vector<std::int32_t> open(size + 1, 0);
  for (const Ordered& batch : batches)
    for (const std::int32_t first : {batch.a, batch.b})
      ++open[std::size_t(first + 1 - begin)], --open[std::size_t(first + batch.count - begin)];
  for (std::size_t i = 1; i <= size; ++i) open[i] += open[i - 1];
  std::vector<std::int64_t> least(size + 1, std::numeric_limits<std::int64_t>::max());
  std::vector<std::size_t> before(size + 1, 0);
  least[0] = 0;
  for (std::size_t last = 1; last <= size; ++last)
    for (std::size_t first = last - std::min(last, std::size_t(kLanes)); first < last; ++first) {
      const std::int64_t cost = least[first] + open[first] + kOwnCost;
      if (cost < least[last]) least[last] = cost, before[last] = first;
    }
  std::vector<std::int32_t> bounds{end};
  for (std::size_t last = size; last > 0; last = before[last]) bounds.push_back(begin + std::int32_t(before[last]));
  std::reverse(bounds.begin(), bounds.end());
  return bounds;
}

enum Kind : std::size_t { later, earlier, beside, kKinds };

/// The pieces of each chunk.
class Pieces {
 public:
  explicit Pieces(const std::vector<std::int32_t>& bounds) : bounds_(bounds), of_chunk_(bounds.size() - 1) {}

  /// Sweeps take what couples different chunks. Where a part of a batch couples a chunk with itself, all of that part
  /// is beside.
  void add(const Ordered& batch) {
    const auto is_beside = [&](std::int32_t i) { return batch.b + i < end_of_chunk(batch.a + i); };
    for (std::int32_t first = 0, last; first < batch.count; first = last) {
      const bool lags = is_beside(first);
      for (last = first; last < batch.count && is_beside(last) == lags;)
        last = std::min(batch.count, end_of_chunk(batch.a + last) - batch.a);
      const std::int32_t a = batch.a + first, b = batch.b + first, place = batch.place + first;
      cut(lags ? beside : later, a, b, place, last - first);
      cut(lags ? beside : earlier, b, a, place, last - first);
    }
  }

  const std::array<std::vector<SweepPiece>, kKinds>& of_chunk(std::size_t chunk) const { return of_chunk_[chunk]; }

 private:
  std::size_t chunk_of(std::int32_t sphere) const {
    return std::size_t(std::upper_bound(bounds_.begin(), bounds_.end(), sphere) - bounds_.begin()) - 1;
  }
  std::int32_t end_of_chunk(std::int32_t sphere) const { return bounds_[chunk_of(sphere) + 1]; }

  /// Adds the pieces by which `count` spheres from `at` on are coupled with those from `across` on.
  void cut(Kind kind, std::int32_t at, std::int32_t across, std::int32_t place, std::int32_t count) {
    for (std::int32_t done = 0; done < count;) {
      const std::size_t chunk = chunk_of(at + done);
      const std::int32_t lane = at + done - bounds_[chunk];
      const std::int32_t here = std::min(count - done, bounds_[chunk + 1] - at - done);
      of_chunk_[chunk][kind].push_back({place + done - lane, across + done - lane, lane, lane + here});
      done += here;
    }
  }

  const std::vector<std::int32_t>& bounds_;
  std::vector<std::array<std::vector<SweepPiece>, kKinds>> of_chunk_;
};

}  // namespace

Sweeps::Sweeps(const std::vector<AxialBatch>& batches, std::int32_t begin, std::int32_t end)
    : begin_(begin), end_(end) {
  const std::vector<Ordered> own = inside(batches);
  const std::vector<std::int32_t> bounds = find_bounds(own, begin, end);
  Pieces pieces(bounds);
  for (const Ordered& batch : own) pieces.add(batch);
  for (const AxialBatch& batch : batches)
    if (!batch.adds_a || !batch.adds_b) lagged_.push_back(batch);

  const std::size_t chunks = bounds.size() - 1;
  std::vector<std::size_t> starts{0};  // of each kind in each chunk
  for (std::size_t chunk = 0; chunk < chunks; ++chunk)
    for (const std::vector<SweepPiece>& of_kind : pieces.of_chunk(chunk)) {
      pieces_.insert(pieces_.end(), of_kind.begin(), of_kind.end());
      starts.push_back(pieces_.size());
    }
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const auto at = [&](Kind kind) { return pieces_.data() + starts[kKinds * chunk + kind]; };
    chunks_.push_back(
        {bounds[chunk], bounds[chunk + 1] - bounds[chunk], at(later), at(earlier), at(beside), at(kKinds)});
  }
}

}  // namespace ctpm::elements
