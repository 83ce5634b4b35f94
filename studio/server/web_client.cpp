#include "studio/server/web_client.h"

#include <boost/asio/post.hpp>
#include <chrono>
#include <cstring>
#include <utility>

#include "studio/server/calls.h"
#include "studio/server/naming_files.h"
#include "studio/server/subprotocol.h"
#include "studio/server/text.h"

namespace ctpm::server {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;

namespace {

HandMove move_of(Parameters& hand) {
  const std::vector<double> p = hand.numbers("position", 3), q = hand.numbers("orientation", 4);
  return {{{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}}, std::uint32_t(hand.number("buttons", 0, 4294967295.0))};
}

}  // namespace

WebClient::WebClient(Services& services, beast::tcp_stream stream, std::shared_ptr<CountedConnection> counted)
    : services_(services), counted_(std::move(counted)), socket_(std::move(stream)) {}

void WebClient::start(const beast::http::request<beast::http::empty_body>& request, const std::string& offered,
                      std::string page) {
  page_ = std::move(page);
  beast::get_lowest_layer(socket_).expires_never();
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = services_.limits.handshake;
  timeout.idle_timeout = std::chrono::seconds(120);  // pings keep a quiet page
  timeout.keep_alive_pings = true;
  socket_.set_option(timeout);
  socket_.set_option(websocket::stream_base::decorator([offered](websocket::response_type& response) {
    response.set(beast::http::field::sec_websocket_protocol, offered);
  }));
  socket_.read_message_max(services_.limits.most_message);
  socket_.auto_fragment(false);
  services_.clients[this] = [this] { close(); };
  auto kept = std::make_shared<beast::http::request<beast::http::empty_body>>(request);
  socket_.async_accept(*kept, [self = shared_from_this(), kept, offered](beast::error_code failure) {
    if (failure || self->is_closed_) return self->close();
    if (offered != kSubprotocol) return self->part_from(offered);
    self->begin();
  });
}

void WebClient::begin() {
  desk_ = std::make_shared<Desk>(page_, shared_from_this(), [&services = services_](const std::string& file) {
    remove_unused_upload(services.folder, services.uploads, file);
  });
  services_.desks.add(desk_);
  is_open_ = true;
  read_next();
  write_next();
}

void WebClient::part_from(const std::string& offered) {
  const websocket::close_reason why(websocket::close_code(kOtherVersion), other_version_text(offered));
  socket_.async_close(why, [self = shared_from_this()](beast::error_code) { self->close(); });
}

void WebClient::read_next() {
  socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code failure, std::size_t) {
    if (failure || self->is_closed_) return self->close();
    if (!self->socket_.got_text()) return self->close();  // pages send text alone
    self->take(beast::buffers_to_string(self->buffer_.data()));
    self->buffer_.consume(self->buffer_.size());
    self->read_next();
  });
}

/// One message of the page: a call, the end of a call, or one of the quick ones that need no answer.
void WebClient::take(const std::string& text) {
  Result<Parameters> message = Parameters::parse(text);
  if (!message) return close();
  if (std::optional<Parameters> show = message->object_if("show")) {
    const std::uint32_t stage = std::uint32_t(show->number("stage", 0, Desk::kMostStages - 1));
    const std::int64_t tick = std::int64_t(show->number("tick", 0, 1e15));
    const std::uint32_t request = std::uint32_t(show->number("request", 0, 4e9));
    if (message->errors().empty()) desk_->show(stage, tick, request);
  } else if (std::optional<Parameters> hand = message->object_if("hand")) {
    HandMoves moves;
    moves[0] = move_of(*hand);
    const double time_s = hand->number("time_s", 1e-9, 1e12);
    if (std::optional<Parameters> second = hand->object_if("second")) moves[1] = move_of(*second);
    if (message->errors().empty()) desk_->move(moves, time_s);
    services_.leading.go_on(), services_.is_led = true;
  } else if (std::optional<Parameters> ready = message->object_if("ready")) {
    const std::uint32_t stage = std::uint32_t(ready->number("stage", 0, Desk::kMostStages - 1));
    const std::optional<double> request = ready->number_if("request", 0, 4e9);
    if (message->errors().empty()) desk_->ready(stage, std::uint32_t(request.value_or(0)));
  } else if (const std::optional<double> id = message->number_if("cancel", 0, 9e15)) {
    if (const auto it = calls_.find(std::int64_t(*id)); it != calls_.end()) *it->second = true;
  } else {
    return take_call(*message);
  }
  if (const Errors errors = message->errors(); !errors.empty()) {
    output::JsonWriter json;
    write_errors(json, errors);
    send(event_text("bad_message", json.text()));
  }
}

