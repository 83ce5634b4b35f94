// Attacks on the studio's server, from outside: none is let in, and the server goes on.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <vector>

#include "tests/studio/server/serving.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::body_of;
using testing::RawClient;
using testing::response_to;
using testing::Serving;
using testing::SocketClient;
using testing::status_of;

const std::string kProtocol(server::kSubprotocol);
const std::string kList = R"({"id": 1, "call": "folder.list", "params": {}})";

class Safety : public ::testing::Test {
 protected:
  Safety() {
    fs::create_directories(folder());
    std::ofstream(outer_.path() / "secret.ctpm") << "secret";
    std::ofstream(folder() / "own.ctpm") << "own";
  }
  fs::path folder() const { return outer_.path() / "folder"; }
  /// The server still lets its own page in.
  void expect_it_goes_on(const Serving& serving) {
    const std::string response = response_to(serving.port(), serving.post(kList));
    EXPECT_EQ(status_of(response), 200) << response;
    EXPECT_NE(response.find("own.ctpm"), std::string::npos) << response;
  }
  /// Refused with this status, and without a header that would let another page read it.
  void expect_refused(const std::string& response, int status) {
    EXPECT_EQ(status_of(response), status) << response;
    EXPECT_EQ(response.find("Access-Control"), std::string::npos) << response;
    EXPECT_EQ(response.find("own.ctpm"), std::string::npos) << response;
  }
  std::string handshake(const std::string& host, const std::string& origin, const std::string& protocol) {
    return "GET /socket HTTP/1.1\r\nHost: " + host + "\r\n" + (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
           "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
           (protocol.empty() ? "" : "Sec-WebSocket-Protocol: " + protocol + "\r\n") + "\r\n";
  }

  testing::TemporaryFolder outer_;
};

TEST_F(Safety, ThePageHoldsNoTokenAndForbidsAllOthers) {
  const Serving serving(folder());
  for (const char* target : {"/", "/app.js", "/style.css"}) {
    const std::string response = response_to(serving.port(), serving.head(std::string("GET ") + target));
    EXPECT_EQ(status_of(response), 200) << response.substr(0, 300);
    EXPECT_EQ(response.find(serving.token()), std::string::npos);
    EXPECT_NE(response.find("script-src 'self'"), std::string::npos);
    EXPECT_NE(response.find("frame-ancestors 'none'"), std::string::npos);
    EXPECT_EQ(response.find("unsafe"), std::string::npos);
    EXPECT_EQ(response.find("Access-Control"), std::string::npos);
  }
  EXPECT_EQ(serving.token().size(), 64u);
}

TEST_F(Safety, OtherMachinesComeThroughTheProxyThatIsNamedAlone) {
  const Serving serving(folder(), {}, "https://Studio.Ward.example:8443/");
  const auto call = [&](const std::string& host, const std::string& origin, const std::string& token) {
    return response_to(serving.port(), "POST /call HTTP/1.1\r\nHost: " + host + "\r\nOrigin: " + origin + "\r\n" +
                                           token + "Content-Type: application/json\r\nContent-Length: " +
                                           std::to_string(kList.size()) + "\r\n\r\n" + kList);
  };
  const std::string host = "studio.ward.example:8443", origin = "https://studio.ward.example:8443";
  const std::string good = call(host, origin, serving.bearer());
  EXPECT_EQ(status_of(good), 200) << good;
  EXPECT_NE(good.find("own.ctpm"), std::string::npos) << good;
  expect_refused(call(host, origin, ""), 403);
  expect_refused(call(host, "http://studio.ward.example:8443", serving.bearer()), 403);
  expect_refused(call(host, serving.origin(), serving.bearer()), 403);
  expect_refused(call("studio.ward.example", "https://studio.ward.example", serving.bearer()), 403);
  expect_refused(call("evil.example:8443", "https://evil.example:8443", serving.bearer()), 403);
  expect_refused(call("x.studio.ward.example:8443", origin, serving.bearer()), 403);
  expect_refused(call(serving.host(), origin, serving.bearer()), 403);
  expect_it_goes_on(serving);  // this machine's own page
}

TEST_F(Safety, NothingIsServedPlainToOtherMachines) {
  const auto refusal = [&](const std::string& bind, const std::string& behind) {
    server::ServerOptions options;
    options.folder = folder().string(), options.port = 0, options.bind = bind, options.behind = behind;
    const auto opened = server::Server::open(options);
    return opened ? "opened on " + (*opened)->listens_on() : opened.errors().front().message;
  };
  for (const char* bind : {"0.0.0.0", "::", "127.0.0.2"})
    EXPECT_NE(refusal(bind, "").find("could read the token"), std::string::npos) << bind;
  EXPECT_NE(refusal("ward", "").find("must be an IP address"), std::string::npos);
  for (const char* behind : {"http://ward", "ward", "https://", "https://a b", "https://ward:0", "https://ward:99999",
                             "https://ward/path", "https://user@ward", "https://ward:"})
    EXPECT_NE(refusal("127.0.0.1", behind).find("must be https://NAME"), std::string::npos) << behind;
  EXPECT_EQ(refusal("127.0.0.2", "https://ward").substr(0, 20), "opened on 127.0.0.2:");
  // The command says both at once.
  const testing::ProgramOutcome command =
      testing::run_ctpm({"studio", folder().string(), "--no-open", "--bind", "0.0.0.0", "--port", "0"}, outer_.path());
  EXPECT_EQ(command.code, 2);
  EXPECT_NE(command.err.find("--bind: error: 0.0.0.0: others could read the token"), std::string::npos) << command.err;
  EXPECT_NE(command.err.find("--behind https://NAME"), std::string::npos) << command.err;
}

TEST_F(Safety, AnotherHostIsRefused) {
  const Serving serving(folder());
  const std::string port = std::to_string(serving.port());
  // A name that an attacker made resolve to 127.0.0.1, and names that only look like this machine's.
  for (const std::string& host :
       {std::string("evil.example:") + port, std::string("127.0.0.1"), std::string("127.0.0.1:1"),
        "127.0.0.1.evil.example:" + port, "localhost.:" + port, "0.0.0.0:" + port}) {
    const std::string lines = "Host: " + host + "\r\nOrigin: http://" + host + "\r\n" + serving.bearer();
    expect_refused(response_to(serving.port(), "GET / HTTP/1.1\r\n" + lines + "\r\n"), 403);
    expect_refused(response_to(serving.port(), "POST /call HTTP/1.1\r\n" + lines +
                                                   "Content-Type: application/json\r\nContent-Length: " +
                                                   std::to_string(kList.size()) + "\r\n\r\n" + kList),
                   403);
    expect_refused(
        response_to(serving.port(), handshake(host, "http://" + host, kProtocol + ", token." + serving.token())), 403);
  }
  expect_refused(response_to(serving.port(), "GET / HTTP/1.1\r\n\r\n"), 403);
  for (const char* own : {"localhost", "127.0.0.1", "[::1]"})
    EXPECT_EQ(
        status_of(response_to(serving.port(), "GET / HTTP/1.1\r\nHost: " + std::string(own) + ":" + port + "\r\n\r\n")),
        200);
  expect_it_goes_on(serving);
}

TEST_F(Safety, AnotherPageIsRefused) {
  const Serving serving(folder());
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), "https://" + serving.host(),
        "http://localhost:" + std::to_string(serving.port())}) {
    const std::string lines = "Host: " + serving.host() + "\r\nOrigin: " + origin + "\r\n" + serving.bearer();
    expect_refused(response_to(serving.port(), "POST /call HTTP/1.1\r\n" + lines +
                                                   "Content-Type: application/json\r\nContent-Length: " +
                                                   std::to_string(kList.size()) + "\r\n\r\n" + kList),
                   403);
    expect_refused(response_to(serving.port(), "PUT /upload/x.stl HTTP/1.1\r\n" + lines + "Content-Length: 1\r\n\r\nx"),
                   403);
    expect_refused(
        response_to(serving.port(), handshake(serving.host(), origin, kProtocol + ", token." + serving.token())), 403);
    // The question that a browser asks before it sends anything unusual for another page.
    expect_refused(response_to(serving.port(), "OPTIONS /call HTTP/1.1\r\n" + lines +
                                                   "Access-Control-Request-Method: POST\r\n"
                                                   "Access-Control-Request-Headers: authorization\r\n\r\n"),
                   403);
  }
  expect_it_goes_on(serving);
}

