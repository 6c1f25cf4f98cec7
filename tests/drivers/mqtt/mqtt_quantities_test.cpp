#include "drivers/mqtt/mqtt_quantities.hpp"

#include <random>

#include <gtest/gtest.h>

namespace yuragi::drivers::mqtt {
namespace {

TEST(Rtl433Quantities, AreInTheUnitsOfTheKeys) {
  const auto metric = quantities_of_rtl_433(Payload(
      R"({"model":"Bresser-6in1","temperature_C":-3.5,"humidity":71,"pressure_hPa":1002.5,"rain_mm":12.8,"rain_rate_mm_h":1.2})"));
  ASSERT_TRUE(metric);
  EXPECT_EQ(metric->air_temperature_c, -3.5);
  EXPECT_EQ(metric->relative_humidity_percent, 71.0);
  EXPECT_EQ(metric->pressure_hpa, 1002.5);
  EXPECT_EQ(metric->rain_total_mm, 12.8);
  EXPECT_EQ(metric->rain_rate_mm_h, 1.2);
  const auto customary = quantities_of_rtl_433(Payload(R"({"temperature_F":14.0,"rain_in":2.0,"rain_rate_in_h":0.5})"));
  ASSERT_TRUE(customary);
  EXPECT_DOUBLE_EQ(customary->air_temperature_c.value(), -10.0);
  EXPECT_DOUBLE_EQ(customary->rain_total_mm.value(), 50.8);
  EXPECT_DOUBLE_EQ(customary->rain_rate_mm_h.value(), 12.7);
  EXPECT_FALSE(customary->pressure_hpa);
}

TEST(Rtl433Quantities, AreNoneWhereNothingIsSaid) {
  for (const char* const message : {"", "7", "[]", "{}", R"({"wind_avg_m_s":2.4})", R"({"temperature_C":null})",
                                    R"({"temperature_C":"warm"})", R"({"temperature_C")"}) {
    EXPECT_FALSE(quantities_of_rtl_433(Payload(message))) << message;
  }
}

TEST(TasmotaQuantities, AreOfTheOneSensorThatSaysThem) {
  const auto said = quantities_of_tasmota(
      Payload(R"({"Time":"2024-06-01T12:00:00","TX23":{"Speed":{"Act":14.8}},"ESP32":{"Temperature":53.3},)"
              R"("BME280":{"Temperature":21.5,"Humidity":40.1,"DewPoint":7.4,"Pressure":29.92},)"
              R"("SHT3X":{"Temperature":19.0},"PressureUnit":"inHg","TempUnit":"C"})"));
  ASSERT_TRUE(said);
  EXPECT_FALSE(said->air_temperature_c) << "two sensors say it, and nobody knows which of them is outside";
  EXPECT_EQ(said->relative_humidity_percent, 40.1);
  EXPECT_NEAR(said->pressure_hpa.value(), 1013.2, 0.1);
  const auto one = quantities_of_tasmota(Payload(R"({"ESP32":{"Temperature":53.3},"DS18B20":{"Temperature":5.5}})"));
  ASSERT_TRUE(one);
  EXPECT_EQ(one->air_temperature_c, 5.5) << "the chip's own does not count";
}

TEST(Quantities, StandAnyBytes) {
  std::mt19937_64 random(20261123);
  const std::string message =
      R"({"temperature_F":62.8,"humidity":86,"rain_in":6.7,"S":{"Temperature":1,"Pressure":2},"TempUnit":"F"})";
  int found = 0;
  for (int round = 0; round < 100'000; ++round) {
    std::string hurt = message;
    for (int change = static_cast<int>(random() % 4); change > 0; --change)
      hurt[random() % hurt.size()] = static_cast<char>(random());
    const Payload payload(hurt);
    found += quantities_of_rtl_433(payload).has_value() ? 1 : 0;
    found += quantities_of_tasmota(payload).has_value() ? 1 : 0;
  }
  EXPECT_GT(found, 10'000) << "not all of them were hurt beyond reading";
}

}  // namespace
}  // namespace yuragi::drivers::mqtt
