// Messages of stations in the local network through `yuragi decode`.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/commands/decode_run.hpp"

namespace yuragi::daemon::commands {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr double kMph = 0.44704;

std::string rapid_wind(const std::string& station, int time_s, double speed_m_s) {
  return R"({"serial_number":")" + station + R"(","type":"rapid_wind","hub_sn":"HB-00000001","ob":[)" +
         std::to_string(time_s) + "," + std::to_string(speed_m_s) + ",128]}\n";
}

std::string observation(int time_s, double mean_m_s) {
  return R"({"serial_number":"ST-00000512","type":"obs_st","hub_sn":"HB-00000001","obs":[[)" + std::to_string(time_s) +
         ",0.18," + std::to_string(mean_m_s) +
         ",9.5,144,6,1017.57,22.37,50.26,328,0.03,3,0.000000,0,0,0,2.410,1]],\"firmware_revision\":129}\n";
}

TEST_F(DecodeCommand, ReadsATempestAsTheDriverDoes) {
  const auto done =
      run(rapid_wind("ST-00000512", 1, 2.5) + rapid_wind("ST-00000512", 1, 2.5) + observation(2, 3.0) +
              rapid_wind("ST-00000777", 3, 4.0) +
              "{\"serial_number\":\"HB-00000001\",\"type\":\"hub_status\",\"firmware_revision\":\"177\"}\n" +
              observation(62, 3.5) + "{}\n",
          {"tempest", "--refused"});
  ASSERT_EQ(done.objects.size(), 5U) << done.text;
  EXPECT_EQ(done.objects[0]["speed_m_s"], 2.5);
  EXPECT_EQ(done.objects[0]["direction_deg"], 128.0);
  EXPECT_EQ(done.objects[1]["detail"], "another station");
  EXPECT_EQ(done.objects[2]["detail"], "no wind");
  EXPECT_EQ(done.objects[3]["speed_m_s"], 3.5) << "no rapid wind has come since the observation before";
  EXPECT_EQ(done.objects[3]["gust_m_s"], 9.5);
  EXPECT_EQ(done.objects[4]["refused"], "malformed");
}

TEST_F(DecodeCommand, ReadsAnEcowittGatewaysReply) {
  // A recorded one, in a calm (drivers/SOURCES.md S9.2), and one of 7.0 m/s from 270 degrees.
  json calm = one(
      "ff ff 27 00 53 01 00 e1 06 25 08 27 b3 09 27 c2 02 00 05 07 5d 0a 01 59 0b 00 00 0c 00 00 15 00 00 93 bc 16 00 "
      "20 17 00 2c 12 1a 00 87 22 32 1b 00 b0 23 27 1c 00 dd 24 31 58 00 19 00 47 0e 00 00 10 00 08 11 00 42 12 00 00 "
      "02 9a 13 00 00 0f 8b 0d 00 42 63\n",
      {"ecowitt", "--hex"});
  EXPECT_EQ(calm["speed_m_s"], 0.0);
  EXPECT_EQ(calm["direction_deg"], 345.0);
  json wind = one("ff ff 27 03 2a | ff ff 27 00 0a 0a 01 0e 0b 00 46 9b\n", {"ecowitt", "--hex"});
  EXPECT_NEAR(wind["speed_m_s"].get<double>(), 7.0, 1e-9);
  EXPECT_EQ(wind["direction_deg"], 270.0);
  EXPECT_EQ(run("ff ff 27 00 0a 0a 01 0e 0b 00 46 9c\n", {"ecowitt", "--hex", "--refused"}).objects.at(0)["refused"],
            "bad checksum");
}

TEST_F(DecodeCommand, ReadsWhatStationsPush) {
  const auto done =
      run("PASSKEY=(secret)&stationtype=GW2000A_V2.1.5&winddir=289&windspeedmph=10&windgustmph=12\n"
          "GET /weatherstation/updateweatherstation.php?ID=a&PASSWORD=b&winddir=25&windspeedmph=20 HTTP/1.1\n"
          "/data/report/PASSKEY=(secret)&windspeedmph=-9999\n",
          {"ecowitt-push", "--refused"});
  ASSERT_EQ(done.objects.size(), 3U) << done.text;
  EXPECT_NEAR(done.objects[0]["speed_m_s"].get<double>(), 10 * kMph, 1e-9);
  EXPECT_NEAR(done.objects[0]["gust_m_s"].get<double>(), 12 * kMph, 1e-9);
  EXPECT_EQ(done.objects[1]["detail"], "another station");
  EXPECT_EQ(done.objects[2]["refused"], "invalid");
  json wunderground =
      one("GET /weatherstation/updateweatherstation.php?ID=a&winddir=25&windspeedmph=20 HTTP/1.1\n", {"ecowitt-push"});
  EXPECT_NEAR(wunderground["speed_m_s"].get<double>(), 20 * kMph, 1e-9);
  EXPECT_EQ(wunderground["direction_deg"], 25.0);
  // A station with many sensors says more than a line of an anemometer has.
  const std::string more = "PASSKEY=a&" + std::string(5000, 'x') + "=1&windspeedmph=10\n";
  EXPECT_NEAR(one(more, {"ecowitt-push"})["speed_m_s"].get<double>(), 10 * kMph, 1e-9);
}

std::string live_record(int transmitter, double speed_mph) {
  return R"({"data_structure_type":1,"txid":)" + std::to_string(transmitter) + R"(,"wind_speed_last":)" +
         std::to_string(speed_mph) + R"(,"wind_dir_last":183,"wind_speed_hi_last_10_min":50,"rain_size":1})";
}

TEST_F(DecodeCommand, ReadsAWeatherLinkLivesRepliesAndBroadcasts) {
  const auto broadcast = [](const std::string& device, const std::string& records) {
    return R"({"did":")" + device + R"(","ts":1646168724,"conditions":[)" + records + "]}";
  };
  const std::string own = "001D0A711980";
  const auto done = run(R"({"data":)" + broadcast(own, live_record(2, 10)) + ",\"error\":null}\n" +
                            R"({"data":{"broadcast_port":22222,"duration":1200},"error":null})" + "\n" +
                            broadcast(own, live_record(1, 30) + "," + live_record(2, 20)) + "\n" +
                            broadcast("001D0A700002", live_record(2, 40)) + "\n",
                        {"weatherlink", "--refused"});
  ASSERT_EQ(done.objects.size(), 4U) << done.text;
  EXPECT_NEAR(done.objects[0]["speed_m_s"].get<double>(), 10 * kMph, 1e-6);
  EXPECT_EQ(done.objects[0]["direction_deg"], 183.0);
  EXPECT_EQ(done.objects[1]["refused"], "not mine");
  EXPECT_NEAR(done.objects[2]["speed_m_s"].get<double>(), 20 * kMph, 1e-6) << "of the transmitter that came first";
  EXPECT_EQ(done.objects[3]["detail"], "another WeatherLink Live");
}

}  // namespace
}  // namespace yuragi::daemon::commands
