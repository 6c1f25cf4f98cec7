// What the simulated devices say, byte for byte, and what the wire and its faults make of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/text/line_device.hpp"
#include "simulators/text/nmea2000_device.hpp"
#include "simulators/text/nmea_device.hpp"
#include "simulators/text/signalk_device.hpp"
#include "simulators/text/text_simulator.hpp"

namespace yuragi::simulators::text {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

constexpr core::PlayedMoment kMoment = {.speed_m_s = 3.42, .direction_deg = 230.6};

std::string message_in(const std::string& format, std::optional<core::FaultKind> fault = {},
                       core::PlayedMoment moment = kMoment) {
  const auto messages = make_nmea_device({format})->send_messages(moment, fault);
  return messages.size() == 1 ? messages[0] : "";
}

/// The checksums were computed by hand (Python: functools.reduce(xor, body)), not by the simulator.
TEST(NmeaDevice, SaysEachFormatByteForByte) {
  EXPECT_EQ(message_in("mwv"), "$WIMWV,230.6,R,3.42,M,A*12\r\n");
  EXPECT_EQ(message_in("mwd"), "$WIMWD,230.6,T,,M,6.65,N,3.42,M*73\r\n");
  EXPECT_EQ(message_in("vwr"), "$WIVWR,129.4,L,6.65,N,3.42,M,12.31,K*46\r\n");
  EXPECT_EQ(message_in("vwt"), "$WIVWT,129.4,L,6.65,N,3.42,M,12.31,K*40\r\n");
  EXPECT_EQ(message_in("mda"), "$WIMDA,29.9200,I,1.0132,B,12.5,C,,,55.0,,3.7,C,230.6,T,,M,6.65,N,3.42,M*73\r\n");
  EXPECT_EQ(message_in("xdr"), "$WIXDR,A,226,D,0,A,231,D,1,A,236,D,2,S,3.1,M,0,S,3.4,M,1,S,3.8,M,2*5A\r\n");
  EXPECT_EQ(message_in("gill"),
            "\x02Q,231,003.42,M,00,\x03"
            "1B\r\n");
  EXPECT_EQ(message_in("gill-uv"),
            "\x02Q,+002.17,-002.64,M,00,\x03"
            "32\r\n");
  EXPECT_EQ(message_in("ft"), "$WI,WVP=003.4,231,0*77\r\n");
  EXPECT_EQ(message_in("umb"), "$WIMWV,230.6,R,003.4,M,A*20\r\n");
  EXPECT_EQ(message_in("wxt"), "0r1,Dn=226D,Dm=231D,Dx=236D,Sn=3.1M,Sm=3.4M,Sx=3.8M@NE\r\n");
}

TEST(NmeaDevice, HasNoDirectionWhereAWindSonicHasNone) {
  EXPECT_THAT(message_in("gill", {}, {.speed_m_s = 0.03, .direction_deg = 10.0}),
              testing::HasSubstr("Q,,000.03,M,00,"));
}

TEST(NmeaDevice, SaysSeveralFormatsInOneBurst) {
  const auto messages = make_nmea_device({"mwd", "mwv"})->send_messages(kMoment, {});
  EXPECT_THAT(messages, ElementsAre(message_in("mwd"), message_in("mwv")));
}

TEST(NmeaDevice, FailsAsItIsTold) {
  EXPECT_EQ(message_in("mwv", core::FaultKind::kBadChecksum), "$WIMWV,230.6,R,3.42,M,A*13\r\n");
  EXPECT_EQ(message_in("mwv", core::FaultKind::kWrongId).substr(0, 6), "$IIMWV");
  EXPECT_EQ(message_in("gill", core::FaultKind::kWrongId).substr(0, 3), "\x02R,");
}

TEST(NmeaDevice, KnowsWhatItIsAsked) {
  EXPECT_TRUE(make_nmea_device({"umb"})->is_request("01TR4"));
  EXPECT_FALSE(make_nmea_device({"umb"})->is_request("02TR4"));
  EXPECT_TRUE(make_nmea_device({"ft"})->is_request("$01,WV?*2B"));
  EXPECT_TRUE(make_nmea_device({"wxt"})->is_request("0r1Goe"));
  EXPECT_FALSE(make_nmea_device({"mwv"})->is_request("01TR4"));
  EXPECT_THROW(make_nmea_device({"mwx"}), std::runtime_error);
}

TEST(Nmea2000Device, SaysEachFormatByteForByte) {
  const auto line_in = [](const std::string& format) {
    return make_nmea2000_device(format)->send_messages(kMoment, {}).at(0);
  };
  // 3.42 m/s is 342, 230.6 degrees are 4.0247 rad.
  EXPECT_EQ(line_in("yacht-devices"), "00:00:00.179 R 09FD0223 00 56 01 37 9D FA FF FF\r\n");
  EXPECT_EQ(
      line_in("canboat"),
      R"({"timestamp":"2026-06-21-15:00:00.626","prio":2,"src":35,"dst":255,"pgn":130306,"description":"Wind Data",)"
      R"("fields":{"SID":0,"Wind Speed":3.42,"Wind Angle":230.6,"Reference":"Apparent"}})"
      "\n");
  EXPECT_THAT(line_in("canboat-si"),
              testing::HasSubstr(R"("windAngle":4.0247,"reference":{"value":2,"name":"Apparent"})"));
  EXPECT_EQ(line_in("candump"), "(1436509052.249713) can0 09FD0223#005601379DFAFFFF\n");
  EXPECT_EQ(line_in("canboat-plain"), "2026-06-21T00:00:00.626Z,2,130306,35,255,8,00,56,01,37,9d,fa,ff,ff\r\n");
  EXPECT_EQ(line_in("actisense"), "A000000.626 23FF2 1FD02 005601379DFAFFFF\r\n");
  EXPECT_THAT(make_nmea2000_device("yacht-devices", "north")->send_messages(kMoment, {}).at(0),
              testing::HasSubstr(" F8 "));
  EXPECT_THAT(make_nmea2000_device("canboat", "boat")->send_messages(kMoment, {}).at(0),
              testing::HasSubstr(R"x("Reference":"True (boat referenced)")x"));
  EXPECT_THAT(make_nmea2000_device("canboat")->greeting(), testing::HasSubstr("std"));
  EXPECT_THROW(make_nmea2000_device("mwv"), std::runtime_error);
  EXPECT_THROW(make_nmea2000_device("canboat", "sideways"), std::runtime_error);
}

TEST(Nmea2000Device, SaysAFrameByteForByte) {
  const auto frame_in = [](std::optional<core::FaultKind> fault) {
    return make_nmea2000_can_device("magnetic")->send_messages(kMoment, fault).at(0);
  };
  using namespace std::string_literals;
  EXPECT_EQ(frame_in({}), "\x23\x02\xFD\x89\x08\0\0\0\0\x56\x01\x37\x9D\xF9\xFF\xFF"s) << "29 bits: 0x80000000";
  EXPECT_EQ(frame_in(core::FaultKind::kWrongId).front(), '\x24');
  EXPECT_EQ(frame_in(core::FaultKind::kException), "\x40\0\0\x20\x08\0\0\0\0\0\0\0\0\0\0\0"s) << "bus off";
}

TEST(SignalKDevice, SaysItsWindToWhomAsksForItAfterWhatItRemembers) {
  const auto server = make_signalk_device(true);
  EXPECT_TRUE(server->send_messages(kMoment, {}).empty());
  server->hear(R"({"context":"vessels.self","subscribe":[{"path":"navigation.*"}]})");
  EXPECT_TRUE(server->send_messages(kMoment, {}).empty());
  server->hear(R"({"context":"vessels.self","subscribe":[{"path":"environment.wind.*"}]})");
  const auto first = server->send_messages(kMoment, {});
  ASSERT_EQ(first.size(), 4U);
  EXPECT_THAT(first[0], testing::HasSubstr("33.0000"));
  EXPECT_THAT(first[2], testing::HasSubstr(R"("path":"environment.wind.speedApparent","value":3.4200)"));
  EXPECT_THAT(first[3], testing::HasSubstr(R"("path":"environment.wind.angleApparent","value":-2.2585)"));
  EXPECT_EQ(server->send_messages(kMoment, {}).size(), 2U);
  EXPECT_EQ(make_signalk_device(false)->send_messages(kMoment, {}).size(), 2U);
}

TEST(LineDevice, SaysColumnsAndKeys) {
  EXPECT_THAT(make_line_device("csv")->send_messages(kMoment, {}), ElementsAre("3.42,230.6\r\n"));
  EXPECT_THAT(make_line_device("key-value")->send_messages(kMoment, {}), ElementsAre("speed=3.42 direction=230.6\r\n"));
  EXPECT_THAT(make_line_device("units")->send_messages(kMoment, {}),
              ElementsAre("speed: 12.31 km/h, direction: 230.6 deg\r\n"));
  EXPECT_THAT(make_line_device("json")->send_messages(kMoment, {}),
              ElementsAre("{\"speed\":3.42,\"direction\":230.6}\r\n"));
  EXPECT_THROW(make_line_device("xml"), std::runtime_error);
}

/// A wire that keeps what is said.
struct Heard {
  std::vector<std::string> messages;
  std::string asked;
  bool is_there = true;
};
class KeepingWire final : public Wire {
 public:
  explicit KeepingWire(Heard& heard) : received_(heard) {}
  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override { return {}; }
  std::string read(std::span<const int> /*ready*/) override { return std::exchange(received_.asked, ""); }
  void write(std::string_view bytes) override { received_.messages.emplace_back(bytes); }
  void take_away() override { received_.is_there = false; }
  void bring_back() override { received_.is_there = true; }
  std::string place() const override { return "kept"; }

