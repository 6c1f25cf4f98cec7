// Messages that WeatherFlow's "Tempest UDP Reference" v171 prints, messages of real hubs that others have published,
// and what is left of them when they are hurt.
#include <cstdint>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "drivers/decode/network/tempest.hpp"
#include "tests/support/decoded_winds.hpp"

namespace yuragi::drivers::decode::network {
namespace {

using test::is_refused_as;

// The maker's reference.
constexpr std::string_view kRapidWind =
    R"({"serial_number":"SK-00008453","type":"rapid_wind","hub_sn":"HB-00000001","ob":[1493322445,2.3,128]})";
constexpr std::string_view kObservation =
    R"({"serial_number":"ST-00000512","type":"obs_st","hub_sn":"HB-00013030","obs":[[1588948614,0.18,0.22,0.27,144,6,)"
    R"(1017.57,22.37,50.26,328,0.03,3,0.000000,0,0,0,2.410,1]],"firmware_revision":129})";
constexpr std::string_view kSky =
    R"({"serial_number":"SK-00008453","type":"obs_sky","hub_sn":"HB-00000001",)"
    R"("obs":[[1493321340,9000,10,0.0,2.6,4.6,7.4,187,3.12,1,130,null,0,3]],"firmware_revision":29})";
constexpr std::string_view kAir = R"({"serial_number":"AR-00004049","type":"obs_air","hub_sn":"HB-00000001",)"
                                  R"("obs":[[1493164835,835.0,10.0,45,0,0,3.46,1]],"firmware_revision":17})";

/// A message of one rapid wind with these values.
std::string rapid_wind(const std::string& values) {
  return R"({"serial_number":"ST-00000512","type":"rapid_wind","hub_sn":"HB-00013030","ob":)" + values + "}";
}

/// The wind in a message, or why it has none.
Result<DecodedWind, Refusal> wind_in(std::string_view datagram) {
  const auto message = decode_tempest(datagram);
  if (!message) return message.error();
  return message->wind;
}

TEST(Tempest, ReadsTheRapidWindOfTheReference) {
  const auto message = decode_tempest(kRapidWind);
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->serial_number, "SK-00008453");
  EXPECT_EQ(message->hub_serial_number, "HB-00000001");
  EXPECT_EQ(message->kind, TempestKind::kRapidWind);
  EXPECT_EQ(message->time_s, 1493322445);
  EXPECT_EQ(*message->wind, (DecodedWind{.speed_m_s = 2.3, .direction_deg = 128.0, .gust_m_s = {}}));
}

TEST(Tempest, ReadsTheObservationOfTheReference) {
  const auto message = decode_tempest(kObservation);
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->kind, TempestKind::kObservation);
  EXPECT_EQ(*message->wind, (DecodedWind{.speed_m_s = 0.22, .direction_deg = 144.0, .gust_m_s = 0.27}));
  EXPECT_EQ(message->quantities.pressure_hpa, 1017.57);
  EXPECT_EQ(message->quantities.air_temperature_c, 22.37);
  EXPECT_EQ(message->quantities.relative_humidity_percent, 50.26);
  EXPECT_EQ(message->quantities.rain_rate_mm_h, 0.0);
  EXPECT_FALSE(message->quantities.rain_total_mm.has_value());
}

TEST(Tempest, ReadsTheSkyOfTheReference) {
  const auto message = decode_tempest(kSky);
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->kind, TempestKind::kObservation);
  EXPECT_EQ(*message->wind, (DecodedWind{.speed_m_s = 4.6, .direction_deg = 187.0, .gust_m_s = 7.4}));
  EXPECT_EQ(message->quantities.rain_rate_mm_h, 0.0);
  EXPECT_FALSE(message->quantities.rain_total_mm.has_value()) << "null";
  EXPECT_FALSE(message->quantities.air_temperature_c.has_value()) << "a Sky has no thermometer";
}

TEST(Tempest, KnowsWhatHasNoWind) {
  for (const std::string_view text :
       {kAir,
        std::string_view(R"({"serial_number":"HB-00069665","type":"hub_status","firmware_revision":"177",)"
                         R"("uptime":68441,"rssi":-47,"timestamp":1642340890,"seq":6831})"),
        std::string_view(R"({"serial_number":"ST-00000512","type":"evt_precip","hub_sn":"HB-00013030","evt":[1]})")}) {
    const auto message = decode_tempest(text);
    ASSERT_TRUE(message.has_value()) << text;
    EXPECT_EQ(message->kind, TempestKind::kOther);
    EXPECT_EQ(message->hub_serial_number.substr(0, 3), "HB-");
    EXPECT_TRUE(is_refused_as(message->wind, Refusal::kNotMine));
  }
}

/// As logs of several real hubs have it.
TEST(Tempest, HasNoDirectionInACalm) {
  EXPECT_EQ(*wind_in(rapid_wind("[1642340887,0.00,0]")),
            (DecodedWind{.speed_m_s = 0.0, .direction_deg = {}, .gust_m_s = {}}));
}

