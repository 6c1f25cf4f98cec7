// What every driver states of itself, for all that asks: a driver that leaves something out fails here.
#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "daemon/tools/decode/decode_formats.hpp"
#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::tools {
namespace {

using drivers::sensor::DriverDescription;

/// The sensor of each driver, as its defaults are.
ParameterValues defaults_of(const DriverDescription& driver) {
  return ParameterValues::resolve(driver.parameters, {}).value();
}

std::set<std::string> words_of(std::string_view text) {
  std::istringstream in{std::string(text)};
  return {std::istream_iterator<std::string>(in), {}};
}

/// Those that neither decode messages of their own nor have a device.
bool has_no_device(const DriverDescription& driver) {
  return driver.name == "synthetic";
}

TEST(DriverTable, EachDriverNamesWhatItNeeds) {
  for (const DriverDescription* const driver : drivers::sensor::driver_table()) {
    EXPECT_EQ(driver->endpoints == nullptr, has_no_device(*driver)) << driver->name;
    if (driver->endpoints == nullptr) continue;
    EXPECT_FALSE(driver->endpoints(defaults_of(*driver)).empty()) << driver->name;
  }
}

TEST(DriverTable, EachFormatOfDecodeIsADriversAndTheReverse) {
  std::set<std::string> of_drivers;
  for (const DriverDescription* const driver : drivers::sensor::driver_table()) {
    of_drivers.merge(words_of(driver->formats));
    for (const drivers::sensor::MessageFormat& format : driver->message_formats) of_drivers.emplace(format.name);
  }
  std::set<std::string> known;
  for (const decode::UnitFormat& format : decode::unit_formats()) known.emplace(format.name);
  EXPECT_EQ(of_drivers, known);
}

TEST(DriverTable, EachDriverIsSimulatedOrSaysWhyNot) {
  for (const DriverDescription* const driver : drivers::sensor::driver_table()) {
    ASSERT_NE(driver->simulated, nullptr) << driver->name;
    const auto device = driver->simulated(defaults_of(*driver));
    if (!device) {
      EXPECT_FALSE(device.error().message.empty()) << driver->name;
      continue;
    }
    EXPECT_TRUE(device->values.has(device->port_key)) << driver->name;
    EXPECT_TRUE(ParameterValues::resolve(driver->parameters, device->values.all())) << driver->name;
  }
}

TEST(DriverTable, OneDriverPlaysRecordings) {
  EXPECT_EQ(std::ranges::count(drivers::sensor::driver_table(), true,
                               [](const DriverDescription* driver) { return driver->plays_recordings; }),
            1);
}

}  // namespace
}  // namespace yuragi::daemon::tools
