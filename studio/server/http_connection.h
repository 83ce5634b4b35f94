#pragma once

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "studio/server/services.h"

namespace ctpm::server {

/// One connection: one request, of which the head is judged before its body is read. PROTOCOL.md lists the targets.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Services& services, boost::asio::ip::tcp::socket socket);
  void start();

 private:
  using Head = boost::beast::http::request_parser<boost::beast::http::empty_body>;
  struct Upload {
    std::string part, place;  ///< where it grows; where it belongs
    std::string page;         ///< with which it goes; empty: it stays
  };

  void take_head();
  bool refuses_length(std::uint64_t most);
  void take_call();
  void take_upload(const std::string& name);
  void end_upload(const Upload& upload, boost::beast::error_code broken);
  void hand_over(const Upload& upload);
  void remove_upload(const std::string& name);
  void send_film(const std::string& path);
  void answer_call(const std::string& body);
  void send_page();
  void send(boost::beast::http::status status, const std::string& type, std::string body, bool is_compressed = false);
  template <typename Response>
  void write(std::shared_ptr<Response> response, std::chrono::milliseconds within);
  void drain();
  void refuse(boost::beast::http::status status, const std::string& why);

  Services& services_;
  std::shared_ptr<CountedConnection> counted_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<Head> head_;
};

}  // namespace ctpm::server
