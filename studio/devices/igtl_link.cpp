#include "studio/devices/igtl_link.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "studio/devices/hand_over.h"
#include "studio/devices/igtl_message.h"
#include "studio/devices/socket.h"
#include "studio/sources/rotation.h"

namespace ctpm::devices {
namespace {

constexpr double kConnectTimeout = 3;    // [s]
constexpr int kCallAgainAfter = 200;     // [ms]
constexpr std::size_t kReports = 4096;   // capacity towards the tick's thread: seconds of a fast device
constexpr double kSilent = 0.5;          // without a pose, a connection may be displaced [s]
constexpr double kMostWaiting = 10;      // of a connection that sends no pose while it waits [s]
constexpr std::size_t kCandidates = 32;  // connections that wait: two rounds of those accepted at once
constexpr int kAcceptedAtOnce = 16;      // before the other sockets are looked at again
constexpr auto kFloodPause = std::chrono::milliseconds(1);  // after a full buffer: the sender waits, not the tick
constexpr std::size_t kForces = 64;                         // capacity towards this thread
constexpr const char* kSecond = "a second device came and was turned away";

/// A connection that waits for the place of a silent one.
struct Candidate {
  Descriptor socket;
  IgtlStream stream;
  double since;  ///< [s]
};

bool is_good_pose(const DeviceReport& report) {
  const Pose& pose = report.pose;
  return report.news == DeviceNews::pose && is_finite(pose.position) && sources::is_finite(pose.orientation) &&
         std::abs(sources::length_of(pose.orientation) - 1) < 0.1;
}

}  // namespace

struct IgtlLink::Impl {
  explicit Impl(const IgtlSettings& settings_) : settings(settings_), stream(settings_.device_name) {}

  IgtlSettings settings;
  int port = 0;
  HandOver<DeviceReport, kReports> reports;
  HandOver<Vec3, kForces> forces;
  std::atomic<bool> stopping{false};
  Descriptor wake;  ///< written when a force waits, or to stop
  std::thread thread;

  // The thread's own.
  Descriptor listener, connection;
  double connected_at = 0, last_pose = 0;  ///< of the connection [s]; 0: it has sent no pose
  std::vector<Candidate> candidates;
  IgtlStream stream;
  IgtlForceMessage message;
  std::optional<Vec3> newest;        ///< next force to send
  std::vector<std::uint8_t> unsent;  ///< rest of a partly sent message
  std::array<std::uint8_t, 1 << 16> buffer;

