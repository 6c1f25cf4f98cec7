// Byte ports against the other end of what they open: pseudo terminals, sockets on the loopback, files, pipes.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/bus/host_lookup.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/no_free_descriptor.hpp"
#include "tests/support/scripted_server.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::bus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto kHang = 60s;  // so long waits only who waits for something that hangs

/// What comes, until it is as long as expected.
std::string read_text(BytePort& port, std::size_t size) {
  std::string text;
  std::vector<std::uint8_t> buffer(kMaxDatagram);
  while (text.size() < size) {
    const ByteArrival arrival = port.read(buffer, kHang);
    if (arrival.status == ByteStatus::kBytes)
      text.append(buffer.begin(), buffer.begin() + static_cast<long>(arrival.size));
    if (arrival.status != ByteStatus::kBytes) break;
  }
  return text;
}

/// The status of a read once it is what is waited for; the last one if it hangs.
ByteStatus status_until(BytePort& port, ByteStatus wanted) {
  std::vector<std::uint8_t> buffer(kMaxDatagram);
  ByteStatus status = ByteStatus::kSilence;
  const auto deadline = std::chrono::steady_clock::now() + kHang;
  while (status != wanted && std::chrono::steady_clock::now() < deadline) status = port.read(buffer, 100ms).status;
  return status;
}

