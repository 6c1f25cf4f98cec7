// Finding out what is on a line, against the simulator.
#include "drivers/modbus/modbus_probe.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/modbus_programs.hpp"
#include "tests/support/modbus_servers.hpp"

namespace yuragi::simulators::modbus {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Transport = test::ModbusSimulatorProgram::Transport;

const std::vector<std::string> kSteadyAir = {"--speed", "7", "--direction", "135", "--turbulence", "0"};

class ModbusProbeTest : public testing::Test {
 protected:
  void play(Transport transport, std::vector<std::string> options) {
    if (std::ranges::find(options, "--speed") == options.end())
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
  std::vector<drivers::modbus::Hit> probe() {
    std::vector<drivers::modbus::Hit> hits;
    const auto count = drivers::modbus::probe_modbus(
        plan_, [this](const drivers::bus::ModbusLine&, std::uint8_t, double) { ++tried_; },
        [&hits](const drivers::modbus::Hit& hit) { hits.push_back(hit); }, interruption_);
    EXPECT_TRUE(count);
    EXPECT_EQ(*count, static_cast<int>(hits.size()));
    return hits;
  }
  static std::vector<std::string> names_of(const drivers::modbus::Hit& hit) {
    std::vector<std::string> names;
    for (const drivers::modbus::Fit& fit : hit.fits) names.push_back(fit.profile);
    return names;
  }

  std::unique_ptr<test::ModbusSimulatorProgram> simulator_;
  drivers::modbus::ProbePlan plan_;
  drivers::bus::Interruption interruption_;
  int tried_ = 0;
};

TEST_F(ModbusProbeTest, FindsEachDeviceBehindAGatewayAndWhatItSays) {
  play(Transport::kTcp, {"--device", "thies-clima-sensor-us", "--device", "calypso-ulp@3", "--device",
                         "lambrecht-industry@4", "--device", "gill-maximet-gmx@6"});
  plan_.ids = {1, 2, 3, 4, 5, 6};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 5U);
  EXPECT_THAT(names_of(hits[0]), ElementsAre("thies-clima-sensor-us"));
  EXPECT_THAT(names_of(hits[1]), ElementsAre("calypso-ulp"));
  // A pair is looked for under its own ids, 1 and 2: elsewhere each half is found by itself.
  ASSERT_THAT(names_of(hits[2]), ElementsAre("lambrecht-industry"));
  EXPECT_NEAR(*hits[2].fits[0].speed_m_s, 7.0, 1e-6);
  EXPECT_FALSE(hits[2].fits[0].direction_deg.has_value());
  EXPECT_EQ(hits[2].fits[0].direction_slave, 2);
  ASSERT_THAT(names_of(hits[3]), ElementsAre("lambrecht-industry"));
  EXPECT_FALSE(hits[3].fits[0].speed_m_s.has_value());
  EXPECT_THAT(names_of(hits[4]), testing::Contains("gill-maximet-gmx"));
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

TEST_F(ModbusProbeTest, FindsThePairOfALambrechtUnderItsFactoryIds) {
  play(Transport::kTcp, {"--device", "lambrecht-industry"});
  plan_.ids = {1, 2};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 2U);
  ASSERT_THAT(names_of(hits[0]), ElementsAre("lambrecht-industry"));
  EXPECT_NEAR(*hits[0].fits[0].speed_m_s, 7.0, 1e-6);
  EXPECT_NEAR(*hits[0].fits[0].direction_deg, 135.0, 1e-6);
  EXPECT_EQ(hits[0].fits[0].direction_slave, 2);
}

TEST_F(ModbusProbeTest, FindsAStationByItsOwnRegistersWhereTheFirstOnesAreMissing) {
  play(Transport::kTcp, {"--device", "ecowitt-wn90lp"});
  plan_.ids = {144};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 1U);
  ASSERT_THAT(names_of(hits[0]), ElementsAre("ecowitt-wn90lp"));
  EXPECT_TRUE(hits[0].fits[0].is_at_home);
  EXPECT_NEAR(*hits[0].fits[0].gust_m_s, 7.0, 1e-6);
}

TEST_F(ModbusProbeTest, FindsACupWhoseOnlyRegisterIs0x16) {
  play(Transport::kTcp, {"--device", "generic-rs485-cup-0x16"});
  plan_.ids = {1};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 1U);
  EXPECT_THAT(names_of(hits[0]), ElementsAre("generic-rs485-cup-0x16"));
  EXPECT_NEAR(hits[0].fits[0].speed_m_s.value(), 7.0, 1e-6);
}

