// What the simulator says on the wire, byte by byte, without any Modbus client: the test moves its time.
#include "simulators/modbus/modbus_simulator.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>

#include "tests/support/descriptor.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::simulators::modbus {
namespace {

using testing::ElementsAre;

class SteadyWind final : public core::PlayedWind {
 public:
  core::PlayedMoment at(double time_s) override { return {8.6 + time_s, 359.7}; }
};

Simulator simulate(const std::vector<std::string>& devices, std::unique_ptr<Port> port,
                   const FaultOptions& options = {}) {
  std::vector<Slave> slaves;
  for (const std::string& device : devices) {
    for (const Slave& slave : modbus_slaves(device)) slaves.push_back(slave);
  }
  return {slaves, std::move(port), core::MeasuredWind(std::make_unique<SteadyWind>()), options};
}

/// Serves until there is nothing left to do.
void serve_all(Simulator& simulator, double time_s, std::optional<core::FaultKind> fault) {
  for (int ready_count = 1; ready_count > 0;) {
    std::vector<pollfd> waits;
    for (const int descriptor : simulator.descriptors()) waits.push_back({descriptor, POLLIN, 0});
    ready_count = poll(waits.data(), waits.size(), 20);
    std::vector<int> ready;
    for (const pollfd& wait : waits) {
      if (wait.revents != 0) ready.push_back(wait.fd);
    }
    simulator.serve(ready, time_s, fault);
  }
}

class ModbusSimulatorTest : public testing::Test {
 protected:
  std::uint16_t port() const {
    return static_cast<std::uint16_t>(std::stoi(simulator_.name().substr(std::string("127.0.0.1:").size())));
  }
  Descriptor connect_client() {
    Descriptor client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port());
    if (connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) client.reset();
    return client;
  }

  Bytes received_by(const Descriptor& client) const {
    Bytes reply(260);
    const ssize_t size = recv(client.get(), reply.data(), reply.size(), MSG_DONTWAIT);
    reply.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return reply;
  }
  Bytes exchange(const Descriptor& client, const Bytes& request, std::optional<core::FaultKind> fault = std::nullopt) {
    EXPECT_EQ(send(client.get(), request.data(), request.size(), MSG_NOSIGNAL), std::ssize(request));
    serve_all(simulator_, time_s_, fault);
    return received_by(client);
  }

  const Bytes read_speed_ = {0, 7, 0, 0, 0, 6, 1, 3, 0, 0, 0, 1};
  const Bytes read_vane_ = {0, 8, 0, 0, 0, 6, 2, 3, 0, 0, 0, 2};
  double time_s_ = 0.0;
  Simulator simulator_ = simulate({"renke-rs-fsjt-rs-fxjt-n01"}, make_modbus_tcp_port("127.0.0.1", 0));
};

TEST_F(ModbusSimulatorTest, PlaysTheWindInTimeOnTheRegistersOfBothDevices) {
  const Descriptor client = connect_client();
  EXPECT_THAT(exchange(client, read_speed_), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0, 86));
  EXPECT_THAT(exchange(client, read_vane_), ElementsAre(0, 8, 0, 0, 0, 7, 2, 3, 4, 0, 0, 360 >> 8, 360 & 0xFF));
  time_s_ = 1.4;
  EXPECT_THAT(exchange(client, read_speed_), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0, 100));
}

TEST_F(ModbusSimulatorTest, ServesSeveralClients) {
  const Descriptor one = connect_client();
  const Descriptor another = connect_client();
  EXPECT_EQ(exchange(one, read_speed_).size(), 11U);
  EXPECT_EQ(exchange(another, read_speed_).size(), 11U);
  EXPECT_EQ(exchange(one, read_vane_).size(), 13U);
}

TEST_F(ModbusSimulatorTest, RefusesWhatTheDevicesDoNotHave) {
  const Descriptor client = connect_client();
  EXPECT_THAT(exchange(client, {0, 1, 0, 0, 0, 6, 1, 3, 0, 1, 0, 1}),
              ElementsAre(0, 1, 0, 0, 0, 3, 1, 0x83, 2));  // address
  EXPECT_THAT(exchange(client, {0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 1}),
              ElementsAre(0, 1, 0, 0, 0, 3, 1, 0x84, 1));  // function
  EXPECT_THAT(exchange(client, {0, 1, 0, 0, 0, 6, 3, 3, 0, 0, 0, 1}),
              ElementsAre(0, 1, 0, 0, 0, 3, 3, 0x83, 11));  // device
}

