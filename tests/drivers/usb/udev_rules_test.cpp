// config/udev/70-yuragi.rules, read as udev reads it (udev(7)), against the drivers' own lists of devices.
#include <algorithm>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/hid/hid_station.hpp"
#include "drivers/usb/usb_daq.hpp"
#include "tests/support/places.hpp"

namespace yuragi::drivers::usb {
namespace {

using testing::UnorderedElementsAreArray;

/// One rule: its comma separated assignments and comparisons, as they stand.
struct UdevRule {
  std::vector<std::string> parts;

  bool has(const std::string& part) const { return std::ranges::count(parts, part) == 1; }
  /// The value that `key` is compared with.
  std::string compared(const std::string& key) const {
    for (const std::string& part : parts) {
      if (part.starts_with(key + "==\"")) return part.substr(key.size() + 3, part.size() - key.size() - 4);
    }
    return "";
  }
};

/// All rules of the file; a line that udev would not understand is a failure.
std::vector<UdevRule> read_rules() {
  std::ifstream file(test::source_path("config/udev/70-yuragi.rules"));
  EXPECT_TRUE(file.is_open());
  const std::regex part_form(R"re(([A-Z]+(\{[A-Za-z]+\})?(==|=|\+=)"[^"]*")(, |$))re");
  std::vector<UdevRule> rules;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    UdevRule& rule = rules.emplace_back();
    std::ptrdiff_t understood = 0;
    for (auto part = std::sregex_iterator(line.begin(), line.end(), part_form); part != std::sregex_iterator();
         ++part) {
      EXPECT_EQ(part->position(), understood) << line;
      understood = part->position() + part->length();
      rule.parts.push_back((*part)[1]);
    }
    EXPECT_EQ(understood, std::ssize(line)) << line;
  }
  return rules;
}

std::vector<std::string> ids_of_subsystem(const std::string& subsystem, const std::string& attribute) {
  std::vector<std::string> ids;
  for (const UdevRule& rule : read_rules()) {
    if (rule.compared("SUBSYSTEM") != subsystem) continue;
    ids.push_back(rule.compared(attribute + "{idVendor}") + ":" + rule.compared(attribute + "{idProduct}"));
  }
  return ids;
}

TEST(UdevRules, LetTheGroupInAndNobodyElse) {
  const std::vector<UdevRule> rules = read_rules();
  EXPECT_FALSE(rules.empty());
  for (const UdevRule& rule : rules) {
    EXPECT_TRUE(rule.has(R"(GROUP="plugdev")"));
    EXPECT_TRUE(rule.has(R"(MODE="0660")"));
    EXPECT_TRUE(rule.has(R"(TAG+="uaccess")"));
  }
}

TEST(UdevRules, NameTheUsbDevicesOfTheDriverUsb) {
  std::vector<std::string> ids;
  for (const DaqModel* const model : usb_daq_models()) ids.push_back(describe(model->id));
  EXPECT_THAT(ids_of_subsystem("usb", "ATTR"), UnorderedElementsAreArray(ids));
}

TEST(UdevRules, MatchUsbDevicesAndNotTheirInterfaces) {
  for (const UdevRule& rule : read_rules()) {
    if (rule.compared("SUBSYSTEM") == "usb") {
      EXPECT_TRUE(rule.has(R"(ENV{DEVTYPE}=="usb_device")"));
    }
  }
}

TEST(UdevRules, NameTheStationsOfTheDriverHid) {
  std::vector<std::string> ids;
  for (const hid::StationKind& kind : hid::station_kinds()) ids.push_back(describe(kind.id));
  EXPECT_THAT(ids_of_subsystem("hidraw", "ATTRS"), UnorderedElementsAreArray(ids));
}

}  // namespace
}  // namespace yuragi::drivers::usb