TEST_F(Safety, WithoutTheTokenNothingIsDone) {
  const Serving serving(folder());
  std::string almost = serving.token();
  almost.back() = almost.back() == '0' ? '1' : '0';
  for (const std::string& line :
       {std::string(), std::string("Authorization: Bearer \r\n"), "Authorization: Bearer " + almost + "\r\n",
        "Authorization: Bearer " + serving.token() + "0\r\n", "Authorization: " + serving.token() + "\r\n",
        "Cookie: token=" + serving.token() + "\r\n"}) {
    expect_refused(response_to(serving.port(),
                               serving.head("POST /call", line + "Content-Type: application/json\r\nContent-Length: " +
                                                              std::to_string(kList.size()) + "\r\n") +
                                   kList),
                   403);
    expect_refused(response_to(serving.port(), serving.head("PUT /upload/x.stl", line + "Content-Length: 1\r\n") + "x"),
                   403);
  }
  expect_refused(response_to(serving.port(), serving.head("GET /call?token=" + serving.token())), 403);
  for (const std::string& protocol : {std::string(), kProtocol, kProtocol + ", token." + almost})
    expect_refused(response_to(serving.port(), handshake(serving.host(), serving.origin(), protocol)), 403);
  EXPECT_FALSE(fs::exists(folder() / "x.stl"));
  expect_it_goes_on(serving);
}

