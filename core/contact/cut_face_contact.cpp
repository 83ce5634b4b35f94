#include "core/contact/cut_face_contact.h"

#include <algorithm>
#include <cmath>

namespace ctpm::contact {
CutFaceContact::CutFaceContact(const Model& model) : model_(model) {
  if (!is_wanted()) return;
  const AxialElements& axial = model.axial;
  const std::size_t n = model.sphere_count();
  first_.assign(n + 1, 0);
  for (std::size_t e = 0; e < axial.size(); ++e)
    ++first_[std::size_t(axial.a[e]) + 1], ++first_[std::size_t(axial.b[e]) + 1];
  for (std::size_t i = 0; i < n; ++i) first_[i + 1] += first_[i];
  joins_.resize(2 * axial.size());
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t e = 0; e < axial.size(); ++e) {
    const std::int32_t a = axial.a[e], b = axial.b[e];
    joins_[std::size_t(next[std::size_t(a)]++)] = {b, std::int32_t(e)};
    joins_[std::size_t(next[std::size_t(b)]++)] = {a, std::int32_t(e)};
  }
  spacing_.assign(n, 0), organ_.assign(n, -1);
  for (std::size_t o = 0; o < model.organs.size(); ++o)
    for (std::int32_t i = 0; i < model.organs[o].count; ++i) {
      const auto sphere = std::size_t(model.organs[o].first + i);
      spacing_[sphere] = model.organs[o].spacing, organ_[sphere] = std::int32_t(o);
    }
  is_on_face_.assign(n, 0);
  on_faces_.reserve(n);
}

/// Collects the spheres on cut faces, sorted along x. Ties are broken by index, so that the order is always the same.
void CutFaceContact::gather(const StateView& state) {
  std::fill(is_on_face_.begin(), is_on_face_.end(), std::uint8_t(0));
  const AxialElements& axial = model_.axial;
  for (std::size_t i = 0; i < axial.size(); ++i)
    if (state.axial_severed[i]) is_on_face_[std::size_t(axial.a[i])] = is_on_face_[std::size_t(axial.b[i])] = 1;
  on_faces_.clear();
  for (std::size_t i = 0; i < is_on_face_.size(); ++i)
    if (is_on_face_[i]) on_faces_.push_back({state.position.x[i], std::int32_t(i)});
  std::sort(on_faces_.begin(), on_faces_.end(),
            [](const Place& p, const Place& q) { return p.x != q.x ? p.x < q.x : p.sphere < q.sphere; });
}

bool CutFaceContact::are_joined(const StateView& state, std::int32_t a, std::int32_t b) const {
  for (std::int32_t i = first_[std::size_t(a)]; i < first_[std::size_t(a) + 1]; ++i) {
    const Join join = joins_[std::size_t(i)];
    if (join.neighbour == b && !state.axial_severed[std::size_t(join.element)]) return true;
  }
  return false;
}

void CutFaceContact::add_pair(const StateView& state, std::int32_t a, std::int32_t b, PointContacts& contacts) const {
  const Vec3 apart = state.position[std::size_t(b)] - state.position[std::size_t(a)];
  const double spacing = spacing_[std::size_t(a)], squared = dot(apart, apart);
  if (squared >= spacing * spacing || squared == 0 || are_joined(state, a, b)) return;
  const double distance = std::sqrt(squared), p = spacing - distance;
  const double grown = model_.cut_face_stiffening * p / spacing, k = model_.lip_k * (1 + 3 * grown * grown);
  const Vec3 axis = apart / distance;
  contacts.add({.axis = axis, .force = model_.lip_k * p * (1 + grown * grown) * axis, .k = k, .only_pushes = true}, a,
               b, -1, 1);
}

void CutFaceContact::find(const StateView& state, PointContacts& contacts) {
  if (state.axial_severed.empty()) return;
  gather(state);
  std::size_t added = 0;
  for (std::size_t i = 0; i < on_faces_.size(); ++i)
    for (std::size_t j = i + 1; j < on_faces_.size(); ++j) {
      const auto a = on_faces_[i].sphere, b = on_faces_[j].sphere;
      if (on_faces_[j].x - on_faces_[i].x >= spacing_[std::size_t(a)]) break;
      if (organ_[std::size_t(a)] != organ_[std::size_t(b)]) continue;
      if (added == capacity()) return;
      const std::size_t before = contacts.count();
      add_pair(state, std::min(a, b), std::max(a, b), contacts);
      added += contacts.count() - before;
    }
}

}  // namespace ctpm::contact
