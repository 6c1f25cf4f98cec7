#include "daemon/sensing/recording_folders.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::sensing {
namespace {

settings::SensorConfig sensor_of(const char* file) {
  const std::vector<Parameter> table{{.name = "file", .default_value = std::string{}, .help = "what it plays"}};
  settings::SensorConfig sensor;
  sensor.values = ParameterValues::resolve(table, {{"file", std::string(file)}}).value();
  return sensor;
}

class RecordingFoldersTest : public testing::Test {
 protected:
  RecordingFoldersTest() {
    config_.sensors = {sensor_of("/home/anna/storm.windlog"), sensor_of("/home/anna/storm.windlog.old"),
                       sensor_of("days/calm.windlog"), sensor_of("bare.windlog"), settings::SensorConfig{}};
    config_.wind.fallback = {.recording = "/srv/a good day.windlog"};
  }

  std::string told(std::string detail) const {
    wire::Sensors sensors;
    sensors.sensors.resize(1);
    sensors.sensors[0].detail = std::move(detail);
    RecordingFolders(config_).remove_from(sensors);
    return sensors.sensors[0].detail;
  }

  settings::Config config_;
};

TEST_F(RecordingFoldersTest, OfEachFileTheNameStays) {
  EXPECT_EQ(told("playing /home/anna/storm.windlog"), "playing storm.windlog");
  EXPECT_EQ(told("/home/anna/storm.windlog.old: disk I/O error"), "storm.windlog.old: disk I/O error");
  EXPECT_EQ(told("days/calm.windlog has ended"), "calm.windlog has ended");
  EXPECT_EQ(told("all sensors are silent: playing /srv/a good day.windlog"),
            "all sensors are silent: playing a good day.windlog");
  EXPECT_EQ(told("paused: /home/anna/storm.windlog is paused, /home/anna/storm.windlog"),
            "paused: storm.windlog is paused, storm.windlog");
}

TEST_F(RecordingFoldersTest, OtherTextsStayAsTheyAre) {
  EXPECT_EQ(told("bare.windlog, 3 m/s, /dev/ttyUSB0"), "bare.windlog, 3 m/s, /dev/ttyUSB0");
  EXPECT_EQ(told(""), "");
}

TEST_F(RecordingFoldersTest, EveryTextThatHoldsOneIsTakenCareOf) {
  const std::string text = "x /home/anna/storm.windlog";
  wire::Sensors sensors;
  sensors.sensors.resize(2);
  sensors.sensors[1].detail = sensors.sensors[1].state_reason = text;
  wire::ControlReply reply;
  reply.message = text;
  reply.players.resize(1);
  reply.players[0].file = reply.players[0].refusal = text;
  const RecordingFolders folders(config_);
  folders.remove_from(sensors);
  folders.remove_from(reply);
  for (const std::string& clean : {sensors.sensors[1].detail, sensors.sensors[1].state_reason, reply.message,
                                   reply.players[0].file, reply.players[0].refusal}) {
    EXPECT_EQ(clean, "x storm.windlog");
  }
}

}  // namespace
}  // namespace yuragi::daemon::sensing
