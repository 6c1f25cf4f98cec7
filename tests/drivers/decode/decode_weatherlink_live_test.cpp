// What a WeatherLink Live says. Messages that begin with a device's id are recorded ones that others have published
// (drivers/SOURCES.md S10.2).
#include <string>

#include <gtest/gtest.h>

#include "drivers/decode/davis/weatherlink_live.hpp"

namespace yuragi::drivers::decode::davis {
namespace {

constexpr double kMphInMetresPerSecond = 0.44704;

/// A recorded reply, of weewx-weatherlinklive-json, without what nobody reads.
const std::string kRecordedConditions =
    R"({"data":{"did":"001D0A711980","ts":1582669708,"conditions":[{"lsid":288313,"data_structure_type":1,"txid":7,)"
    R"("temp": 49.8,"hum":87.2,"thsw_index":null,"wind_speed_last":0.00,"wind_dir_last":0,)"
    R"("wind_speed_avg_last_1_min":0.43,"wind_speed_hi_last_10_min":1.00,"wind_dir_at_hi_speed_last_10_min":40,)"
    R"("rain_size":1,"rain_rate_last":0,"rx_state":0,"rainfall_daily":6},{"lsid":288312,"data_structure_type":4,)"
    R"("temp_in": 68.2,"hum_in":35.9},{"lsid":288311,"data_structure_type":3,"bar_sea_level":29.800,"bar_trend": 0.021,)"
    R"("bar_absolute":29.315}]},"error":null})";

/// A recorded broadcast, of a weewx driver's help; its id is another one.
const std::string kRecordedBroadcast =
    R"({"did":"001D0A711980","ts":1646168724,"conditions":[{"lsid":488584,"data_structure_type":1,"txid":1,)"
    R"("wind_speed_last":1.43,"wind_dir_last":183,"rain_size":1,"rain_rate_last":0,"rain_15_min":0,"rain_60_min":2,)"
    R"("rain_24_hr":4,"rain_storm":4,"rain_storm_start_at":1646162220,"rainfall_daily":4,"rainfall_monthly":4,)"
    R"("rainfall_year":1039,"wind_speed_hi_last_10_min":5.00,"wind_dir_at_hi_speed_last_10_min":247}]})";

/// A broadcast with these members in its one record.
std::string broadcast(const std::string& members) {
  return R"({"did":"001D0A700002","ts":1,"conditions":[{"data_structure_type":1,"txid":1,)" + members + "}]}";
}

Refusal refusal_of(const std::string& json, int transmitter = 0) {
  const auto decoded = decode_live_conditions(json, transmitter);
  EXPECT_FALSE(decoded.has_value()) << json;
  return decoded ? Refusal::kOverrun : decoded.error();
}

TEST(WeatherLinkLiveMessage, ThatWasRecordedGivesItsWind) {
  const auto said = decode_live_conditions(kRecordedBroadcast, 0);
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->device, "001D0A711980");
  EXPECT_EQ(said->time_s, 1646168724.0);
  EXPECT_EQ(said->transmitter, 1);
  EXPECT_DOUBLE_EQ(*said->wind.speed_m_s, 1.43 * kMphInMetresPerSecond);
  EXPECT_EQ(said->wind.direction_deg, 183.0);
  EXPECT_DOUBLE_EQ(*said->wind.gust_m_s, 5.0 * kMphInMetresPerSecond);
  EXPECT_EQ(said->wind.reference, WindReference::kNorth);
  EXPECT_NEAR(*said->quantities.rain_total_mm, 1.016, 1e-9);
}

TEST(WeatherLinkLiveMessage, ThatWasRecordedGivesTheWeather) {
  const auto said = decode_live_conditions(kRecordedConditions, 0);
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->transmitter, 7);
  EXPECT_EQ(said->wind.speed_m_s, 0.0);
  EXPECT_FALSE(said->wind.direction_deg.has_value()) << "in a calm a direction of 0 is none";
  EXPECT_NEAR(*said->quantities.air_temperature_c, (49.8 - 32.0) / 1.8, 1e-9);
  EXPECT_EQ(said->quantities.relative_humidity_percent, 87.2);
  EXPECT_NEAR(*said->quantities.pressure_hpa, 1009.14, 0.01);
  EXPECT_EQ(said->quantities.rain_rate_mm_h, 0.0);
  EXPECT_NEAR(*said->quantities.rain_total_mm, 1.524, 1e-9);
}