TEST_F(ModbusSimulatorTest, FailsInEveryWayItIsToldTo) {
  const Descriptor client = connect_client();
  EXPECT_THAT(exchange(client, read_speed_, core::FaultKind::kSilence), ElementsAre());
  EXPECT_THAT(exchange(client, read_speed_, core::FaultKind::kException), ElementsAre(0, 7, 0, 0, 0, 3, 1, 0x83, 4));
  EXPECT_THAT(exchange(client, read_speed_, core::FaultKind::kWrongId), ElementsAre(0, 7, 0, 0, 0, 5, 2, 3, 2, 0, 86));
  EXPECT_THAT(exchange(client, read_speed_, core::FaultKind::kWrongTransaction),
              ElementsAre(0, 6, 0, 0, 0, 5, 1, 3, 2, 0, 86));
  EXPECT_THAT(exchange(client, read_speed_, core::FaultKind::kPartial), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0));
  EXPECT_EQ(exchange(client, read_speed_, core::FaultKind::kGarbage).size(), 24U);
  EXPECT_THAT(exchange(client, read_speed_), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0, 86));
}

TEST_F(ModbusSimulatorTest, DropsItsClientsRefusesNewOnesAndIsBackOnTheSamePort) {
  const Descriptor client = connect_client();
  ASSERT_EQ(exchange(client, read_speed_).size(), 11U);
  const std::uint16_t port_before = port();

  simulator_.serve({}, time_s_, core::FaultKind::kDisconnect);
  char byte = 0;
  EXPECT_EQ(recv(client.get(), &byte, 1, 0), 0);
  EXPECT_LT(connect_client().get(), 0);
  EXPECT_TRUE(simulator_.descriptors().empty());

  simulator_.serve({}, time_s_, std::nullopt);
  EXPECT_EQ(port(), port_before);
  EXPECT_EQ(exchange(connect_client(), read_speed_).size(), 11U);
}

TEST_F(ModbusSimulatorTest, OutlivesAClientThatStopsInTheMiddleOfARequest) {
  const Descriptor lame = connect_client();
  EXPECT_TRUE(exchange(lame, {0, 7, 0, 0, 0, 6, 1}).empty());
  EXPECT_EQ(exchange(connect_client(), read_speed_).size(), 11U);
}

TEST_F(ModbusSimulatorTest, AnswersLateWhenItsTimeHasCome) {
  const Descriptor client = connect_client();
  EXPECT_TRUE(exchange(client, read_speed_, core::FaultKind::kLate).empty());
  time_s_ = 0.7;
  serve_all(simulator_, time_s_, std::nullopt);
  EXPECT_TRUE(received_by(client).empty());
  time_s_ = 0.8;
  serve_all(simulator_, time_s_, std::nullopt);
  EXPECT_THAT(received_by(client), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0, 86));
}

TEST_F(ModbusSimulatorTest, SaysASplitAnswerInThreePieces) {
  const Descriptor client = connect_client();
  EXPECT_THAT(exchange(client, read_speed_, core::FaultKind::kSplit), ElementsAre(0));
  time_s_ = 0.03;
  serve_all(simulator_, time_s_, std::nullopt);
  EXPECT_THAT(received_by(client), ElementsAre(7, 0, 0, 0, 5));
  time_s_ = 0.06;
  serve_all(simulator_, time_s_, std::nullopt);
  EXPECT_THAT(received_by(client), ElementsAre(1, 3, 2, 0, 86));
}

TEST_F(ModbusSimulatorTest, AnswersQuestionsThatComeInPiecesAndTogether) {
  const Descriptor client = connect_client();
  const Bytes beginning(read_speed_.begin(), read_speed_.begin() + 5);
  EXPECT_TRUE(exchange(client, beginning).empty());
  Bytes rest(read_speed_.begin() + 5, read_speed_.end());
  rest.insert(rest.end(), read_vane_.begin(), read_vane_.end());
  EXPECT_EQ(exchange(client, rest).size(), 11U + 13U);
}

