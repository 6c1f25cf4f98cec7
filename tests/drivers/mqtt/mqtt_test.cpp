// The driver as the daemon opens it and runs it, with Debian's own broker and its own publisher.
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include "drivers/sensor/driver.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/mosquitto_broker.hpp"
#include "tests/support/running_sensor.hpp"
#include "tests/support/scripted_server.hpp"

namespace yuragi::drivers::mqtt {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

std::unique_ptr<sensor::Sensor> open_mqtt_sensor(const ParameterValues::Map& given) {
  return driver_named("mqtt").open(values_for("mqtt", given));
}

/// The driver on a thread of its own, connected to a broker.
class MqttRun {
 public:
  MqttRun(const MosquittoBroker& broker, ParameterValues::Map given) : MqttRun(broker.port(), std::move(given)) {}
  MqttRun(std::uint16_t port, ParameterValues::Map given) : sensor_(make(port, std::move(given))) {}

  /// Sends when the driver listens, and waits for the reading.
  bool reads_after(const std::function<void()>& publish) {
    const bool listens = sensor_.wait_until([](const RecordingSink& sink) {
      const std::string detail = sink.last_detail();
      return sink.last_state() == wind::LinkState::kConnected || detail.find("waits for") != std::string::npos ||
             detail.find("no wind has been received") != std::string::npos;
    });
    const std::size_t before = count();
    publish();
    return listens && has_read(before + 1);
  }
  bool has_refused(decode::Refusal why, std::ptrdiff_t times = 1) {
    return sensor_.wait_until([&](const RecordingSink& sink) { return sink.count(why) >= times; });
  }
  std::ptrdiff_t count(decode::Refusal why) {
    return sensor_.look([why](const RecordingSink& sink) { return sink.count(why); });
  }
  bool is_in(wind::LinkState state) {
    return sensor_.wait_until([&](const RecordingSink& sink) { return sink.last_state() == state; });
  }
  bool reports(const std::string& text) {
    return sensor_.wait_until(
        [&](const RecordingSink& sink) { return sink.last_detail().find(text) != std::string::npos; });
  }
  bool has_read(std::size_t readings) {
    return sensor_.wait_until([&](const RecordingSink& sink) { return sink.readings.size() >= readings; });
  }
  std::size_t count() {
    return sensor_.look([](const RecordingSink& sink) { return sink.readings.size(); });
  }
  std::vector<wind::StationQuantities> quantities() {
    return sensor_.look([](const RecordingSink& sink) { return sink.station_quantities; });
  }
  wind::Reading last() {
    return sensor_.look([](const RecordingSink& sink) { return sink.readings.back(); });
  }
  /// Ends it; what it says at last.
  std::string end() {
    sensor_.end();
    return sensor_.look([](const RecordingSink& sink) { return sink.last_detail(); });
  }
  wind::LinkState state() {
    return sensor_.look([](const RecordingSink& sink) { return sink.last_state(); });
  }

 private:
  static std::unique_ptr<sensor::Sensor> make(std::uint16_t port, ParameterValues::Map given) {
    given.try_emplace("port", std::int64_t{port});
    given.try_emplace("topic", std::string("garden/speed"));
    return open_mqtt_sensor(given);
  }

  RunningSensor sensor_;
};

/// A sensor that reads "garden/speed" as a plain number has read one wind of 4 m/s.
struct RunningGarden {
  MosquittoBroker broker;
  MqttRun run;

  explicit RunningGarden(const ParameterValues::Map& given = {}) : run(broker, given) {
    if (!run.reads_after([this] { broker.publish("garden/speed", "4"); })) throw std::runtime_error("no wind came");
  }

  /// What comes next is refused for this reason, and is no reading; then the wind is read again.
  void expect_refused(const std::string& topic, const std::string& payload, decode::Refusal why,
                      const std::vector<std::string>& more = {}) {
    const std::size_t before = run.count();
    broker.publish(topic, payload, more);
    EXPECT_TRUE(run.has_refused(why));
    EXPECT_EQ(run.count(), before);
    EXPECT_EQ(run.state(), wind::LinkState::kConnected);
    broker.publish("garden/speed", "6");
    EXPECT_TRUE(run.has_read(before + 1));
    EXPECT_EQ(run.last().speed_m_s, 6.0);
  }
};

TEST(MqttDriver, ReadsPlainNumbersEachFromATopicOfItsOwn) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"topic", std::string("homeassistant/sensor/wind_speed/state")},
                       {"direction_topic", std::string("homeassistant/sensor/wind_bearing/state")},
                       {"gust_topic", std::string("homeassistant/sensor/wind_gust/state")},
                       {"speed_unit", std::string("km/h")}});
  ASSERT_TRUE(run.reads_after([&] { broker.publish("homeassistant/sensor/wind_speed/state", "18"); }));
  EXPECT_DOUBLE_EQ(run.last().speed_m_s, 5.0);
  EXPECT_FALSE(run.last().direction_deg.has_value()) << "nobody has said";
  const std::size_t before = run.count();
  broker.publish("homeassistant/sensor/wind_bearing/state", "360");
  broker.publish("homeassistant/sensor/wind_gust/state", "36.0");
  broker.publish("homeassistant/sensor/wind_speed/state", "21.6");
  ASSERT_TRUE(run.has_read(before + 1));
  EXPECT_DOUBLE_EQ(run.last().speed_m_s, 6.0);
  EXPECT_EQ(run.last().direction_deg, 0.0);
  EXPECT_DOUBLE_EQ(run.last().gust_m_s.value(), 10.0);
}

