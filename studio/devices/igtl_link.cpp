#include "studio/devices/igtl_link.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "studio/devices/hand_over.h"
#include "studio/devices/igtl_message.h"
#include "studio/devices/socket.h"

namespace ctpm::devices {
namespace {

constexpr double kConnectTimeout = 3;   // [s]
constexpr int kCallAgainAfter = 200;    // [ms]
constexpr std::size_t kReports = 4096;  // capacity towards the tick's thread: seconds of a fast device
constexpr std::size_t kForces = 64;     // capacity towards this thread

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
  void hang_up(const char* reason);
  void accept_all();
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
    std::array<pollfd, 3> waiting{
        {{wake.number(), POLLIN, 0}, {listener.number(), POLLIN, 0}, {connection.number(), wanted, 0}}};
    const bool calls_again = !settings.listens && !connection;
    if (::poll(waiting.data(), waiting.size(), calls_again ? kCallAgainAfter : -1) < 0) continue;
    if (calls_again && waiting[0].revents == 0)
      if (Result<Descriptor> socket = connect_to(settings.host, settings.port, 0.1); socket)
        take_connection(std::move(*socket));
    if (waiting[2].revents & (POLLIN | POLLHUP | POLLERR)) read();
    if (waiting[1].revents) accept_all();
    if (waiting[0].revents) take_forces();
    send_newest();
  }
  newest = Vec3{};
  send_newest();
}

void IgtlLink::Impl::accept_all() {
  while (Descriptor socket = accept_from(listener)) {
    if (connection)
      tell(DeviceNews::turned_away);
    else
      take_connection(std::move(socket));
  }
}

void IgtlLink::Impl::read() {
  if (!connection) return;
  const int count = receive(connection, buffer);
  if (count < 0) return hang_up("it hung up");
  const auto pass_on = [this](const DeviceReport& report) { tell(report); };
  if (!stream.take(std::span(buffer).first(std::size_t(count)), device_clock(), pass_on))
    hang_up("what it sends is not OpenIGTLink");
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
