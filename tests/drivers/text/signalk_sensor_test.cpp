#include "drivers/text/signalk_sensor.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scripted_text.hpp"

namespace yuragi::drivers::text {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kSelfVessel = "vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d";
const std::string kHello =
    R"({"name":"signalk-server","version":"2.14.4","timestamp":"2026-06-21T12:00:00.000Z","self":")" + kSelfVessel +
    R"(","roles":["master","main"]})" + "\r\n";

/// One value, as a server sends it.
std::string said(const std::string& path, double value, const std::string& time, const std::string& source = "mast",
                 const std::string& context = kSelfVessel) {
  return fmt::format(R"({{"context":"{}","updates":[{{"$source":"{}","timestamp":"2026-06-21T{}Z","values":[)"
                     R"({{"path":"environment.wind.{}","value":{}}}]}}]}})"
                     "\r\n",
                     context, source, time, path, value);
}

class SignalKSensorTest : public testing::Test, protected ScriptedText {
 protected:
  void make(ParameterValues::Map given = {}) {
    sink = {};
    far_end.written.clear();
    given.try_emplace("host", std::string("server"));
    sensor = std::make_unique<SignalKSensor>(signalk_sensor_settings_of(values_for("signalk", given)),
                                             std::make_unique<ScriptedPort>(far_end, clock));
  }
};

TEST_F(SignalKSensorTest, SubscribesOnceToTheWind) {
  make();
  receive(kHello);
  run(1s);
  EXPECT_THAT(far_end.written,
              ElementsAre("{\"context\":\"vessels.self\",\"subscribe\":[{\"path\":\"environment.wind.*\",\"policy\":"
                          "\"instant\"}]}\r\n"));
  make({{"transport", std::string("udp")}});
  run(1s);
  EXPECT_TRUE(far_end.written.empty());
}

TEST_F(SignalKSensorTest, JoinsTheValuesOfOneMoment) {
  make();
  receive(kHello);
  for (const char* time : {"12:00:01.000", "12:00:02.000"}) {
    far_end.send(said("speedApparent", 5.0, time));
    receive(said("angleApparent", -1.0, time));
    run(750ms);
  }
  ASSERT_EQ(sink.readings.size(), 2U);
  for (const wind::Reading& reading : sink.readings) {
    EXPECT_EQ(reading.speed_m_s, 5.0);
    EXPECT_NEAR(reading.direction_deg.value(), 302.704, 0.001);
  }
  EXPECT_TRUE(sink.refusals.empty());
}

TEST_F(SignalKSensorTest, PublishesASpeedWithoutItsDirectionAtTheEndOfTheBurst) {
  make();
  receive(kHello);
  receive(said("speedApparent", 5.0, "12:00:01.000"));
  ASSERT_EQ(sink.readings.size(), 1U);
  EXPECT_FALSE(sink.readings[0].direction_deg);
}

TEST_F(SignalKSensorTest, PrefersNorthOfOneMessageInSeveralFrames) {
  make();
  receive(kHello);
  for (int second = 10; second < 20; ++second) {
    const std::string time = fmt::format("12:00:{}.000", second);
    far_end.send(said("speedApparent", 5.0, time));
    far_end.send(said("angleApparent", -1.0, time));
    far_end.send(said("directionTrue", 2.0, time));
    receive(said("speedTrue", 4.0, time));
    run(750ms);
  }
  EXPECT_EQ(sink.readings.size(), 10U);
  for (const wind::Reading& reading : sink.readings) {
    EXPECT_EQ(reading.speed_m_s, 4.0);
    EXPECT_NEAR(reading.direction_deg.value(), 114.592, 0.001);
  }
  EXPECT_THAT(sink.last_detail(), HasSubstr("north wind of mast"));
}

TEST_F(SignalKSensorTest, NeverTakesWhatTheServerRemembersForTheWind) {
  make();
  far_end.send(kHello);
  far_end.send(said("speedApparent", 33.0, "07:00:00.000"));
  receive(said("angleApparent", 1.0, "07:00:00.000"));
  receive(said("speedApparent", 33.0, "07:00:00.000"));
  run(1s);
  EXPECT_TRUE(sink.readings.empty()) << "from before the server's hello";
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 3);

  // A source whose clock is behind: its next time is new.
  far_end.send(said("speedApparent", 4.0, "07:00:01.000"));
  receive(said("angleApparent", 1.0, "07:00:01.000"));
  ASSERT_EQ(sink.readings.size(), 1U);
  EXPECT_EQ(sink.readings[0].speed_m_s, 4.0);

  // A server without a clock.
  make();
  far_end.send(R"({"version":"2.14.4","roles":["main"]})"
               "\r\n");
  receive(said("speedApparent", 33.0, "13:00:00.000"));
  EXPECT_TRUE(sink.readings.empty());
  receive(said("speedApparent", 4.0, "13:00:01.000"));
  EXPECT_EQ(sink.readings.size(), 1U);
}

TEST_F(SignalKSensorTest, TakesItsOwnVesselAndTheSourceThatItIsTold) {
  make({{"source", std::string("mast")}});
  receive(kHello);
  receive(said("speedApparent", 9.0, "12:00:01.000", "mast", "vessels.urn:mrn:imo:mmsi:230099999"));
  receive(said("speedApparent", 9.0, "12:00:01.000", "other"));
  EXPECT_TRUE(sink.readings.empty());
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 2);
  receive(said("speedApparent", 5.0, "12:00:01.000"));
  EXPECT_EQ(sink.readings.size(), 1U);

  make({{"context", std::string("vessels.urn:mrn:imo:mmsi:230099999")}});
  receive(kHello);
  EXPECT_THAT(far_end.written.at(0), HasSubstr("\"context\":\"vessels.urn:mrn:imo:mmsi:230099999\""));
  receive(said("speedApparent", 9.0, "12:00:01.000", "mast", "vessels.urn:mrn:imo:mmsi:230099999"));
  EXPECT_EQ(sink.readings.size(), 1U);
}

TEST_F(SignalKSensorTest, RefusesSettingsThatCannotWork) {
  EXPECT_THROW(make({{"context", std::string("a\"b")}}), std::runtime_error);
  EXPECT_THROW(make({{"poll_interval", 1.0}}), std::runtime_error);
}

}  // namespace
}  // namespace yuragi::drivers::text