TEST_F(Safety, AClientOfAnotherVersionIsToldBothVersionsAndNothingElse) {
  const Serving serving(folder());
  for (const char* other : {"ctpm.studio.1", "ctpm.studio.3", "ctpm.studio.1234"}) {
    SocketClient client(serving, other);
    const auto reason = client.reason_of_end();
    EXPECT_EQ(reason.code, server::kOtherVersion);
    const std::string text = reason.reason.c_str(), version = std::string(other).substr(12);
    EXPECT_NE(text.find("this program speaks version 2 of the protocol"), std::string::npos) << text;
    EXPECT_NE(text.find("its client version " + version + ": load the page again"), std::string::npos) << text;
  }
  // Of several versions that a client speaks, the program's is taken.
  SocketClient client(serving, "ctpm.studio.1, ctpm.studio.2");
  EXPECT_TRUE(client.call("folder.list", nlohmann::json::object()).contains("result"));
  // What is no version of it is refused, and another version needs the token too.
  for (const char* name : {"ctpm.studio.", "ctpm.studio.x", "ctpm.studio.12345", "chat"})
    expect_refused(response_to(serving.port(), handshake(serving.host(), serving.origin(),
                                                         std::string(name) + ", token." + serving.token())),
                   400);
  expect_refused(response_to(serving.port(), handshake(serving.host(), serving.origin(), "ctpm.studio.1")), 403);
  expect_it_goes_on(serving);
}

TEST_F(Safety, CallsAreJsonByPostAlone) {
  const Serving serving(folder());
  const std::string length = "Content-Length: " + std::to_string(kList.size()) + "\r\n";
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data"})
    expect_refused(
        response_to(serving.port(),
                    serving.head("POST /call", serving.bearer() + "Content-Type: " + type + "\r\n" + length) + kList),
        415);
  expect_refused(response_to(serving.port(), serving.head("GET /call", serving.bearer())), 405);
  expect_refused(
      response_to(
          serving.port(),
          serving.head("POST /other", serving.bearer() + "Content-Type: application/json\r\n" + length) + kList),
      404);
  for (const char* body : {"", "[", "[]", "\"text\"", "{\"id\": 1, \"call\": \"folder.list\", \"params\": {}} x"})
    EXPECT_EQ(status_of(response_to(serving.port(), serving.post(body))), 400) << body;
  expect_it_goes_on(serving);
}

