// The connection and its thread, in one process with the device's side.

#include "studio/devices/igtl_link.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/studio/devices/igtl_client.h"

namespace ctpm {
namespace {

using testing::IgtlPeer;
using testing::transform_bytes;

std::unique_ptr<devices::IgtlLink> listen() {
  devices::IgtlSettings settings;
  settings.listens = true;
  Result<std::unique_ptr<devices::IgtlLink>> link = devices::IgtlLink::open(settings);
  CTPM_CHECK(bool(link), "a free port on this machine");
  return std::move(*link);
}

/// The next report, for which it waits.
devices::DeviceReport next_of(devices::IgtlLink& link) {
  devices::DeviceReport report;
  for (int i = 0; i < 20000 && !link.next(report); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return report;
}

TEST(IgtlLink, HandsOverEveryReportInItsOrderWhileForcesGoTheOtherWay) {
  auto link = listen();
  IgtlPeer peer = IgtlPeer::connect(link->port());
  EXPECT_EQ(next_of(*link).news, devices::DeviceNews::connected);
  constexpr int kCount = 20000;
  std::thread sender([&] {
    for (int i = 0; i < kCount; ++i) {
      peer.send(transform_bytes({double(i % 1000), 0, double(i / 1000)}));
      if (i % 1000 == 999) std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the queue holds 4096
    }
  });
  double before = 0;
  for (int i = 0; i < kCount; ++i) {
    const devices::DeviceReport report = next_of(*link);
    ASSERT_EQ(report.news, devices::DeviceNews::pose);
    ASSERT_NEAR(report.pose.position.x, 1e-3 * (i % 1000), 1e-7) << i;
    ASSERT_NEAR(report.pose.position.z, 1e-3 * (i / 1000), 1e-7) << i;
    EXPECT_GE(report.arrival, before);
    before = report.arrival;
    link->send_force({0, 0, 1 + double(i)});
  }
  sender.join();
  link.reset();
  peer.wait_for_end();
  // The newest in their order, some left out, and none at the end.
  const std::vector<Vec3>& forces = peer.forces();
  ASSERT_GT(forces.size(), 2u);
  EXPECT_EQ(peer.wrong_messages(), 0);
  for (std::size_t i = 1; i + 1 < forces.size(); ++i) EXPECT_GT(forces[i].z, forces[i - 1].z);
  EXPECT_EQ(forces.back(), Vec3{});
}

TEST(IgtlLink, ADeviceThatTakesNoForcesHoldsUpNobody) {
  auto link = listen();
  igtl::ClientSocket::Pointer deaf = igtl::ClientSocket::New();
  ASSERT_EQ(deaf->ConnectToServer("127.0.0.1", link->port()), 0);
  EXPECT_EQ(next_of(*link).news, devices::DeviceNews::connected);
  for (int i = 0; i < 100000; ++i) link->send_force({1, 2, 3});  // ten times what the connection can hold
  const std::string pose = transform_bytes({7, 0, 0});
  deaf->Send(pose.data(), int(pose.size()));
  EXPECT_NEAR(next_of(*link).pose.position.x, 0.007, 1e-9);
}

TEST(IgtlLink, WhoeverHangsUpIsReportedAndTheNextOneTaken) {
  auto link = listen();
  for (int i = 0; i < 5; ++i) {
    {
      IgtlPeer peer = IgtlPeer::connect(link->port());
      EXPECT_EQ(next_of(*link).news, devices::DeviceNews::connected);
    }
    EXPECT_EQ(next_of(*link).news, devices::DeviceNews::lost);
  }
}

TEST(IgtlLink, ADeviceThatHangsUpAndComesBackAtOnceIsNotTurnedAway) {
  auto link = listen();
  for (int i = 0; i < 200; ++i) {
    IgtlPeer peer = IgtlPeer::connect(link->port());
    EXPECT_EQ(next_of(*link).news, devices::DeviceNews::connected) << i;
    peer.send(transform_bytes({7, 0, 0}));
    peer.hang_up();
    EXPECT_EQ(next_of(*link).news, devices::DeviceNews::pose) << i;
    EXPECT_EQ(next_of(*link).news, devices::DeviceNews::lost) << i;
  }
}

/// The reports until one of `news`, for which it waits.
devices::DeviceReport wait_for(devices::IgtlLink& link, devices::DeviceNews news) {
  devices::DeviceReport report;
  for (int i = 0; i < 2000; ++i) {
    report = next_of(link);
    if (report.news == news) break;
  }
  EXPECT_EQ(report.news, news);
  return report;
}

TEST(IgtlLink, ASilentHolderIsDisplacedByOneThatSendsPosesAndThatIsSaid) {
  auto link = listen();
  IgtlPeer silent = IgtlPeer::connect(link->port());  // a port scan, or a device that lost its power
  EXPECT_EQ(next_of(*link).news, devices::DeviceNews::connected);
  std::atomic<bool> is_over{false};
  std::thread device([&] {
    IgtlPeer peer = IgtlPeer::connect(link->port());
    while (!is_over && peer.send(transform_bytes({7, 0, 0}))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  });
  EXPECT_NE(std::string(wait_for(*link, devices::DeviceNews::lost).text).find("silent"), std::string::npos);
  wait_for(*link, devices::DeviceNews::connected);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(wait_for(*link, devices::DeviceNews::pose).pose.position.x, 0.007, 1e-9);
  silent.wait_for_end();
  is_over = true;
  device.join();
}

TEST(IgtlLink, HundredsOfSilentConnectionsThatStayKeepNoDeviceOut) {
  auto link = listen();
  IgtlPeer holder = IgtlPeer::connect(link->port());
  EXPECT_EQ(next_of(*link).news, devices::DeviceNews::connected);
  std::vector<igtl::ClientSocket::Pointer> silent;
  for (int i = 0; i < 300; ++i) silent.push_back(IgtlPeer::connected(link->port()));
  IgtlPeer device = IgtlPeer::connect(link->port());
  devices::DeviceReport report;
  do {
    ASSERT_TRUE(device.send(transform_bytes({7, 0, 0}))) << "turned away";
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    while (link->next(report) && report.news != devices::DeviceNews::pose) continue;
  } while (report.news != devices::DeviceNews::pose);
  EXPECT_NEAR(report.pose.position.x, 0.007, 1e-9);
}

TEST(IgtlLink, OnlyAddressesOfTheListMayConnect) {
  devices::IgtlSettings settings;
  settings.listens = true;
  for (const auto& [entry, may] : std::vector<std::pair<std::string, bool>>{
           {"192.0.2.7", false}, {"127.0.0.1", true}, {"127.0.0.0/8", true}, {"::1", false}}) {
    const Result<devices::AddressList> allowed = devices::AddressList::read({entry});
    ASSERT_TRUE(allowed);
    settings.allowed = *allowed;
    Result<std::unique_ptr<devices::IgtlLink>> link = devices::IgtlLink::open(settings);
    ASSERT_TRUE(link);
    IgtlPeer peer = IgtlPeer::connect((*link)->port());
    EXPECT_EQ(next_of(**link).news, may ? devices::DeviceNews::connected : devices::DeviceNews::turned_away) << entry;
  }
  EXPECT_FALSE(devices::AddressList::read({"10.0.0.0/33"}));
  EXPECT_FALSE(devices::AddressList::read({"tracker"}));
}

}  // namespace
}  // namespace ctpm
