// Finding out what is on a line, against the simulator.
#include "drivers/modbus/modbus_probe.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/modbus_programs.hpp"

namespace yuragi::simulators::modbus {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Transport = test::ModbusSimulatorProgram::Transport;

const std::vector<std::string> kSteadyAir = {"--speed", "7", "--direction", "135", "--turbulence", "0"};

class ModbusProbeTest : public testing::Test {
 protected:
  void play(Transport transport, std::vector<std::string> options) {
    options.insert(options.end(), kSteadyAir.begin(), kSteadyAir.end());
    simulator_ = std::make_unique<test::ModbusSimulatorProgram>(transport, options);
    plan_.profiles = drivers::modbus::shipped_modbus_profiles(test::source_path("drivers/modbus/profiles"));
    if (transport == Transport::kTcp) {
      drivers::bus::ModbusLine line;
      line.host = "127.0.0.1";
      line.port = static_cast<std::uint16_t>(std::stoi(simulator_->where()));
      plan_.lines = {line};
    } else {
      plan_.lines = drivers::modbus::likely_modbus_lines(simulator_->where(), plan_.profiles, {9600}, {'N'});
    }
  }
  std::vector<drivers::modbus::ModbusHit> probe() {
    std::vector<drivers::modbus::ModbusHit> hits;
    const auto count = drivers::modbus::probe_modbus(
        plan_, [this](const drivers::bus::ModbusLine&, std::uint8_t, double) { ++tried_; },
        [&hits](const drivers::modbus::ModbusHit& hit) { hits.push_back(hit); }, interruption_);
    EXPECT_TRUE(count);
    EXPECT_EQ(*count, static_cast<int>(hits.size()));
    return hits;
  }
  static std::vector<std::string> names_of(const drivers::modbus::ModbusHit& hit) {
    std::vector<std::string> names;
    for (const drivers::modbus::ModbusFit& fit : hit.fits) names.push_back(fit.profile);
    return names;
  }

  std::unique_ptr<test::ModbusSimulatorProgram> simulator_;
  drivers::modbus::ModbusProbePlan plan_;
  drivers::bus::Interruption interruption_;
  int tried_ = 0;
};

TEST_F(ModbusProbeTest, FindsEachDeviceBehindAGatewayAndWhatItSays) {
  play(Transport::kTcp, {"--device", "thies-clima-sensor-us", "--device", "calypso-ulp@3", "--device",
                         "lambrecht-industry@4", "--device", "gill-maximet-gmx@5"});
  plan_.ids = {1, 2, 3, 4, 5, 6};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 4U);
  EXPECT_THAT(names_of(hits[0]), ElementsAre("thies-clima-sensor-us"));
  EXPECT_THAT(names_of(hits[1]), ElementsAre("calypso-ulp"));
  EXPECT_THAT(names_of(hits[2]), ElementsAre("lambrecht-industry"));
  EXPECT_THAT(names_of(hits[3]), testing::Contains("gill-maximet-gmx"));
  EXPECT_NEAR(*hits[1].fits[0].speed_m_s, 7.0, 1e-6);
  EXPECT_NEAR(*hits[1].fits[0].direction_deg, 135.0, 1e-6);
  EXPECT_NEAR(*hits[1].fits[0].gust_m_s, 7.0, 1e-6);
  EXPECT_EQ(tried_, 6);
}

TEST_F(ModbusProbeTest, FindsAPairOnASerialLineAndAVaneThatHasMoved) {
  play(Transport::kRtu, {"--device", "dfrobot-sen0483-sen0482", "--device", "renke-rs-fxjt-n01@9"});
  plan_.ids = {2, 3, 9, 10};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 3U);
  EXPECT_EQ(hits[0].fits.at(0).profile, "dfrobot-sen0483-sen0482");
  EXPECT_TRUE(hits[0].fits[0].is_at_home);
  EXPECT_THAT(names_of(hits[0]), testing::Contains("dfrobot-sen0483"));
  EXPECT_FALSE(hits[1].fits.at(0).speed_m_s.has_value());
  EXPECT_THAT(names_of(hits[1]), testing::Contains("dfrobot-sen0483-sen0482"));
  EXPECT_EQ(hits[2].id, 9);
}