 private:
  Heard& received_;
};

/// Blows harder each second.
class GrowingWind final : public core::PlayedWind {
 public:
  core::PlayedMoment at(double time_s) override { return {.speed_m_s = time_s, .direction_deg = 90.0}; }
};

class TextSimulatorTest : public testing::Test {
 protected:
  Simulator make(double rate_hz, const std::string& format = "mwv") {
    return {make_nmea_device({format}), std::make_unique<KeepingWire>(received_), rate_hz,
            core::MeasuredWind(std::make_unique<GrowingWind>()), 1};
  }
  /// From one moment to another, 50 times a second.
  void serve(Simulator& simulator, double from_s, double to_s, std::optional<core::FaultKind> fault = {}) {
    for (int i = 0; from_s + 0.02 * i < to_s; ++i) simulator.serve({}, from_s + 0.02 * i, fault);
  }

  Heard received_;
};

TEST_F(TextSimulatorTest, SpeaksAtItsRateOfTheMomentThatItIs) {
  auto simulator = make(4.0);
  serve(simulator, 0.0, 9.99);
  ASSERT_EQ(received_.messages.size(), 40U);
  EXPECT_EQ(received_.messages[10].substr(0, 22), "$WIMWV,90.0,R,2.50,M,A");
}

TEST_F(TextSimulatorTest, AnswersOnlyWhatItIsAsked) {
  auto simulator = make(0.0, "umb");
  received_.asked = "01TR";
  serve(simulator, 0.0, 1.0);
  EXPECT_TRUE(received_.messages.empty());
  received_.asked = "4\r";
  serve(simulator, 1.0, 2.0);
  EXPECT_EQ(received_.messages.size(), 1U);
  received_.asked = "02TR4\r" + std::string(5000, 'x') + "\r01TR4\r";
  serve(simulator, 2.0, 3.0);
  EXPECT_EQ(received_.messages.size(), 2U);
}

TEST_F(TextSimulatorTest, FailsInEveryWayItIsToldTo) {
  auto simulator = make(4.0);
  const auto message_with = [&](core::FaultKind fault) {
    static double time_s = 10.0;
    serve(simulator, time_s, time_s + 0.25, {});
    received_.messages.clear();
    serve(simulator, time_s + 0.25, time_s + 0.5, fault);
    time_s += 0.5;
    std::string all;
    for (const std::string& message : received_.messages) all += message;
    return all;
  };
  serve(simulator, 0.0, 10.0);
  EXPECT_EQ(message_with(core::FaultKind::kSilence), "");
  const std::string frozen = message_with(core::FaultKind::kFreeze);
  EXPECT_EQ(message_with(core::FaultKind::kFreeze).substr(0, 13), frozen.substr(0, 13));
  EXPECT_THAT(message_with(core::FaultKind::kSpike), testing::HasSubstr(",R,55.00,M"));
  EXPECT_EQ(message_with(core::FaultKind::kGarbage).size() % 24, 0U);
  EXPECT_THAT(message_with(core::FaultKind::kPartial), Not(testing::HasSubstr("*")));
  const std::string split = message_with(core::FaultKind::kSplit);
  EXPECT_GE(received_.messages.size(), 3U);
  EXPECT_THAT(split, testing::EndsWith("\r\n"));
  message_with(core::FaultKind::kUnplug);
  EXPECT_FALSE(received_.is_there);
  EXPECT_TRUE(received_.messages.empty());
  EXPECT_THAT(message_with(core::FaultKind::kBadChecksum), testing::HasSubstr("*"));
  EXPECT_TRUE(received_.is_there);
}

TEST_F(TextSimulatorTest, IsLateOnlyWhereItIsAsked) {
  auto simulator = make(0.0, "umb");
  const auto known = simulator.known_faults();
  EXPECT_THAT(std::vector<core::FaultKind>(known.begin(), known.end()), Contains(core::FaultKind::kLate));
  auto sender = make(1.0);
  const auto others = sender.known_faults();
  EXPECT_THAT(std::vector<core::FaultKind>(others.begin(), others.end()), Not(Contains(core::FaultKind::kLate)));

  received_.asked = "01TR4\r";
  serve(simulator, 0.0, 1.2, core::FaultKind::kLate);
  EXPECT_TRUE(received_.messages.empty());
  serve(simulator, 1.2, 1.5);
  EXPECT_EQ(received_.messages.size(), 1U);
}

}  // namespace
}  // namespace yuragi::simulators::text
