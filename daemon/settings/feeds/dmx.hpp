#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/feeds/span.hpp"
#include "daemon/values/grid.hpp"
#include "daemon/values/moment.hpp"
#include "daemon/values/reference.hpp"
#include "engine/base/address.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings::feeds {

/// Channels of a universe, counted from 1.
inline constexpr std::size_t kDmxChannels = 512;
/// Points of all grids of an installation.
inline constexpr std::size_t kMaxDmxPixels = 1024;

/// A [[dmx.channel]]: a value as the level of one channel, or of two for 16 bits (the high byte first).
struct DmxChannel {
  std::size_t channel = 1;
  int bits = 8;
  std::string value_text = {};
  std::optional<Span> given_from = {}, given_to = {};
  Span from = {}, to = {};
  double curve = 1.0;
  double least = 0.0;
  double slew_s = 0.0;
  double rest = 0.0;
  values::Reference value{};  ///< of value_text
  friend bool operator==(const DmxChannel& one, const DmxChannel& other) {
    return one.channel == other.channel && one.bits == other.bits && one.value_text == other.value_text &&
           one.from == other.from && one.to == other.to && one.curve == other.curve && one.least == other.least &&
           one.slew_s == other.slew_s && one.rest == other.rest;
  }

  double max_level() const noexcept { return bits == 16 ? 65535.0 : 255.0; }
  std::size_t last_channel() const noexcept { return channel + (bits == 16 ? 1 : 0); }
};

/// The levels of the three channels of a pixel.
using DmxColor = std::array<std::uint8_t, 3>;

struct DmxColors {
  DmxColor from{0, 0, 0}, to{255, 255, 255};
  friend bool operator==(const DmxColors&, const DmxColors&) = default;
};

/// A [[dmx.grid]]: the wind at points of the ground as pixels of a red, a green and a blue channel. A pixel is never
/// divided between universes.
struct DmxGrid {
  std::size_t channel = 1;  ///< of the first pixel; in the universes after the first it is 1
  values::Grid grid = {};
  std::string value_text = {};
  std::optional<Span> given_from = {};
  Span from = {};
  DmxColors to = {};
  double curve = 1.0;
  DmxColor rest{0, 0, 0};
  friend bool operator==(const DmxGrid&, const DmxGrid&) = default;

  /// Where a pixel's first channel is.
  struct Where {
    std::size_t universe;  ///< counted from the feed's
    std::size_t channel;
  };
  Where where(std::size_t pixel) const noexcept;
};

enum class DmxProtocol : std::uint8_t { kSacn, kArtNet };
inline constexpr std::array<std::string_view, 2> kDmxProtocolNames = {"sacn", "artnet"};
inline constexpr std::string_view kDmxMulticast = "multicast";

/// A [[dmx]]: levels for lamps, fans and LED walls, by E1.31 (sACN) or Art-Net.
struct Dmx {
  std::string name = {};
  int universe = 1;
  DmxProtocol protocol = DmxProtocol::kSacn;
  std::string to = {};         ///< HOST, HOST:PORT or kDmxMulticast
  std::string interface = {};  ///< own address on the network for multicast; empty: the system chooses
  int priority = 100;
  std::vector<DmxChannel> channels = {};
  std::vector<DmxGrid> grids = {};
  friend bool operator==(const Dmx&, const Dmx&) = default;

  std::size_t universe_count() const noexcept;
  /// Does it send a universe to the same receiver as `other`? Then each undoes what the other sends.
  bool clashes_with(const Dmx& other) const;
  /// HOST:PORT to which a universe is sent; `index`: counted from the feed's.
  std::string target(std::size_t index) const;
};

std::span<const Parameter> dmx_parameters();
std::span<const Parameter> dmx_channel_parameters();
std::span<const Parameter> dmx_grid_parameters();

/// From values of these parameters. An error names the key. `feed`: to which it is added.
Result<Dmx, ParameterError> dmx_of(std::string name, const ParameterValues& values);
Result<DmxChannel, ParameterError> dmx_channel_of(const Dmx& feed, const ParameterValues& values,
                                                  const values::Names& names);
Result<DmxGrid, ParameterError> dmx_grid_of(const Dmx& feed, const ParameterValues& values);

}  // namespace yuragi::daemon::settings::feeds