TEST_F(ModbusProbeTest, WritesTheTableThatTheDriverTakes) {
  play(Transport::kTcp, {"--device", "calypso-ulp@3"});
  plan_.ids = {3};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 1U);
  const auto named = std::ranges::find(plan_.profiles, "calypso-ulp", &drivers::modbus::NamedModbusProfile::name);
  EXPECT_EQ(drivers::modbus::sensor_table_for(hits[0].line, hits[0].fits.at(0), named->profile, ""),
            "[[sensor]]\nname = \"wind\"\ndriver = \"modbus\"\nprofile = \"calypso-ulp\"\ntransport = \"tcp\"\n"
            "host = \"127.0.0.1\"\nport = " +
                simulator_->where() + "\nspeed_slave = 3\n");

  drivers::bus::ModbusLine serial;
  serial.framing = drivers::decode::modbus::ModbusFraming::kRtu;
  serial.baud = 9600;
  serial.parity = 'E';
  EXPECT_THAT(drivers::modbus::sensor_table_for(serial, hits[0].fits[0], named->profile, "/dev/serial/by-id/x"),
              HasSubstr("device = \"/dev/serial/by-id/x\"\nbaud = 9600\nparity = \"even\"\nspeed_slave = 3\n"));
}

TEST_F(ModbusProbeTest, FindsNobodyWhereNobodyIs) {
  play(Transport::kRtu, {"--device", "renke-rs-fsjt-n01@40"});
  plan_.ids = {1, 2};
  plan_.response_timeout = std::chrono::milliseconds(30);
  EXPECT_TRUE(probe().empty());
}

TEST_F(ModbusProbeTest, EndsWhenItIsInterrupted) {
  play(Transport::kRtu, {});
  plan_.ids = {1, 2, 3};
  int found = 0;
  const auto count = drivers::modbus::probe_modbus(
      plan_, [](const drivers::bus::ModbusLine&, std::uint8_t, double) {},
      [&](const drivers::modbus::ModbusHit&) {
        ++found;
        interruption_.set();
      },
      interruption_);
  EXPECT_EQ(found, 1);
  EXPECT_EQ(*count, 1);
}

TEST_F(ModbusProbeTest, SaysWhyAPortCannotBeOpened) {
  plan_.lines = drivers::modbus::likely_modbus_lines("/no/such/port", {}, {}, {});
  plan_.ids = {1};
  const auto count = drivers::modbus::probe_modbus(
      plan_, [](const drivers::bus::ModbusLine&, std::uint8_t, double) {}, [](const drivers::modbus::ModbusHit&) {},
      interruption_);
  ASSERT_FALSE(count);
  EXPECT_THAT(count.error().message, HasSubstr("cannot open /no/such/port"));
}

TEST(ModbusProbeLines, BeginWithWhatMostProfilesHaveAndCanBeNarrowed) {
  const auto profiles = drivers::modbus::shipped_modbus_profiles(test::source_path("drivers/modbus/profiles"));
  const auto all = drivers::modbus::likely_modbus_lines("/dev/x", profiles, {}, {});
  ASSERT_GE(all.size(), 7U);
  EXPECT_EQ(all[0].baud, 9600);
  EXPECT_EQ(all[0].parity, 'N');
  const auto is_lufft = [](const drivers::bus::ModbusLine& line) { return line.baud == 19200 && line.parity == 'E'; };
  EXPECT_EQ(std::ranges::count_if(all, is_lufft), 1);

  const auto narrow = drivers::modbus::likely_modbus_lines("/dev/x", profiles, {1200}, {'O'});
  ASSERT_EQ(narrow.size(), 1U);
  EXPECT_EQ(narrow[0].baud, 1200);
  EXPECT_EQ(narrow[0].parity, 'O');
}

}  // namespace
}  // namespace yuragi::simulators::modbus