bool write_text(BytePort& port, std::string_view text) {
  return port.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// A read that waits for ever ends when somebody interrupts it.
void expect_interrupt_ends_read(BytePort& port) {
  std::vector<std::uint8_t> buffer(16);
  std::thread other([&port] {
    std::this_thread::yield();
    port.interrupt();
  });
  EXPECT_EQ(port.read(buffer, 1h).status, ByteStatus::kInterrupted);
  other.join();
  EXPECT_EQ(port.read(buffer, 1h).status, ByteStatus::kInterrupted);
  EXPECT_FALSE(port.open().has_value());
}

class SerialBytePortTest : public testing::Test {
 protected:
  SerialBytePortTest() {
    int far_end = -1;
    int kept = -1;
    std::array<char, 128> name{};
    if (openpty(&far_end, &kept, name.data(), nullptr, nullptr) != 0) throw std::runtime_error("no pseudo terminal");
    far_end_ = Descriptor(far_end);
    kept_ = Descriptor(kept);
    address_.path = name.data();
  }

  std::string far_end_reads(std::size_t size) const {
    std::string text(size, '\0');
    std::size_t at = 0;
    while (at < size) {
      const ssize_t got = ::read(far_end_.get(), &text[at], size - at);
      if (got <= 0) break;
      at += static_cast<std::size_t>(got);
    }
    return text.substr(0, at);
  }
  void far_end_writes(std::string_view text) const {
    ASSERT_EQ(::write(far_end_.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }

  BytePortAddress address_;
  Descriptor far_end_;
  Descriptor kept_;
};

TEST_F(SerialBytePortTest, CarriesEveryByteUnchangedBothWays) {
  const auto port = make_byte_port(address_);
  ASSERT_TRUE(port->open().has_value());
  std::string all(256, '\0');
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<char>(i);
  far_end_writes(all);
  EXPECT_EQ(read_text(*port, all.size()), all);
  ASSERT_TRUE(write_text(*port, all));
  EXPECT_EQ(far_end_reads(all.size()), all);
}

TEST_F(SerialBytePortTest, SetsTheLineUpAsItIsTold) {
  address_.baud = 19200;
  address_.stop_bits = 2;
  const auto port = make_byte_port(address_);
  ASSERT_TRUE(port->open().has_value());
  termios settings{};
  ASSERT_EQ(tcgetattr(kept_.get(), &settings), 0);
  EXPECT_EQ(cfgetispeed(&settings), static_cast<speed_t>(B19200));
  EXPECT_EQ(cfgetospeed(&settings), static_cast<speed_t>(B19200));
  EXPECT_TRUE((settings.c_cflag & CSTOPB) != 0U);
  EXPECT_TRUE((settings.c_cflag & CRTSCTS) == 0U);
  EXPECT_TRUE((settings.c_iflag & (IXON | IXOFF | ICRNL | INLCR)) == 0U);
  EXPECT_TRUE((settings.c_lflag & (ICANON | ECHO | ISIG)) == 0U);
}

TEST_F(SerialBytePortTest, RefusesBitsThatThePortDoesNotHave) {
  // A pseudo terminal has eight bits and no parity.
  address_.data_bits = 7;
  address_.parity = 'E';
  const auto opened = make_byte_port(address_)->open();
  ASSERT_FALSE(opened.has_value());
  EXPECT_THAT(opened.error().message, HasSubstr("at 9600 7E1 (Invalid argument): it does not support this rate"));
}

TEST_F(SerialBytePortTest, ForgetsWhatCameBeforeItWasOpened) {
  termios raw{};
  tcgetattr(kept_.get(), &raw);
  cfmakeraw(&raw);
  tcsetattr(kept_.get(), TCSANOW, &raw);
  far_end_writes("old");
  const auto deadline = std::chrono::steady_clock::now() + kHang;
  for (int waiting = 0; waiting < 3 && std::chrono::steady_clock::now() < deadline;) {
    ioctl(kept_.get(), FIONREAD, &waiting);
  }
  const auto port = make_byte_port(address_);
  ASSERT_TRUE(port->open().has_value());
  far_end_writes("new");
  EXPECT_EQ(read_text(*port, 3), "new");
}

TEST_F(SerialBytePortTest, IsReadByOneAloneAndFreeAfterwards) {
  const auto first = make_byte_port(address_);
  const auto second = make_byte_port(address_);
  ASSERT_TRUE(first->open().has_value());
  const auto refused = second->open();
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message, HasSubstr("another program has it open"));

  // The refusal left the first one's locks alone.
  int is_exclusive = 0;
  ASSERT_EQ(ioctl(kept_.get(), TIOCGEXCL, &is_exclusive), 0);
  EXPECT_NE(is_exclusive, 0);
  first->close();
  ASSERT_EQ(ioctl(kept_.get(), TIOCGEXCL, &is_exclusive), 0);
  EXPECT_EQ(is_exclusive, 0);
  EXPECT_TRUE(second->open().has_value());
}

TEST_F(SerialBytePortTest, IsLostWhenItsFarEndIsGone) {
  const auto port = make_byte_port(address_);
  ASSERT_TRUE(port->open().has_value());
  far_end_.reset();
  EXPECT_EQ(status_until(*port, ByteStatus::kLost), ByteStatus::kLost);
  EXPECT_FALSE(write_text(*port, "x"));
  port->close();
  EXPECT_EQ(status_until(*port, ByteStatus::kLost), ByteStatus::kLost) << "a closed port says nothing else";
}

TEST_F(SerialBytePortTest, IsSilentWhileNothingComes) {
  const auto port = make_byte_port(address_);
  ASSERT_TRUE(port->open().has_value());
  std::vector<std::uint8_t> buffer(16);
  EXPECT_EQ(port->read(buffer, 1ms).status, ByteStatus::kSilence);
  EXPECT_EQ(port->read(buffer, 0ms).status, ByteStatus::kSilence);
}

TEST_F(SerialBytePortTest, CanBeInterrupted) {
  const auto port = make_byte_port(address_);
  ASSERT_TRUE(port->open().has_value());
  expect_interrupt_ends_read(*port);
}

TEST_F(SerialBytePortTest, GivesUpWritingToAFarEndThatTakesNothing) {
  const auto port = make_byte_port(address_);
  ASSERT_TRUE(port->open().has_value());
  EXPECT_FALSE(write_text(*port, std::string(std::size_t{1} << 20U, 'x')));
}

TEST(SerialBytePortTrouble, SaysWhatIsWrongAndWhatToDo) {
  BytePortAddress address;
  address.path = "/dev/serial/by-id/no-such-adapter";
  const auto missing = make_byte_port(address)->open();
  ASSERT_FALSE(missing.has_value());
  EXPECT_THAT(missing.error().message, HasSubstr("check that it is plugged in, and its name"));
  address.path = "/dev/null";
  const auto other = make_byte_port(address)->open();
  ASSERT_FALSE(other.has_value());
  EXPECT_THAT(other.error().message, HasSubstr("it is not a serial port"));
}

TEST(TcpBytePort, CarriesBytesAndIsLostWithItsServer) {
  auto server = std::make_unique<ScriptedServer>([](const ScriptedServer::Bytes& request) { return request; });
  const BytePortAddress address = {.kind = BytePortKind::kTcpClient, .host = "localhost", .port = server->port()};
  const auto port = make_byte_port(address);
  ASSERT_TRUE(port->open().has_value());
  ASSERT_TRUE(write_text(*port, "there and back"));
  EXPECT_EQ(read_text(*port, 14), "there and back");

  server.reset();
  EXPECT_EQ(status_until(*port, ByteStatus::kLost), ByteStatus::kLost);
  const auto refused = port->open();
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message, HasSubstr("Connection refused): check the host and port"));
}

TEST(TcpBytePort, CanBeInterrupted) {
  const ScriptedServer server([](const ScriptedServer::Bytes&) { return ScriptedServer::Bytes(); });
  const auto port = make_byte_port({.kind = BytePortKind::kTcpClient, .host = "127.0.0.1", .port = server.port()});
  ASSERT_TRUE(port->open().has_value());
  expect_interrupt_ends_read(*port);
}

/// A server that takes no more connections, but does not refuse them either: what a dead host looks like.
TEST(TcpBytePort, GivesUpAServerThatDoesNotAnswer) {
  const Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(bind(listener.get(), generic, size), 0);
  ASSERT_EQ(listen(listener.get(), 0), 0);
  ASSERT_EQ(getsockname(listener.get(), generic, &size), 0);
  std::vector<Descriptor> waiting;
  for (int i = 0; i < 3; ++i) {
    waiting.emplace_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    static_cast<void>(connect(waiting.back().get(), generic, size));  // under way, or refused
  }

  const auto port = make_byte_port({.kind = BytePortKind::kTcpClient,
                                    .host = "127.0.0.1",
                                    .port = ntohs(address.sin_port),
                                    .connect_timeout = 200ms});
  const auto opened = port->open();
  ASSERT_FALSE(opened.has_value());
  EXPECT_THAT(opened.error().message, HasSubstr("timed out"));
}

TEST(HostLookup, FindsAddressesAndNamesAndGivesUpAtItsTime) {
  const auto address = HostLookup("192.0.2.7", 502).find(1s);
  ASSERT_TRUE(address.has_value());
  EXPECT_EQ(address->front().address().to_string(), "192.0.2.7");
  EXPECT_EQ(address->front().port(), 502);
  EXPECT_TRUE(HostLookup("localhost", 502).find(kHang).has_value());
  EXPECT_FALSE(HostLookup("no-such-host.invalid", 502).find(kHang).has_value());
  HostLookup interrupted("no-such-host.invalid", 502);
  interrupted.interrupt();
  EXPECT_FALSE(interrupted.find(1h).has_value());
}

TEST(HostLookup, WithoutADescriptorItFailsAndWorksAgainLater) {
  HostLookup lookup("localhost", 502);
  {
    const test::NoFreeDescriptor none;
    const auto found = lookup.find(kHang);
    ASSERT_FALSE(found.has_value());
    EXPECT_THAT(found.error().message, HasSubstr("localhost"));
  }
  EXPECT_TRUE(lookup.find(kHang).has_value());
}

/// A socket to send datagrams from, at an address of its own.
class Sender {
 public:
  explicit Sender(const char* from) : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = at(from, 0);
    if (bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no address to send from");
    }
  }
  void send(std::string_view text, std::uint16_t port, const char* to = "127.0.0.1") const {
    const sockaddr_in address = at(to, port);
    ASSERT_EQ(
        sendto(socket_.get(), text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address),
        static_cast<ssize_t>(text.size()));
  }

 private:
  static sockaddr_in at(const char* host, std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    inet_pton(AF_INET, host, &address.sin_addr);
    address.sin_port = htons(port);
    return address;
  }
  Descriptor socket_;
};

