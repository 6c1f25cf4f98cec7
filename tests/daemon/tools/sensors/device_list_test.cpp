#include "daemon/tools/sensors/device_list.hpp"

#include <array>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/settings/config.hpp"
#include "daemon/tools/sensors/driver_reference.hpp"

namespace yuragi::daemon::tools::sensors {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kRule = "SUBSYSTEM==\"hidraw\", ATTRS{idVendor}==\"0fde\", TAG+=\"uaccess\"";

// Of the names that real drivers have, so that what is printed is a configuration.
const drivers::sensor::DriverDescription kSeesTwo{
    .name = "synthetic",
    .summary = "a maker of wind",
    .parameters = {},
    .open = nullptr,
    .find = []() -> std::vector<drivers::sensor::FoundDevice> {
      return {{"Station A", "speed = 3.0\ndirection = 90.0", "", ""},
              {"Station B", "speed = 4.0", "/dev/hidraw0: Permission denied", kRule}};
    }};
const drivers::sensor::DriverDescription kSeesBToo{
    .name = "modbus",
    .summary = "another reader",
    .parameters = {},
    .open = nullptr,
    .find = []() -> std::vector<drivers::sensor::FoundDevice> {
      return {{"Station B", "transport = \"tcp\"", "/dev/hidraw0: Permission denied", kRule}};
    }};
const drivers::sensor::DriverDescription kSeesNothing{
    .name = "blind",
    .summary = "",
    .parameters = {},
    .open = nullptr,
    .find = []() -> std::vector<drivers::sensor::FoundDevice> { return {}; }};
const drivers::sensor::DriverDescription kFails{
    .name = "broken",
    .summary = "",
    .parameters = {},
    .open = nullptr,
    .find = []() -> std::vector<drivers::sensor::FoundDevice> { throw std::runtime_error("no bus"); }};
const drivers::sensor::DriverDescription kOfTheNetwork{
    .name = "mqtt", .summary = "", .parameters = {}, .open = nullptr};

std::string list_of(const std::vector<const drivers::sensor::DriverDescription*>& drivers) {
  return device_list(find_devices(drivers), drivers);
}

TEST(DeviceList, SaysSoWhereNothingIsPluggedIn) {
  const std::string text = list_of({&kSeesNothing, &kOfTheNetwork});
  EXPECT_THAT(text, HasSubstr("No device found that a driver could read (looked for devices of blind)."));
  EXPECT_THAT(text, HasSubstr("Not searched for: mqtt."));
  EXPECT_THAT(text, Not(HasSubstr("[[sensor]]")));
}

TEST(DeviceList, PrintsAConfigurationForEachDeviceThatIsOne) {
  const std::string text = list_of({&kSeesTwo, &kSeesBToo});
  std::string toml;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line == "  It cannot be opened:") break;
    if (line.starts_with("    ")) toml += line + "\n";
  }
  const settings::Config config = settings::parse_config(toml, "pasted.toml");
  ASSERT_EQ(config.sensors.size(), 2U) << toml;
  EXPECT_EQ(config.sensors[0].name, "synthetic");
  EXPECT_EQ(config.sensors[1].name, "synthetic-2") << "each sensor needs a name of its own";
  EXPECT_THAT(settings::to_toml(config.sensors[1].values), ::testing::HasSubstr("speed = 4.0"));
}

TEST(DeviceList, NamesADeviceOnceThatTwoDriversCouldReadAndItsTroubleOnce) {
  const std::string text = list_of({&kSeesTwo, &kSeesBToo});
  EXPECT_EQ(text.find("Station B"), text.rfind("Station B")) << text;
  EXPECT_EQ(text.find("Permission denied"), text.rfind("Permission denied")) << text;
  EXPECT_THAT(text, HasSubstr("  or\n    [[sensor]]\n    name = \"modbus\"\n    driver = \"modbus\"\n"));
  EXPECT_THAT(text, HasSubstr("  What to do:\n    SUBSYSTEM==\"hidraw\""));
}

TEST(DeviceList, TellsOfADriverThatCannotLookAndGoesOnWithTheOthers) {
  const std::string text = list_of({&kFails, &kSeesTwo});
  EXPECT_THAT(text, HasSubstr("search failed: no bus"));
  EXPECT_THAT(text, HasSubstr("Station A"));
}

TEST(DriverReference, DescribesEveryDriverAndEveryKeyOfIt) {
  const std::string page = driver_reference(drivers::sensor::driver_table());
  const std::string names = driver_names(drivers::sensor::driver_table());
  for (const drivers::sensor::DriverDescription* driver : drivers::sensor::driver_table()) {
    const std::string text = describe_driver(*driver);
    EXPECT_THAT(names, HasSubstr(driver->name));
    EXPECT_THAT(page, HasSubstr("\n## " + std::string(driver->name) + "\n"));
    EXPECT_THAT(text, HasSubstr("driver = \"" + std::string(driver->name) + "\""));
    for (const Parameter& parameter : driver->parameters) {
      EXPECT_THAT(text, HasSubstr(parameter.help));
      EXPECT_THAT(text, HasSubstr(describe_allowed(parameter)));
      EXPECT_THAT(page, HasSubstr("| `" + std::string(parameter.name) + "` | "));
    }
  }
}