TEST_F(Safety, NothingOutsideOfTheFolderIsReached) {
  const Serving serving(folder());
  fs::create_symlink(outer_.path() / "secret.ctpm", folder() / "link.ctpm");
  fs::create_directory_symlink(outer_.path(), folder() / "way-out");
  std::vector<std::string> paths{"../secret.ctpm",
                                 "a/../../secret.ctpm",
                                 (outer_.path() / "secret.ctpm").string(),
                                 "link.ctpm",
                                 "way-out/secret.ctpm",
                                 "/etc/passwd",
                                 "..",
                                 std::string("own.ctpm\0/../../secret.ctpm", 26)};
  for (const std::string& path : paths)
    for (const char* call : {"session.open", "session.timeline", "session.verify", "notes.read"}) {
      nlohmann::json message = {{"id", 1}, {"call", call}, {"params", {{"path", path}}}};
      if (std::string(call) == "session.timeline") message["params"]["points"] = 10;
      const std::string response = response_to(serving.port(), serving.post(message.dump()));
      EXPECT_EQ(status_of(response), 422) << path << response;
      EXPECT_NE(response.find("lies outside the folder"), std::string::npos) << path << response;
    }
  EXPECT_EQ(response_to(serving.port(), serving.post(kList)).find("link.ctpm"), std::string::npos);
  for (const char* name : {"..%2Fx.stl", "%2Ftmp%2Fx.stl", "way-out%2Fx.stl", "..", "", ".hidden"})
    expect_refused(
        response_to(serving.port(),
                    serving.head("PUT /upload/" + std::string(name), serving.bearer() + "Content-Length: 1\r\n") + "x"),
        403);
  EXPECT_EQ(outer_.list(), "folder secret.ctpm");
  expect_it_goes_on(serving);
}

TEST_F(Safety, UploadsAreWholeOrNothing) {
  server::Limits limits;
  limits.most_upload = 1000;
  const Serving serving(folder(), limits);
  const auto put = [&](const std::string& name, std::size_t announced, const std::string& bytes) {
    const RawClient client(serving.port());
    client.send(serving.head("PUT /upload/" + name,
                             serving.bearer() + "Content-Length: " + std::to_string(announced) + "\r\n") +
                bytes);
    return announced == bytes.size() ? client.receive() : "";
  };
  EXPECT_EQ(status_of(put("mesh.stl", 300, std::string(300, 'm'))), 201);
  EXPECT_EQ(testing::slurp(folder() / "mesh.stl"), std::string(300, 'm'));
  EXPECT_EQ(status_of(put("mesh.stl", 3, "new")), 409);
  EXPECT_EQ(testing::slurp(folder() / "mesh.stl"), std::string(300, 'm'));
  EXPECT_EQ(status_of(put("large.stl", 1001, std::string(1001, 'm'))), 413);
  put("broken.stl", 900, std::string(100, 'm'));  // goes away in between
  std::string left;
  for (int i = 0; i < 100; ++i) {
    left.clear();
    for (const auto& entry : fs::directory_iterator(folder())) left += entry.path().filename().string() + " ";
    if (left.find("part-") == std::string::npos) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(left.find("broken"), std::string::npos) << left;
  EXPECT_EQ(left.find("large"), std::string::npos) << left;
  expect_it_goes_on(serving);
}

TEST_F(Safety, OnlyWhatWasUploadedInThisRunIsRemoved) {
  const Serving serving(folder());
  const auto answer = [&](const std::string& what, const std::string& more, const std::string& body = "") {
    return status_of(response_to(serving.port(), serving.head(what, more) + body));
  };
  const auto put = [&](const std::string& name) {
    EXPECT_EQ(answer("PUT /upload/" + name, serving.bearer() + "Content-Length: 4\r\n", "mesh"), 201);
  };
  put("mesh.stl"), put("changed.stl"), put("swapped.stl");
  std::ofstream(folder() / "changed.stl") << "by its author";
  fs::remove(folder() / "swapped.stl");
  fs::create_symlink(folder() / "own.ctpm", folder() / "swapped.stl");
  EXPECT_EQ(answer("DELETE /upload/mesh.stl", ""), 403) << "the token is missing";
  for (const char* name : {"own.ctpm", "changed.stl", "swapped.stl"})
    EXPECT_EQ(answer("DELETE /upload/" + std::string(name), serving.bearer()), 409) << name;
  for (const char* name : {"nothing.stl", "..%2Fsecret.ctpm", "%2Fetc%2Fpasswd", ""})
    EXPECT_GE(answer("DELETE /upload/" + std::string(name), serving.bearer()), 403) << name;
  for (const char* name : {"own.ctpm", "changed.stl", "mesh.stl"}) EXPECT_TRUE(fs::exists(folder() / name)) << name;
  EXPECT_TRUE(fs::exists(outer_.path() / "secret.ctpm"));
  EXPECT_EQ(answer("DELETE /upload/mesh.stl", serving.bearer()), 200);
  EXPECT_FALSE(fs::exists(folder() / "mesh.stl"));
  EXPECT_EQ(answer("DELETE /upload/mesh.stl", serving.bearer()), 403) << "it is gone";
  expect_it_goes_on(serving);
}

/// Largest resident memory of this process since forget_peak() [KiB].
long peak_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stol(line.substr(6));
  return -1;
}
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