TEST(MqttDriver, ReachesABrokerByItsName) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"host", std::string("localhost")}});
  EXPECT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4"); })) << "whichever of its addresses it has";
}

TEST(MqttDriver, SaysThatThereIsNoSuchHost) {
  MqttRun run(1, {{"host", std::string("no-such-host.invalid")}});
  EXPECT_TRUE(run.reports("no-such-host.invalid"));
}

TEST(MqttDriver, ForgetsADirectionThatIsOldOrNotKnownAnyMore) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"direction_topic", std::string("garden/direction")}, {"hold", 0.2}});
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4"); }));
  broker.publish("garden/direction", "90");
  broker.publish("garden/direction", "unavailable");
  std::size_t before = run.count();
  broker.publish("garden/speed", "4");
  ASSERT_TRUE(run.has_read(before + 1));
  EXPECT_FALSE(run.last().direction_deg.has_value());

  // One that has come stays for so long only: with the speeds of the next moments, and then no more.
  broker.publish("garden/direction", "90");
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "5"); }));
  const auto deadline = std::chrono::steady_clock::now() + RunningSensor::kHang;
  while (run.last().direction_deg && std::chrono::steady_clock::now() < deadline) {
    before = run.count();
    broker.publish("garden/speed", "5");
    ASSERT_TRUE(run.has_read(before + 1));
  }
  EXPECT_FALSE(run.last().direction_deg.has_value());
}

TEST(MqttDriver, ReadsWhatTasmotaPublishes) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"preset", std::string("tasmota")}, {"topic", std::string("")}});
  ASSERT_TRUE(run.reads_after([&] {
    broker.publish(
        "tele/roof/SENSOR",
        R"({"Time":"2024-06-01T12:00:00","TX23":{"Speed":{"Act":14.4,"Avg":8.5,"Min":7.2,"Max":28.8},)"
        R"("Dir":{"Card":"WSW","Deg":247.5,"Avg":240.1,"AvgCard":"WSW","Min":225.0,"Max":270.0,"Range":45.0}}})");
  }));
  EXPECT_DOUBLE_EQ(run.last().speed_m_s, 4.0);
  EXPECT_EQ(run.last().direction_deg, 247.5);
  EXPECT_DOUBLE_EQ(run.last().gust_m_s.value(), 8.0);
}

TEST(MqttDriver, ReadsWhatRtl433Publishes) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"preset", std::string("rtl_433")}, {"topic", std::string("")}});
  ASSERT_TRUE(run.reads_after([&] {
    broker.publish(
        "rtl_433/attic/events",
        R"({"model":"Fineoffset-WS80","id":"0a003b","wind_dir_deg":109,"wind_avg_m_s":2.4,"wind_max_m_s":2.8})");
  }));
  EXPECT_EQ(run.last().speed_m_s, 2.4);
  EXPECT_EQ(run.last().direction_deg, 109.0);
  EXPECT_EQ(run.last().gust_m_s, 2.8);
}

/// The driver with the preset of rtl_433, on the topic that its messages have by default.
class Rtl433Run {
 public:
  explicit Rtl433Run(ParameterValues::Map given = {}) : run(broker_, with_preset(std::move(given))) {}

  void publish(const std::string& message) const { broker_.publish("rtl_433/attic/events", message); }
  /// The reading that the message makes; without one, the test has failed.
  wind::Reading reading_of(const std::string& message) {
    EXPECT_TRUE(run.reads_after([&] { publish(message); })) << message;
    return run.count() > 0 ? run.last() : wind::Reading();
  }
  /// The message makes no reading, but is refused for this reason.
  void expect_refused(const std::string& message, decode::Refusal why) {
    const std::size_t before = run.count();
    const auto times = run.count(why);
    publish(message);
    EXPECT_TRUE(run.has_refused(why, times + 1)) << message;
    EXPECT_EQ(run.count(), before) << message;
  }

 private:
  static ParameterValues::Map with_preset(ParameterValues::Map given) {
    given.insert({{"preset", std::string("rtl_433")}, {"topic", std::string("")}});
    return given;
  }

  MosquittoBroker broker_;

 public:
  MqttRun run;
};

// As quoted in domoticz/domoticz issue 4864: the station says the direction in every other message.
const std::string kAcuriteWithDirection =
    R"({"time" : "2021-06-21 15:28:22", "model" : "Acurite-5n1", "message_type" : 49, "id" : 115, "channel" : "A", )"
    R"("sequence_num" : 0, "battery_ok" : 1, "wind_avg_km_h" : 6.795, "wind_dir_deg" : 157.500, "rain_in" : 6.700, )"
    R"("mic" : "CHECKSUM"})";