  void wake_thread();
  void run();
  void tell(DeviceReport report) { (void)reports.push(report); }  // if full, the session has stopped reading
  void tell(DeviceNews news, const char* text = "");
  void take_connection(Descriptor socket);
  void let_wait(Descriptor socket);
  void turn_away(const char* text);
  void read_candidates(std::span<const pollfd> waiting);
  void hang_up(const char* reason);
  void accept_all();
  void read_to_the_end();
  void read();
  void take_forces();
  void send_newest();
  bool send_rest();
};

IgtlLink::IgtlLink(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<IgtlLink>> IgtlLink::open(const IgtlSettings& settings) {
  auto impl = std::make_unique<Impl>(settings);
  Result<Descriptor> socket = settings.listens ? listen_on(settings.host, settings.port)
                                               : connect_to(settings.host, settings.port, kConnectTimeout);
  if (!socket) return socket.errors();
  impl->wake = Descriptor(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
  if (!impl->wake) return Error{settings.host, std::string("no event descriptor: ") + std::strerror(errno), ""};
  impl->port = settings.listens ? port_of(*socket) : settings.port;
  if (settings.listens)
    impl->listener = std::move(*socket);
  else
    impl->take_connection(std::move(*socket));
  impl->thread = std::thread([link = impl.get()] { link->run(); });
  return std::unique_ptr<IgtlLink>(new IgtlLink(std::move(impl)));
}

IgtlLink::~IgtlLink() {
  impl_->stopping = true;
  impl_->wake_thread();
  impl_->thread.join();
}

int IgtlLink::port() const { return impl_->port; }

bool IgtlLink::next(DeviceReport& report) { return impl_->reports.pop(report); }

void IgtlLink::send_force(Vec3 force) {
  (void)impl_->forces.push(force);  // if full, the thread has stopped sending
  impl_->wake_thread();
}

void IgtlLink::Impl::wake_thread() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake.number(), &one, sizeof one);
}

// ---- the thread ----

void IgtlLink::Impl::tell(DeviceNews news, const char* text) {
  DeviceReport report;
  report.news = news, report.arrival = device_clock(), report.text = text;
  tell(report);
}

void IgtlLink::Impl::take_connection(Descriptor socket) {
  connection = std::move(socket);
  connected_at = device_clock(), last_pose = 0;
  stream.begin_again();
  newest.reset(), unsent.clear();
  tell(DeviceNews::connected);
}

void IgtlLink::Impl::hang_up(const char* reason) {
  connection.close();
  tell(DeviceNews::lost, reason);
}

void IgtlLink::Impl::run() {
  while (!stopping) {
    const short wanted = short(POLLIN | (unsent.empty() ? 0 : POLLOUT));
    // poll() ignores negative descriptors.
    std::vector<pollfd> waiting{
        {wake.number(), POLLIN, 0}, {listener.number(), POLLIN, 0}, {connection.number(), wanted, 0}};
    for (const Candidate& candidate : candidates) waiting.push_back({candidate.socket.number(), POLLIN, 0});
    const bool calls_again = !settings.listens && !connection;
    if (::poll(waiting.data(), waiting.size(), calls_again || !candidates.empty() ? kCallAgainAfter : -1) < 0) continue;
    if (calls_again && waiting[0].revents == 0)
      if (Result<Descriptor> socket = connect_to(settings.host, settings.port, 0.1); socket)
        take_connection(std::move(*socket));
    if (waiting[2].revents & (POLLIN | POLLHUP | POLLERR)) read();
    read_candidates(std::span(waiting).subspan(3));
    if (waiting[1].revents) accept_all();
    if (waiting[0].revents) take_forces();
    send_newest();
  }
  newest = Vec3{};
  send_newest();
}

/// Reads what a device sent before it hung up, so that it is not in the way when it comes back at once.
void IgtlLink::Impl::read_to_the_end() {
  pollfd hung_up{connection.number(), POLLRDHUP, 0};
  while (connection && ::poll(&hung_up, 1, 0) == 1) read();
}

void IgtlLink::Impl::accept_all() {
  for (int i = 0; i < kAcceptedAtOnce; ++i) {
    Descriptor socket = accept_from(listener);
    if (!socket) return;
    read_to_the_end();
    if (!settings.allowed.is_empty() && !settings.allowed.holds(peer_of(socket)))
      turn_away("a connection from an address that may not connect was refused");
    else if (!connection)
      take_connection(std::move(socket));
    else if (device_clock() - last_pose < kSilent)
      turn_away(kSecond);
    else
      let_wait(std::move(socket));
  }
  std::this_thread::sleep_for(kFloodPause);
}

/// Whoever has waited longest without a pose makes room, so that silent connections keep no device out.
void IgtlLink::Impl::let_wait(Descriptor socket) {
  if (candidates.size() >= kCandidates) {
    candidates.erase(candidates.begin());
    turn_away(kSecond);
  }
  candidates.push_back({std::move(socket), IgtlStream(settings.device_name), device_clock()});
}

void IgtlLink::Impl::turn_away(const char* text) { tell(DeviceNews::turned_away, text); }

/// Reads those that wait. The first with a good pose takes the place of a connection that is silent.
void IgtlLink::Impl::read_candidates(std::span<const pollfd> waiting) {
  const double now = device_clock();
  std::optional<std::size_t> taken;
  DeviceReport pose;
  std::vector<Candidate> left;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& candidate = candidates[i];
    bool stays = now - candidate.since < kMostWaiting;
    if (stays && i < waiting.size() && waiting[i].revents) {
      const int count = receive(candidate.socket, buffer);
      const auto look = [&](const DeviceReport& report) {
        if (is_good_pose(report)) pose = report, taken = i;
      };
      stays = count >= 0 && candidate.stream.take(std::span(buffer).first(std::size_t(count)), now, look);
    }
    const bool may_displace = !connection || now - std::max(last_pose, connected_at) >= kSilent;
    if (stays && taken == i && may_displace) {
      if (connection) hang_up("it was silent, and another device that sends poses took its place");
      take_connection(std::move(candidate.socket));
      stream = candidate.stream;
      last_pose = now;
      tell(pose);
    } else if (stays && (now - last_pose >= kSilent || taken != i)) {
      left.push_back(std::move(candidate));
    } else {
      turn_away(kSecond);
    }
  }
  candidates = std::move(left);
}

void IgtlLink::Impl::read() {
  if (!connection) return;
  const int count = receive(connection, buffer);
  if (count < 0) return hang_up("it hung up");
  const auto pass_on = [this](const DeviceReport& report) {
    if (is_good_pose(report)) last_pose = report.arrival;
    tell(report);
  };
  if (!stream.take(std::span(buffer).first(std::size_t(count)), device_clock(), pass_on))
    hang_up("what it sends is not OpenIGTLink");
  if (std::size_t(count) == buffer.size()) std::this_thread::sleep_for(kFloodPause);
}

/// Sends the rest of a message. True if nothing is left. Reading detects the end of a connection.
bool IgtlLink::Impl::send_rest() {
  if (unsent.empty()) return true;
  const int count = devices::send(connection, unsent);
  unsent.erase(unsent.begin(), count < 0 ? unsent.end() : unsent.begin() + count);
  return unsent.empty();
}

/// Takes the waiting forces and keeps only the newest.
void IgtlLink::Impl::take_forces() {
  std::uint64_t ignored;
  [[maybe_unused]] const ssize_t count = ::read(wake.number(), &ignored, sizeof ignored);
  for (Vec3 force; forces.pop(force);) newest = force;
}

/// Sends the newest force after the message before it is complete.
void IgtlLink::Impl::send_newest() {
  if (!connection || !send_rest() || !newest) return;
  const std::span<const std::uint8_t> bytes = message.pack(*newest);
  newest.reset();
  unsent.assign(bytes.begin(), bytes.end());
  send_rest();
}

}  // namespace ctpm::devices
