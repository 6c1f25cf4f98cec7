// The dialogue with a Davis console, with a script at the far end.
#include "drivers/davis/vantage_sensor.hpp"

#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/davis/vantage.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/scripted_port.hpp"

namespace yuragi::drivers::davis {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace std::chrono_literals;

std::string with_checksum(std::string bytes) {
  const std::uint16_t sum =
      decode::davis::vantage_checksum({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  bytes += static_cast<char>(sum >> 8U);
  bytes += static_cast<char>(sum & 0xFFU);
  return bytes;
}

/// A packet of nothing but a wind: 10 mph from 90 degrees.
std::string packet(bool is_loop2) {
  std::string bytes(95, '\0');
  bytes.replace(0, 3, "LOO");
  bytes[4] = is_loop2 ? '\x01' : '\0';
  bytes[14] = 10;
  bytes[16] = 90;
  return with_checksum(bytes + "\n\r");
}

const std::string kAwake = "\n\r";
const std::string kSetup = '\x06' + with_checksum(std::string(1, '\x10'));

/// The driver, with a script at the far end.
struct ScriptedVantage {
  FarEnd far_end;
  ManualClock clock;
  RecordingSink sink;
  std::unique_ptr<VantageSensor> sensor;

  explicit ScriptedVantage(ParameterValues::Map given = {}) {
    given.try_emplace("device", std::string("/dev/script"));
    sensor = std::make_unique<VantageSensor>(vantage_settings_of(values_for("davis", given)),
                                             std::make_unique<ScriptedPort>(far_end, clock));
  }

  /// Polls for so long, as the daemon does: whenever the sensor wants it.
  void run(Nanoseconds duration) {
    const MonoTime end = clock.now().mono + duration;
    for (int idle = 0; clock.now().mono < end && idle < 100'000; ++idle) clock.advance_to(sensor->poll(clock, sink));
  }

  /// A console that does all that it is asked for, and sends `packets_each` packets for each request.
  void script(bool knows_lps, int packets_each) {
    far_end.on_request = [this, knows_lps, packets_each](const std::string& request) {
      const bool is_lps = request.starts_with("LPS");
      if (request == "\n") far_end.send(kAwake);
      if (request.starts_with("EEBRD")) far_end.send(kSetup);
      if (is_lps && !knows_lps) far_end.send("\x21");
      if ((is_lps && knows_lps) || request.starts_with("LOOP")) {
        far_end.send("\x06");
        for (int i = 0; i < packets_each; ++i) far_end.send(packet(is_lps));
      }
    };
  }
};

TEST(Vantage, IsWokenAskedForItsSetupAndForPackets) {
  ScriptedVantage vantage;
  vantage.script(true, 2);
  vantage.run(1s);
  EXPECT_THAT(vantage.far_end.written, ElementsAre("\n", "EEBRD 2B 01\n", "LPS 2 200\n"));
  ASSERT_EQ(vantage.sink.readings.size(), 2U);
  EXPECT_DOUBLE_EQ(vantage.sink.readings[0].speed_m_s, 4.4704);
  EXPECT_EQ(vantage.sink.readings[0].direction_deg, 90.0);
  EXPECT_EQ(vantage.sink.last_state(), wind::LinkState::kConnected);
  EXPECT_EQ(vantage.sink.last_detail(), "Davis console (LOOP2) at /dev/script at 19200 8N1");
  EXPECT_EQ(vantage.sink.station_quantities.size(), 2U);
  EXPECT_EQ(vantage.sink.station_quantities[0].rain_total_mm, 0.0) << "the setup said what a tip is";
  EXPECT_TRUE(vantage.sink.refusals.empty());
}

TEST(Vantage, IsAskedForLoopWhereItDoesNotKnowLoop2) {
  ScriptedVantage vantage;
  vantage.script(false, 1);
  vantage.run(1s);
  EXPECT_THAT(vantage.far_end.written, ElementsAre("\n", "EEBRD 2B 01\n", "LPS 2 200\n", "\n", "LOOP 200\n"));
  EXPECT_EQ(vantage.sink.readings.size(), 1U);
  EXPECT_THAT(vantage.sink.last_detail(), HasSubstr("(LOOP)"));
  EXPECT_THAT(vantage.sink.refusals, ElementsAre(decode::Refusal::kException));
}

TEST(Vantage, IsAskedForWhatIsConfigured) {
  ScriptedVantage loop({{"packets", std::string("loop")}});
  loop.script(true, 1);
  loop.run(1s);
  EXPECT_EQ(loop.far_end.written.back(), "LOOP 200\n");
  ScriptedVantage loop2({{"packets", std::string("loop2")}});
  loop2.script(false, 1);
  loop2.run(2s);
  EXPECT_THAT(loop2.far_end.written, testing::Not(testing::Contains("LOOP 200\n")));
}

TEST(Vantage, IsWokenThreeTimesBeforeItIsGivenUp) {
  ScriptedVantage vantage;
  vantage.run(3650ms);
  EXPECT_THAT(vantage.far_end.written, ElementsAre("\n", "\n", "\n"));
  EXPECT_EQ(vantage.sink.count(decode::Refusal::kTimeout), 3);
  EXPECT_EQ(vantage.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(vantage.sink.last_detail(), HasSubstr("does not wake up: check the console's power"));
  EXPECT_EQ(vantage.far_end.closed, 1);
  EXPECT_THAT(vantage.far_end.written, Each("\n")) << "who sends no packets is not told to end them";
}

TEST(Vantage, IsAskedAgainBeforeItsLastPacket) {
  ScriptedVantage vantage;
  vantage.script(true, 198);
  vantage.run(1s);
  ASSERT_GE(vantage.far_end.written.size(), 5U);
  vantage.far_end.written.resize(5);
  EXPECT_THAT(vantage.far_end.written, ElementsAre("\n", "EEBRD 2B 01\n", "LPS 2 200\n", "\n", "LPS 2 200\n"));
  EXPECT_EQ(vantage.far_end.opened, 1);
  EXPECT_TRUE(vantage.sink.refusals.empty());
}

TEST(Vantage, IsWokenAndAskedAgainWhenItFallsSilent) {
  ScriptedVantage vantage;
  vantage.script(true, 1);
  vantage.run(5s);
  EXPECT_EQ(vantage.sink.readings.size(), 1U);
  EXPECT_EQ(vantage.sink.last_state(), wind::LinkState::kConnected);
  vantage.run(3s);
  EXPECT_EQ(vantage.sink.readings.size(), 2U);
  EXPECT_EQ(vantage.sink.count(decode::Refusal::kTimeout), 1);
  EXPECT_EQ(vantage.far_end.opened, 1);
}

TEST(Vantage, EndsThePacketsWhenItIsClosed) {
  ScriptedVantage vantage;
  vantage.script(true, 3);
  vantage.run(1s);
  ASSERT_EQ(vantage.sink.readings.size(), 3U);
  vantage.far_end.written.clear();
  vantage.sensor->interrupt();
  vantage.sensor.reset();
  EXPECT_THAT(vantage.far_end.written, ElementsAre("\n"));
  EXPECT_GE(vantage.far_end.closed, 1);
}

TEST(Vantage, TakesRepliesInPiecesAndAfterALateWakeUp) {
  ScriptedVantage vantage;
  vantage.far_end.on_request = [&](const std::string& request) {
    if (request == "\n") {
      vantage.far_end.send("\n");
      vantage.far_end.send("\r");
    } else if (request.starts_with("EEBRD")) {
      vantage.far_end.send(kAwake + kSetup.substr(0, 2));
      vantage.far_end.send(kSetup.substr(2));
    } else {
      vantage.far_end.send(kAwake);
      vantage.far_end.send('\x06' + packet(true).substr(0, 50));
      vantage.far_end.send(packet(true).substr(50));
    }
  };
  vantage.run(1s);
  EXPECT_EQ(vantage.sink.readings.size(), 1U);
  EXPECT_TRUE(vantage.sink.refusals.empty());
}

TEST(Vantage, DoesWithoutItsSetup) {
  for (const std::string& reply : {std::string(), std::string("\x18"), std::string("\x06\x10\x01\x02", 4)}) {
    ScriptedVantage vantage;
    vantage.far_end.on_request = [&](const std::string& request) {
      if (request == "\n") vantage.far_end.send(kAwake);
      if (request.starts_with("EEBRD") && !reply.empty()) vantage.far_end.send(reply);
      if (request.starts_with("LPS")) vantage.far_end.send('\x06' + packet(true));
    };
    vantage.run(3s);
    ASSERT_EQ(vantage.sink.readings.size(), 1U);
    EXPECT_EQ(vantage.sink.refusals.size(), 1U);
    EXPECT_FALSE(vantage.sink.station_quantities.at(0).rain_total_mm.has_value());
  }
}

TEST(Vantage, ThatIsNoConsoleIsOpenedAgain) {
  ScriptedVantage vantage;
  vantage.far_end.on_request = [&](const std::string& request) {
    vantage.far_end.send(request == "\n" ? kAwake : "what?");
  };
  vantage.run(2s);
  EXPECT_THAT(vantage.sink.last_detail(), HasSubstr("check that it is a Davis console"));
  EXPECT_TRUE(vantage.sink.readings.empty());
}

TEST(Vantage, WithoutAnAnemometerSaysSo) {
  ScriptedVantage vantage;
  std::string lost = packet(true);
  lost.resize(97);
  lost[14] = 0;
  lost[16] = 0;
  lost = with_checksum(lost);
  vantage.far_end.on_request = [&](const std::string& request) {
    if (request == "\n") vantage.far_end.send(kAwake);
    if (request.starts_with("EEBRD")) vantage.far_end.send(kSetup);
    if (request.starts_with("LPS")) vantage.far_end.send('\x06' + lost);
  };
  vantage.run(20s);
  EXPECT_TRUE(vantage.sink.readings.empty()) << "a calm that nobody measured";
  EXPECT_GE(vantage.sink.count(decode::Refusal::kInvalid), 2);
  EXPECT_THAT(vantage.sink.last_detail(), HasSubstr("has no wind: check the anemometer's radio"));
  EXPECT_FALSE(vantage.sink.station_quantities.empty());
}

TEST(DavisDriver, SaysWhatIsMissing) {
  const auto refusal_of = [](const ParameterValues::Map& given) -> std::string {
    try {
      vantage_settings_of(values_for("davis", given));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal_of({}), HasSubstr("device: is missing"));
  EXPECT_THAT(refusal_of({{"transport", std::string("tcp")}}), HasSubstr("host: is missing"));
  EXPECT_THAT(refusal_of({{"device", std::string("/dev/ttyUSB0")}, {"baud", std::int64_t{14400}}}),
              HasSubstr("baud: is 14400"));
  EXPECT_EQ(refusal_of({{"transport", std::string("tcp")}, {"host", std::string("10.0.0.7")}}), "");
}

}  // namespace
}  // namespace yuragi::drivers::davis
