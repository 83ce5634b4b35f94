#include "studio/server/http_connection.h"

#include <boost/asio/post.hpp>
#include <boost/beast/websocket.hpp>
#include <filesystem>
#include <limits>

#include "studio/server/calls.h"
#include "studio/server/file_moves.h"
#include "studio/server/naming_files.h"
#include "studio/server/page.h"
#include "studio/server/subprotocol.h"
#include "studio/server/text.h"
#include "studio/server/upload_list.h"
#include "studio/server/web_client.h"

namespace ctpm::server {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

namespace {

constexpr const char* kPage = "Ctpm-Page";  ///< header of an upload: the page with which it goes

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

/// What follows `prefix` in a subprotocol of a WebSocket handshake: browsers let a page give no other headers there.
std::string offered_behind(std::string_view prefix, const http::request<http::empty_body>& request) {
  for (const auto& name : http::token_list(request[http::field::sec_websocket_protocol]))
    if (view_of(name).starts_with(prefix)) return std::string(view_of(name).substr(prefix.size()));
  return "";
}

/// The token of an Authorization header, or of a WebSocket handshake.
std::string token_of(const http::request<http::empty_body>& request) {
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view given = view_of(request[http::field::authorization]);
  return given.starts_with(kBearer) ? std::string(given.substr(kBearer.size())) : offered_behind("token.", request);
}

/// The subprotocol that a client offers: this program's version, if it is among them. Empty: none of any version.
std::string subprotocol_of(const http::request<http::empty_body>& request) {
  std::string other;
  for (const auto& name : http::token_list(request[http::field::sec_websocket_protocol])) {
    if (view_of(name) == kSubprotocol) return std::string(kSubprotocol);
    if (is_subprotocol(view_of(name))) other = view_of(name);
  }
  return other;
}

Knock knock_of(const http::request<http::empty_body>& request, const std::string& token) {
  Knock knock{view_of(request[http::field::host]), {}, token};
  if (request.find(http::field::origin) != request.end()) knock.origin = view_of(request[http::field::origin]);
  return knock;
}

/// The name of a file behind such a beginning; percent signs are decoded. None: the target begins otherwise.
std::optional<std::string> name_behind(std::string_view begin, std::string_view target) {
  if (!target.starts_with(begin)) return std::nullopt;
  std::string name;
  for (std::size_t i = begin.size(); i < target.size(); ++i) {
    const auto digit = [&](std::size_t at) -> int {
      const char c = at < target.size() ? target[at] : '?';
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (target[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0)
      name += char(16 * digit(i + 1) + digit(i + 2)), i += 2;
    else
      name += target[i];
  }
  return name;
}

std::string film_type(const std::string& path) {
  for (const auto& [ending, type] :
       {std::pair{".mp4", "video/mp4"}, {".avi", "video/x-msvideo"}, {".png", "image/png"}})
    if (path.ends_with(ending)) return type;
  return "application/octet-stream";
}

/// What every response says: nobody keeps it, and only this server's own page may use it.
template <typename Body>
void add_headers(http::response<Body>& response, const std::string& type) {
  response.set(http::field::content_type, type);
  response.set(http::field::cache_control, "no-store");
  response.set(
      "Content-Security-Policy",
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.keep_alive(false);
  response.prepare_payload();
}

}  // namespace

HttpConnection::HttpConnection(Services& services, asio::ip::tcp::socket socket)
    : services_(services), counted_(std::make_shared<CountedConnection>(services)), stream_(std::move(socket)) {}

void HttpConnection::start() {
  stream_.expires_after(services_.limits.handshake);
  head_.emplace();
  head_->header_limit(std::uint32_t(services_.limits.most_header));
  head_->body_limit(std::numeric_limits<std::uint64_t>::max());  // each target sets its own
  http::async_read_header(stream_, buffer_, *head_,
                          [self = shared_from_this()](beast::error_code failure, std::size_t) {
                            if (!failure) self->take_head();
                          });
}

void HttpConnection::take_head() {
  const http::request<http::empty_body>& request = head_->get();
  const std::string target(view_of(request.target())), token = token_of(request);
  const Knock knock = knock_of(request, token);
  const bool is_socket = beast::websocket::is_upgrade(request);
  if (request.method() == http::verb::get && !is_socket && page_file(target)) {
    const std::string why = services_.access.refuses_page(knock);
    return why.empty() ? send_page() : refuse(http::status::forbidden, why);
  }
  if (const std::string why = services_.access.refuses(knock); !why.empty())
    return refuse(http::status::forbidden, why);
  if (is_socket) {
    if (target != "/socket") return refuse(http::status::not_found, "there is nothing at " + target);
    const std::string offered = subprotocol_of(request);
    if (offered.empty())
      return refuse(http::status::bad_request, "the WebSocket protocol must be " + std::string(kSubprotocol));
    return std::make_shared<WebClient>(services_, std::move(stream_), std::move(counted_))
        ->start(request, offered, offered_behind("page.", request));
  }
  const std::optional<std::string> upload = name_behind("/upload/", target), film = name_behind("/film/", target);
  if (upload && request.method() == http::verb::put) return take_upload(*upload);
  if (upload && request.method() == http::verb::delete_) return remove_upload(*upload);
  if (film && request.method() == http::verb::get) return send_film(*film);
  if (target != "/call") return refuse(http::status::not_found, "there is nothing at " + target);
  if (request.method() != http::verb::post) return refuse(http::status::method_not_allowed, "calls are made by POST");
  if (view_of(request[http::field::content_type]).substr(0, 16) != "application/json")
    return refuse(http::status::unsupported_media_type, "calls are application/json");
  take_call();
}

/// Refuses a body that is announced larger than `most` [bytes]; one that grows larger is refused while it is read.
bool HttpConnection::refuses_length(std::uint64_t most) {
  const auto length = head_->content_length();
  if (!length || *length <= most) return false;
  refuse(http::status::payload_too_large, "at most " + std::to_string(most) + " bytes are taken");
  return true;
}

void HttpConnection::take_call() {
  if (refuses_length(services_.limits.most_message)) return;
  auto body = std::make_shared<http::request_parser<http::string_body>>(std::move(*head_));
  body->body_limit(services_.limits.most_message);
  http::async_read(stream_, buffer_, *body, [self = shared_from_this(), body](beast::error_code failure, std::size_t) {
    if (failure == http::error::body_limit)
      return self->refuse(http::status::payload_too_large,
                          "at most " + std::to_string(self->services_.limits.most_message) + " bytes are taken");
    if (!failure) self->answer_call(body->get().body());
  });
}

/// Runs the call in the pool; the connection waits.
void HttpConnection::answer_call(const std::string& body) {
  stream_.expires_never();
  asio::post(services_.pool, [self = shared_from_this(), body] {
    const auto finish = [&](http::status status, std::string text) {
      asio::post(self->services_.network, [self, status, text = as_utf8(std::move(text))]() mutable {
        self->send(status, "application/json", std::move(text));
      });
    };
    Result<Parameters> message = Parameters::parse(body);
    if (!message) return finish(http::status::bad_request, answer(0, message.errors()));
    const std::int64_t id = std::int64_t(message->number_if("id", 0, 9e15).value_or(0));
    const std::string name = message->text("call");
    std::optional<Parameters> given = message->object_if("params");
    Parameters parameters = given ? *given : *Parameters::parse("{}");
    CallContext context{self->services_.folder};
    context.should_stop = [&] { return self->services_.ends.load(); };
    context.uploads = &self->services_.uploads, context.films = &self->services_.films;
    context.verified = &self->services_.verified, context.comparisons = &self->services_.comparisons;
    context.desks = &self->services_.desks, context.scenes = &self->services_.scenes;
    const Result<std::string> result = run_call(name, parameters, context);
    finish(result ? http::status::ok : http::status::unprocessable_entity,
           result ? answer(id, *result) : answer(id, result.errors()));
  });
}

/// Streams the body into a temporary file, which takes its name when it is whole.
void HttpConnection::take_upload(const std::string& name) {
  if (refuses_length(services_.limits.most_upload)) return;
  const Result<std::string> place = services_.folder.place(name);
  std::error_code ignored;
  if (!place) return refuse(http::status::forbidden, to_string(place.errors().front()));
  if (std::filesystem::exists(*place, ignored)) return refuse(http::status::conflict, name + " exists already");
  auto body = std::make_shared<http::request_parser<http::file_body>>(std::move(*head_));
  body->body_limit(services_.limits.most_upload);
  const Upload upload{*place + kPart + make_token().substr(0, 8), *place, std::string(view_of(body->get()[kPage]))};
  services_.listed.add(upload.part, {});
  beast::error_code failure;
  body->get().body().open(upload.part.c_str(), beast::file_mode::write_new, failure);
  if (failure) return refuse(http::status::forbidden, name + " cannot be written: " + failure.message());
  stream_.expires_after(services_.limits.upload);
  http::async_read(stream_, buffer_, *body,
                   [self = shared_from_this(), body, upload](beast::error_code broken, std::size_t) {
                     body->get().body().close();
                     self->end_upload(upload, broken);
                   });
}

/// Gives an upload that is whole its name, and removes another one.
void HttpConnection::end_upload(const Upload& upload, beast::error_code broken) {
  if (!broken && !upload.page.empty()) services_.listed.add(upload.place, KnownFiles::stamp_of(upload.part));
  const Result<Done> moved = broken ? Done{} : move_all(services_.folder, {{upload.part, upload.place}});
  std::error_code ignored;
  if (broken || !moved) std::filesystem::remove(upload.part, ignored);
  if (broken == http::error::body_limit)
    return refuse(http::status::payload_too_large, "the file is larger than the limit");
  // What fails on the disk and not on the way; quotas and limits of a file's size are others of its kind.
  for (const auto full : {boost::system::errc::no_space_on_device, boost::system::errc::file_too_large})
    if (broken == full)
      return refuse(http::status::insufficient_storage, "nothing of the file was kept: " + broken.message());
  if (broken) return;  // the connection is gone
  if (!moved) return refuse(http::status::conflict, to_string(moved.errors().front()));
  services_.uploads.add(upload.place);
  asio::post(services_.pool, [self = shared_from_this(), upload] { self->hand_over(upload); });
}

/// An upload that is whole goes with its page, and at once if that is gone already.
void HttpConnection::hand_over(const Upload& upload) {
  if (const std::shared_ptr<Desk> desk = services_.desks.of_page(upload.page))
    desk->take_charge(upload.place);
  else if (!upload.page.empty())
    remove_unused_upload(services_.folder, services_.uploads, upload.place);
  asio::post(services_.network, [self = shared_from_this(), upload] {
    output::JsonWriter json;
    json.begin_object().member("path", self->services_.folder.relative(upload.place)).end_object();
    self->send(http::status::created, "application/json", as_utf8(json.text()));
  });
}

void HttpConnection::remove_upload(const std::string& name) {
  const Result<std::string> file = services_.folder.find(name);
  if (!file) return refuse(http::status::forbidden, to_string(file.errors().front()));
  if (!services_.uploads.remove(*file))
    return refuse(http::status::conflict, name + " stays: it was not uploaded in this run, or has changed since");
  send(http::status::ok, "application/json", "{}");
}

/// Streams a film of this run; other files of the folder are not given.
void HttpConnection::send_film(const std::string& path) {
  const Result<std::string> file = services_.folder.find(path);
  if (!file) return refuse(http::status::forbidden, to_string(file.errors().front()));
  if (!services_.films.holds(*file))
    return refuse(http::status::not_found, path + " is no film that was exported in this run");
  auto response = std::make_shared<http::response<http::file_body>>(http::status::ok, 11);
  beast::error_code failure;
  response->body().open(file->c_str(), beast::file_mode::scan, failure);
  if (failure) return refuse(http::status::not_found, path + " cannot be read: " + failure.message());
  add_headers(*response, film_type(*file));
  write(response, services_.limits.upload);
}

void HttpConnection::send_page() {
  const std::optional<PageFile> file = page_file(view_of(head_->get().target()));
  send(http::status::ok, file->type, std::string(file->bytes), true);
}

void HttpConnection::refuse(http::status status, const std::string& why) {
  output::JsonWriter json;
  json.begin_object().key("errors");
  write_errors(json, {{"", why, ""}});
  send(status, "application/json", as_utf8(json.end_object().text()));
}

void HttpConnection::send(http::status status, const std::string& type, std::string body, bool is_compressed) {
  auto response = std::make_shared<http::response<http::string_body>>(status, 11);
  if (is_compressed) response->set(http::field::content_encoding, "gzip");
  response->body() = std::move(body);
  add_headers(*response, type);
  write(response, services_.limits.handshake);
}

/// Sends a response within a time, and ends.
template <typename Response>
void HttpConnection::write(std::shared_ptr<Response> response, std::chrono::milliseconds within) {
  stream_.expires_after(within);
  http::async_write(stream_, *response, [self = shared_from_this(), response](beast::error_code, std::size_t) {
    beast::error_code ignored;
    self->stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    self->drain();
  });
}

/// Takes what still comes, for a moment: closing with unread bytes would make the system withdraw the response.
void HttpConnection::drain() {
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(64 << 10),
                          [self = shared_from_this()](beast::error_code failure, std::size_t) {
                            if (!failure) self->drain();
                          });
}

}  // namespace ctpm::server
