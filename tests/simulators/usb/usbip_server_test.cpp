// The server as a host meets it: a small USB/IP client over the loopback; the test moves the simulator's time.
#include "simulators/usb/usbip_server.hpp"

#include <chrono>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include "tests/simulators/usb/steady_wind.hpp"
#include "tests/simulators/usb/usbip_bytes.hpp"
#include "tests/support/descriptor.hpp"

namespace yuragi::simulators::usb {
namespace {

class UsbipServerTest : public testing::Test {
 protected:
  Descriptor connect_client() {
    Descriptor client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(server_.port());
    if (connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) client.reset();
    return client;
  }

  void serve_once(std::optional<core::FaultKind> fault = std::nullopt) {
    std::vector<pollfd> waits;
    for (const int descriptor : server_.descriptors()) waits.push_back({descriptor, POLLIN, 0});
    poll(waits.data(), waits.size(), 5);
    std::vector<int> ready;
    for (const pollfd& wait : waits) {
      if (wait.revents != 0) ready.push_back(wait.fd);
    }
    server_.serve(ready, time_s_, fault);
  }

  static void send_bytes(const Descriptor& client, const Bytes& bytes) {
    EXPECT_EQ(send(client.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), std::ssize(bytes));
  }

  /// Serves until so many bytes have come, or the server has closed the connection; what has come.
  Bytes answer(const Descriptor& client, std::size_t size, std::optional<core::FaultKind> fault = std::nullopt) {
    Bytes got;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (got.size() < size && std::chrono::steady_clock::now() < deadline) {
      serve_once(fault);
      std::array<std::uint8_t, 4096> block{};
      const ssize_t more = recv(client.get(), block.data(), block.size(), MSG_DONTWAIT);
      if (more == 0) break;
      got.insert(got.end(), block.begin(), block.begin() + std::max<ssize_t>(more, 0));
    }
    return got;
  }
  Bytes ask(const Descriptor& client, const Bytes& bytes, std::size_t size,
            std::optional<core::FaultKind> fault = std::nullopt) {
    send_bytes(client, bytes);
    return answer(client, size, fault);
  }
  /// Serves until the server closes the connection; false: it never does.
  bool is_closed(const Descriptor& client, std::optional<core::FaultKind> fault = std::nullopt) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      serve_once(fault);
      std::uint8_t byte = 0;
      const ssize_t size = recv(client.get(), &byte, 1, MSG_DONTWAIT);
      if (size == 0 || (size < 0 && errno == ECONNRESET)) return true;
    }
    return false;
  }

  Descriptor attach(const std::string& bus_id = "1-1") {
    Descriptor client = connect_client();
    EXPECT_EQ(ask(client, usbip_request_import(bus_id), kImported).size(), kImported);
    return client;
  }

  static constexpr std::size_t kHead = 48;  // of a reply to a transfer
  static constexpr std::size_t kReport = kHead + EchoDevice::kReportSize;
  static constexpr std::size_t kRefused = 8;
  static constexpr std::size_t kImported = 320;
  UsbipServer server_{"127.0.0.1", 0, echo_ports(2)};
  double time_s_ = 0.0;
};

TEST_F(UsbipServerTest, ListsItsDevicesAndEndsTheConnection) {
  const Descriptor client = connect_client();
  const Bytes list = ask(client, kUsbipRequestList, 12 + 2 * 320);
  ASSERT_EQ(list.size(), 12U + 2U * 320U);
  EXPECT_EQ(list[11], 2);
  EXPECT_TRUE(is_closed(client));
}

TEST_F(UsbipServerTest, GivesADeviceToOneHostAtATime) {
  Descriptor first = attach("1-1");
  const Descriptor second = connect_client();
  EXPECT_EQ(ask(second, usbip_request_import("1-1"), kRefused), (Bytes{1, 0x11, 0, 3, 0, 0, 0, 2}));
  const Descriptor other = attach("1-2");
  const Descriptor stranger = connect_client();
  EXPECT_EQ(ask(stranger, usbip_request_import("9-9"), kRefused), (Bytes{1, 0x11, 0, 3, 0, 0, 0, 4}));

  first.reset();
  Bytes again;
  for (int i = 0; i < 1000 && again.size() != kImported; ++i) {  // until the server has seen that it is gone
    const Descriptor next = connect_client();
    again = ask(next, usbip_request_import("1-1"), kRefused);
    again.resize(again.at(7) == 0 ? kImported : again.size());
  }
  EXPECT_EQ(again.size(), kImported);
}