class UdpBytePort : public testing::Test {
 protected:
  const std::uint16_t port_ = free_port(SOCK_DGRAM);
};

TEST_F(UdpBytePort, KeepsDatagramsApartAndLongOnesWhole) {
  const auto port = make_byte_port({.kind = BytePortKind::kUdp, .host = "127.0.0.1", .port = port_});
  ASSERT_TRUE(port->open().has_value());
  const Sender sender("127.0.0.1");
  const std::string longest(60000, 'x');
  for (const std::string& text : {std::string("one"), std::string("two"), longest}) sender.send(text, port_);

  std::vector<std::uint8_t> buffer(kMaxDatagram);
  for (const std::size_t size : {std::size_t{3}, std::size_t{3}, longest.size()}) {
    const ByteArrival arrival = port->read(buffer, kHang);
    EXPECT_EQ(arrival.status, ByteStatus::kBytes);
    EXPECT_EQ(arrival.size, size);
    EXPECT_TRUE(arrival.is_whole_datagram);
  }
  EXPECT_FALSE(write_text(*port, "x"));
}

TEST_F(UdpBytePort, TakesOnlyTheSendersThatItIsTold) {
  const auto port =
      make_byte_port({.kind = BytePortKind::kUdp, .host = "", .port = port_, .senders = "127.0.0.2, 127.8.0.0/16"});
  ASSERT_TRUE(port->open().has_value());
  const Sender wanted("127.0.0.2");
  const Sender other("127.0.0.1");
  std::vector<std::uint8_t> buffer(kMaxDatagram);
  other.send("other", port_);
  const ByteArrival refused = port->read(buffer, kHang);
  EXPECT_EQ(refused.status, ByteStatus::kForeign);
  EXPECT_EQ(refused.sender, "127.0.0.1");
  wanted.send("wanted", port_);
  const ByteArrival arrival = port->read(buffer, kHang);
  EXPECT_EQ(arrival.status, ByteStatus::kBytes);
  EXPECT_EQ(arrival.size, 6U);
  Sender("127.8.9.1").send("of the net", port_);
  EXPECT_EQ(port->read(buffer, kHang).status, ByteStatus::kBytes);
}

