#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>

#include "studio/server/server.h"
#include "studio/server/subprotocol.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm::testing {

/// A studio that serves a folder until it goes.
class Serving {
 public:
  explicit Serving(const std::filesystem::path& folder, const server::Limits& limits = {},
                   const std::string& behind = "") {
    server::ServerOptions options;
    options.folder = folder.string(), options.port = 0, options.limits = limits, options.behind = behind;
    auto opened = server::Server::open(options);
    if (!opened) throw std::runtime_error(to_string(opened.errors().front()));
    server_ = std::move(*opened);
    const std::string address = server_->address(), place = server_->listens_on();
    port_ = std::stoi(place.substr(place.rfind(':') + 1)), token_ = address.substr(address.find('=') + 1);
    thread_ = std::thread([this] { server_->run([this] { return ends_.load(); }); });
  }
  ~Serving() {
    ends_ = true;
    thread_.join();
  }

  int port() const { return port_; }
  const std::string& token() const { return token_; }
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  std::string origin() const { return "http://" + host(); }

  /// The head of a request as the page would send it; `more` are further lines, each with its end.
  std::string head(const std::string& what, const std::string& more = "") const {
    return what + " HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: " + origin() + "\r\n" + more + "\r\n";
  }
  std::string bearer() const { return "Authorization: Bearer " + token_ + "\r\n"; }
  std::string post(const std::string& body) const {
    return head("POST /call", bearer() + "Content-Type: application/json\r\nContent-Length: " +
                                  std::to_string(body.size()) + "\r\n") +
           body;
  }

 private:
  std::unique_ptr<server::Server> server_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
  int port_ = 0;
  std::string token_;
};

/// A plain connection that sends what it is told.
class RawClient {
 public:
  explicit RawClient(int port, double patience_s = 5) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET, to.sin_port = htons(std::uint16_t(port)), to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval wait{long(patience_s), long(1e6 * (patience_s - double(long(patience_s))))};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    is_connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0;
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool is_connected() const { return is_connected_; }
  bool send(const std::string& bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t sent = ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
      if (sent <= 0) return false;
      done += std::size_t(sent);
    }
    return true;
  }
  /// Everything until the other end closes, or patience ends (then the text ends in "(no end)").
  std::string receive() const {
    std::string all;
    char part[65536];
    for (;;) {
      const ssize_t got = ::recv(socket_, part, sizeof part, 0);
      if (got == 0 || (got < 0 && errno == ECONNRESET)) return all;
      if (got < 0) return all + "(no end)";
      all.append(part, std::size_t(got));
    }
  }

 private:
  int socket_;
  bool is_connected_ = false;
};

/// The whole response to a request.
inline std::string response_to(int port, const std::string& request) {
  const RawClient client(port);
  client.send(request);
  return client.receive();
}

inline int status_of(const std::string& response) {
  return response.starts_with("HTTP/1.1 ") ? std::atoi(response.c_str() + 9) : 0;
}

inline std::string body_of(const std::string& response) {
  const std::size_t at = response.find("\r\n\r\n");
  return at == std::string::npos ? "" : response.substr(at + 4);
}

/// A page's WebSocket, without the page.
class SocketClient {
 public:
  explicit SocketClient(const Serving& serving, const std::string& subprotocol = std::string(server::kSubprotocol))
      : SocketClient(serving.port(), serving.token(), subprotocol) {}
  SocketClient(int port, const std::string& token, const std::string& subprotocol) : socket_(context_) {
    const std::string host = "127.0.0.1:" + std::to_string(port);
    namespace beast = boost::beast;
    beast::get_lowest_layer(socket_).connect(
        boost::asio::ip::tcp::endpoint(boost::asio::ip::address_v4::loopback(), std::uint16_t(port)));
    beast::get_lowest_layer(socket_).socket().set_option(boost::asio::ip::tcp::no_delay(true));  // as browsers do
    socket_.set_option(beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
      request.set(beast::http::field::sec_websocket_protocol, subprotocol + ", token." + token);
      request.set(beast::http::field::origin, "http://" + host);
    }));
    socket_.read_message_max(64u << 20);
    socket_.handshake(host, "/socket");
  }

  /// The kernel keeps little of what this client does not read.
  void keep_little() {
    boost::beast::get_lowest_layer(socket_).socket().set_option(boost::asio::socket_base::receive_buffer_size(1 << 16));
  }

  void send(const nlohmann::json& message) { send_text(message.dump()); }
  void send_text(const std::string& text) {
    socket_.text(true);
    socket_.write(boost::asio::buffer(text));
  }
  void send_bytes(const std::string& bytes) {
    socket_.binary(true);
    socket_.write(boost::asio::buffer(bytes));
  }

  /// Waits for the end of the connection, before which nothing may come; why the server ended it.
  boost::beast::websocket::close_reason reason_of_end() {
    boost::beast::flat_buffer buffer;
    boost::beast::error_code end;
    socket_.read(buffer, end);
    if (end != boost::beast::websocket::error::closed) throw std::runtime_error("the connection did not end");
    return socket_.reason();
  }

  /// The next message; throws when the connection has ended.
  struct Message {
    bool is_text = false;
    std::string bytes;
  };
  Message receive() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer);
    return {socket_.got_text(), boost::beast::buffers_to_string(buffer.data())};
  }

  /// Whether a message, or a part of one, has come.
  bool has_news() { return boost::beast::get_lowest_layer(socket_).socket().available() > 0; }

  /// Calls, and returns the whole answer. Binary messages on the way go to `binary`.
  nlohmann::json call(const std::string& name, const nlohmann::json& parameters,
                      std::vector<std::string>* binary = nullptr) {
    const int id = ++last_;
    send({{"id", id}, {"call", name}, {"params", parameters}});
    for (;;) {
      Message message = receive();
      if (!message.is_text) {
        if (binary) binary->push_back(std::move(message.bytes));
        continue;
      }
      const nlohmann::json answer = nlohmann::json::parse(message.bytes);
      if (answer.value("id", 0) == id && !answer.contains("progress")) return answer;
    }
  }
  /// The next frame, glimpse or not; what comes before it is dropped.
  std::string any_frame() {
    for (;;) {
      Message message = receive();
      std::uint32_t kind = 0;
      std::memcpy(&kind, message.bytes.data(), 4);
      if (!message.is_text && kind == 2) return std::move(message.bytes);
    }
  }
  /// The next frame that is no glimpse.
  std::string frame() {
    std::string frame = any_frame();
    while (is_glimpse(frame)) frame = any_frame();
    return frame;
  }
  static bool is_glimpse(const std::string& frame) {
    std::uint32_t flags = 0;
    std::memcpy(&flags, frame.data() + 20, 4);
    return (flags & 4u) != 0;
  }

 private:
  boost::asio::io_context context_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  int last_ = 0;
};

/// Begins a call and ends it at its first progress, which is in `at` if given. Returns its answer.
inline nlohmann::json stopped(SocketClient& client, const std::string& call, const nlohmann::json& parameters,
                              nlohmann::json* at = nullptr) {
  client.send({{"id", 77}, {"call", call}, {"params", parameters}});
  for (;;) {
    const auto message = client.receive();
    if (!message.is_text) continue;
    const nlohmann::json answer = nlohmann::json::parse(message.bytes);
    if (answer.value("id", 0) != 77) continue;
    if (!answer.contains("progress")) return answer;
    if (at) *at = answer["progress"];
    client.send({{"cancel", 77}});
  }
}

/// A value at a byte offset of a message.
template <class T>
T value_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace ctpm::testing
