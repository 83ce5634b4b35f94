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

/// The address of a reverse proxy that ends TLS in front of the server: what browsers of other machines open.
struct PublicAddress {
  std::string host;  ///< as their header Host has it, in lower case: a name, with a port unless it is 443

  std::string origin() const { return "https://" + host; }
  /// Reads `https://NAME` or `https://NAME:PORT`; nothing: it is none.
  static std::optional<PublicAddress> read(std::string_view text);
};

/// Who may use the server. Listening on 127.0.0.1 protects from other machines only: any page in the user's browser can
/// send requests here, and a name that an attacker owns can be made to resolve to 127.0.0.1 (DNS rebinding).
class Access {
 public:
  /// `port` is that of the server, `token` at least 128 random bits as text; `outside`: further machines come that way.
  Access(int port, std::string token, std::optional<PublicAddress> outside = {})
      : port_(port), token_(std::move(token)), outside_(std::move(outside)) {}

  /// Whether the page itself may be given out: it holds no data and no token. Returns why not; empty if it may.
  std::string refuses_page(const Knock& knock) const;

  /// Whether a call, an upload or a WebSocket may go on. Returns why not; empty if it may.
  std::string refuses(const Knock& knock) const;

 private:
  std::optional<std::string> origin_of(std::string_view host) const;

  int port_;
  std::string token_;
  std::optional<PublicAddress> outside_;
};

/// 256 random bits from the system as 64 hexadecimal digits.
std::string make_token();

}  // namespace ctpm::server