TEST_F(UdpBytePort, CountsWhatTheKernelDropsWhileNobodyReads) {
  const auto port = make_byte_port({.kind = BytePortKind::kUdp, .host = "127.0.0.1", .port = port_});
  ASSERT_TRUE(port->open().has_value());
  const Sender sender("127.0.0.1");
  const std::string large(8000, 'x');
  constexpr std::uint32_t kFlood = 2000;  // 16 MB: more than a socket keeps
  for (std::uint32_t i = 0; i < kFlood; ++i) sender.send(large, port_);

  std::vector<std::uint8_t> buffer(kMaxDatagram);
  std::uint32_t read = 0;
  std::uint32_t dropped = 0;
  const auto read_all = [&] {
    for (ByteArrival arrival = port->read(buffer, 0s); arrival.status == ByteStatus::kBytes;
         arrival = port->read(buffer, 0s)) {
      ++read;
      dropped += arrival.overrun;
    }
  };
  read_all();
  EXPECT_LT(read, kFlood);
  sender.send("after the flood", port_);
  read_all();
  EXPECT_GT(dropped, 0U);
  EXPECT_EQ(read + dropped, kFlood + 1) << "each datagram is accounted for";
  sender.send("in peace", port_);
  const ByteArrival later = port->read(buffer, kHang);
  EXPECT_EQ(later.size, 8U);
  EXPECT_EQ(later.overrun, 0U);
}

TEST_F(UdpBytePort, SaysWhatIsWrongAndWhatToDo) {
  const auto first = make_byte_port({.kind = BytePortKind::kUdp, .host = "127.0.0.1", .port = port_});
  ASSERT_TRUE(first->open().has_value());
  const auto open = [](BytePortAddress address) {
    address.kind = BytePortKind::kUdp;
    const auto opened = make_byte_port(address)->open();
    return opened ? std::string("opened") : opened.error().message;
  };
  EXPECT_THAT(open({.host = "127.0.0.1", .port = port_}), HasSubstr("another program uses this port"));
  EXPECT_THAT(open({.host = "192.0.2.7", .port = port_}), HasSubstr("this machine does not have that address"));
  EXPECT_THAT(open({.host = "nowhere", .port = port_}), HasSubstr("is not an address of this machine"));
  EXPECT_THAT(open({.port = port_, .senders = "nobody"}), HasSubstr("\"nobody\" is neither an address"));
}