void WebClient::take_call(Parameters& message) {
  const std::int64_t id = std::int64_t(message.number("id", 0, 9e15));
  const std::string name = message.text("call");
  std::optional<Parameters> given = message.object_if("params");
  if (const Errors errors = message.errors(); !given && !errors.empty()) return send(answer(id, errors));
  if (calls_.size() >= services_.limits.most_calls || calls_.contains(id))
    return send(answer(id, Errors{{name, "too many calls at a time, or a number that is in use", ""}}));
  const auto cancelled = calls_[id] = std::make_shared<std::atomic<bool>>(false);
  auto parameters = given ? *given : *Parameters::parse("{}");
  asio::post(services_.pool, [self = shared_from_this(), desk = desk_, cancelled, id, name, parameters]() mutable {
    using Clock = std::chrono::steady_clock;
    Clock::time_point last = Clock::now();
    CallContext context{self->services_.folder, desk.get()};
    context.should_stop = [&] { return *cancelled || self->services_.ends; };
    context.uploads = &self->services_.uploads, context.films = &self->services_.films;
    context.verified = &self->services_.verified, context.comparisons = &self->services_.comparisons;
    context.desks = &self->services_.desks, context.scenes = &self->services_.scenes;
    context.progress = [&](std::int64_t done, std::int64_t total) {
      if (Clock::now() - last < std::chrono::milliseconds(100)) return;
      last = Clock::now();
      self->send(progress_of(id, done, total));
    };
    const Result<std::string> result = run_call(name, parameters, context);
    desk.reset();
    // Whoever has the answer may use the number again.
    asio::post(self->services_.network,
               [self, id, text = result ? answer(id, *result) : answer(id, result.errors())]() mutable {
                 self->calls_.erase(id);
                 self->send(std::move(text));
               });
  });
}

void WebClient::send(std::string text) { queue({as_utf8(std::move(text)), true}); }
void WebClient::send_bytes(std::string bytes) { queue({std::move(bytes), false}); }

void WebClient::queue(Message message) {
  {
    const std::lock_guard lock(mutex_);
    queued_bytes_ += message.bytes.size();
    is_too_slow_ = is_too_slow_ || queued_bytes_ > services_.limits.most_waiting;
    if (!is_too_slow_) queue_.push_back(std::move(message));
  }
  wake();
}

void WebClient::show(Picture picture) {
  {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[picture.stage];
    if (slot.picture) ++slot.missed;
    slot.picture = std::move(picture);
  }
  wake();
}

void WebClient::wake() {
  asio::post(services_.network, [self = shared_from_this()] { self->write_next(); });
}

/// What is sent next: control messages first, then the newest picture of a stage, before it its triangles, if the page
/// does not have them, its drawing and the expert's cut.
std::optional<WebClient::Message> WebClient::next_message() {
  const std::lock_guard lock(mutex_);
  if (!queue_.empty()) {
    Message message = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= message.bytes.size();
    return message;
  }
  for (auto& [stage, slot] : slots_) {
    if (!slot.picture) continue;
    if (slot.sent_topology != slot.picture->topology) {
      slot.sent_topology = slot.picture->topology;
      return Message{*slot.picture->triangles, false};
    }
    for (std::string* before : {&slot.picture->drawing, &slot.picture->expert})
      if (!before->empty()) return Message{std::exchange(*before, {}), false};
    Message message{std::move(slot.picture->frame), false};
    slot.picture.reset();
    std::memcpy(message.bytes.data() + kMissedOffset, &slot.missed, sizeof slot.missed);
    slot.missed = 0;
    return message;
  }
  return std::nullopt;
}

/// Beast allows one write at a time.
void WebClient::write_next() {
  if (writing_ || !is_open_ || is_closed_) return;
  if (std::lock_guard lock(mutex_); is_too_slow_)
    return asio::post(services_.network, [self = shared_from_this()] { self->close(); });
  writing_ = next_message();
  if (!writing_) return;
  socket_.text(writing_->is_text);
  socket_.async_write(asio::buffer(writing_->bytes),
                      [self = shared_from_this()](beast::error_code failure, std::size_t) {
                        self->writing_.reset();
                        if (failure) return self->close();
                        self->write_next();
                      });
}

/// Ends the connection and what the page had open. A page that does not read cannot be told.
void WebClient::close() {
  if (std::exchange(is_closed_, true)) return;
  services_.clients.erase(this);
  for (const auto& [id, cancelled] : calls_) *cancelled = true;
  beast::get_lowest_layer(socket_).close();
  // The threads of stages may compute for a moment, and the network must not wait for them.
  asio::post(services_.pool, [desk = std::move(desk_)]() mutable { desk.reset(); });
}

}  // namespace ctpm::server