const std::string kAcuriteWithoutDirection =
    R"({"time" : "2021-06-21 15:28:41", "model" : "Acurite-5n1", "message_type" : 56, "id" : 115, "channel" : "A", )"
    R"("sequence_num" : 0, "battery_ok" : 1, "wind_avg_km_h" : 8.450, "temperature_F" : 62.800, "humidity" : 86, )"
    R"("mic" : "CHECKSUM"})";

TEST(MqttDriver, ReadsTheUnitOfRtl433FromTheKeys) {
  Rtl433Run rtl_433;
  const auto vevor = rtl_433.reading_of(
      R"({"model":"Vevor-7in1","id":"f8f7","wind_avg_km_h":18.0,"wind_max_km_h":36.0,"wind_dir_deg":13})");
  EXPECT_DOUBLE_EQ(vevor.speed_m_s, 5.0);
  EXPECT_DOUBLE_EQ(vevor.gust_m_s.value(), 10.0);
  EXPECT_EQ(vevor.direction_deg, 13.0);

  Rtl433Run other;
  const auto hideki = other.reading_of(
      R"({"model":"Hideki-Wind","id":5,"channel":4,"wind_avg_mi_h":10.0,"wind_max_mi_h":20.0,"wind_dir_deg":90.0})");
  EXPECT_DOUBLE_EQ(hideki.speed_m_s, 4.4704);
  EXPECT_DOUBLE_EQ(hideki.gust_m_s.value(), 8.9408);
}

TEST(MqttDriver, LetsASetPathAndUnitOverrideWhatIsKnownOfThePublisher) {
  Rtl433Run known({{"speed_path", std::string("/wind_avg_km_h")}});
  EXPECT_DOUBLE_EQ(known.reading_of(R"({"wind_avg_m_s":1.0,"wind_avg_km_h":36.0})").speed_m_s, 10.0);
  Rtl433Run set({{"speed_path", std::string("/wind_avg_km_h")}, {"speed_unit", std::string("m/s")}});
  EXPECT_DOUBLE_EQ(set.reading_of(R"({"wind_avg_km_h":36.0})").speed_m_s, 36.0);
  Rtl433Run other({{"speed_path", std::string("/wind")}, {"speed_unit", std::string("kn")}});
  EXPECT_DOUBLE_EQ(other.reading_of(R"({"wind":36.0})").speed_m_s, 18.52);
}

TEST(MqttDriver, KeepsADirectionOverMessagesThatHaveNone) {
  Rtl433Run rtl_433;
  EXPECT_FALSE(rtl_433.reading_of(kAcuriteWithoutDirection).direction_deg.has_value()) << "nobody has said";
  EXPECT_EQ(rtl_433.reading_of(kAcuriteWithDirection).direction_deg, 157.5);
  const auto next = rtl_433.reading_of(kAcuriteWithoutDirection);
  EXPECT_DOUBLE_EQ(next.speed_m_s, 8.45 / 3.6);
  EXPECT_EQ(next.direction_deg, 157.5);
  rtl_433.expect_refused(R"({"model":"Acurite-5n1","id":115,"channel":"A","wind_avg_km_h":)",
                         decode::Refusal::kMalformed);
  EXPECT_EQ(rtl_433.reading_of(kAcuriteWithoutDirection).direction_deg, 157.5) << "a hurt message does not wipe it";
}

TEST(MqttDriver, KeepsAGustThatComesInAMessageOfItsOwn) {
  // As LaCrosse WS-2310 sends it (merbanan/rtl_433 src/devices/lacrossews.c).
  Rtl433Run rtl_433;
  EXPECT_FALSE(
      rtl_433.reading_of(R"({"model":"LaCrosse-WS2310","id":9,"wind_avg_m_s":3.0,"wind_dir_deg":45.0})").gust_m_s);
  rtl_433.publish(R"({"model":"LaCrosse-WS2310","id":9,"wind_max_m_s":6.5,"wind_dir_deg":67.5})");
  const auto next = rtl_433.reading_of(R"({"model":"LaCrosse-WS2310","id":9,"wind_avg_m_s":3.5})");
  EXPECT_EQ(next.gust_m_s, 6.5);
  EXPECT_EQ(next.direction_deg, 67.5);
  EXPECT_EQ(rtl_433.run.count(decode::Refusal::kNotMine), 0) << "a message with a gust alone is used";
}

TEST(MqttDriver, LeavesTheSpeedBesideAnImpossibleDirection) {
  Rtl433Run rtl_433;
  EXPECT_EQ(rtl_433.reading_of(kAcuriteWithDirection).quality, wind::ReadingQuality::kGood);
  for (const char* const direction : {"-1", "1e9", "720"}) {
    const auto reading = rtl_433.reading_of(fmt::format(
        R"({{"model":"Acurite-5n1","id":115,"channel":"A","wind_avg_km_h":36,"wind_dir_deg":{}}})", direction));
    EXPECT_EQ(reading.speed_m_s, 10.0);
    EXPECT_FALSE(reading.direction_deg.has_value()) << "nor the one before";
    EXPECT_EQ(reading.quality, wind::ReadingQuality::kUncertain);
  }
  EXPECT_EQ(rtl_433.run.count(decode::Refusal::kImplausible), 3) << "and it is counted";
}

