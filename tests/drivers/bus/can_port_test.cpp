// A CAN port on a socket pair, which carries the kernel's frames one by one as a CAN socket does; tests/kernel has a
// real one. What the port says where there is no interface is the kernel's own answer.
#include <array>
#include <cerrno>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/bus/can_interfaces.hpp"
#include "drivers/bus/can_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::bus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class CanPort : public testing::Test {
 protected:
  CanPort() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends_.data()), 0); }
  ~CanPort() override { hang_up(); }

  void send(canid_t identifier, std::initializer_list<std::uint8_t> data) {
    can_frame frame{};
    frame.can_id = identifier;
    frame.can_dlc = static_cast<std::uint8_t>(data.size());
    std::ranges::copy(data, std::begin(frame.data));
    ASSERT_EQ(::write(ends_[0], &frame, sizeof frame), CAN_MTU);
  }
  void hang_up() {
    if (ends_[0] >= 0) ::close(ends_[0]);
    ends_[0] = -1;
  }
  /// What comes next, as text.
  std::string next_line() {
    std::array<std::uint8_t, 256> buffer{};
    const ByteArrival arrival = port_->read(buffer, 60s);
    EXPECT_EQ(arrival.status, ByteStatus::kBytes);
    EXPECT_TRUE(arrival.is_whole_datagram);
    return {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(arrival.size)};
  }

  std::array<int, 2> ends_{};
  std::unique_ptr<BytePort> port_ = make_can_port({.kind = BytePortKind::kCan, .path = "can3"},
                                                  [this](const BytePortAddress& /*address*/) { return ends_[1]; });
};

TEST_F(CanPort, WritesEachFrameAsALineOfCandump) {
  ASSERT_TRUE(port_->open());
  send(0x09FD0205 | CAN_EFF_FLAG, {0x64, 0x1E, 0x01, 0xC8, 0xF1, 0xFA, 0xFF, 0xFF});
  send(0x1FFFFFFF | CAN_EFF_FLAG, {});
  send(CAN_ERR_FLAG | CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_PASSIVE, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(next_line(), "can3 09FD0205#641E01C8F1FAFFFF");
  EXPECT_EQ(next_line(), "can3 1FFFFFFF#");
  EXPECT_EQ(next_line(), "can3 20000004#0010000000000000");
  std::array<std::uint8_t, 16> buffer{};
  EXPECT_EQ(port_->read(buffer, 0ns).status, ByteStatus::kSilence);
  EXPECT_FALSE(port_->write(buffer)) << "it only listens";
}

TEST_F(CanPort, IsLostWithItsSocketAndEndsWhenItIsInterrupted) {
  std::array<std::uint8_t, 16> buffer{};
  EXPECT_EQ(port_->read(buffer, 0ns).status, ByteStatus::kLost) << "not open yet";
  ASSERT_TRUE(port_->open());
  hang_up();
  EXPECT_EQ(port_->read(buffer, 60s).status, ByteStatus::kLost);
  port_->interrupt();
  EXPECT_FALSE(port_->open());
}

TEST(CanTrouble, SaysWhatToType) {
  const auto failure_with = [](const std::string& interface, int error) {
    const auto opened =
        make_can_port({.kind = BytePortKind::kCan, .path = interface}, [error](const BytePortAddress& /*address*/) {
          errno = error;
          return -1;
        })->open();
    return opened ? "it opened" : opened.error().message;
  };
  EXPECT_EQ(failure_with("can0", ENETDOWN),
            "the CAN interface can0 is down: sudo ip link set can0 up type can bitrate 250000");
  EXPECT_EQ(failure_with("vcan0", ENETDOWN), "the CAN interface vcan0 is down: sudo ip link set vcan0 up");
  EXPECT_THAT(failure_with("can7", ENODEV), HasSubstr("no CAN interface can7"));
  EXPECT_THAT(failure_with("can0", EAFNOSUPPORT), HasSubstr("modprobe can_raw"));
  EXPECT_THAT(failure_with("can0", EPERM), HasSubstr("no permission to open the CAN interface can0"));
  EXPECT_THAT(failure_with("can0", EIO), HasSubstr("ip -details link show can0"));
}

TEST(CanTrouble, IsTheKernelsOwnWhereThereIsNoInterface) {
  const int probe = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, 1);
  const bool has_can = probe >= 0;
  if (has_can) ::close(probe);
  for (const std::string interface : {"nocan7", "lo"}) {
    const auto opened = make_byte_port({.kind = BytePortKind::kCan, .path = interface})->open();
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().message, HasSubstr(has_can ? "no CAN interface " + interface : "no CAN sockets"));
  }
  EXPECT_EQ(describe({.kind = BytePortKind::kCan, .path = "can0"}), "CAN interface can0");
}

TEST(CanInterfaces, AreThoseOfThatTypeWithTheCommandForThoseThatAreDown) {
  const test::TemporaryFolder folder;
  const auto add = [&](const std::string& name, const std::string& type, const std::string& flags) {
    std::filesystem::create_directories(folder / name);
    std::ofstream(folder / name / "type") << type << "\n";
    std::ofstream(folder / name / "flags") << flags << "\n";
  };
  add("vcan0", "280", "0x40c0");
  add("can1", "280", "0x400c0");
  add("can0", "280", "0x400c1");
  add("eth0", "1", "0x1003");
  std::filesystem::create_directories(folder / "bonding_masters");
  const auto found = find_can_interfaces(folder.path());
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "can0");
  EXPECT_EQ(found[0].trouble, "");
  EXPECT_EQ(found[1].name, "can1");
  EXPECT_EQ(found[1].remedy, "sudo ip link set can1 up type can bitrate 250000");
  EXPECT_EQ(found[2].remedy, "sudo ip link set vcan0 up");
  EXPECT_TRUE(find_can_interfaces(folder / "missing").empty());
}

}  // namespace
}  // namespace yuragi::drivers::bus
