#include "studio/server/server.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <utility>

#include "core/model/errors.h"
#include "studio/output/option_name.h"
#include "studio/server/http_connection.h"
#include "studio/server/services.h"
#include "studio/session/urgency.h"

namespace ctpm::server {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

/// Returns why it failed to listen; empty if it did not.
std::string listen_on(tcp::acceptor& acceptor, const asio::ip::address& address, int port) {
  boost::system::error_code failure;
  const tcp::endpoint endpoint(address, std::uint16_t(port));
  acceptor.open(endpoint.protocol(), failure);
  if (!failure) acceptor.set_option(tcp::acceptor::reuse_address(true), failure);
  if (!failure) acceptor.bind(endpoint, failure);
  if (!failure) acceptor.listen(asio::socket_base::max_listen_connections, failure);
  if (failure) acceptor.close();
  return failure ? failure.message() : "";
}

/// Where a server listens, and who comes from outside.
struct Place {
  asio::ip::address address;
  std::optional<PublicAddress> outside;
};

Result<Place> find_place(const ServerOptions& options) {
  Errors errors;
  boost::system::error_code failure;
  const Place place{asio::ip::make_address(options.bind, failure), PublicAddress::read(options.behind)};
  const bool is_own =
      place.address == asio::ip::address_v4::loopback() || place.address == asio::ip::address_v6::loopback();
  if (!options.behind.empty() && !place.outside)
    errors.push_back({output::option_name("studio.behind"),
                      "got '" + options.behind + "', must be https://NAME or https://NAME:PORT",
                      "it is the address of the proxy that ends TLS, as browsers open it"});
  if (failure)
    errors.push_back({output::option_name("studio.bind"), "got '" + options.bind + "', must be an IP address", ""});
  else if (!is_own && options.behind.empty())
    errors.push_back({output::option_name("studio.bind"),
                      options.bind + ": others could read the token and everything else on its way, and with it use "
                                     "and overwrite all files of the folder",
                      "let a reverse proxy end TLS in front of it, and name its address: " +
                          output::option_name("studio.behind") + " https://NAME"});
  if (!errors.empty()) return errors;
  return place;
}

}  // namespace

struct Server::Impl {
  Impl(Folder folder, const Limits& limits, std::string token_)
      : token(std::move(token_)), services(std::move(folder), Access(0, token), limits), acceptor(services.network) {}

  std::string token;
  Services services;
  tcp::acceptor acceptor;
  std::optional<PublicAddress> outside;
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
    if (!std::exchange(services.is_led, false)) services.leading.give_up();
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
  const Result<Place> place = find_place(options);
  if (!folder || !place) {
    Errors errors;
    append(errors, folder), append(errors, place);
    return errors;
  }
  UploadList::remove_left(*folder);
  auto impl = std::make_unique<Impl>(std::move(*folder), options.limits, make_token());
  std::string why = listen_on(impl->acceptor, place->address, options.port.value_or(kUsualPort));
  if (!why.empty() && !options.port) why = listen_on(impl->acceptor, place->address, 0);
  if (!why.empty())
    return Error{output::option_name(options.port ? "studio.port" : "studio.bind"),
                 (options.port ? std::to_string(*options.port) : options.bind) + ": " + why,
                 options.port ? "0 takes any free port" : ""};
  impl->outside = place->outside;
  impl->services.access = Access(impl->acceptor.local_endpoint().port(), impl->token, impl->outside);
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

std::string Server::address() const {
  const std::string origin = impl_->outside ? impl_->outside->origin() : "http://" + listens_on();
  return origin + "/#token=" + impl_->token;
}

std::string Server::listens_on() const {
  const tcp::endpoint endpoint = impl_->acceptor.local_endpoint();
  const std::string address = endpoint.address().to_string();
  return (endpoint.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(endpoint.port());
}

void Server::run(const std::function<bool()>& should_stop) {
  session::become(session::Urgency::tick);
  impl_->accept_next();
  impl_->look(should_stop);
  impl_->services.network.run();
}

}  // namespace ctpm::server
