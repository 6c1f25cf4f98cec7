#include "daemon/settings/feeds/lists.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "daemon/settings/feeds/place.hpp"

namespace yuragi::daemon::settings::feeds {
namespace {

constexpr std::size_t kMaxPlaces = 64;
constexpr std::size_t kMaxFeeds = 16;
constexpr std::size_t kMaxBelow = 256;

std::vector<ParameterError> add_place(Config& config, const std::string& name, const ParameterValues& values,
                                      const values::Names&) {
  config.places.push_back(place_of(name, values));
  return {};
}

template <class Made>
std::vector<ParameterError> add_to(std::vector<Made>& list, Result<Made, ParameterError> made) {
  if (!made) return {made.error()};
  list.push_back(std::move(*made));
  return {};
}

std::vector<ParameterError> add_osc(Config& config, const std::string& name, const ParameterValues& values,
                                    const values::Names&) {
  return add_to(config.osc, osc_of(name, values));
}

std::vector<ParameterError> add_osc_map(Config& config, const std::string&, const ParameterValues& values,
                                        const values::Names& names) {
  if (config.osc.empty()) return {};  // its [[osc]] was refused
  return add_to(config.osc.back().maps, osc_map_of(values, names));
}

std::vector<ParameterError> add_osc_cue(Config& config, const std::string&, const ParameterValues& values,
                                        const values::Names& names) {
  if (config.osc.empty()) return {};
  return add_to(config.osc.back().cues, osc_cue_of(values, names));
}

/// The last [[dmx]] beside the others. `key`: of the table that was added.
std::vector<ParameterError> dmx_clashes(const Config& config, const char* key) {
  for (std::size_t i = 0; i + 1 < config.dmx.size(); ++i) {
    if (!config.dmx.back().clashes_with(config.dmx[i])) continue;
    return {
        {key, fmt::format("makes this [[dmx]] send a universe to the receiver of the [[dmx]] \"{}\": both would undo "
                          "each other; give one [[dmx]] all channels, or choose another universe",
                          config.dmx[i].name)}};
  }
  return {};
}

std::vector<ParameterError> add_dmx(Config& config, const std::string& name, const ParameterValues& values,
                                    const values::Names&) {
  auto errors = add_to(config.dmx, dmx_of(name, values));
  return errors.empty() ? dmx_clashes(config, "universe") : errors;
}

std::vector<ParameterError> add_dmx_channel(Config& config, const std::string&, const ParameterValues& values,
                                            const values::Names& names) {
  if (config.dmx.empty()) return {};
  return add_to(config.dmx.back().channels, dmx_channel_of(config.dmx.back(), values, names));
}

std::vector<ParameterError> add_dmx_grid(Config& config, const std::string&, const ParameterValues& values,
                                         const values::Names&) {
  if (config.dmx.empty()) return {};
  auto grid = dmx_grid_of(config.dmx.back(), values);
  std::size_t pixels = grid ? grid->grid.size() : 0;
  for (const values::Grid& other : config.grids()) pixels += other.size();
  if (grid && pixels > kMaxDmxPixels)
    return {
        {"columns", fmt::format("and rows make {} pixels with the other grids (maximum {})", pixels, kMaxDmxPixels)}};
  auto errors = add_to(config.dmx.back().grids, std::move(grid));
  return errors.empty() ? dmx_clashes(config, "columns") : errors;
}

std::vector<ParameterError> add_nmea(Config& config, const std::string& name, const ParameterValues& values,
                                     const values::Names&) {
  return add_to(config.nmea, nmea_of(name, values));
}

}  // namespace

std::span<const ListTable> list_tables() {
  static const std::array kOscLists = {
      ListTable{.name = "map",
                .summary = "below an [[osc]]: a value at an address of the receiver's own",
                .max_entries = kMaxBelow,
                .needs_name = false,
                .parameters = osc_map_parameters(),
                .add = add_osc_map},
      ListTable{.name = "cue",
                .summary = "below an [[osc]]: a message that is sent when something happens",
                .max_entries = kMaxBelow,
                .needs_name = false,
                .parameters = osc_cue_parameters(),
                .add = add_osc_cue},
  };
  static const std::array kDmxLists = {
      ListTable{.name = "channel",
                .summary = "below a [[dmx]]: a value as the level of a channel",
                .max_entries = kDmxChannels,
                .needs_name = false,
                .parameters = dmx_channel_parameters(),
                .add = add_dmx_channel},
      ListTable{.name = "grid",
                .summary = "below a [[dmx]]: the wind at points of the ground as pixels of an LED wall",
                .max_entries = kMaxFeeds,
                .needs_name = false,
                .parameters = dmx_grid_parameters(),
                .add = add_dmx_grid},
  };
  static const std::array kTables = {
      ListTable{.name = "place",
                .summary = "a point on the ground whose wind feeds send; with a name",
                .max_entries = kMaxPlaces,
                .needs_name = true,
                .parameters = place_parameters(),
                .add = add_place},
      ListTable{.name = "osc",
                .summary = "sends the wind as Open Sound Control messages to another program",
                .max_entries = kMaxFeeds,
                .needs_name = false,
                .parameters = osc_parameters(),
                .add = add_osc,
                .below = kOscLists},
      ListTable{.name = "dmx",
                .summary = "sends the wind to lamps, fans and LED walls, by sACN or Art-Net",
                .max_entries = kMaxFeeds,
                .needs_name = false,
                .parameters = dmx_parameters(),
                .add = add_dmx,
                .below = kDmxLists},
      ListTable{.name = "nmea",
                .summary = "sends the wind as sentences of NMEA 0183 to another program",
                .max_entries = kMaxFeeds,
                .needs_name = false,
                .parameters = nmea_parameters(),
                .add = add_nmea},
  };
  return kTables;
}

}  // namespace yuragi::daemon::settings::feeds
