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

}  // namespace

bool Access::is_own_host(std::string_view host) const {
  std::string lower;
  for (const char c : host) lower += char(std::tolower(static_cast<unsigned char>(c)));
  for (const char* name : {"localhost", "127.0.0.1", "[::1]"})
    if (lower == std::string(name) + ":" + std::to_string(port_)) return true;
  return false;
}

std::string Access::refuses_page(const Knock& knock) const {
  if (!is_own_host(knock.host)) return "the request names a host that is not this server";
  if (knock.origin && *knock.origin != "http://" + std::string(knock.host))
    return "the request comes from another page";
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
