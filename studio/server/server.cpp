#include "studio/server/server.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>

#include "studio/output/option_name.h"
#include "studio/server/http_connection.h"
#include "studio/server/services.h"

namespace ctpm::server {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

/// Listens on 127.0.0.1. Returns why it failed; empty if it did not.
std::string listen_on(tcp::acceptor& acceptor, int port) {
  boost::system::error_code failure;
  const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), std::uint16_t(port));
  acceptor.open(endpoint.protocol(), failure);
  if (!failure) acceptor.set_option(tcp::acceptor::reuse_address(true), failure);
  if (!failure) acceptor.bind(endpoint, failure);
  if (!failure) acceptor.listen(asio::socket_base::max_listen_connections, failure);
  if (failure) acceptor.close();
  return failure ? failure.message() : "";
}

}  // namespace

struct Server::Impl {
  Impl(Folder folder, const Limits& limits, std::string token_)
      : token(std::move(token_)), services(std::move(folder), Access(0, token), limits), acceptor(services.network) {}

  std::string token;
  Services services;
  tcp::acceptor acceptor;
  asio::steady_timer timer{services.network};

  void accept_next() {
    acceptor.async_accept([this](boost::system::error_code failure, tcp::socket socket) {
      if (failure == asio::error::operation_aborted) return;
      // Above the limit the socket closes here.
      if (!failure && services.connections < services.limits.connections) {
        boost::system::error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<HttpConnection>(services, std::move(socket))->start();
      }
      accept_next();
    });
  }

  void end() {
    services.ends = true;
    while (!services.clients.empty()) std::function(services.clients.begin()->second)();
    services.network.stop();
  }

  void look(const std::function<bool()>& should_stop) {
    if (should_stop()) return end();
    timer.expires_after(std::chrono::milliseconds(100));
    timer.async_wait([this, &should_stop](boost::system::error_code failure) {
      if (!failure) look(should_stop);
    });
  }
};

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Server::~Server() {
  impl_->services.ends = true;
  impl_->services.pool.join();
}

Result<std::unique_ptr<Server>> Server::open(const ServerOptions& options) {
  Result<Folder> folder = Folder::open(options.folder);
  if (!folder) return folder.errors();
  auto impl = std::make_unique<Impl>(std::move(*folder), options.limits, make_token());
  std::string why = listen_on(impl->acceptor, options.port.value_or(kUsualPort));
  if (!why.empty() && !options.port) why = listen_on(impl->acceptor, 0);
  if (!why.empty())
    return Error{output::option_name("studio.port"), std::to_string(*options.port) + ": " + why,
                 "0 takes any free port"};
  impl->services.access = Access(impl->acceptor.local_endpoint().port(), impl->token);
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

std::string Server::address() const {
  return "http://127.0.0.1:" + std::to_string(impl_->acceptor.local_endpoint().port()) + "/#token=" + impl_->token;
}

void Server::run(const std::function<bool()>& should_stop) {
  impl_->accept_next();
  impl_->look(should_stop);
  impl_->services.network.run();
}

}  // namespace ctpm::server