TEST(MqttDriver, ReadsACompassPointAndKeepsTheSpeedBesideAnotherWord) {
  MosquittoBroker broker;
  MqttRun run(broker, {{"speed_path", std::string("/v")}, {"direction_path", std::string("/d")}});
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", R"({"v": 4, "d": "NW"})"); }));
  EXPECT_EQ(run.last().direction_deg, 315.0);
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", R"({"v": 5, "d": "up"})"); }));
  EXPECT_EQ(run.last().speed_m_s, 5.0);
  EXPECT_FALSE(run.last().direction_deg.has_value());
  EXPECT_EQ(run.last().quality, wind::ReadingQuality::kUncertain);
}

TEST(MqttDriver, ReadsOneOfSeveralStationsAndWarnsOfTheOthers) {
  Rtl433Run rtl_433;
  const std::string neighbour = R"({"model":"Fineoffset-WS80","id":"0a003b","wind_dir_deg":10,"wind_avg_m_s":2.4})";
  EXPECT_DOUBLE_EQ(rtl_433.reading_of(kAcuriteWithoutDirection).speed_m_s, 8.45 / 3.6);
  rtl_433.expect_refused(neighbour, decode::Refusal::kNotMine);
  const auto reading = rtl_433.reading_of(kAcuriteWithoutDirection);
  EXPECT_DOUBLE_EQ(reading.speed_m_s, 8.45 / 3.6);
  EXPECT_FALSE(reading.direction_deg.has_value()) << "the neighbour's direction is not ours";
  EXPECT_TRUE(
      rtl_433.run.reports("reads Acurite-5n1, id 115, channel A, but another station is received, too: "
                          "Fineoffset-WS80, id 0a003b"));
  EXPECT_EQ(rtl_433.run.state(), wind::LinkState::kConnected);
}

TEST(MqttDriver, ReadsTheStationThatItIsTold) {
  const std::string other_id = R"({"model":"Acurite-5n1","id":116,"channel":"A","wind_avg_km_h":36})";
  const std::string other_channel = R"({"model":"Acurite-5n1","id":115,"channel":"C","wind_avg_km_h":36})";
  const std::string other_model = R"({"model":"Acurite-3n1","id":115,"channel":"A","wind_avg_km_h":36})";
  Rtl433Run rtl_433({{"model", std::string("Acurite-5n1")}, {"id", std::string("115")}, {"channel", std::string("A")}});
  ASSERT_TRUE(rtl_433.run.reports("waits for"));
  for (const std::string& message : {other_id, other_channel, other_model})
    rtl_433.expect_refused(message, decode::Refusal::kNotMine);
  EXPECT_TRUE(rtl_433.run.reports(
      "it receives Acurite-5n1, id 116, channel A, but model, id or channel select another station"));
  EXPECT_DOUBLE_EQ(rtl_433.reading_of(kAcuriteWithDirection).speed_m_s, 6.795 / 3.6);
}

TEST(MqttDriver, HandsOnWhatTheStationSaysBesidesTheWind) {
  Rtl433Run rtl_433;
  // Of another device on the topic; and of ours before it is known which one that is.
  rtl_433.run.reports("waits for");
  rtl_433.expect_refused(R"({"model":"Acurite-Tower","id":1,"temperature_C":21.5})", decode::Refusal::kNotMine);
  rtl_433.reading_of(kAcuriteWithDirection);
  rtl_433.expect_refused(R"({"model":"Acurite-Tower","id":1,"temperature_C":21.5})", decode::Refusal::kNotMine);
  rtl_433.reading_of(kAcuriteWithoutDirection);
  const auto said = rtl_433.run.quantities();
  ASSERT_EQ(said.size(), 2U);
  EXPECT_DOUBLE_EQ(said[0].rain_total_mm.value(), 6.7 * 25.4);
  EXPECT_FALSE(said[0].air_temperature_c.has_value());
  EXPECT_NEAR(said[1].air_temperature_c.value(), 17.111, 0.001);
  EXPECT_EQ(said[1].relative_humidity_percent, 86.0);
  EXPECT_EQ(said[1].time.mono, rtl_433.run.last().time.mono);
}