TEST_F(Safety, UploadsAreStreamedToTheDisk) {
  constexpr std::size_t kPart = 1 << 20, kParts = 300;
  const Serving serving(folder());
  const auto part = [](std::size_t number) { return std::string(kPart, char('a' + number % 26)); };
  forget_peak();
  const long before = peak_kib();
  {
    const RawClient client(serving.port(), 60);
    ASSERT_TRUE(client.send(serving.head(
        "PUT /upload/large.stl", serving.bearer() + "Content-Length: " + std::to_string(kParts * kPart) + "\r\n")));
    for (std::size_t i = 0; i < kParts; ++i) ASSERT_TRUE(client.send(part(i)));
    EXPECT_EQ(status_of(client.receive()), 201);
  }
  const long more = peak_kib() - before;
  ASSERT_GT(before, 0);
  EXPECT_LT(more, 16 << 10) << "KiB more for " << kParts << " MiB";
  std::ifstream stored(folder() / "large.stl", std::ios::binary);
  std::string read(kPart, ' ');
  for (std::size_t i = 0; i < kParts; ++i) ASSERT_TRUE(stored.read(read.data(), kPart) && read == part(i)) << i;
  EXPECT_EQ(stored.peek(), EOF);
  expect_it_goes_on(serving);
}

TEST_F(Safety, HugeMessagesAreNotTaken) {
  const Serving serving(folder());
  struct rusage before {
  }, after{};
  getrusage(RUSAGE_SELF, &before);
  // A call and a head that announce or send too much.
  EXPECT_EQ(status_of(response_to(
                serving.port(),
                serving.head("POST /call",
                             serving.bearer() + "Content-Type: application/json\r\nContent-Length: 1000000000\r\n"))),
            413);
  const std::string endless = response_to(serving.port(), "GET / HTTP/1.1\r\nX: " + std::string(1 << 20, 'x'));
  EXPECT_NE(status_of(endless), 200);
  {
    // A WebSocket message of 1 GB from a page that is let in: in a frame whose header says so, and in small frames
    // that do not end. The server hangs up early.
    const std::string whole("\x81\xff\x00\x00\x00\x00\x40\x00\x00\x00\x01\x02\x03\x04", 14);
    const std::string first("\x01\xfe\xff\xff\x01\x02\x03\x04", 8), next("\x00\xfe\xff\xff\x01\x02\x03\x04", 8);
    for (const bool is_whole : {true, false}) {
      RawClient client(serving.port());
      client.send(handshake(serving.host(), serving.origin(), kProtocol + ", token." + serving.token()));
      const std::string part(65535, 'x');
      std::size_t sent = 0;
      bool goes_on = client.send(is_whole ? whole : first);
      while (goes_on && sent < std::size_t{1} << 30) {
        goes_on = client.send(is_whole || sent == 0 ? part : next + part);
        sent += part.size();
      }
      EXPECT_FALSE(goes_on) << "1 GB was taken";
      EXPECT_LT(sent, std::size_t{64} << 20);
      const std::string said = client.receive();
      EXPECT_EQ(said.find("(no end)"), std::string::npos);
    }
  }
  SocketClient client(serving);
  EXPECT_ANY_THROW({
    client.send_text(std::string(5 << 20, ' '));
    for (int i = 0; i < 3; ++i) client.receive();
  });
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100 << 10) << "KiB more";
  expect_it_goes_on(serving);
}

