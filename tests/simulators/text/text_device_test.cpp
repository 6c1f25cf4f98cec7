// What the simulated devices say, byte for byte, and what the wire and its faults make of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/text/line_device.hpp"
#include "simulators/text/nmea_device.hpp"
#include "simulators/text/text_simulator.hpp"

namespace yuragi::sim {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

constexpr PlayedMoment kSaid = {.speed_m_s = 3.42, .direction_deg = 230.6};

std::string said_in(const std::string& format, std::optional<FaultKind> fault = {}, PlayedMoment moment = kSaid) {
  const auto messages = make_nmea_device({format})->say(moment, fault);
  return messages.size() == 1 ? messages[0] : "";
}

/// The checksums were computed by hand (Python: functools.reduce(xor, body)), not by the simulator.
TEST(NmeaDevice, SaysEachFormatByteForByte) {
  EXPECT_EQ(said_in("mwv"), "$WIMWV,230.6,R,3.42,M,A*12\r\n");
  EXPECT_EQ(said_in("mwd"), "$WIMWD,230.6,T,,M,6.65,N,3.42,M*73\r\n");
  EXPECT_EQ(said_in("vwr"), "$WIVWR,129.4,L,6.65,N,3.42,M,12.31,K*46\r\n");
  EXPECT_EQ(said_in("vwt"), "$WIVWT,129.4,L,6.65,N,3.42,M,12.31,K*40\r\n");
  EXPECT_EQ(said_in("mda"), "$WIMDA,29.9200,I,1.0132,B,12.5,C,,,55.0,,3.7,C,230.6,T,,M,6.65,N,3.42,M*73\r\n");
  EXPECT_EQ(said_in("xdr"), "$WIXDR,A,226,D,0,A,231,D,1,A,236,D,2,S,3.1,M,0,S,3.4,M,1,S,3.8,M,2*5A\r\n");
  EXPECT_EQ(said_in("gill"),
            "\x02Q,231,003.42,M,00,\x03"
            "1B\r\n");
  EXPECT_EQ(said_in("gill-uv"),
            "\x02Q,+002.17,-002.64,M,00,\x03"
            "32\r\n");
  EXPECT_EQ(said_in("ft"), "$WI,WVP=003.4,231,0*77\r\n");
  EXPECT_EQ(said_in("umb"), "$WIMWV,230.6,R,003.4,M,A*20\r\n");
}

TEST(NmeaDevice, HasNoDirectionWhereAWindSonicHasNone) {
  EXPECT_THAT(said_in("gill", {}, {.speed_m_s = 0.03, .direction_deg = 10.0}), testing::HasSubstr("Q,,000.03,M,00,"));
}

TEST(NmeaDevice, SaysSeveralFormatsInOneBurst) {
  const auto messages = make_nmea_device({"mwd", "mwv"})->say(kSaid, {});
  EXPECT_THAT(messages, ElementsAre(said_in("mwd"), said_in("mwv")));
}

TEST(NmeaDevice, FailsAsItIsTold) {
  EXPECT_EQ(said_in("mwv", FaultKind::kBadChecksum), "$WIMWV,230.6,R,3.42,M,A*13\r\n");
  EXPECT_EQ(said_in("mwv", FaultKind::kWrongId).substr(0, 6), "$IIMWV");
  EXPECT_EQ(said_in("gill", FaultKind::kWrongId).substr(0, 3), "\x02R,");
}

TEST(NmeaDevice, KnowsWhatItIsAsked) {
  EXPECT_TRUE(make_nmea_device({"umb"})->is_request("01TR4"));
  EXPECT_FALSE(make_nmea_device({"umb"})->is_request("02TR4"));
  EXPECT_TRUE(make_nmea_device({"ft"})->is_request("$01,WV?*2B"));
  EXPECT_FALSE(make_nmea_device({"mwv"})->is_request("01TR4"));
  EXPECT_THROW(make_nmea_device({"mwx"}), std::runtime_error);
}

TEST(LineDevice, SaysColumnsAndKeys) {
  EXPECT_THAT(make_line_device("csv")->say(kSaid, {}), ElementsAre("3.42,230.6\r\n"));
  EXPECT_THAT(make_line_device("key-value")->say(kSaid, {}), ElementsAre("speed=3.42 direction=230.6\r\n"));
  EXPECT_THROW(make_line_device("xml"), std::runtime_error);
}

/// A wire that keeps what is said.
struct Heard {
  std::vector<std::string> messages;
  std::string asked;
  bool is_there = true;
};
class KeepingWire final : public TextWire {
 public:
  explicit KeepingWire(Heard& heard) : heard_(heard) {}
  std::span<const FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override { return {}; }
  std::string read(std::span<const int> /*ready*/) override { return std::exchange(heard_.asked, ""); }
  void write(std::string_view bytes) override { heard_.messages.emplace_back(bytes); }
  void take_away() override { heard_.is_there = false; }
  void bring_back() override { heard_.is_there = true; }
  std::string place() const override { return "kept"; }