TEST(MqttDriver, TakesTheSpeedUnitThatTasmotaSays) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"preset", std::string("tasmota")}, {"topic", std::string("")}});
  const auto reading_in = [&](const std::string& unit) {
    EXPECT_TRUE(run.reads_after([&] {
      broker.publish("tele/roof/SENSOR",
                     R"({"TX20":{"Speed":{"Act":10.0,"Max":20.0},"Dir":{"Deg":22.5}})" + unit + "}");
    })) << unit;
    return run.last();
  };
  EXPECT_DOUBLE_EQ(reading_in(R"(,"SpeedUnit":"km/h")").speed_m_s, 10.0 / 3.6);
  EXPECT_DOUBLE_EQ(reading_in(R"(,"SpeedUnit":"m/s")").speed_m_s, 10.0);
  EXPECT_DOUBLE_EQ(reading_in(R"(,"SpeedUnit":"m/s")").gust_m_s.value(), 20.0);
  EXPECT_DOUBLE_EQ(reading_in(R"(,"SpeedUnit":"kn")").speed_m_s, 18520.0 / 3600.0);
  EXPECT_DOUBLE_EQ(reading_in(R"(,"SpeedUnit":"mph")").speed_m_s, 4.4704);
  EXPECT_DOUBLE_EQ(reading_in(R"(,"SpeedUnit":"ft/s")").speed_m_s, 3.048);
  EXPECT_DOUBLE_EQ(reading_in(R"(,"SpeedUnit":"yd/s")").speed_m_s, 9.144);
  EXPECT_DOUBLE_EQ(reading_in("").speed_m_s, 10.0 / 3.6) << "as Tasmota sets it by itself";
}

TEST(MqttDriver, RefusesASpeedUnitThatItDoesNotKnowUnlessOneIsSet) {
  const std::string message = R"({"TX23":{"Speed":{"Act":10.0}},"SpeedUnit":"furlong"})";
  const MosquittoBroker broker;
  MqttRun run(broker, {{"preset", std::string("tasmota")}, {"topic", std::string("")}});
  ASSERT_TRUE(run.reports("waits for"));
  broker.publish("tele/roof/SENSOR", message);
  EXPECT_TRUE(run.has_refused(decode::Refusal::kInvalid));
  EXPECT_TRUE(run.reports("the unit of its speed, \"furlong\", is unknown: set speed_unit"));
  EXPECT_EQ(run.count(), 0U);
  MqttRun told(broker,
               {{"preset", std::string("tasmota")}, {"topic", std::string("")}, {"speed_unit", std::string("m/s")}});
  EXPECT_TRUE(told.reads_after([&] { broker.publish("tele/roof/SENSOR", message); }));
  EXPECT_EQ(told.last().speed_m_s, 10.0);
}

TEST(MqttDriver, HandsOnWhatTasmotaSaysBesidesTheWindOfTheDeviceWithTheAnemometer) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"preset", std::string("tasmota")}, {"topic", std::string("")}});
  ASSERT_TRUE(run.reports("waits for"));
  broker.publish("tele/cellar/SENSOR", R"({"AM2301":{"Temperature":12.0,"Humidity":80.0},"TempUnit":"C"})");
  ASSERT_TRUE(run.has_refused(decode::Refusal::kNotMine));
  ASSERT_TRUE(run.reads_after([&] {
    broker.publish("tele/roof/SENSOR", R"({"TX23":{"Speed":{"Act":14.4}},"BME280":{"Temperature":59.0,"Humidity":40.5,)"
                                       R"("Pressure":750.0},"PressureUnit":"mmHg","TempUnit":"F","SpeedUnit":"km/h"})");
  }));
  const auto said = run.quantities();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_DOUBLE_EQ(said[0].air_temperature_c.value(), 15.0);
  EXPECT_EQ(said[0].relative_humidity_percent, 40.5);
  EXPECT_NEAR(said[0].pressure_hpa.value(), 999.9, 0.1);
}

TEST(MqttDriver, TakesNoDirectionOfAnotherMessageOnTheSameTopic) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"preset", std::string("windnerd")}});
  ASSERT_TRUE(run.reads_after([&] {
    broker.publish("garden/speed", R"({"type":"INSTANT_WIND","wind_instant_speed":4.3,"wind_instant_dir":237})");
  }));
  EXPECT_EQ(run.last().direction_deg, 237.0);
  const std::size_t before = run.count();
  broker.publish("garden/speed", R"({"type":"INSTANT_WIND","wind_instant_speed":4.5,"wind_instant_dir":null})");
  ASSERT_TRUE(run.has_read(before + 1));
  EXPECT_FALSE(run.last().direction_deg.has_value());
}

TEST(MqttDriver, SpeaksTlsAndChecksWhoTheBrokerIs) {
  const test::TemporaryFolder folder;
  const std::string key = folder / "broker.key";
  const std::string certificate = folder / "broker.pem";
  run_program({"openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=127.0.0.1",
               "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", certificate});
  const MosquittoBroker broker("allow_anonymous true\ncafile " + certificate + "\ncertfile " + certificate +
                               "\nkeyfile " + key + "\n");
  MqttRun run(broker, {{"tls", true}, {"ca_file", certificate}});
  EXPECT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4", {"--cafile", certificate}); }));

  MqttRun stranger(broker, {{"tls", true}});
  EXPECT_TRUE(stranger.reports("the TLS connection to")) << "this system does not trust it";
  MqttRun plain(broker, {});
  EXPECT_TRUE(plain.reports("MQTT broker 127.0.0.1")) << "says something, at least";
  EXPECT_EQ(plain.count(), 0U);
}

TEST(MqttDriver, SaysWhichFileOfCertificatesIsMissing) {
  MqttRun run(1, {{"tls", true}, {"ca_file", std::string("/no/such/file.pem")}});
  EXPECT_TRUE(run.reports("ca_file"));
}