TEST_F(Safety, HalfHandshakesAreTimedOut) {
  server::Limits limits;
  limits.connections = 8, limits.handshake = std::chrono::seconds(1);
  const Serving serving(folder(), limits);
  std::vector<std::unique_ptr<RawClient>> half;
  for (const std::string& begun : {std::string(), std::string("G"), std::string("GET / HTTP/1.1\r\nHost: "),
                                   "POST /call HTTP/1.1\r\nHost: " + serving.host() + "\r\n" + serving.bearer() +
                                       "Content-Type: application/json\r\nContent-Length: 50\r\n\r\n{"}) {
    half.push_back(std::make_unique<RawClient>(serving.port()));
    half.push_back(std::make_unique<RawClient>(serving.port()));
    for (const auto* client : {&half.back(), &half[half.size() - 2]}) (*client)->send(begun);
  }
  // All places are taken: one more is turned away.
  EXPECT_EQ(response_to(serving.port(), serving.post(kList)), "");
  for (const auto& client : half) EXPECT_EQ(client->receive().find("(no end)"), std::string::npos);
  expect_it_goes_on(serving);
}

TEST_F(Safety, TenThousandConnectionsDoNotStopIt) {
  // All are open at a time, where this process may have so many files.
  constexpr std::size_t kWanted = 10000, kOwn = 500;
  struct rlimit files {};
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = std::min<rlim_t>(files.rlim_max, kWanted + kOwn);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  const std::size_t most = std::min<std::size_t>(kWanted, files.rlim_cur - std::min<rlim_t>(files.rlim_cur, kOwn));
  const Serving serving(folder());
  SocketClient page(serving);
  std::vector<std::unique_ptr<RawClient>> open;
  std::size_t connected = 0, held = 0;
  for (std::size_t i = 0; i < kWanted; ++i) {
    if (open.size() == most) open.clear();
    open.push_back(std::make_unique<RawClient>(serving.port()));
    connected += open.back()->is_connected();
    held = std::max(held, open.size());
    if (i % 1000 != 0) continue;
    EXPECT_TRUE(page.call("folder.list", nlohmann::json::object()).contains("result")) << i;
  }
  EXPECT_EQ(connected, kWanted);
  EXPECT_EQ(held, most);
  EXPECT_TRUE(page.call("folder.list", nlohmann::json::object()).contains("result")) << "the page that was there first";
  // One more is turned away without an answer.
  EXPECT_EQ(response_to(serving.port(), serving.post(kList)), "");
  open.clear();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  expect_it_goes_on(serving);
}

TEST_F(Safety, GarbageIsSurvived) {
  const Serving serving(folder());
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string bytes =
        i % 3 == 0 ? ""
        : i % 3 == 1
            ? "GET / HTTP/1.1\r\n"
            : serving.head("POST /call", serving.bearer() + "Content-Type: application/json\r\nContent-Length: 40\r\n");
    for (int k = 0; k < 200; ++k) bytes += char(random());
    RawClient client(serving.port(), 0.2);
    client.send(bytes);
    if (i % 10 == 0) client.receive();
  }
  for (int i = 0; i < 50; ++i) {
    SocketClient client(serving);
    std::string text;
    for (int k = 0; k < 50; ++k) text += char(' ' + random() % 90);
    EXPECT_ANY_THROW({
      client.send_text(text);
      client.receive();
    });
  }
  expect_it_goes_on(serving);
}

TEST_F(Safety, APageThatSendsNonsenseIsToldOrClosed) {
  const Serving serving(folder());
  SocketClient client(serving);
  const auto errors = [&](const char* call, const nlohmann::json& parameters) {
    return client.call(call, parameters).value("errors", nlohmann::json()).dump();
  };
  EXPECT_NE(errors("no.such", nlohmann::json::object()).find("no such call"), std::string::npos);
  EXPECT_NE(errors("session.open", {{"path", 7}}).find("must be a text"), std::string::npos);
  EXPECT_NE(errors("session.open", {{"path", "own.ctpm"}, {"stage", 99}}).find("must be a number in [0, 3]"),
            std::string::npos);
  EXPECT_NE(errors("session.open", {{"paht", "own.ctpm"}}).find("is not known here"), std::string::npos);
  EXPECT_NE(errors("session.open", {{"path", "own.ctpm"}}).find("own.ctpm"), std::string::npos);
  client.send({{"show", {{"stage", 0}, {"tick", "x"}, {"request", 1}}}});
  EXPECT_NE(client.receive().bytes.find("bad_message"), std::string::npos);
  client.send_bytes("abcd");
  EXPECT_ANY_THROW(client.receive());
  expect_it_goes_on(serving);
}

}  // namespace
}  // namespace ctpm
