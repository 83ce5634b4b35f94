#include "studio/server/desks.h"

namespace ctpm::server {

void Desks::add(const std::shared_ptr<Desk>& desk) {
  const std::lock_guard lock(mutex_);
  std::erase_if(desks_, [](const std::weak_ptr<Desk>& one) { return one.expired(); });
  desks_.push_back(desk);
}

/// Those whose page is there; one that ends with the list does so outside of the lock.
std::vector<std::shared_ptr<Desk>> Desks::open() {
  std::vector<std::shared_ptr<Desk>> open;
  const std::lock_guard lock(mutex_);
  for (const std::weak_ptr<Desk>& one : desks_)
    if (std::shared_ptr<Desk> desk = one.lock()) open.push_back(std::move(desk));
  return open;
}

std::shared_ptr<Desk> Desks::of_page(const std::string& name) {
  for (const std::shared_ptr<Desk>& desk : open())
    if (!name.empty() && desk->page() == name) return desk;
  return nullptr;
}

std::string Desks::use_of(const std::string& file, const Desk* own) {
  for (const std::shared_ptr<Desk>& desk : open()) {
    if (desk->trains_in(file)) return "is being trained in; end that session first";
    if (desk.get() == own) continue;
    if (desk->shows_scene(file)) return "is open in another page; leave it there first";
    if (desk->holds_scene(file)) return "has changes in another page that are not saved; save or undo them there first";
  }
  return "";
}

}  // namespace ctpm::server
