// USB weather stations that are HID devices. Their reports are decoded in drivers/decode, their protocols run in
// drivers/stations, one file per family:
//
//   station      USB id      sends                      wind every
//   wmr100       0fde:ca01   by itself                  14 s       Oregon Scientific WMR100, WMR88, RMS300, RMS600 ...
//   wmr300       0fde:ca08   while it gets a heartbeat  2.75 s     Oregon Scientific WMR300
//   fineoffset   1941:8021   on request                48 s       Fine Offset WH1080, WH2080, WH3080 and their clones
//   acurite      24c0:0003   on request                18 s       AcuRite 01025, 01035, 01036, 02032, 02064
//   te923        1130:6801   on request                33 s       Hideki TE923: Meade, TFA Nexus, Mebus, IROX
//
// Source: drivers/SOURCES.md S2.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "drivers/decode/hid/acurite.hpp"
#include "drivers/decode/hid/wmr300.hpp"
#include "drivers/hid/hid_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::hid {
namespace {

constexpr std::array<std::string_view, 6> kStationChoices = {"auto",       "wmr100",  "wmr300",
                                                             "fineoffset", "acurite", "te923"};

struct Keys {
  std::string station;
  bus::HidPlace place;
  double pace = 1.0;
  Nanoseconds poll_interval{};
};

const Fields<Keys> kHidFields = {
    {{.name = "station",
      .default_value = std::string("auto"),
      .help = "family of the station; auto: the one that is plugged in",
      .choices = kStationChoices},
     &Keys::station},
    {{.name = "path",
      .default_value = std::string(""),
      .help =
          "USB port of the station, such as 1-1.2, or its /dev/hidraw node or a link to that; selects one of several"},
     [](Keys& keys) -> std::string& { return keys.place.path; }},
    {{.name = "serial",
      .default_value = std::string(""),
      .help = "its serial number, if it has one; selects one of several"},
     [](Keys& keys) -> std::string& { return keys.place.serial; }},
    {{"poll_interval", "s", 0.0, 0.0, 3600.0,
      "interval between requests, of fineoffset, acurite and te923; 0: the station's own, 48, 18 and 33 s. A "
      "shorter one gives no new readings; fineoffset, which could lock up, ignores it"},
     &Keys::poll_interval,
     from_seconds},
    {{"pace", "", 1.0, 1.0, 1000.0, "speed relative to a real station, for simulated ones"}, &Keys::pace},
};

std::span<const StationKind> kinds_named(std::string_view name) {
  const auto all = station_kinds();
  if (name == "auto") return all;
  const auto kind = std::ranges::find(all, name, &StationKind::name);
  return std::span(kind, kind == all.end() ? 0U : 1U);
}

std::unique_ptr<sensor::Sensor> open_hid(const ParameterValues& values) {
  const auto [station, place, pace, poll_interval] = kHidFields.of(values);
  return std::make_unique<Sensor>(kinds_named(station), place,
                                  StationTiming{.pace = pace, .poll_interval = poll_interval},
                                  sensor::seed_of(station + place.path + place.serial), bus::make_hid_device());
}

/// The path of a file is that of the link's target.
sensor::ValueSelection hid_selection(const ParameterValues& values) {
  const Keys keys = kHidFields.of(values);
  std::string path = keys.place.path;
  if (path.starts_with('/')) {
    std::error_code error;
    const auto node = std::filesystem::weakly_canonical(path, error);
    if (!error) path = node.string();
  }
  return {.device = "USB weather station",
          .parts = {{.key = "station", .value = keys.station == "auto" ? "" : keys.station},
                    {.key = "path", .value = std::move(path)},
                    {.key = "serial", .value = keys.place.serial}}};
}

std::vector<sensor::FoundDevice> find_hid() {
  std::vector<bus::HidId> ids;
  for (const StationKind& kind : station_kinds()) ids.push_back(kind.id);
  std::vector<sensor::FoundDevice> found;
  for (const bus::HidListing& listing : bus::list_hid_devices(ids)) {
    const auto kind = std::ranges::find(station_kinds(), listing.info.id, &StationKind::id);
    const std::string& path = listing.info.port.empty() ? listing.info.node : listing.info.port;
    found.push_back({.what = fmt::format("{} ({}) at {}", kind->title, describe(kind->id), bus::where_is(listing.info)),
                     .settings = fmt::format("station = \"{}\"\npath = \"{}\"", kind->name, path),
                     .trouble = listing.trouble.empty()
                                    ? ""
                                    : fmt::format("cannot open {}: {}", listing.info.node, listing.trouble),
                     .remedy = listing.trouble.empty() ? "" : bus::kHidPermissionRemedy});
  }
  return found;
}

/// Of stations whose reports have both an average and a gust. Source: drivers/SOURCES.md S2.1 to S2.3.
std::optional<sensor::StatedValue> hid_value(const ParameterValues& values) {
  const std::string station = kHidFields.of(values).station;
  std::string_view source;
  if (station == "wmr100") source = "average, by weewx's wmr100.py";
  if (station == "wmr300") source = "average, by weewx's wmr300.py";
  if (station == "fineoffset") source = "average, by weewx's fousb.py";
  if (source.empty()) return std::nullopt;
  return sensor::StatedValue{.value = wind::ReadingValue::kMean, .source = std::string(source)};
}

constexpr std::array kHidFormats = {sensor::MessageFormat{.name = "wmr300",
                                                          .unit = "a packet",
                                                          .devices = "Oregon Scientific WMR300",
                                                          .example = "wmr300 --hex --refused packets.hex",
                                                          .decode = decode::hid::decode_wmr300},
                                    sensor::MessageFormat{.name = "acurite",
                                                          .unit = "report 1, of 10 bytes",
                                                          .devices = "AcuRite 01025, 01035, 01036, 02032, 02064",
                                                          .example = "acurite --hex r1.hex",
                                                          .decode = decode::hid::decode_acurite}};

}  // namespace

extern const sensor::DriverDescription kHidDriver;
const sensor::DriverDescription kHidDriver{
    .name = "hid",
    .summary =
        "USB weather stations: Oregon Scientific WMR100 and WMR300, Fine Offset "
        "WH1080 and WH3080, AcuRite, Hideki TE923",
    .parameters = kHidFields.parameters(),
    .open = open_hid,
    .find = find_hid,
    .endpoints =
        [](const ParameterValues&) { return std::vector{sensor::Endpoint{.kind = sensor::EndpointKind::kHid}}; },
    .selection = hid_selection,
    .stated_value = hid_value,
    .simulated = [](const ParameterValues&) -> Result<sensor::SimulatedDevice, Failure> {
      return Failure{
          "a simulated hid cannot be started here: it needs a virtual USB bus, and the permission to create it"};
    },
    .message_formats = kHidFormats,
    .formats = "wmr100 fineoffset te923"};

}  // namespace yuragi::drivers::hid
