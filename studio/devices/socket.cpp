#include "studio/devices/socket.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>

namespace ctpm::devices {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

std::string place(const std::string& host, int port) { return host + ":" + std::to_string(port); }

Result<Addresses> resolve(const std::string& host, int port, int flags) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC, wanted.ai_socktype = SOCK_STREAM, wanted.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int problem = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found); problem != 0)
    return Error{place(host, port), std::string("no such address: ") + gai_strerror(problem), ""};
  return Addresses(found, &freeaddrinfo);
}

Descriptor new_socket(const addrinfo& address) {
  return Descriptor(
      ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol));
}

void switch_on(const Descriptor& socket, int level, int option) {
  const int on = 1;
  ::setsockopt(socket.number(), level, option, &on, sizeof on);
}

/// Sends at once, and notices within seconds that the other side is gone without a word.
void prepare(const Descriptor& socket) {
  switch_on(socket, IPPROTO_TCP, TCP_NODELAY);
  switch_on(socket, SOL_SOCKET, SO_KEEPALIVE);
  const auto set = [&](int option, int value) {
    ::setsockopt(socket.number(), IPPROTO_TCP, option, &value, sizeof value);
  };
  set(TCP_KEEPIDLE, 1), set(TCP_KEEPINTVL, 1), set(TCP_KEEPCNT, 3), set(TCP_USER_TIMEOUT, 4000);
}

/// Result of a pending connection: 0 if it is established, else the error.
int outcome_of(const Descriptor& socket, double timeout_s) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(timeout_s);
  pollfd waiting{socket.number(), POLLOUT, 0};
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    const int ready = left > 0 ? ::poll(&waiting, 1, int(left)) : 0;
    if (ready == 0) return ETIMEDOUT;
    if (ready < 0 && errno == EINTR) return EINTR;
    if (ready > 0) break;
  }
  int problem = 0;
  socklen_t size = sizeof problem;
  ::getsockopt(socket.number(), SOL_SOCKET, SO_ERROR, &problem, &size);
  return problem;
}

}  // namespace

void Descriptor::close() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

Result<Descriptor> listen_on(const std::string& host, int port) {
  const Result<Addresses> addresses = resolve(host, port, AI_PASSIVE);
  if (!addresses) return addresses.errors();
  int problem = 0;
  for (const addrinfo* address = addresses->get(); address; address = address->ai_next) {
    Descriptor socket = new_socket(*address);
    switch_on(socket, SOL_SOCKET, SO_REUSEADDR);  // allows reuse of the port right after a session
    constexpr int kWaiting = 64;                  // a port scan must not keep a device waiting
    if (socket && ::bind(socket.number(), address->ai_addr, address->ai_addrlen) == 0 &&
        ::listen(socket.number(), kWaiting) == 0)
      return socket;
    problem = errno;
  }
  if (problem == EADDRINUSE)
    return Error{place(host, port), "the port is in use", "another session may be listening; choose another port"};
  return Error{place(host, port), std::string("cannot listen here: ") + std::strerror(problem), ""};
}

Result<Descriptor> connect_to(const std::string& host, int port, double timeout_s) {
  const Result<Addresses> addresses = resolve(host, port, 0);
  if (!addresses) return addresses.errors();
  int problem = 0;
  for (const addrinfo* address = addresses->get(); address; address = address->ai_next) {
    Descriptor socket = new_socket(*address);
    if (!socket) {
      problem = errno;
      continue;
    }
    const bool is_done = ::connect(socket.number(), address->ai_addr, address->ai_addrlen) == 0;
    problem = is_done ? 0 : errno == EINPROGRESS ? outcome_of(socket, timeout_s) : errno;
    if (problem != 0) continue;
    prepare(socket);
    return socket;
  }
  return Error{place(host, port), std::string("cannot connect: ") + std::strerror(problem),
               "is the device's OpenIGTLink server running?"};
}

Descriptor accept_from(const Descriptor& listener) {
  Descriptor socket(::accept4(listener.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (socket) prepare(socket);
  return socket;
}

std::string peer_of(const Descriptor& socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  char text[NI_MAXHOST] = {};
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (::getpeername(socket.number(), generic, &size) != 0 ||
      getnameinfo(generic, size, text, sizeof text, nullptr, 0, NI_NUMERICHOST) != 0)
    return "";
  return text;
}

namespace {

/// An address as IPv6, IPv4 mapped into it; none if `text` is no address.
std::optional<std::array<std::uint8_t, 16>> bytes_of(const std::string& text) {
  std::array<std::uint8_t, 16> bytes{};
  const std::string bare = text.substr(0, text.find('%'));  // without the interface of a link-local address
  if (::inet_pton(AF_INET6, bare.c_str(), bytes.data()) == 1) return bytes;
  bytes[10] = bytes[11] = 0xff;
  if (::inet_pton(AF_INET, bare.c_str(), bytes.data() + 12) == 1) return bytes;
  return std::nullopt;
}

}  // namespace

Result<AddressList> AddressList::read(const std::vector<std::string>& entries) {
  AddressList list;
  Errors errors;
  for (const std::string& entry : entries) {
    const std::size_t slash = entry.find('/');
    const auto bytes = bytes_of(entry.substr(0, slash));
    const bool is_short = entry.find(':') == std::string::npos;
    int prefix = is_short ? 32 : 128;
    const int most = prefix;
    bool is_good = bytes.has_value();
    if (slash != std::string::npos) {
      const char* const end = entry.data() + entry.size();
      const auto [last, problem] = std::from_chars(entry.data() + slash + 1, end, prefix);
      is_good = is_good && problem == std::errc() && last == end && prefix >= 0 && prefix <= most;
    }
    if (is_good)
      list.entries_.push_back({*bytes, is_short ? 96 + prefix : prefix});
    else
      errors.push_back(
          {"", "got '" + entry + "', must be an address, or one with a prefix such as 192.168.1.0/24", ""});
  }
  if (!errors.empty()) return errors;
  return list;
}

bool AddressList::holds(const std::string& address) const {
  const auto bytes = bytes_of(address);
  if (!bytes) return false;
  for (const Entry& entry : entries_) {
    int bit = 0;
    while (bit < entry.prefix && !((((*bytes)[bit / 8] ^ entry.bytes[bit / 8]) >> (7 - bit % 8)) & 1)) ++bit;
    if (bit == entry.prefix) return true;
  }
  return false;
}

int port_of(const Descriptor& socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

int receive(const Descriptor& socket, std::span<std::uint8_t> into) {
  const ssize_t count = ::recv(socket.number(), into.data(), into.size(), 0);
  if (count > 0) return int(count);
  return count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) ? 0 : -1;
}

int send(const Descriptor& socket, std::span<const std::uint8_t> bytes) {
  const ssize_t count = ::send(socket.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (count >= 0) return int(count);
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? 0 : -1;
}

}  // namespace ctpm::devices