TEST(WeatherLinkLiveMessage, LeavesOutWhatIsNotThere) {
  const auto said = decode_live_conditions(
      broadcast(R"("wind_speed_last":4,"wind_dir_last":null,"wind_speed_hi_last_10_min":null,"rain_size":0)"), 0);
  ASSERT_TRUE(said.has_value());
  EXPECT_DOUBLE_EQ(*said->wind.speed_m_s, 4 * kMphInMetresPerSecond);
  EXPECT_FALSE(said->wind.direction_deg || said->wind.gust_m_s || said->quantities.rain_total_mm);
  EXPECT_EQ(said->wind.status, DecodedStatus::kGood);
  EXPECT_EQ(refusal_of(broadcast(R"("wind_speed_last":null,"wind_dir_last":9)")), Refusal::kInvalid);
  EXPECT_EQ(refusal_of(broadcast(R"("wind_dir_last":9)")), Refusal::kInvalid);
  EXPECT_EQ(refusal_of(broadcast(R"("wind_speed_last":4,"rx_state":2)")), Refusal::kInvalid)
      << "the last value before the station was lost";
}

TEST(WeatherLinkLiveMessage, KeepsTheSpeedBesideWhatCannotBe) {
  for (const std::string bad : {"361", "-1", "4822.5"}) {
    const auto said = decode_live_conditions(broadcast(R"("wind_speed_last":4,"wind_dir_last":)" + bad), 0);
    ASSERT_TRUE(said.has_value());
    EXPECT_FALSE(said->wind.direction_deg.has_value());
    EXPECT_EQ(said->wind.status, DecodedStatus::kUncertain);
  }
  EXPECT_EQ(decode_live_conditions(broadcast(R"("wind_speed_last":4,"wind_dir_last":360)"), 0)->wind.direction_deg,
            0.0);
  EXPECT_EQ(decode_live_conditions(broadcast(R"("wind_speed_last":4,"wind_dir_last":0)"), 0)->wind.direction_deg, 0.0);
  const auto below = decode_live_conditions(broadcast(R"("wind_speed_last":4,"wind_speed_hi_last_10_min":3)"), 0);
  EXPECT_FALSE(below->wind.gust_m_s.has_value());
  EXPECT_EQ(refusal_of(broadcast(R"("wind_speed_last":42606)")), Refusal::kImplausible);
  EXPECT_EQ(refusal_of(broadcast(R"("wind_speed_last":-1)")), Refusal::kImplausible);
}

TEST(WeatherLinkLiveMessage, IsOfTheTransmitterThatIsWanted) {
  const std::string two =
      R"({"did":"a","conditions":[{"data_structure_type":1,"txid":1,"wind_speed_last":null},)"
      R"({"data_structure_type":2,"txid":2,"wind_speed_last":9},)"
      R"({"data_structure_type":1,"txid":3,"wind_speed_last":3},{"data_structure_type":1,"txid":4,"wind_speed_last":4}]})";
  EXPECT_EQ(decode_live_conditions(two, 0)->transmitter, 3) << "the first with a wind";
  EXPECT_EQ(decode_live_conditions(two, 4)->transmitter, 4);
  EXPECT_EQ(refusal_of(two, 1), Refusal::kInvalid);
  EXPECT_EQ(refusal_of(two, 2), Refusal::kNotMine);
  EXPECT_EQ(refusal_of(two, 8), Refusal::kNotMine);
}

TEST(WeatherLinkLiveMessage, IsRefusedInGrades) {
  for (const std::string json :
       {"", "[]", "7", "{", "{}", R"({"data":null})", R"({"data":7,"error":null})", R"({"conditions":[]})",
        R"({"did":7,"conditions":[]})", R"({"did":"a","conditions":{}})", R"({"did":"a"})", "\xff\xfe"}) {
    EXPECT_EQ(refusal_of(json), Refusal::kMalformed) << json;
  }
  EXPECT_EQ(refusal_of(R"({"data":null,"error":{"code":404,"message":"HTTP Page Not Found"}})"), Refusal::kException);
  EXPECT_EQ(refusal_of(R"({"did":"a","conditions":[7,null,[],{"data_structure_type":"1"}]})"), Refusal::kNotMine);
  EXPECT_EQ(refusal_of(broadcast(R"("wind_speed_last":"4")")), Refusal::kInvalid);
  EXPECT_EQ(refusal_of(std::string(60'000, '[')), Refusal::kMalformed);
}

TEST(WeatherLinkLiveMessage, SaysWhereBroadcastsGo) {
  EXPECT_EQ(*decode_live_broadcast_port(R"({"data":{"broadcast_port":22222,"duration":70},"error":null})"), 22222);
  EXPECT_EQ(decode_live_broadcast_port(R"({"data":null,"error":{"code":400}})").error(), Refusal::kException);
  EXPECT_EQ(decode_live_broadcast_port(R"({"data":{"broadcast_port":0}})").error(), Refusal::kMalformed);
  EXPECT_EQ(decode_live_broadcast_port("no").error(), Refusal::kMalformed);
}

TEST(WeatherLinkLiveMessage, ThatIsCutIsNeverAWind) {
  for (const std::string& whole : {kRecordedBroadcast, kRecordedConditions}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_EQ(refusal_of(whole.substr(0, size)), Refusal::kMalformed);
    }
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode::davis
