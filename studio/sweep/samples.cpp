#include "studio/sweep/samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "studio/output/number_text.h"
#include "studio/output/random_numbers.h"

namespace ctpm::sweep {
namespace {

using scenes::SweepAxis;
using scenes::SweepSpec;
using scenes::SweepValue;

/// The numbers of a seed, one after the other.
class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed) {}
  /// In [0, 1).
  double share() { return double(output::random_at(seed_, count_++) >> 11) * 0x1p-53; }
  /// In [0, count).
  std::size_t below(std::size_t count) { return std::size_t(share() * double(count)); }

 private:
  const std::uint64_t seed_;
  std::uint64_t count_ = 0;
};

/// The value at a share of an axis's range. Six digits hide in what machines round differently.
SweepValue value_at(const SweepAxis& axis, double share) {
  const double from = *axis.from, to = *axis.to;
  const double value = axis.scale == scenes::SweepScale::logarithmic ? from * std::exp(share * std::log(to / from))
                                                                     : from + share * (to - from);
  const std::string text = output::short_number(std::clamp(value, from, to), 6);
  return {text, text, std::strtod(text.c_str(), nullptr)};
}

/// How many values an axis of a grid has.
std::size_t count_of(const SweepAxis& axis) {
  return axis.values.empty() ? std::size_t(axis.steps.value_or(0)) : axis.values.size();
}

void add_value(Sample& sample, const SweepAxis& axis, std::size_t index) {
  if (axis.values.empty()) {
    sample.values.push_back(value_at(axis, double(index) / double(*axis.steps - 1)));
    sample.index.push_back(-1);
  } else {
    sample.values.push_back(axis.values[index]);
    sample.index.push_back(int(index));
  }
}

std::vector<Sample> grid_of(const SweepSpec& sweep) {
  std::size_t count = 1;
  for (const SweepAxis& axis : sweep.vary) count *= count_of(axis);
  std::vector<Sample> samples(count);
  for (std::size_t n = 0; n < count; ++n) {
    std::size_t after = count, rest = n;
    for (const SweepAxis& axis : sweep.vary) {
      after /= count_of(axis);
      add_value(samples[n], axis, rest / after);
      rest %= after;
    }
  }
  return samples;
}

std::vector<Sample> list_of(const SweepSpec& sweep) {
  std::vector<Sample> samples(sweep.vary.front().values.size());
  for (std::size_t n = 0; n < samples.size(); ++n)
    for (const SweepAxis& axis : sweep.vary) add_value(samples[n], axis, n);
  return samples;
}

/// McKay, Beckman & Conover (1979): each axis takes one value from each of as many equal parts as there are samples.
void add_hypercube(const SweepSpec& sweep, const std::string& seed, std::vector<Sample>& samples) {
  const std::size_t count = std::size_t(*sweep.samples), first = samples.size();
  samples.resize(first + count);
  for (std::size_t n = first; n < samples.size(); ++n) samples[n].seed = seed;
  Random random(std::strtoull(seed.c_str(), nullptr, 10));
  for (const SweepAxis& axis : sweep.vary) {
    std::vector<std::size_t> part(count);
    for (std::size_t n = 0; n < count; ++n) part[n] = n;
    for (std::size_t n = count; n > 1; --n) std::swap(part[n - 1], part[random.below(n)]);
    for (std::size_t n = 0; n < count; ++n) {
      const double share = (double(part[n]) + random.share()) / double(count);
      if (!axis.values.empty()) {
        add_value(samples[first + n], axis, part[n] * axis.values.size() / count);
      } else {
        samples[first + n].values.push_back(value_at(axis, share));
        samples[first + n].index.push_back(-1);
      }
    }
  }
}

}  // namespace

std::vector<Sample> samples_of(const SweepSpec& sweep) {
  if (sweep.method == scenes::SweepMethod::grid) return grid_of(sweep);
  if (sweep.method == scenes::SweepMethod::list) return list_of(sweep);
  std::vector<Sample> samples;
  if (sweep.seeds.empty()) add_hypercube(sweep, "1", samples);
  for (const SweepValue& seed : sweep.seeds) add_hypercube(sweep, seed.json, samples);
  return samples;
}

}  // namespace ctpm::sweep