TEST(MqttDriver, NoticesABrokerThatHangs) {
  RunningGarden garden({{"keep_alive", std::int64_t{5}}});
  garden.broker.hold();
  EXPECT_TRUE(garden.run.is_in(wind::LinkState::kConnecting)) << "within two keep-alives";
  garden.broker.go_on();
  EXPECT_TRUE(garden.run.reads_after([&] { garden.broker.publish("garden/speed", "5"); }));
  EXPECT_EQ(garden.run.state(), wind::LinkState::kConnected);
}

TEST(MqttDriver, IsInterruptedWhateverItWaitsFor) {
  // For a wind; for a broker that accepts and says nothing. And it ends while it waits for one that is not there.
  const MosquittoBroker broker;
  const ScriptedServer mute([](const ScriptedServer::Bytes&) { return ScriptedServer::Bytes{}; });
  EXPECT_EQ(MqttRun(broker, {}).end(), "interrupted");
  EXPECT_EQ(MqttRun(mute.port(), {}).end(), "interrupted");
  EXPECT_NE(MqttRun(free_port(SOCK_STREAM), {}).end(), "");
}

TEST(MqttDriver, GivesUpABrokerThatSaysNothing) {
  const ScriptedServer mute([](const ScriptedServer::Bytes&) { return ScriptedServer::Bytes{}; });
  MqttRun run(mute.port(), {});
  EXPECT_TRUE(run.reports("does not reply"));
}

