// Pushes of real stations, as others have published them with their keys changed, and what is left of them when they
// are hurt.
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "drivers/decode/network/station_push.hpp"
#include "tests/support/decoded_winds.hpp"

namespace yuragi::drivers::decode::network {
namespace {

using test::is_refused_as;
using test::is_refused_or_physical;

// A GW2000A with a WS90 (the tests of aioecowitt).
constexpr std::string_view kGw2000 =
    "PASSKEY=345544D8EAF42E1B8824A86D8250D5A3&stationtype=GW2000A_V2.1.5&runtime=188738&dateutc=2022-07-15+15:26:14"
    "&tempinf=78.80&humidityin=53&baromrelin=27.885&baromabsin=27.885&tempf=87.08&humidity=34&winddir=289"
    "&windspeedmph=2.91&windgustmph=3.13&maxdailygust=12.53&solarradiation=530.62&uv=4&rrain_piezo=0.100"
    "&erain_piezo=0.000&hrain_piezo=0.000&drain_piezo=0.000&wrain_piezo=0.000&mrain_piezo=0.000&yrain_piezo=2.000"
    "&ws90cap_volt=5.4&ws90_ver=119&wh90batt=2.74&freq=868M&model=GW2000A";
// A GW1000 with a WS69 (CumulusMX, HttpStationEcowitt).
constexpr std::string_view kGw1000 =
    "PASSKEY=DFD82AD35BF6EC2843920EC477D60648&stationtype=GW1000A_V1.6.8&dateutc=2021-07-23+17:13:34&tempinf=80.6"
    "&humidityin=50&baromrelin=29.940&baromabsin=29.081&tempf=81.3&humidity=43&winddir=296&windspeedmph=2.46"
    "&windgustmph=4.25&maxdailygust=14.09&solarradiation=226.28&uv=1&rainratein=0.000&eventrainin=0.000"
    "&hourlyrainin=0.000&dailyrainin=0.000&weeklyrainin=0.000&monthlyrainin=4.118&yearlyrainin=29.055"
    "&totalrainin=29.055";
// An HP2550 by Weather Underground's protocol, an Observer whose sensors are not heard, and an Ambient Weather station
// (the comments of weewx-interceptor).
constexpr std::string_view kHp2550 =
    "ID=IXXXX1&PASSWORD=PASSWORD&indoortempf=71.6&tempf=55.2&dewptf=51.6&windchillf=55.2&indoorhumidity=64&humidity=88"
    "&windspeedmph=2.0&windgustmph=2.2&winddir=25&absbaromin=29.729&baromin=29.829&rainin=0.000&dailyrainin=0.000"
    "&weeklyrainin=0.000&monthlyrainin=0.091&yearlyrainin=0.091&solarradiation=0.00&UV=0&soilmoisture=52&AqPM2.5=309.0"
    "&dateutc=2019-06-16%2001:05:39&softwaretype=EasyWeatherV1.3.9&action=updateraw&realtime=1&rtfreq=5";
constexpr std::string_view kDeafObserver =
    "ID=XXXXXXXXXXXXX&PASSWORD=PASSWORD&tempf=-9999&humidity=-9999&dewptf=-9999&windchillf=-9999&winddir=-9999"
    "&windspeedmph=-9999&windgustmph=-9999&rainin=0.00&dailyrainin=0.00&weeklyrainin=0.00&monthlyrainin=0.00"
    "&yearlyrainin=0.00&solarradiation=-9999&UV=-9999&indoortempf=66.2&indoorhumidity=47&baromin=29.94&lowbatt=0"
    "&dateutc=2016-5-10%202:34:15&softwaretype=Weather%20logger%20V3.0.7&action=updateraw&realtime=1&rtfreq=5";
constexpr std::string_view kAmbient =
    "stationtype=AMBWeatherV4.0.2&PASSKEY=00:0E:C6:00:00:01&dateutc=2018-06-20+13:39:00&winddir=169&windspeedmph=1.8"
    "&windgustmph=2.2&maxdailygust=3.4&tempf=69.1&hourlyrainin=0.00&eventrainin=0.00&dailyrainin=0.00&weeklyrainin=0.87"
    "&monthlyrainin=0.87&totalrainin=0.87&baromrelin=29.89&baromabsin=29.48&humidity=61&tempinf=73.4&humidityin=51"
    "&uv=3&solarradiation=299.23";
// A GW1100 without outdoor sensors (bentasker, Ecowitt_to_InfluxDB: captured).
constexpr std::string_view kNoAnemometer =
    "PASSKEY=02EB4812BE8FE29E25936DCC71B81862&stationtype=GW1100A_V2.0.4&dateutc=2022-03-23+17:47:28&tempinf=77.5"
    "&humidityin=38&baromrelin=30.428&baromabsin=30.428&freq=868M&model=GW1100A";

// A console with WSLink, with the names of its API's documentation.
constexpr std::string_view kWsLink =
    "wsid=home&wspw=hidden&datetime=2026-11-25%2012:00:00&t1cn=1&t1bat=1&t1tem=18.4&t1hum=65&t1wdir=315&t1ws=3.4"
    "&t1ws10mav=2.9&t1wgust=5.1&t1rainra=1.2&t1raindy=3.0&t1rainyr=512.9&intem=21.0&rbar=1013.2&abar=1001.5&apiver=0.6";

/// The wind in a form, or why it has none.
Result<DecodedWind, Refusal> wind_in(std::string_view form) {
  const auto push = decode_station_push(form);
  if (!push) return push.error();
  return push->wind;
}

TEST(StationPush, ReadsAGatewayOfEcowitt) {
  const auto push = decode_station_push(kGw2000);
  ASSERT_TRUE(push.has_value());
  EXPECT_EQ(push->identity, "345544D8EAF42E1B8824A86D8250D5A3");
  EXPECT_EQ(push->kind, "GW2000A_V2.1.5");
  ASSERT_TRUE(push->wind.has_value());
  EXPECT_NEAR(*push->wind->speed_m_s, 1.3009, 1e-4);
  EXPECT_NEAR(*push->wind->gust_m_s, 1.3992, 1e-4);
  EXPECT_EQ(push->wind->direction_deg, 289.0);
  EXPECT_NEAR(*push->quantities.air_temperature_c, 30.6, 1e-9);
  EXPECT_EQ(push->quantities.relative_humidity_percent, 34.0);
  EXPECT_NEAR(*push->quantities.pressure_hpa, 944.29, 0.01);
  EXPECT_NEAR(*push->quantities.rain_rate_mm_h, 2.54, 1e-9);
  EXPECT_NEAR(*push->quantities.rain_total_mm, 50.8, 1e-9);
}

TEST(StationPush, ReadsThePressureOfTheStationAndTheRainSinceEver) {
  const auto push = decode_station_push(kGw1000);
  ASSERT_TRUE(push.has_value());
  EXPECT_NEAR(*push->quantities.pressure_hpa, 29.081 * 33.86389, 1e-6);
  EXPECT_NEAR(*push->quantities.rain_total_mm, 738.0, 0.01);
  EXPECT_EQ(push->quantities.rain_rate_mm_h, 0.0);
}

TEST(StationPush, ReadsTheProtocolOfWeatherUnderground) {
  const auto push = decode_station_push(kHp2550);
  ASSERT_TRUE(push.has_value());
  EXPECT_EQ(push->identity, "IXXXX1");
  EXPECT_EQ(push->kind, "EasyWeatherV1.3.9");
  EXPECT_NEAR(*push->wind->speed_m_s, 0.89408, 1e-9);
  EXPECT_EQ(push->wind->direction_deg, 25.0);
  EXPECT_NEAR(*push->quantities.pressure_hpa, 29.729 * 33.86389, 1e-6) << "the one at the station";
  EXPECT_NEAR(*push->quantities.rain_total_mm, 0.091 * 25.4, 1e-9);
  EXPECT_FALSE(push->quantities.rain_rate_mm_h.has_value()) << "rainin is the rain of an hour";
}

TEST(StationPush, ReadsAmbientWeather) {
  const auto push = decode_station_push(kAmbient);
  ASSERT_TRUE(push.has_value());
  EXPECT_EQ(push->identity, "00:0E:C6:00:00:01");
  EXPECT_NEAR(*push->wind->gust_m_s, 0.98349, 1e-5);
}

TEST(StationPush, ReadsWsLinkInItsOwnUnits) {
  const auto push = decode_station_push(kWsLink);
  ASSERT_TRUE(push.has_value());
  EXPECT_EQ(push->identity, "home");
  EXPECT_EQ(push->kind, "WSLink");
  EXPECT_EQ(*push->wind, (DecodedWind{.speed_m_s = 3.4, .direction_deg = 315.0, .gust_m_s = 5.1}));
  EXPECT_EQ(push->quantities.air_temperature_c, 18.4);
  EXPECT_EQ(push->quantities.relative_humidity_percent, 65.0);
  EXPECT_EQ(push->quantities.pressure_hpa, 1001.5) << "the one at the console";
  EXPECT_EQ(push->quantities.rain_rate_mm_h, 1.2);
  EXPECT_EQ(push->quantities.rain_total_mm, 512.9);

  const auto unnamed = wind_in("wspw=a&t1ws=0.0&t1wdir=360&t1wgust=1.0");
  EXPECT_EQ(*unnamed, (DecodedWind{.speed_m_s = 0.0, .direction_deg = 0.0, .gust_m_s = 1.0}));
  const auto lost = decode_station_push("wsid=a&t1cn=0&t1ws=3.4&t1tem=18.4&rbar=1013.2");
  ASSERT_TRUE(lost.has_value());
  EXPECT_TRUE(is_refused_as(lost->wind, Refusal::kInvalid)) << "the console does not receive the sensors";
  EXPECT_FALSE(lost->quantities.air_temperature_c.has_value());
  EXPECT_EQ(lost->quantities.pressure_hpa, 1013.2);
  EXPECT_TRUE(is_refused_as(wind_in("wsid=a&rbar=1013.2"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused_as(wind_in("wsid=a&t1ws=3.4&t1ws=4.4"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in("wsid=a&t1ws=3,4"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in("wsid=a&t1ws=130.5"), Refusal::kImplausible));
  EXPECT_NEAR(*wind_in("ID=a&windspeedmph=10&t1ws=99")->speed_m_s, 4.4704, 1e-9) << "of another protocol";
}

TEST(StationPush, KnowsWhatIsMissing) {
  const auto deaf = decode_station_push(kDeafObserver);
  ASSERT_TRUE(deaf.has_value());
  EXPECT_TRUE(is_refused_as(deaf->wind, Refusal::kInvalid));
  EXPECT_FALSE(deaf->quantities.air_temperature_c.has_value());
  EXPECT_FALSE(deaf->quantities.relative_humidity_percent.has_value());
  EXPECT_TRUE(deaf->quantities.pressure_hpa.has_value()) << "the console's own";
  EXPECT_TRUE(is_refused_as(wind_in(kNoAnemometer), Refusal::kInvalid));
  EXPECT_TRUE(is_refused_as(wind_in("ID=a&windspeedmph="), Refusal::kInvalid));

  const auto without_vane = wind_in("ID=a&windspeedmph=10&winddir=-9999&windgustmph=");
  EXPECT_EQ(*without_vane, (DecodedWind{.speed_m_s = 4.4704, .direction_deg = {}, .gust_m_s = {}}));
}

TEST(StationPush, LeavesOutAGustBelowTheMean) {
  const auto wind = wind_in("ID=a&windspeedmph=10&windgustmph=9.9&winddir=360");
  EXPECT_EQ(*wind, (DecodedWind{.speed_m_s = 4.4704, .direction_deg = 0.0, .gust_m_s = {}}));
}

TEST(StationPush, TakesWhatStationsAddByMistake) {
  EXPECT_TRUE(wind_in("&PASSKEY=A&windspeedmph=10&rtfreq2.5&\r\n").has_value());
  EXPECT_TRUE(wind_in("windspeedmph=10").has_value()) << "a station without a name";
}

TEST(StationPush, RefusesWhatNoStationMeasures) {
  for (const std::string_view form :
       {"ID=a&windspeedmph=-1", "ID=a&windspeedmph=270", "ID=a&windspeedmph=10&winddir=-1",
        "ID=a&windspeedmph=10&winddir=9999", "ID=a&windspeedmph=10&windgustmph=999"}) {
    EXPECT_TRUE(is_refused_as(wind_in(form), Refusal::kImplausible)) << form;
  }
}

TEST(StationPush, RefusesWhatIsNoSuchForm) {
  EXPECT_TRUE(is_refused_as(wind_in(""), Refusal::kTooShort));
  EXPECT_TRUE(is_refused_as(wind_in("\r\n"), Refusal::kTooShort));
  EXPECT_TRUE(is_refused_as(wind_in("a=1&tempf=55"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused_as(wind_in("PASSKEY"), Refusal::kNotMine));
  for (const std::string& form :
       {std::string("ID=a&windspeedmph=1&windspeedmph=2"), std::string("ID=a&ID=b&windspeedmph=1"),
        std::string("ID=a&windspeedmph=1e1"), std::string("ID=a&windspeedmph=10&winddir=NE"),
        std::string("ID=a&windspeedmph=10&windgustmph=--"), std::string("{\"ID\": \"a\"}"),
        std::string("ID=a&windspeedmph=1\nwinddir=2"), "ID=" + std::string(kMaxStationPush, 'a')}) {
    EXPECT_TRUE(is_refused_as(wind_in(form), Refusal::kMalformed)) << form.substr(0, 100);
  }
}

TEST(StationPush, FindsTheFormInATarget) {
  const auto expect_parts = [](std::string_view target, std::string_view path, std::string_view form) {
    const PushTarget parts = split_push_target(target);
    EXPECT_EQ(parts.path, path) << target;
    EXPECT_EQ(parts.form, form) << target;
  };
  expect_parts("/data/report/", "/data/report", "");
  expect_parts("/weatherstation/updateweatherstation.php?ID=a&b=/c?", "/weatherstation/updateweatherstation.php",
               "ID=a&b=/c?");
  expect_parts("/data/report/stationtype=AMB&PASSKEY=a", "/data/report", "stationtype=AMB&PASSKEY=a");
  expect_parts("ID=a&b=c", "", "ID=a&b=c");
  expect_parts("/?a=1", "", "a=1");
  expect_parts("", "", "");
}

TEST(StationPush, ShowsNoSecret) {
  EXPECT_EQ(without_push_secrets("PASSKEY=ABC&tempf=1&PASSWORD=x y&z=2"),
            "PASSKEY=(secret)&tempf=1&PASSWORD=(secret)&z=2");
  EXPECT_EQ(without_push_secrets("passkey=a&Password=b&%50ASSWORD=c&key=d&token=e"),
            "(secret)&(secret)&(secret)&(secret)&(secret)");
  EXPECT_EQ(without_push_secrets("wsid=a&wspw=b&t1ws=1"), "wsid=a&wspw=(secret)&t1ws=1");
  EXPECT_EQ(without_push_secrets(R"({"PASSKEY": "ABC"})"), "(secret)");
  EXPECT_EQ(without_push_secrets("a=1;PASSKEY=ABC&b=2"), "(secret)&b=2");
  EXPECT_EQ(without_push_secrets("PASSKEY"), "(secret)");
  EXPECT_EQ(without_push_secrets(""), "");
  const std::string shown = without_push_secrets(kGw2000);
  EXPECT_EQ(shown.find("345544D8"), std::string::npos);
  EXPECT_EQ(*wind_in(shown), *wind_in(kGw2000)) << "what is shown can be decoded again";
}

TEST(StationPush, MakesTextOfAValue) {
  EXPECT_EQ(push_text("Weather%20logger+V3.0.7"), "Weather logger V3.0.7");
  EXPECT_EQ(push_text("a%0a%1bb%zz%4"), "a??b%zz%4");
  EXPECT_EQ(push_text(std::string(1000, 'x')), std::string(40, 'x'));
}

/// A form has no checksum: where a digit of the wind is another digit, that is another wind. Nothing outside of its own
/// values and names changes it.
TEST(StationPush, IsHurtOnlyWhereItsOwnValuesAre) {
  for (const std::string_view whole : {kGw2000, kHp2550, kAmbient, kWsLink}) {
    const DecodedWind wind = *wind_in(whole);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      const std::size_t begin = whole.rfind('&', at) == whole.npos ? 0 : whole.rfind('&', at) + 1;
      const bool is_wind = std::ranges::any_of(std::array{"wind", "t1w", "t1cn"}, [&](const char* name) {
        return whole.substr(begin).starts_with(name) || whole.substr(at + 1).starts_with(name);
      });
      if (is_wind) continue;
      std::string hurt(whole);
      for (int value = 0; value < 256; ++value) {
        hurt[at] = static_cast<char>(value);
        const auto decoded = wind_in(hurt);
        ASSERT_TRUE(!decoded || *decoded == wind) << hurt;
      }
    }
  }
}

TEST(StationPush, NeverSaysWhatCannotBeNorASecret) {
  std::mt19937_64 random(20261123);
  for (int i = 0; i < 40'000; ++i) {
    constexpr std::array kForms = {kGw2000, kHp2550, kDeafObserver, kWsLink};
    std::string hurt(kForms.at(static_cast<std::size_t>(i) % kForms.size()));
    for (auto changes = 1 + random() % 4; changes > 0; --changes) {
      const auto at = static_cast<std::size_t>(random() % hurt.size());
      const auto value = static_cast<char>(random() % 4 == 0 ? random() : ' ' + random() % 95);
      if (random() % 3 == 0) {
        hurt.insert(at, 1, value);
      } else {
        hurt[at] = value;
      }
    }
    ASSERT_TRUE(is_refused_or_physical(wind_in(hurt))) << hurt;
    if (hurt.find("PASSWORD=PASSWORD&") != std::string::npos) {
      ASSERT_EQ(without_push_secrets(hurt).find("PASSWORD=PASSWORD"), std::string::npos) << hurt;
    }
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode::network
