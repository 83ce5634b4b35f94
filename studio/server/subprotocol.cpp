#include "studio/server/subprotocol.h"

namespace ctpm::server {
namespace {

constexpr std::size_t kMostDigits = 4;

std::string_view version_of(std::string_view name) { return name.substr(kSubprotocolFamily.size()); }

}  // namespace

std::string other_version_text(std::string_view offered) {
  return "this program speaks version " + std::string(version_of(kSubprotocol)) +
         " of the protocol, its client version " + std::string(version_of(offered)) +
         ": load the page again, or update the client";
}

bool is_subprotocol(std::string_view name) {
  if (!name.starts_with(kSubprotocolFamily)) return false;
  const std::string_view version = version_of(name);
  return !version.empty() && version.size() <= kMostDigits &&
         version.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace ctpm::server