TEST_F(UdpBytePort, CanBeInterrupted) {
  const auto port = make_byte_port({.kind = BytePortKind::kUdp, .host = "127.0.0.1", .port = port_});
  ASSERT_TRUE(port->open().has_value());
  expect_interrupt_ends_read(*port);
}

class FileBytePortTest : public testing::Test {
 protected:
  std::unique_ptr<BytePort> open(bool is_played) const {
    auto port = make_byte_port({.kind = BytePortKind::kFile, .path = path_, .is_played = is_played});
    const auto opened = port->open();
    EXPECT_TRUE(opened.has_value()) << opened.error().message;
    return port;
  }
  void append(std::string_view text) const { std::ofstream(path_, std::ios::app) << text; }

  test::TemporaryFolder folder_;
  std::string path_ = (folder_ / "wind.txt").string();
};

TEST_F(FileBytePortTest, IsPlayedToItsEndOnce) {
  append("one\ntwo");
  const auto port = open(true);
  EXPECT_EQ(read_text(*port, 7), "one\ntwo");
  EXPECT_EQ(status_until(*port, ByteStatus::kEnd), ByteStatus::kEnd);
}

TEST_F(FileBytePortTest, IsFollowedFromTheLineThatIsBeingWritten) {
  append("old\nhal");
  const auto port = open(false);
  append("f\nnew\n");
  EXPECT_EQ(read_text(*port, 9), "half\nnew\n");
  append("more\n");
  EXPECT_EQ(read_text(*port, 5), "more\n");
}

TEST_F(FileBytePortTest, IsReadOnAfterItWasCutShort) {
  append("a long line that was there before\n");
  const auto port = open(false);
  std::vector<std::uint8_t> buffer(64);
  std::ofstream(path_, std::ios::trunc).close();
  EXPECT_EQ(port->read(buffer, 0ms).status, ByteStatus::kSilence);
  append("short\n");
  EXPECT_EQ(read_text(*port, 6), "short\n");
}

TEST_F(FileBytePortTest, IsLostWhenAnotherTakesItsName) {
  append("old\n");
  const auto port = open(false);
  std::filesystem::rename(path_, path_ + ".1");
  EXPECT_EQ(status_until(*port, ByteStatus::kLost), ByteStatus::kLost);
  EXPECT_FALSE(port->open().has_value());
  append("new\n");
  EXPECT_TRUE(port->open().has_value());
}

TEST_F(FileBytePortTest, MayBeAPipeWhoseWritersComeAndGo) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  const auto port = open(false);
  for (const std::string text : {"first\n", "second\n"}) {
    std::ofstream(path_) << text;
    EXPECT_EQ(read_text(*port, text.size()), text);
    std::vector<std::uint8_t> buffer(16);
    EXPECT_EQ(port->read(buffer, 1ms).status, ByteStatus::kSilence);
  }
  expect_interrupt_ends_read(*port);
}

TEST_F(FileBytePortTest, CanBeInterrupted) {
  append("old\n");
  expect_interrupt_ends_read(*open(false));
}

TEST_F(FileBytePortTest, ThatIsNoneSaysSo) {
  const auto missing = make_byte_port({.kind = BytePortKind::kFile, .path = path_})->open();
  ASSERT_FALSE(missing.has_value());
  EXPECT_THAT(missing.error().message, HasSubstr("check its name"));
  const auto folder = make_byte_port({.kind = BytePortKind::kFile, .path = folder_.path().string()})->open();
  ASSERT_FALSE(folder.has_value());
  EXPECT_THAT(folder.error().message, HasSubstr("neither a file nor a named pipe"));
}

TEST(BytePortAddress, IsDescribedForPeople) {
  EXPECT_EQ(describe({.path = "/dev/ttyUSB0", .baud = 4800, .parity = 'E'}), "/dev/ttyUSB0 at 4800 8E1");
  EXPECT_EQ(describe({.kind = BytePortKind::kTcpClient, .host = "::1", .port = 10110}), "[::1]:10110");
  EXPECT_EQ(describe({.kind = BytePortKind::kUdp, .port = 10110}), "UDP port 10110");
  EXPECT_EQ(describe({.kind = BytePortKind::kFile, .path = "/tmp/wind"}), "/tmp/wind");
}

}  // namespace
}  // namespace yuragi::drivers::bus