/// A serial line with three devices, of which the one with id 7 can be made to fail alone.
class ModbusSerialSimulatorTest : public testing::Test {
 protected:
  Bytes exchange(const Bytes& request, std::optional<core::FaultKind> fault = std::nullopt, double time_s = 0.0) {
    const Descriptor line(open(link_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    EXPECT_EQ(write(line.get(), request.data(), request.size()), std::ssize(request));
    serve_all(simulator_, time_s, fault);
    Bytes reply(260);
    reply.resize(static_cast<std::size_t>(std::max<ssize_t>(read(line.get(), reply.data(), reply.size()), 0)));
    return reply;
  }

  test::TemporaryFolder folder_;
  std::string link_ = folder_ / "wind";
  Simulator simulator_ = simulate({"renke-rs-fsjt-n01", "renke-rs-fsjt-n01@7", "lambrecht-industry@9"},
                                  make_modbus_rtu_port(link_), {.id = std::uint8_t{7}});
  const Bytes read_1_ = {0x01, 0x03, 0x00, 0x00, 0x00, 0x01, 0x84, 0x0A};
  const Bytes read_7_ = {0x07, 0x03, 0x00, 0x00, 0x00, 0x01, 0x84, 0x6C};
  const Bytes reply_1_ = {0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A};  // 8.6 m/s, as in angara/ws_espy
};

TEST_F(ModbusSerialSimulatorTest, IsFoundByItsLinkAndSaysWhatTheRealTranscriptSays) {
  EXPECT_EQ(simulator_.name(), link_);
  EXPECT_EQ(exchange(read_1_), reply_1_);
}

TEST_F(ModbusSerialSimulatorTest, PassesOverWhatHasNoRightSum) {
  Bytes noisy = {0xFF, 0x01, 0x03};
  noisy.insert(noisy.end(), read_1_.begin(), read_1_.end());
  EXPECT_EQ(exchange(noisy), reply_1_);
  Bytes damaged = read_1_;
  damaged[3] ^= 1U;
  EXPECT_TRUE(exchange(damaged).empty());
}

TEST_F(ModbusSerialSimulatorTest, IsSilentForAnIdThatNobodyHas) {
  EXPECT_TRUE(exchange({0x02, 0x03, 0x00, 0x00, 0x00, 0x01, 0x84, 0x39}).empty());
}

TEST_F(ModbusSerialSimulatorTest, LetsOneSlaveAloneSuffer) {
  EXPECT_TRUE(exchange(read_7_, core::FaultKind::kSilence).empty());
  EXPECT_EQ(exchange(read_1_, core::FaultKind::kSilence), reply_1_);
  Bytes wrong_sum = exchange(read_7_);
  ASSERT_EQ(wrong_sum.size(), 7U);
  wrong_sum.back() ^= 0xFFU;
  EXPECT_EQ(exchange(read_7_, core::FaultKind::kBadChecksum), wrong_sum);
}

TEST_F(ModbusSerialSimulatorTest, ClearsExtremesWhenTheirMeanIsReadAsTheMakerSays) {
  // The wind grows by 1 m/s a second. Lambrecht's 30001 is the speed, 30002 the mean that clears, 30004 the least.
  const auto least_at = [this](double time_s) {
    return exchange({0x09, 0x04, 0x75, 0x34, 0x00, 0x01, 0x6B, 0x40}, {}, time_s);
  };
  simulator_.serve({}, 0.0, std::nullopt);
  const Bytes least_before = least_at(2.0);
  ASSERT_EQ(least_before.size(), 7U);
  EXPECT_EQ(least_before[4], 86);
  EXPECT_EQ(exchange({0x09, 0x04, 0x75, 0x32, 0x00, 0x01, 0x8B, 0x41}, {}, 2.0).size(), 7U);
  EXPECT_EQ(least_at(2.0)[4], 106);
}

TEST_F(ModbusSerialSimulatorTest, IsGoneWhileUnpluggedAndBackUnderItsName) {
  simulator_.serve({}, 0.0, core::FaultKind::kUnplug);
  EXPECT_LT(open(link_.c_str(), O_RDWR | O_NOCTTY), 0);
  simulator_.serve({}, 0.0, std::nullopt);
  EXPECT_EQ(exchange(read_1_), reply_1_);
}

TEST(ModbusDevices, OfSeveralSlavesHaveIdsInARow) {
  const auto slaves = modbus_slaves("renke-rs-fsjt-rs-fxjt-n01@5");
  ASSERT_EQ(slaves.size(), 2U);
  EXPECT_EQ(slaves[0].id, 5);
  EXPECT_EQ(slaves[1].id, 6);
}

TEST(ModbusDevices, ThatNobodyKnowsAndIdsThatNoneCanHaveAreRefused) {
  EXPECT_THROW(modbus_slaves("no-such-device"), std::runtime_error);
  EXPECT_THROW(modbus_slaves("renke-rs-fsjt-rs-fxjt-n01@247"), std::runtime_error);
  EXPECT_THROW(modbus_slaves("renke-rs-fsjt-n01@0"), std::runtime_error);
  EXPECT_THROW(modbus_slaves("renke-rs-fsjt-n01@x"), std::runtime_error);
}

TEST(ModbusSimulatorSetUp, RefusesTwoSlavesOfOneIdAndAnAddressThatIsTaken) {
  EXPECT_THROW(simulate({"renke-rs-fsjt-n01", "calypso-ulp"}, make_modbus_tcp_port("127.0.0.1", 0)),
               std::runtime_error);
  const auto first = make_modbus_tcp_port("127.0.0.1", 0);
  const auto port = static_cast<std::uint16_t>(std::stoi(first->name().substr(std::string("127.0.0.1:").size())));
  EXPECT_THROW(make_modbus_tcp_port("127.0.0.1", port), std::runtime_error);
}

}  // namespace
}  // namespace yuragi::simulators::modbus