 private:
  Heard& heard_;
};

/// Blows harder each second.
class GrowingWind final : public PlayedWind {
 public:
  PlayedMoment at(double time_s) override { return {.speed_m_s = time_s, .direction_deg = 90.0}; }
};

class TextSimulatorTest : public testing::Test {
 protected:
  TextSimulator make(double rate_hz, const std::string& format = "mwv") {
    return {make_nmea_device({format}), std::make_unique<KeepingWire>(heard_), rate_hz,
            MeasuredWind(std::make_unique<GrowingWind>()), 1};
  }
  /// From one moment to another, 50 times a second.
  void serve(TextSimulator& simulator, double from_s, double to_s, std::optional<FaultKind> fault = {}) {
    for (int i = 0; from_s + 0.02 * i < to_s; ++i) simulator.serve({}, from_s + 0.02 * i, fault);
  }

  Heard heard_;
};

TEST_F(TextSimulatorTest, SpeaksAtItsRateOfTheMomentThatItIs) {
  auto simulator = make(4.0);
  serve(simulator, 0.0, 9.99);
  ASSERT_EQ(heard_.messages.size(), 40U);
  EXPECT_EQ(heard_.messages[10].substr(0, 22), "$WIMWV,90.0,R,2.50,M,A");
}

TEST_F(TextSimulatorTest, AnswersOnlyWhatItIsAsked) {
  auto simulator = make(0.0, "umb");
  heard_.asked = "01TR";
  serve(simulator, 0.0, 1.0);
  EXPECT_TRUE(heard_.messages.empty());
  heard_.asked = "4\r";
  serve(simulator, 1.0, 2.0);
  EXPECT_EQ(heard_.messages.size(), 1U);
  heard_.asked = "02TR4\r" + std::string(5000, 'x') + "\r01TR4\r";
  serve(simulator, 2.0, 3.0);
  EXPECT_EQ(heard_.messages.size(), 2U);
}

TEST_F(TextSimulatorTest, FailsInEveryWayItIsToldTo) {
  auto simulator = make(4.0);
  const auto said_with = [&](FaultKind fault) {
    static double time_s = 10.0;
    serve(simulator, time_s, time_s + 0.25, {});
    heard_.messages.clear();
    serve(simulator, time_s + 0.25, time_s + 0.5, fault);
    time_s += 0.5;
    std::string all;
    for (const std::string& message : heard_.messages) all += message;
    return all;
  };
  serve(simulator, 0.0, 10.0);
  EXPECT_EQ(said_with(FaultKind::kSilence), "");
  const std::string frozen = said_with(FaultKind::kFreeze);
  EXPECT_EQ(said_with(FaultKind::kFreeze).substr(0, 13), frozen.substr(0, 13));
  EXPECT_THAT(said_with(FaultKind::kSpike), testing::HasSubstr(",R,55.00,M"));
  EXPECT_EQ(said_with(FaultKind::kGarbage).size() % 24, 0U);
  EXPECT_THAT(said_with(FaultKind::kPartial), Not(testing::HasSubstr("*")));
  const std::string split = said_with(FaultKind::kSplit);
  EXPECT_GE(heard_.messages.size(), 3U);
  EXPECT_THAT(split, testing::EndsWith("\r\n"));
  said_with(FaultKind::kUnplug);
  EXPECT_FALSE(heard_.is_there);
  EXPECT_TRUE(heard_.messages.empty());
  EXPECT_THAT(said_with(FaultKind::kBadChecksum), testing::HasSubstr("*"));
  EXPECT_TRUE(heard_.is_there);
}

TEST_F(TextSimulatorTest, IsLateOnlyWhereItIsAsked) {
  auto simulator = make(0.0, "umb");
  const auto known = simulator.known_faults();
  EXPECT_THAT(std::vector<FaultKind>(known.begin(), known.end()), Contains(FaultKind::kLate));
  auto speaker = make(1.0);
  const auto others = speaker.known_faults();
  EXPECT_THAT(std::vector<FaultKind>(others.begin(), others.end()), Not(Contains(FaultKind::kLate)));

  heard_.asked = "01TR4\r";
  serve(simulator, 0.0, 1.2, FaultKind::kLate);
  EXPECT_TRUE(heard_.messages.empty());
  serve(simulator, 1.2, 1.5);
  EXPECT_EQ(heard_.messages.size(), 1U);
}

}  // namespace
}  // namespace yuragi::sim