TEST_F(UsbipServerTest, AnswersAReadWhenTheDeviceHasSomethingToSay) {
  const Descriptor host = attach();
  const Bytes first = ask(host, usbip_submit_in(1, 1, 8), kReport);
  ASSERT_EQ(first.size(), kReport);
  EXPECT_EQ(first[kHead], 'W');

  // The next report is not there yet: what was asked later is answered before.
  send_bytes(host, usbip_submit_in(2, 1, 8));
  EXPECT_EQ(ask(host, usbip_submit_out(3, 2, {1}), kHead)[7], 3);
  time_s_ = 0.5;
  const Bytes second = answer(host, kReport);
  ASSERT_EQ(second.size(), kReport);
  EXPECT_EQ(second[7], 2);
  EXPECT_EQ(second[kHead + 1], 2);
}

TEST_F(UsbipServerTest, UnlinksWhatWaitsAndSaysSoWhereItDoesNot) {
  const Descriptor host = attach();
  send_bytes(host, usbip_submit_in(5, 2, 64));
  const Bytes unlinked = ask(host, usbip_unlink(6, 5), kHead);
  ASSERT_EQ(unlinked.size(), kHead);
  EXPECT_EQ(unlinked[3], 4);
  EXPECT_EQ(unlinked[23], 0x98) << "ECONNRESET: it will have no other answer";
  EXPECT_EQ(ask(host, usbip_unlink(7, 5), kHead).at(23), 0) << "it had its answer";
}

TEST_F(UsbipServerTest, EchoesBulkThatComesInPieces) {
  const Descriptor host = attach();
  const Bytes out = usbip_submit_out(1, 2, {0x0F, 0x33});
  for (const std::uint8_t byte : out) {
    send_bytes(host, {byte});
    serve_once();
  }
  const Bytes sent = answer(host, kHead);
  ASSERT_EQ(sent.size(), kHead);
  EXPECT_EQ(sent[27], 2) << "how much was sent";
  const Bytes echo = ask(host, usbip_submit_in(2, 2, 64), kHead + 2);
  ASSERT_EQ(echo.size(), kHead + 2);
  EXPECT_EQ(echo[kHead], 0xF0);
  EXPECT_EQ(echo[kHead + 1], 0xCC);
}

TEST_F(UsbipServerTest, TellsAStall) {
  const Descriptor host = attach();
  EXPECT_EQ(ask(host, usbip_submit_out(1, 2, {0xFF}), kHead).at(23), 0xE0) << "EPIPE";
}

TEST_F(UsbipServerTest, ADeviceIsUnpluggedAndPluggedInAgain) {
  const Descriptor host = attach();
  const Descriptor other = connect_client();
  time_s_ = 1.0;
  EXPECT_TRUE(is_closed(host, core::FaultKind::kUnplug));
  EXPECT_EQ(ask(other, usbip_request_import("1-1"), kRefused, core::FaultKind::kUnplug),
            (Bytes{1, 0x11, 0, 3, 0, 0, 0, 4}));
  const Descriptor requesting = connect_client();
  EXPECT_EQ(ask(requesting, kUsbipRequestList, 12, core::FaultKind::kUnplug),
            (Bytes{1, 0x11, 0, 5, 0, 0, 0, 0, 0, 0, 0, 0}));

  time_s_ = 2.0;
  const Descriptor again = attach();
  time_s_ = 3.0;
  EXPECT_EQ(ask(again, usbip_submit_in(1, 1, 8), kReport).size(), kReport);
}

TEST_F(UsbipServerTest, GivesUpAHostThatTalksNonsenseAndServesTheOthers) {
  const Descriptor host = attach("1-2");
  const Descriptor hostile = connect_client();
  send_bytes(hostile, Bytes(4096, 0x5A));
  EXPECT_TRUE(is_closed(hostile));
  EXPECT_THAT(server_.status(), testing::HasSubstr("given up: USB/IP version 0x5a5a"));
  EXPECT_EQ(ask(host, usbip_submit_in(1, 1, 8), kReport).size(), kReport);
}

TEST_F(UsbipServerTest, TakesNoAddressThatIsTaken) {
  EXPECT_THROW(UsbipServer("127.0.0.1", server_.port(), echo_ports(1)), std::runtime_error);
  EXPECT_THROW(UsbipServer("nowhere", 0, echo_ports(1)), std::runtime_error);
}

}  // namespace
}  // namespace yuragi::simulators::usb
