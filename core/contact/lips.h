#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/pair_contact.h"
#include "core/model/state.h"

namespace ctpm {

/// Lets the two sides of a cut meet again without passing through each other: spheres with a severed element
/// that are not joined by a living one keep a spacing apart. Only these spheres are looked at, sorted along x.
///
/// The force between two centres at a distance d < s is lip_k p (1 + (b p / s)^2), p = s - d, b = cut_face_stiffening:
/// at first no stiffer than the severed elements were, so that severing compressed tissue adds no energy, then so stiff
/// that nothing slips through.
class LipContact {
 public:
  /// Finds each sphere's elements, if `model.lip_k` > 0; otherwise nothing is kept and find() is never needed.
  explicit LipContact(const Model& model);

  bool is_wanted() const { return model_.lip_k > 0; }

  /// Most contacts that find() adds.
  std::size_t most() const { return is_wanted() ? kMostPerSphere * model_.sphere_count() : 0; }

  /// Adds the contacts of `state`, in an order that depends on it alone.
  void find(const State& state, PairContacts& contacts);

 private:
  static constexpr std::size_t kMostPerSphere = 13;  ///< spheres closer than a spacing, each pair once

  void gather(const State& state);
  bool are_joined(const State& state, std::int32_t a, std::int32_t b) const;
  void add_pair(const State& state, std::int32_t a, std::int32_t b, PairContacts& contacts) const;

  const Model& model_;
  std::vector<std::int32_t> first_;  ///< of a sphere's entries in joins_ (sphere_count + 1)
  struct Join {
    std::int32_t other, element;
  };
  std::vector<Join> joins_;
  std::vector<double> spacing_;       ///< of a sphere's organ [m] (sphere_count)
  std::vector<std::int32_t> organ_;   ///< (sphere_count)
  std::vector<std::uint8_t> is_lip_;  ///< has a severed element (sphere_count)
  struct Place {
    double x;
    std::int32_t sphere;
  };
  std::vector<Place> lips_;
};

}  // namespace ctpm