TEST(DriverReference, SaysOfEachDeviceThatADriverKnowsWhoConfirmsItAndWhatNobodyDoes) {
  const drivers::sensor::DriverDescription driver{
      .name = "knowing", .summary = "", .parameters = {}, .open = nullptr, .known_devices = [] {
        return std::vector<drivers::sensor::KnownDevice>{
            {.name = "a-1", .device = "A 1", .confirmed_by = {"maker", "decoder"}},
            {.name = "b-2",
             .device = "B 2",
             .unconfirmed = "the id | all",
             .value = drivers::sensor::StatedValue{
                 .value = wind::ReadingValue::kMean, .averaging_s = 3.0, .source = "B p. 1"}}};
      }};
  const std::string text = describe_driver(driver);
  EXPECT_THAT(text, HasSubstr("  a-1\n      A 1; confirmed by: maker, decoder\n  b-2\n"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "      B 2; confirmed by: nobody\n      speed: mean over 3 s (B p. 1)\n      unconfirmed: the id | all\n"));
  const std::vector<const drivers::sensor::DriverDescription*> drivers = {&driver};
  EXPECT_THAT(driver_reference(drivers), HasSubstr("| `a-1` | A 1 |  | maker, decoder |  |\n"));
  EXPECT_THAT(driver_reference(drivers),
              HasSubstr("| `b-2` | B 2 | mean over 3 s (B p. 1) | nobody | the id \\| all |\n"));
}

TEST(DriverReference, SaysWhatTheSpeedIsAndOfWhichChoices) {
  static constexpr std::array<std::string_view, 2> kModes = {"fast", "slow"};
  static const std::array kParameters = {
      Parameter{.name = "mode", .default_value = std::string("fast"), .help = "how", .choices = kModes}};
  const drivers::sensor::DriverDescription driver{
      .name = "moody",
      .summary = "",
      .parameters = kParameters,
      .open = nullptr,
      .stated_value = [](const ParameterValues& values) -> std::optional<drivers::sensor::StatedValue> {
        if (values.text("mode") == "fast") return std::nullopt;
        return drivers::sensor::StatedValue{.value = wind::ReadingValue::kMean, .averaging_s = 10.0, .source = "p. 1"};
      }};
  EXPECT_THAT(describe_driver(driver), HasSubstr("Speed: mode = \"slow\": mean over 10 s (p. 1)\n"));
  EXPECT_THAT(describe_driver(driver), Not(HasSubstr("\"fast\": ")));
}

TEST(DriverReference, SaysWhichDevicesCanBeSearchedForInTheNetwork) {
  drivers::sensor::DriverDescription driver{.name = "far", .summary = "", .parameters = {}, .open = nullptr};
  EXPECT_THAT(describe_driver(driver), Not(HasSubstr("--network")));
  driver.find_in_network = [](const drivers::sensor::NetworkSearch& search) {
    if (search.to == "bad") throw std::runtime_error("no network");
    return std::vector<drivers::sensor::FoundDevice>{
        {.what = "station at " + search.to, .settings = {}, .trouble = {}, .remedy = {}}};
  };
  EXPECT_THAT(describe_driver(driver), HasSubstr("`yuragi sensors list --network` searches"));

  const drivers::sensor::DriverDescription near{.name = "near", .summary = "", .parameters = {}, .open = nullptr};
  const std::vector<const drivers::sensor::DriverDescription*> drivers = {&near, &driver};
  const auto found = find_devices_in_network(drivers, {.to = "10.0.0.1"});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().device.what, "station at 10.0.0.1");
  const auto failed = find_devices_in_network(drivers, {.to = "bad"});
  ASSERT_EQ(failed.size(), 1U);
  EXPECT_EQ(failed.front().device.trouble, "search failed: no network");
}

TEST(DriverReference, KeepsItsTablesWhole) {
  const Parameter parameter{.name = "key", .default_value = std::string("a|b"), .help = "either | or <this>"};
  const drivers::sensor::DriverDescription driver{
      .name = "piped", .summary = "a_b", .parameters = std::span(&parameter, 1), .open = nullptr};
  const std::vector<const drivers::sensor::DriverDescription*> drivers = {&driver};
  EXPECT_THAT(driver_reference(drivers), HasSubstr("a\\|b"));
  EXPECT_THAT(driver_reference(drivers), HasSubstr("| either \\| or \\<this> |"));
}

}  // namespace
}  // namespace yuragi::daemon::tools::sensors
