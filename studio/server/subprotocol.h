#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ctpm::server {

inline constexpr std::string_view kSubprotocolFamily = "ctpm.studio.";

/// Name of the WebSocket subprotocol, with the version of PROTOCOL.md. The token follows as a second one: "token.HEX".
inline constexpr std::string_view kSubprotocol = "ctpm.studio.2";

/// Code with which a WebSocket is closed whose client speaks another version; of the range that is free for programs.
inline constexpr std::uint16_t kOtherVersion = 4001;

/// What that client is told; a close frame holds at most 123 bytes. `offered`: its subprotocol.
std::string other_version_text(std::string_view offered);

/// Whether it is the name of any version.
bool is_subprotocol(std::string_view name);

}  // namespace ctpm::server