TEST_F(ModbusProbeTest, SettlesAScaleByTheWindForceThatTheDeviceItselfMakesOfIt) {
  using drivers::modbus::ForceVerdict;
  play(Transport::kTcp, {"--device", "renke-multi-station@1", "--device", "renke-multi-station-x100@2"});
  plan_.ids = {1, 2};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 2U);
  for (const drivers::modbus::Hit& hit : hits) {
    // Both are shown, and the right one first.
    ASSERT_EQ(hit.fits.size(), 2U);
    EXPECT_NEAR(*hit.fits[0].speed_m_s, 7.0, 1e-6);
    EXPECT_EQ(hit.fits[0].beaufort, 4.0);
    EXPECT_EQ(hit.fits[0].verdict, ForceVerdict::kAgrees);
    EXPECT_EQ(hit.fits[1].verdict, ForceVerdict::kContradicts);
    EXPECT_THAT(hit.scale_doubts, testing::IsEmpty());
  }
  EXPECT_EQ(hits[0].fits[0].profile, "renke-multi-station");
  EXPECT_NEAR(*hits[0].fits[1].speed_m_s, 0.7, 1e-6);
  EXPECT_EQ(hits[1].fits[0].profile, "renke-multi-station-x100");
  EXPECT_NEAR(*hits[1].fits[1].speed_m_s, 70.0, 1e-6);
}

TEST_F(ModbusProbeTest, LeavesAScaleOpenThatNothingSettles) {
  // The SEN0657 has no wind force; and a calm has none in any scale.
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--device", "dfrobot-sen0657"},
        std::vector<std::string>{"--device", "renke-multi-station", "--speed", "0", "--direction", "90", "--turbulence",
                                 "0"}}) {
    play(Transport::kTcp, options);
    plan_.ids = {1};
    const auto hits = probe();
    ASSERT_EQ(hits.size(), 1U);
    ASSERT_EQ(hits[0].fits.size(), 2U);
    EXPECT_THAT(hits[0].scale_doubts, ElementsAre("renke-multi-station", "renke-multi-station-x100"));
  }
}

TEST_F(ModbusProbeTest, RanksNothingThatReadsZerosAboveWhatIsLive) {
  // A cup of 3.7 m/s, all of whose other registers are 0: profiles with direction and gust fit it, too.
  std::vector<std::uint16_t> registers(250, 0);
  registers[0] = 37;
  const SerialBus bus({{3, registers}});
  plan_.profiles = drivers::modbus::shipped_modbus_profiles(test::source_path("drivers/modbus/profiles"));
  plan_.lines = drivers::modbus::likely_modbus_lines(bus.device(), plan_.profiles, {9600}, {'N'});
  plan_.response_timeout = std::chrono::seconds(2);
  plan_.ids = {3};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 1U);
  const auto& fits = hits[0].fits;
  EXPECT_THAT(names_of(hits[0]), testing::IsSupersetOf({"calypso-ulp", "xunchip-xm8589", "vaisala-wm80"}));
  EXPECT_NEAR(*fits.at(0).speed_m_s, 3.7, 1e-9);
  EXPECT_TRUE(std::ranges::is_partitioned(fits, drivers::modbus::is_live));
  const auto calypso = std::ranges::find(fits, "calypso-ulp", &drivers::modbus::Fit::profile);
  EXPECT_FALSE(drivers::modbus::is_live(*calypso));
}

TEST_F(ModbusProbeTest, WritesTheTableThatTheDriverTakes) {
  play(Transport::kTcp, {"--device", "calypso-ulp@3"});
  plan_.ids = {3};
  const auto hits = probe();
  ASSERT_EQ(hits.size(), 1U);
  const auto named = std::ranges::find(plan_.profiles, "calypso-ulp", &drivers::modbus::NamedModbusProfile::name);
  EXPECT_EQ(drivers::modbus::sensor_table_for("roof", hits[0].line, hits[0].fits.at(0), named->profile, ""),
            "[[sensor]]\nname = \"roof\"\ndriver = \"modbus\"\nprofile = \"calypso-ulp\"\ntransport = \"tcp\"\n"
            "host = \"127.0.0.1\"\nport = " +
                simulator_->where() + "\nspeed_slave = 3\n");

  drivers::bus::ModbusLine serial;
  serial.framing = drivers::decode::modbus::Framing::kRtu;
  serial.baud = 9600;
  serial.parity = 'E';
  EXPECT_THAT(drivers::modbus::sensor_table_for("roof", serial, hits[0].fits[0], named->profile, "/dev/serial/by-id/x"),
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
      [&](const drivers::modbus::Hit&) {
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
      plan_, [](const drivers::bus::ModbusLine&, std::uint8_t, double) {}, [](const drivers::modbus::Hit&) {},
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
