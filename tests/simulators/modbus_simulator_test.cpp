// What the simulator says on the wire, byte by byte, without any Modbus client: the test moves its time.
#include "simulators/modbus_simulator.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include "tests/support/descriptor.hpp"

namespace yuragi::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::ElementsAre;

class SteadyWind final : public PlayedWind {
 public:
  PlayedMoment at(double time_s) override { return {8.6 + time_s, 359.7}; }
};

class ModbusSimulatorTest : public testing::Test {
 protected:
  Descriptor connect_client() {
    Descriptor client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(simulator_.port());
    if (connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) client.reset();
    return client;
  }

  /// Serves until there is nothing left to do.
  void serve(std::optional<FaultKind> fault = std::nullopt) {
    for (int ready_count = 1; ready_count > 0;) {
      std::vector<pollfd> waits;
      for (const int descriptor : simulator_.descriptors()) waits.push_back({descriptor, POLLIN, 0});
      ready_count = poll(waits.data(), waits.size(), 20);
      std::vector<int> ready;
      for (const pollfd& wait : waits) {
        if (wait.revents != 0) ready.push_back(wait.fd);
      }
      simulator_.serve(ready, time_s_, fault);
    }
  }

  Bytes ask(const Descriptor& client, const Bytes& request, std::optional<FaultKind> fault = std::nullopt) {
    EXPECT_EQ(send(client.get(), request.data(), request.size(), MSG_NOSIGNAL), std::ssize(request));
    serve(fault);
    Bytes answer(260);
    const ssize_t size = recv(client.get(), answer.data(), answer.size(), MSG_DONTWAIT);
    answer.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return answer;
  }

  const Bytes ask_speed_ = {0, 7, 0, 0, 0, 6, 1, 3, 0, 0, 0, 1};
  const Bytes ask_vane_ = {0, 8, 0, 0, 0, 6, 2, 3, 0, 0, 0, 2};
  double time_s_ = 0.0;
  ModbusSimulator simulator_{"renke-rs-fsjt-rs-fxjt-n01", "127.0.0.1", 0, 1,
                             MeasuredWind(std::make_unique<SteadyWind>())};
};

TEST_F(ModbusSimulatorTest, PlaysTheWindInTimeOnTheRegistersOfBothDevices) {
  const Descriptor client = connect_client();
  EXPECT_THAT(ask(client, ask_speed_), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0, 86));
  EXPECT_THAT(ask(client, ask_vane_), ElementsAre(0, 8, 0, 0, 0, 7, 2, 3, 4, 0, 0, 360 >> 8, 360 & 0xFF));
  time_s_ = 1.4;
  EXPECT_THAT(ask(client, ask_speed_), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0, 100));
}

TEST_F(ModbusSimulatorTest, ServesSeveralClients) {
  const Descriptor one = connect_client();
  const Descriptor another = connect_client();
  EXPECT_EQ(ask(one, ask_speed_).size(), 11U);
  EXPECT_EQ(ask(another, ask_speed_).size(), 11U);
  EXPECT_EQ(ask(one, ask_vane_).size(), 13U);
}

TEST_F(ModbusSimulatorTest, RefusesWhatTheDevicesDoNotHave) {
  const Descriptor client = connect_client();
  EXPECT_THAT(ask(client, {0, 1, 0, 0, 0, 6, 1, 3, 0, 1, 0, 1}), ElementsAre(0, 1, 0, 0, 0, 3, 1, 0x83, 2));  // address
  EXPECT_THAT(ask(client, {0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 1}),
              ElementsAre(0, 1, 0, 0, 0, 3, 1, 0x84, 1));  // function
  EXPECT_THAT(ask(client, {0, 1, 0, 0, 0, 6, 3, 3, 0, 0, 0, 1}), ElementsAre(0, 1, 0, 0, 0, 3, 3, 0x83, 11));  // device
}

TEST_F(ModbusSimulatorTest, FailsInEveryWayItIsToldTo) {
  const Descriptor client = connect_client();
  EXPECT_THAT(ask(client, ask_speed_, FaultKind::kSilence), ElementsAre());
  EXPECT_THAT(ask(client, ask_speed_, FaultKind::kException), ElementsAre(0, 7, 0, 0, 0, 3, 1, 0x83, 4));
  EXPECT_THAT(ask(client, ask_speed_, FaultKind::kWrongId), ElementsAre(0, 7, 0, 0, 0, 5, 2, 3, 2, 0, 86));
  EXPECT_THAT(ask(client, ask_speed_, FaultKind::kWrongTransaction), ElementsAre(0, 6, 0, 0, 0, 5, 1, 3, 2, 0, 86));
  EXPECT_THAT(ask(client, ask_speed_, FaultKind::kPartial), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0));
  EXPECT_EQ(ask(client, ask_speed_, FaultKind::kGarbage).size(), 24U);
  EXPECT_THAT(ask(client, ask_speed_), ElementsAre(0, 7, 0, 0, 0, 5, 1, 3, 2, 0, 86));
}

TEST_F(ModbusSimulatorTest, DropsItsClientsRefusesNewOnesAndIsBackOnTheSamePort) {
  const Descriptor client = connect_client();
  ASSERT_EQ(ask(client, ask_speed_).size(), 11U);
  const std::uint16_t port = simulator_.port();

  simulator_.serve({}, time_s_, FaultKind::kDisconnect);
  char byte = 0;
  EXPECT_EQ(recv(client.get(), &byte, 1, 0), 0);
  EXPECT_LT(connect_client().get(), 0);
  EXPECT_TRUE(simulator_.descriptors().empty());

  simulator_.serve({}, time_s_, std::nullopt);
  EXPECT_EQ(simulator_.port(), port);
  EXPECT_EQ(ask(connect_client(), ask_speed_).size(), 11U);
}

TEST_F(ModbusSimulatorTest, OutlivesAClientThatStopsInTheMiddleOfARequest) {
  const Descriptor lame = connect_client();
  EXPECT_TRUE(ask(lame, {0, 7, 0, 0, 0, 6, 1}).empty());
  EXPECT_EQ(ask(connect_client(), ask_speed_).size(), 11U);
}

TEST(ModbusSimulatorSetUp, RefusesADeviceThatItDoesNotKnowAndAnAddressThatIsTaken) {
  EXPECT_THROW(ModbusSimulator("no-such-device", "127.0.0.1", 0, 1, MeasuredWind(std::make_unique<SteadyWind>())),
               std::runtime_error);
  const ModbusSimulator first("renke-rs-fsjt-n01", "127.0.0.1", 0, 1, MeasuredWind(std::make_unique<SteadyWind>()));
  EXPECT_THROW(
      ModbusSimulator("renke-rs-fsjt-n01", "127.0.0.1", first.port(), 1, MeasuredWind(std::make_unique<SteadyWind>())),
      std::runtime_error);
}

}  // namespace
}  // namespace yuragi::sim
