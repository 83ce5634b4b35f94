#include "studio/server/desks.h"

namespace ctpm::server {

void Desks::add(const std::shared_ptr<Desk>& desk) {
  const std::lock_guard lock(mutex_);
  std::erase_if(desks_, [](const std::weak_ptr<Desk>& one) { return one.expired(); });
  desks_.push_back(desk);
}

std::string Desks::use_of(const std::string& file, const Desk* own) {
  std::vector<std::shared_ptr<Desk>> open;  // one that ends here does so outside of the lock
  {
    const std::lock_guard lock(mutex_);
    for (const std::weak_ptr<Desk>& one : desks_)
      if (std::shared_ptr<Desk> desk = one.lock()) open.push_back(std::move(desk));
  }
  for (const std::shared_ptr<Desk>& desk : open) {
    if (desk->trains_in(file)) return "is being trained in; end that session first";
    if (desk.get() == own) continue;
    if (desk->shows_scene(file)) return "is open in another page; leave it there first";
    if (desk->holds_scene(file)) return "has changes in another page that are not saved; save or undo them there first";
  }
  return "";
}

}  // namespace ctpm::server
