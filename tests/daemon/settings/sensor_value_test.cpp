// What the speed in a reading is: stated by driver or profile, configured, or assumed.
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/settings/config.hpp"
#include "daemon/settings/recorded_sensor.hpp"
#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::settings {
namespace {

using drivers::sensor::StatedValue;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using wind::ReadingValue;

/// Of one sensor with these lines.
SensorConfig sensor_of(const std::string& lines) {
  return parse_config("[[sensor]]\n" + lines, "wall.toml").sensors.at(0);
}

std::string text_of(const std::string& lines) {
  const SensorConfig sensor = sensor_of(lines);
  EXPECT_EQ(sensor.blend.value, sensor.value.value);
  EXPECT_EQ(sensor.blend.averaging_s, sensor.value.averaging_s);
  return value_text(sensor.value);
}

TEST(SensorValue, IsStatedByEachDriverWithItsSource) {
  std::size_t statements = 0;
  for (const drivers::sensor::DriverDescription* driver : drivers::sensor::driver_table()) {
    if (driver->stated_value == nullptr) continue;
    auto values = ParameterValues::resolve(driver->parameters, {});
    ASSERT_TRUE(values) << driver->name;
    const auto check = [&](const ParameterValues& of) {
      const std::optional<StatedValue> stated = driver->stated_value(of);
      if (!stated) return;
      ++statements;
      EXPECT_NE(stated->value, ReadingValue::kUnknown) << driver->name;
      EXPECT_FALSE(stated->source.empty()) << driver->name;
      EXPECT_GE(stated->averaging_s, 0.0) << driver->name;
    };
    check(*values);
    for (const Parameter& parameter : driver->parameters) {
      for (const std::string_view choice : parameter.choices) {
        ParameterValues of_choice = *values;
        of_choice.set(parameter.name, std::string(choice));
        check(of_choice);
      }
    }
    if (driver->known_devices == nullptr) continue;
    for (const drivers::sensor::KnownDevice& device : driver->known_devices()) {
      if (!device.value) continue;
      ++statements;
      EXPECT_NE(device.value->value, ReadingValue::kUnknown) << device.name;
      EXPECT_FALSE(device.value->source.empty()) << device.name;
    }
  }
  EXPECT_GE(statements, 12U);
}

TEST(SensorValue, IsWhatDriverOrProfileStates) {
  const std::string modbus = "driver = \"modbus\"\nhost = \"localhost\"\ntransport = \"tcp\"\nprofile = ";
  EXPECT_EQ(text_of(modbus + "\"calypso-ulp\"\n"), "mean over 3 s (Calypso ULP manual p. 14)");
  EXPECT_THAT(text_of(modbus + "\"lufft-umb\"\n"), StartsWith("instantaneous (Lufft WS600 manual"));
  EXPECT_THAT(text_of("driver = \"microphone\"\nwindow = 2\n"), StartsWith("mean over 2 s ("));
  EXPECT_THAT(text_of("driver = \"hid\"\nstation = \"wmr100\"\n"), StartsWith("mean over the interval ("));
  EXPECT_THAT(text_of("driver = \"usb\"\n"), StartsWith("mean over the interval ("));
  EXPECT_THAT(text_of("driver = \"synthetic\"\n"), StartsWith("instantaneous ("));
  // Not documented.
  EXPECT_EQ(sensor_of("driver = \"hid\"\n").value.value, ReadingValue::kUnknown);
  EXPECT_EQ(sensor_of(modbus + "\"xunchip-xm8589\"\n").value.value, ReadingValue::kUnknown);
  EXPECT_EQ(sensor_of("driver = \"ecowitt-push\"\n").value.value, ReadingValue::kUnknown);
}

TEST(SensorValue, IsAsConfiguredBeforeItIsAsStated) {
  const std::string calypso =
      "driver = \"modbus\"\nhost = \"localhost\"\ntransport = \"tcp\"\nprofile = \"calypso-ulp\"\n[sensor.blend]\n";
  EXPECT_EQ(text_of(calypso + "value = \"instant\"\n"), "instantaneous ([sensor.blend])");
  EXPECT_EQ(text_of(calypso + "value = \"mean\"\n"), "mean over 3 s ([sensor.blend])") << "its time is still known";
  EXPECT_EQ(text_of(calypso + "value = \"maximum\"\n"), "maximum over the interval ([sensor.blend])");
  EXPECT_EQ(text_of(calypso + "averaging = 120\n"), "mean over 120 s ([sensor.blend])");
  EXPECT_EQ(text_of("driver = \"hid\"\n[sensor.blend]\naveraging = 60\n"), "mean over 60 s ([sensor.blend])")
      << "what is averaged is a mean";
  EXPECT_EQ(text_of("driver = \"hid\"\n[sensor.blend]\nvalue = \"instant\"\naveraging = 60\n"),
            "instantaneous ([sensor.blend])");
  EXPECT_THAT(text_of("driver = \"synthetic\"\n[sensor.blend]\nvalue = \"auto\"\n"), StartsWith("instantaneous (d"));
  try {
    parse_config("[[sensor]]\ndriver = \"synthetic\"\n[sensor.blend]\nvalue = \"median\"\n", "wall.toml");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), StartsWith("wall.toml:4:9: sensor.blend.value: is \"median\"; allowed:"));
    EXPECT_THAT(error.what(), HasSubstr("\"maximum\""));
  }
}

TEST(SensorValue, IsShownAsAssumedIfItIsUnknown) {
  EXPECT_EQ(value_text(StatedValue{}, {.value = wind::assumed_value(16.0)}), "instantaneous (assumed)");
  EXPECT_EQ(value_text(StatedValue{}, {.value = wind::assumed_value(60.0)}), "mean over the interval (assumed)");
  EXPECT_EQ(value_text(StatedValue{}, {.value = wind::ReadingValue::kMean, .is_judged = true}),
            "mean over the interval (judged from its readings)");
  EXPECT_EQ(value_text(StatedValue{}), "unknown");
}

TEST(SensorValue, OfARecordingIsThatOfTheDriverThatRecorded) {
  const auto stated = recorded_source("microphone", "window = 4.0\n").value;
  ASSERT_TRUE(stated);
  EXPECT_EQ(stated->averaging_s, 4.0);
  EXPECT_EQ(recorded_source("mqtt", "topic = \"wind\"\n").value, std::nullopt);
  EXPECT_EQ(recorded_source("microphone", "window =").value, std::nullopt);
  EXPECT_EQ(recorded_source("a driver of later", "").value, std::nullopt);
}

}  // namespace
}  // namespace yuragi::daemon::settings
