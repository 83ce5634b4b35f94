#pragma once

#include <atomic>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "studio/server/desk.h"
#include "studio/server/outbox.h"
#include "studio/server/parameters.h"
#include "studio/server/services.h"

namespace ctpm::server {

/// A page's WebSocket. It lives as long as the connection, and until what the page has open was closed.
class WebClient : public Outbox, public std::enable_shared_from_this<WebClient> {
 public:
  WebClient(Services& services, boost::beast::tcp_stream stream, std::shared_ptr<CountedConnection> counted);

  /// Answers the handshake, which was let in, and serves the page from then on. A page that `offered` another version
  /// of the protocol is told so, and nothing else: browsers hide from pages why a handshake was refused. `page`: its
  /// name for itself.
  void start(const boost::beast::http::request<boost::beast::http::empty_body>& request, const std::string& offered,
             std::string page);

  void send(std::string text) override;
  void send_bytes(std::string bytes) override;
  void show(Picture picture) override;

 private:
  struct Message {
    std::string bytes;
    bool is_text = true;
  };
  /// The newest picture of a stage.
  struct Slot {
    std::optional<Picture> picture;
    std::uint32_t missed = 0;         ///< pictures that were replaced since the last one sent
    std::uint32_t sent_topology = 0;  ///< 0: none
  };

  void begin();
  void part_from(const std::string& offered);
  void read_next();
  void take(const std::string& text);
  void take_call(Parameters& message);
  void queue(Message message);
  void wake();
  void write_next();
  std::optional<Message> next_message();
  void write(Message message);
  void close();

  Services& services_;
  std::shared_ptr<CountedConnection> counted_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_buffer buffer_;
  std::string page_;
  std::shared_ptr<Desk> desk_;
  std::map<std::int64_t, std::shared_ptr<std::atomic<bool>>> calls_;  ///< running; true: cancelled
  std::optional<Message> writing_;
  bool is_open_ = false, is_closed_ = false;

  std::mutex mutex_;  ///< of what follows
  std::deque<Message> queue_;
  std::size_t queued_bytes_ = 0;
  std::map<std::uint32_t, Slot> slots_;
  bool is_too_slow_ = false;
};

}  // namespace ctpm::server
