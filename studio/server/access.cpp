#include "studio/server/access.h"

#include <cctype>
#include <cstdint>
#include <random>

namespace ctpm::server {
namespace {

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= unsigned(std::uint8_t(a[i]) ^ std::uint8_t(b[i]));
  return difference == 0;
}

std::string in_lower_case(std::string_view text) {
  std::string lower;
  for (const char c : text) lower += char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

std::optional<PublicAddress> PublicAddress::read(std::string_view text) {
  constexpr std::string_view kScheme = "https://";
  if (text.substr(0, kScheme.size()) != kScheme) return std::nullopt;
  std::string host = in_lower_case(text.substr(kScheme.size()));
  if (host.ends_with('/')) host.pop_back();
  const std::size_t colon = host.find(':');
  const std::string name = host.substr(0, colon), port = colon == std::string::npos ? "443" : host.substr(colon + 1);
  const auto is_of = [](const std::string& word, const char* known) {
    return !word.empty() && word.find_first_not_of(known) == std::string::npos;
  };
  if (!is_of(name, "abcdefghijklmnopqrstuvwxyz0123456789.-") || !is_of(port, "0123456789") || port.size() > 5)
    return std::nullopt;
  if (std::stoi(port) < 1 || std::stoi(port) > 65535) return std::nullopt;
  return PublicAddress{std::stoi(port) == 443 ? name : name + ":" + std::to_string(std::stoi(port))};
}

/// The origin of this server's pages, as the one who asked that host has it; nothing: it is not this server's.
std::optional<std::string> Access::origin_of(std::string_view host) const {
  const std::string lower = in_lower_case(host);
  if (outside_ && lower == outside_->host) return outside_->origin();
  for (const char* name : {"localhost", "127.0.0.1", "[::1]"})
    if (lower == std::string(name) + ":" + std::to_string(port_)) return "http://" + std::string(host);
  return std::nullopt;
}

std::string Access::refuses_page(const Knock& knock) const {
  const std::optional<std::string> own = origin_of(knock.host);
  if (!own) return "the request names a host that is not this server";
  if (knock.origin && *knock.origin != *own) return "the request comes from another page";
  return "";
}

std::string Access::refuses(const Knock& knock) const {
  if (std::string why = refuses_page(knock); !why.empty()) return why;
  if (!equal_in_constant_time(knock.token, token_))
    return "the token is missing or belongs to an earlier run: open the address that the program printed";
  return "";
}

std::string make_token() {
  std::random_device device;  // getrandom() in libstdc++
  std::string token;
  for (int word = 0; word < 8; ++word) {
    std::uint32_t bits = device();
    for (int digit = 0; digit < 8; ++digit, bits >>= 4) token += "0123456789abcdef"[bits & 15];
  }
  return token;
}

}  // namespace ctpm::server