TEST(MqttDriver, ConnectsToABrokerThatIsSlowToTakeUs) {
  // A listener with no room left: our connection is under way until two others have been taken.
  const LoopbackPort listener(SOCK_STREAM);
  ASSERT_EQ(listen(listener.descriptor(), 0), 0);
  const int any = SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC;
  const std::array others = {Descriptor(socket(AF_INET, any, 0)), Descriptor(socket(AF_INET, any, 0))};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(listener.port());
  for (const Descriptor& other : others) {
    static_cast<void>(connect(other.get(), reinterpret_cast<sockaddr*>(&address), sizeof address));
  }
  MqttRun run(listener.port(), {});

  constexpr std::uint8_t kMqttConnect = 0x10;
  std::uint8_t first_byte = 0;
  std::vector<Descriptor> taken;
  const auto deadline = std::chrono::steady_clock::now() + RunningSensor::kHang;
  while (first_byte != kMqttConnect && std::chrono::steady_clock::now() < deadline) {
    pollfd wait{listener.descriptor(), POLLIN, 0};
    if (poll(&wait, 1, 100) == 1)
      taken.emplace_back(accept4(listener.descriptor(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    for (const Descriptor& client : taken) recv(client.get(), &first_byte, 1, 0);
  }
  EXPECT_EQ(first_byte, kMqttConnect);
}

TEST(MqttDriver, SaysThatThereIsNoBroker) {
  MqttRun run(free_port(SOCK_STREAM), {});
  EXPECT_TRUE(run.reports("check its address, the network, and that it is running")) << "refused";
}

TEST(MqttDriver, RefusesWhatCannotWork) {
  EXPECT_THAT([] { open_mqtt_sensor({}); }, ThrowsMessage<std::runtime_error>(HasSubstr("topic: is missing")));
  EXPECT_THAT(
      [] {
        open_mqtt_sensor({{"topic", std::string("a/#/b")}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("topic: \"a/#/b\" is not a topic")));
  EXPECT_THAT(
      [] {
        open_mqtt_sensor({{"topic", std::string("a")}, {"direction_path", std::string("Dir.Deg")}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("direction_path: \"Dir.Deg\" is not a JSON pointer")));
  EXPECT_THAT(
      [] {
        open_mqtt_sensor({{"topic", std::string("a")}, {"speed_path", std::string("x")}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("speed_path")));
  EXPECT_THAT(
      [] {
        open_mqtt_sensor({{"topic", std::string("a")}, {"model", std::string("Acurite-5n1")}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("model, id, channel: are only for preset \"rtl_433\"")));
}

/// Memory of this process, MiB: "VmRSS" now, "VmHWM" at most since forget_the_most().
double memory_mib(const std::string& which) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(which + ":")) return std::stod(line.substr(which.size() + 1)) / 1024.0;
  }
  throw std::runtime_error("no " + which);
}
void forget_the_most() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

TEST(MqttDriver, TakesTwiceTheLengthOfAHugeMessageAndGivesItBackAtOnce) {
  constexpr double kHuge_mib = 64.0;
  constexpr double kOthers_mib = 16.0;
  const MosquittoBroker broker;
  broker.retain("garden/speed", std::string(static_cast<std::size_t>(kHuge_mib) << 20U, '7'));
  forget_the_most();
  const double before_mib = memory_mib("VmRSS");
  MqttRun run(broker, {});
  ASSERT_TRUE(run.has_refused(decode::Refusal::kMalformed));
  EXPECT_LE(memory_mib("VmHWM") - before_mib, 2.0 * kHuge_mib + kOthers_mib);
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4"); }));
  EXPECT_LE(memory_mib("VmRSS") - before_mib, kOthers_mib);
}

TEST(MqttDriver, KeepsNoMemoryOfLongMessages) {
  // Long ones, but shorter than the longest block of which the C library would by itself keep the room: 36 MiB of
  // these.
  constexpr double kLong_mib = 12.0;
  constexpr int kMessages = 4;
  constexpr double kOthers_mib = 4.0;
  const MosquittoBroker broker;
  MqttRun run(broker, {});
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4"); }));
  const std::string payload(static_cast<std::size_t>(kLong_mib) << 20U, '7');
  const double before_mib = memory_mib("VmRSS");
  for (int i = 0; i < kMessages; ++i) broker.retain("garden/speed", payload);
  ASSERT_TRUE(run.has_refused(decode::Refusal::kMalformed, kMessages));
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4"); }));
  EXPECT_LE(memory_mib("VmRSS") - before_mib, kOthers_mib);
}

/// The message of the refusal.
std::string refusal_of(const ParameterValues::Map& given) {
  try {
    ParameterValues::Map all = given;
    all.try_emplace("topic", std::string("garden/speed"));
    open_mqtt_sensor(all);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "it was opened";
}

/// A broker that lets in only the user "garden" with the password "right".
class GuardedBroker {
 public:
  GuardedBroker() : broker_(configuration(folder_ / "passwords")) {}
  bool lets_in(ParameterValues::Map given) {
    given.insert_or_assign("user", std::string("garden"));
    MqttRun run(broker_, std::move(given));
    return run.reads_after([this] { broker_.publish("garden/speed", "4", {"-u", "garden", "-P", "right"}); });
  }

 private:
  static std::string configuration(const std::string& passwords) {
    std::ofstream(passwords) << "";
    run_program({"mosquitto_passwd", "-b", passwords, "garden", "right"});
    return "allow_anonymous false\npassword_file " + passwords + "\n";
  }

  test::TemporaryFolder folder_;
  MosquittoBroker broker_;
};

TEST(MqttDriver, TakesThePasswordFromTheConfigurationAFileOrTheEnvironment) {
  GuardedBroker broker;
  EXPECT_TRUE(broker.lets_in({{"password", std::string("right")}}));
  const test::TemporaryFolder folder;
  for (const char* text : {"right", "right\n", "right\r\n"}) {
    std::ofstream(folder / "password") << text;
    EXPECT_TRUE(broker.lets_in({{"password_file", (folder / "password").string()}})) << text;
  }
  // No other thread is running.
  ASSERT_EQ(setenv("YURAGI_TEST_PASSWORD", "right", 1), 0);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_TRUE(broker.lets_in({{"password_env", std::string("YURAGI_TEST_PASSWORD")}}));
  unsetenv("YURAGI_TEST_PASSWORD");  // NOLINT(concurrency-mt-unsafe)
}

TEST(MqttDriver, RefusesAPasswordThatIsNotThereOrGivenTwice) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "password";
  const auto refusal_of_file = [&] { return refusal_of({{"password_file", file}}); };
  EXPECT_THAT(refusal_of_file(), AllOf(HasSubstr("password_file: "), HasSubstr(file), HasSubstr("does not exist")));
  std::ofstream(file) << "\n";
  EXPECT_THAT(refusal_of_file(), HasSubstr("is empty"));
  std::ofstream(file) << "hunter2\nhunter3\n";
  EXPECT_THAT(refusal_of_file(), AllOf(HasSubstr("has more than one line"), Not(HasSubstr("hunter"))));
  std::ofstream(file) << std::string("hunter\0two", 10);
  EXPECT_THAT(refusal_of_file(), HasSubstr("has a zero byte"));
  std::ofstream(file) << std::string(4096, 'x');
  EXPECT_EQ(refusal_of_file(), "it was opened");
  std::ofstream(file) << std::string(4097, 'x');
  EXPECT_THAT(refusal_of_file(), HasSubstr("is too large; allowed: up to 4096 bytes"));
  EXPECT_THAT(refusal_of({{"password_file", folder.path().string()}}), HasSubstr("is not a regular file"));

  EXPECT_THAT(refusal_of({{"password_env", std::string("YURAGI_TEST_NONE")}}),
              HasSubstr("password_env: the environment variable \"YURAGI_TEST_NONE\" is not set"));
  EXPECT_THAT(refusal_of({{"password", std::string("(secret)")}}), HasSubstr("password: is \"(secret)\""));
  for (const ParameterValues::Map& twice :
       {ParameterValues::Map{{"password", std::string("hunter2")}, {"password_file", file}},
        ParameterValues::Map{{"password", std::string("hunter2")}, {"password_env", std::string("HOME")}},
        ParameterValues::Map{{"password_file", file}, {"password_env", std::string("HOME")}}}) {
    EXPECT_THAT(refusal_of(twice), AllOf(HasSubstr("password: is set more than once"), Not(HasSubstr("hunter2"))));
  }
}

TEST(MqttFault, Silence) {
  RunningGarden garden({{"silence", 1.0}});
  EXPECT_TRUE(garden.run.is_in(wind::LinkState::kConnecting));
  EXPECT_TRUE(garden.run.reports("no wind has been received on topic garden/speed"));
  EXPECT_TRUE(garden.run.reads_after([&] { garden.broker.publish("garden/speed", "5"); }));
  EXPECT_EQ(garden.run.last().speed_m_s, 5.0);
}

TEST(MqttFault, Freeze) {
  // The same again and again: the driver says so, and the hub has to judge it.
  RunningGarden garden;
  for (int i = 0; i < 5; ++i) garden.broker.publish("garden/speed", "4");
  EXPECT_TRUE(garden.run.has_read(6));
  EXPECT_EQ(garden.run.last().speed_m_s, 4.0);
  EXPECT_EQ(garden.run.state(), wind::LinkState::kConnected);
}

TEST(MqttFault, Spike) {
  // 55 m/s is a wind, for the hub to judge; 200 m/s is none.
  RunningGarden garden;
  garden.broker.publish("garden/speed", "55");
  EXPECT_TRUE(garden.run.has_read(2));
  EXPECT_EQ(garden.run.last().speed_m_s, 55.0);
  garden.expect_refused("garden/speed", "200", decode::Refusal::kImplausible);
}

TEST(MqttFault, Garbage) {
  RunningGarden garden;
  garden.expect_refused("garden/speed", "\xfe\x01\x80garbage", decode::Refusal::kMalformed);
  garden.expect_refused("garden/speed", std::string(100'000, '7'), decode::Refusal::kMalformed);
}

TEST(MqttFault, Partial) {
  const MosquittoBroker broker;
  MqttRun run(broker, {{"speed_path", std::string("/wind/speed")}});
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", R"({"wind":{"speed":4.0}})"); }));
  const std::size_t before = run.count();
  broker.publish("garden/speed", R"({"wind":{"speed":4.)");
  EXPECT_TRUE(run.has_refused(decode::Refusal::kMalformed));
  EXPECT_EQ(run.count(), before);
  EXPECT_TRUE(run.reads_after([&] { broker.publish("garden/speed", R"({"wind":{"speed":4.5}})"); }));
}

TEST(MqttFault, WrongId) {
  // Somebody else publishes on the same topic: there is no wind in it.
  const MosquittoBroker broker;
  MqttRun run(broker, {{"preset", std::string("rtl_433")}, {"topic", std::string("")}});
  const std::string wind = R"({"model":"Fineoffset-WS80","wind_avg_m_s":2.4})";
  ASSERT_TRUE(run.reads_after([&] { broker.publish("rtl_433/attic/events", wind); }));
  const std::size_t before = run.count();
  broker.publish("rtl_433/attic/events", R"({"model":"Acurite-Tower","temperature_C":21.5})");
  EXPECT_TRUE(run.has_refused(decode::Refusal::kNotMine));
  EXPECT_EQ(run.count(), before);
  EXPECT_TRUE(run.reads_after([&] { broker.publish("rtl_433/attic/events", wind); }));
}

TEST(MqttFault, Late) {
  // What the broker kept from before is of no known age: it is no wind of now.
  const MosquittoBroker broker;
  broker.publish("garden/speed", "25", {"-r"});
  MqttRun run(broker, {});
  EXPECT_TRUE(run.has_refused(decode::Refusal::kInvalid));
  EXPECT_EQ(run.count(), 0U);
  EXPECT_EQ(run.state(), wind::LinkState::kConnecting);
  ASSERT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4"); }));
  EXPECT_EQ(run.last().speed_m_s, 4.0);
}

TEST(MqttFault, Exception) {
  // The broker does not let us in; and then somebody sets it right.
  const test::TemporaryFolder folder;
  const std::string passwords = folder / "passwords";
  std::ofstream(passwords) << "";
  run_program({"mosquitto_passwd", "-b", passwords, "garden", "right"});
  MosquittoBroker broker("allow_anonymous false\npassword_file " + passwords + "\n");
  MqttRun run(broker, {{"user", std::string("garden")}, {"password", std::string("wrong")}});
  EXPECT_TRUE(run.reports("check `user` and `password`"));
  EXPECT_EQ(run.state(), wind::LinkState::kConnecting);

  run_program({"mosquitto_passwd", "-b", passwords, "garden", "wrong"});
  broker.stop();
  broker.start();
  EXPECT_TRUE(run.reads_after([&] { broker.publish("garden/speed", "4", {"-u", "garden", "-P", "wrong"}); }));
}

TEST(MqttFault, Disconnect) {
  RunningGarden garden;
  garden.broker.stop();
  EXPECT_TRUE(garden.run.is_in(wind::LinkState::kConnecting));
  EXPECT_EQ(garden.run.count(), 1U);
  garden.broker.start();
  EXPECT_TRUE(garden.run.reads_after([&] { garden.broker.publish("garden/speed", "5"); }));
  EXPECT_EQ(garden.run.last().speed_m_s, 5.0);
  EXPECT_EQ(garden.run.state(), wind::LinkState::kConnected);
}

}  // namespace
}  // namespace yuragi::drivers::mqtt