TEST(Tempest, SaysWhatTheStationDoesNotKnow) {
  EXPECT_TRUE(is_refused_as(wind_in(rapid_wind("[1493322445,null,128]")), Refusal::kInvalid));
  EXPECT_EQ(*wind_in(rapid_wind("[1493322445,2.3,null]")),
            (DecodedWind{.speed_m_s = 2.3, .direction_deg = {}, .gust_m_s = {}}));

  // A station whose anemometer has failed still measures the rest.
  const auto message = decode_tempest(
      R"({"serial_number":"ST-00202901","type":"obs_st","hub_sn":"HB-00204613","obs":[[1775778196,null,null,null,null,)"
      R"(60,1030.52,14.0,45.41,778,0.08,6,0.103412,1,0,0,2.189,1]],"firmware_revision":185})");
  ASSERT_TRUE(message.has_value());
  EXPECT_TRUE(is_refused_as(message->wind, Refusal::kInvalid));
  EXPECT_EQ(message->quantities.pressure_hpa, 1030.52);
  EXPECT_NEAR(message->quantities.rain_rate_mm_h.value(), 6.20472, 1e-9);
}

TEST(Tempest, LeavesOutARainWhoseTimeIsNotKnown) {
  std::string text(kObservation);
  text.replace(text.find(",1]]"), 4, ",5]]");
  EXPECT_FALSE(decode_tempest(text)->quantities.rain_rate_mm_h.has_value());
}

TEST(Tempest, TakesTheLastOfSeveralObservations) {
  std::string text(kSky);
  text.insert(text.find("[1493321340"), "[1493321280,9000,10,0.0,1,2,3,90,3.12,1,130,null,0,3],");
  EXPECT_EQ(wind_in(text)->speed_m_s, 4.6);
}

TEST(Tempest, RefusesWhatNoStationMeasures) {
  EXPECT_TRUE(is_refused_as(wind_in(rapid_wind("[1493322445,-0.1,128]")), Refusal::kImplausible));
  EXPECT_TRUE(is_refused_as(wind_in(rapid_wind("[1493322445,230,128]")), Refusal::kImplausible));
  for (const char* values : {"[1493322445,2.3,-1]", "[1493322445,2.3,1280]"}) {
    const auto wind = wind_in(rapid_wind(values));
    ASSERT_TRUE(wind) << values;
    EXPECT_EQ(wind->speed_m_s, 2.3);
    EXPECT_FALSE(wind->direction_deg);
    EXPECT_EQ(wind->status, DecodedStatus::kUncertain);
  }
  std::string text(kObservation);
  text.replace(text.find("0.27"), 4, "0.21");
  EXPECT_TRUE(is_refused_as(wind_in(text), Refusal::kImplausible)) << "a gust below the mean";
}

TEST(Tempest, RefusesWhatIsNoSuchMessage) {
  EXPECT_TRUE(is_refused_as(wind_in(""), Refusal::kTooShort));
  EXPECT_TRUE(is_refused_as(wind_in(rapid_wind("[1493322445,2.3]")), Refusal::kTooShort));
  for (const std::string& text :
       {std::string("{}"),
        std::string("null"),
        std::string("[1,2,3]"),
        std::string("2.3"),
        rapid_wind("{}"),
        rapid_wind("null"),
        rapid_wind("[\"1493322445\",2.3,128]"),
        rapid_wind("[1493322445,\"2.3\",128]"),
        rapid_wind("[null,2.3,128]"),
        rapid_wind("[0,2.3,128]"),
        rapid_wind("[1e300,2.3,128]"),
        rapid_wind("[1493322445,2.3,128") + "]",
        std::string(kRapidWind) + "x",
        std::string(R"({"type":"rapid_wind","hub_sn":"HB-00000001","ob":[1493322445,2.3,128]})"),
        std::string(R"({"serial_number":"","type":"rapid_wind","hub_sn":"HB-1","ob":[1493322445,2.3,128]})"),
        std::string(R"({"serial_number":"ST-1","type":"rapid_wind","hub_sn":"HB-1"})"),
        std::string(R"({"serial_number":"ST-1","type":"obs_st","hub_sn":"HB-1","obs":[]})"),
        R"({"serial_number":")" + std::string(33, 'S') + R"(","type":"hub_status"})",
        std::string(kMaxTempestMessage, '['),
        std::string(kMaxTempestMessage + 1, ' ')}) {
    EXPECT_TRUE(is_refused_as(wind_in(text), Refusal::kMalformed)) << text.substr(0, 100);
  }
}

TEST(Tempest, RefusesWhatIsCutOff) {
  for (const std::string_view whole : {kRapidWind, kObservation, kSky}) {
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_FALSE(decode_tempest(whole.substr(0, size)).has_value()) << size;
  }
}

/// JSON has no checksum: where a digit of the wind is another digit, that is another wind. Nothing else changes it.
TEST(Tempest, IsHurtOnlyWhereItsOwnValuesAre) {
  for (const std::string_view whole : {kRapidWind, kObservation, kSky}) {
    const DecodedWind wind = *wind_in(whole);
    const std::size_t first = whole.find('[');
    const std::size_t last = whole.rfind(']');
    for (std::size_t at = 0; at < whole.size(); ++at) {
      if (at >= first && at <= last) continue;
      std::string hurt(whole);
      for (int value = 0; value < 256; ++value) {
        hurt[at] = static_cast<char>(value);
        const auto decoded = wind_in(hurt);
        ASSERT_TRUE(!decoded || *decoded == wind) << hurt;
      }
    }
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode::network
