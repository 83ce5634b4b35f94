#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ctpm::server {

/// The parts of a request that decide whether it is let in.
struct Knock {
  std::string_view host;                     ///< header Host; empty: missing
  std::optional<std::string_view> origin{};  ///< header Origin; browsers send it with each request that can do harm
  std::string_view token{};                  ///< presented token; empty: none
};

/// Who may use the server. Listening on 127.0.0.1 protects from other machines only: any page in the user's browser can
/// send requests here, and a name that an attacker owns can be made to resolve to 127.0.0.1 (DNS rebinding).
class Access {
 public:
  /// `port` is that of the server, `token` at least 128 random bits as text.
  Access(int port, std::string token) : port_(port), token_(std::move(token)) {}

  /// Whether the page itself may be given out: it holds no data and no token. Returns why not; empty if it may.
  std::string refuses_page(const Knock& knock) const;

  /// Whether a call, an upload or a WebSocket may go on. Returns why not; empty if it may.
  std::string refuses(const Knock& knock) const;

 private:
  bool is_own_host(std::string_view host) const;

  int port_;
  std::string token_;
};

/// 256 random bits from the system as 64 hexadecimal digits.
std::string make_token();

}  // namespace ctpm::server
