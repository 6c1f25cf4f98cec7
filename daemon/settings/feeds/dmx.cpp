#include "daemon/settings/feeds/dmx.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "engine/base/fields.hpp"

namespace yuragi::daemon::settings::feeds {
namespace {

/// ANSI E1.31-2018 9.1.1; Art-Net 4: a Port-Address has 15 bits.
constexpr int kMaxSacnUniverse = 63'999, kMaxArtNetUniverse = 32'767;
constexpr std::uint16_t kSacnPort = 5568, kArtNetPort = 6454;
constexpr std::size_t kPixelChannels = 3;
constexpr double kFarthest_m = 1000.0;
constexpr double kMaxLevel = 65'535.0;

std::uint16_t port_of(DmxProtocol protocol) {
  return protocol == DmxProtocol::kSacn ? kSacnPort : kArtNetPort;
}

Result<std::string, Failure> checked_target(const std::string& text) {
  if (text == kDmxMulticast) return {boost::system::in_place_value, text};
  const auto target = parse_address(text, kSacnPort);
  if (!target) return target.error();
  if (target->port == 0) return Failure{"has port 0; leave the port out for the usual one"};
  return {boost::system::in_place_value, text};
}

Result<std::string, Failure> checked_interface(const std::string& text) {
  in_addr address{};
  if (text.empty() || ::inet_pton(AF_INET, text.c_str(), &address) == 1) return {boost::system::in_place_value, text};
  return Failure{fmt::format("is \"{}\"; give this machine's IPv4 address on that network: 192.168.10.5", text)};
}

Result<int, Failure> checked_bits(std::int64_t bits) {
  if (bits == 8 || bits == 16) return static_cast<int>(bits);
  return Failure{fmt::format("is {}; allowed: 8, 16", bits)};
}

std::optional<DmxColor> color_in(std::string_view text) {
  constexpr std::size_t kLength = 7;
  if (text.size() != kLength || text[0] != '#') return std::nullopt;
  DmxColor color{};
  for (std::size_t i = 0; i < color.size(); ++i) {
    const char* const first = text.data() + 1 + 2 * i;
    if (std::from_chars(first, first + 2, color[i], 16).ptr != first + 2) return std::nullopt;
  }
  return color;
}

Result<DmxColor, Failure> color_of(std::string_view text) {
  if (const auto color = color_in(text)) return *color;
  return Failure{fmt::format("is \"{}\"; allowed: \"#rrggbb\", as in \"#1b2a49\"", text)};
}

Result<DmxColors, Failure> colors_of(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::string first, second, more;
  in >> first >> second;
  const auto from = color_in(first), to = color_in(second);
  if (from && to && !(in >> more)) return DmxColors{*from, *to};
  return Failure{fmt::format("is \"{}\"; give two colors: \"#000010 #ffffff\"", text)};
}

const Fields<Dmx>& dmx_fields() {
  static const Fields<Dmx> kFields{
      {{.name = "universe",
        .default_value = std::int64_t{1},
        .min = 0,
        .max = kMaxSacnUniverse,
        .help =
            "number of the universe: 1 to 63999 for sacn; for artnet 0 to 32767 (net * 256 + subnet * 16 + universe)"},
       &Dmx::universe},
      {{.name = "protocol",
        .default_value = std::string(kDmxProtocolNames[0]),
        .help = "sacn: ANSI E1.31; artnet: Art-Net 4",
        .choices = kDmxProtocolNames},
       &Dmx::protocol},
      {{.name = "to",
        .default_value = std::string(kDmxMulticast),
        .help =
            "multicast: all receivers of the universe (sacn only); or the receiver, HOST or HOST:PORT; artnet: also "
            "a broadcast address (2.255.255.255)"},
       &Dmx::to,
       checked_target},
      {{.name = "interface",
        .default_value = std::string(),
        .help = "for multicast, if this machine has several networks: its own address on that of the lamps; empty: the "
                "system chooses"},
       &Dmx::interface,
       checked_interface},
      {{.name = "priority",
        .default_value = std::int64_t{100},
        .min = 0,
        .max = 200,
        .help = "sacn: a receiver follows the source of the highest priority, such as a desk at 150"},
       &Dmx::priority},
  };
  return kFields;
}

const Fields<DmxChannel>& dmx_channel_fields() {
  static const Fields<DmxChannel> kFields{
      {{.name = "channel",
        .default_value = std::int64_t{1},
        .min = 1,
        .max = static_cast<double>(kDmxChannels),
        .help = "number of the channel"},
       &DmxChannel::channel},
      {{.name = "bits",
        .default_value = std::int64_t{8},
        .min = 8,
        .max = 16,
        .help = "8, or 16: this channel and the next, the high byte first"},
       &DmxChannel::bits,
       checked_bits},
      {{.name = "value",
        .default_value = std::string("speed"),
        .help = "what is sent: speed, direction, u, v, mean, gust, peak, norm, gust_norm, live, age, sensor:NAME, "
                "place:NAME, scene:NAME, or a part of one: place:NAME.gust_norm"},
       &DmxChannel::value_text},
      {{.name = "from",
        .default_value = std::string("0 12"),
        .help = "two numbers: the range of the value that becomes the range `to`",
        .left_out = "the value's usual range"},
       &DmxChannel::given_from,
       span_of},
      {{.name = "to",
        .default_value = std::string("0 255"),
        .help = "two numbers: the levels; 0 to 255, for 16 bits 0 to 65535",
        .left_out = "all levels"},
       &DmxChannel::given_to,
       span_of},
      {{.name = "curve",
        .default_value = 1.0,
        .min = 0.1,
        .max = 10.0,
        .help = "exponent of the way from one end to the other: above 1, weak wind does less"},
       &DmxChannel::curve},
      {{.name = "least",
        .default_value = 0.0,
        .min = 0.0,
        .max = kMaxLevel,
        .help = "the lowest level at which a fan turns: below it the level is 0. It turns on at this level and off at "
                "three quarters of it"},
       &DmxChannel::least},
      {{.name = "slew",
        .unit = "s",
        .default_value = 0.0,
        .min = 0.0,
        .max = 600.0,
        .help = "shortest time from level 0 to full and back"},
       &DmxChannel::slew_s},
      {{.name = "rest",
        .default_value = 0.0,
        .min = 0.0,
        .max = kMaxLevel,
        .help = "level outside of the opening hours, when the daemon ends, and while the value is missing"},
       &DmxChannel::rest},
  };
  return kFields;
}

const Fields<DmxGrid>& dmx_grid_fields() {
  constexpr double kMost = static_cast<double>(kMaxDmxPixels);
  const auto point = [](auto member) { return member_of(&DmxGrid::grid, member); };
  using values::Grid;
  static const Fields<DmxGrid> kFields{
      {{.name = "columns",
        .default_value = std::int64_t{16},
        .min = 1,
        .max = kMost,
        .help = "pixels from west to east"},
       point(&Grid::columns)},
      {{.name = "rows", .default_value = std::int64_t{9}, .min = 1, .max = kMost, .help = "pixels from north to south"},
       point(&Grid::rows)},
      {{.name = "spacing",
        .unit = "m",
        .default_value = 1.0,
        .min = 0.01,
        .max = 100.0,
        .help = "distance between two pixels on the ground of the scenes; larger: the gusts are smaller on the wall"},
       point(&Grid::spacing_m)},
      {{.name = "x",
        .unit = "m",
        .default_value = 0.0,
        .min = -kFarthest_m,
        .max = kFarthest_m,
        .help = "its middle, east of the middle of the scenes"},
       point(&Grid::east_m)},
      {{.name = "z", .unit = "m", .default_value = 0.0, .min = -kFarthest_m, .max = kFarthest_m, .help = "south of it"},
       point(&Grid::south_m)},
      {{.name = "turn",
        .unit = "deg",
        .default_value = 0.0,
        .min = -360.0,
        .max = 360.0,
        .help = "clockwise, seen from above"},
       point(&Grid::turn_deg)},
      {{.name = "channel",
        .default_value = std::int64_t{1},
        .min = 1,
        .max = static_cast<double>(kDmxChannels - kPixelChannels + 1),
        .help =
            "of the first pixel. Each pixel has three, red, green and blue, row by row; what does not fit goes on in "
            "the next universe, at channel 1"},
       &DmxGrid::channel},
      {{.name = "value",
        .default_value = std::string("speed"),
        .help = "what is shown of each point: speed, direction, u, v, mean, gust, peak, norm, gust_norm, live, age"},
       &DmxGrid::value_text},
      {{.name = "from",
        .default_value = std::string("0 12"),
        .help = "two numbers: the range of the value that becomes the colors `to`",
        .left_out = "the value's usual range"},
       &DmxGrid::given_from,
       span_of},
      {{.name = "to",
        .default_value = std::string("#000000 #ffffff"),
        .help = "two colors, \"#rrggbb #rrggbb\": at both ends of the range"},
       &DmxGrid::to,
       colors_of},
      {{.name = "curve",
        .default_value = 1.0,
        .min = 0.1,
        .max = 10.0,
        .help = "exponent of the way from one color to the other: above 1, weak wind does less; 2.2 looks even"},
       &DmxGrid::curve},
      {{.name = "rest",
        .default_value = std::string("#000000"),
        .help = "color outside of the opening hours and when the daemon ends"},
       &DmxGrid::rest,
       color_of},
  };
  return kFields;
}

std::size_t pixels_from(std::size_t channel) {
  return (kDmxChannels - channel + 1) / kPixelChannels;
}

/// The part of a universe that a channel or a grid takes: first and last channel.
struct Taken {
  std::size_t first, last;
};

/// Nullopt: it takes nothing of this universe.
std::optional<Taken> taken_by(const DmxGrid& grid, std::size_t universe) {
  const std::size_t last = grid.grid.size() - 1;
  const DmxGrid::Where end = grid.where(last);
  if (universe > end.universe) return std::nullopt;
  const std::size_t first = universe == 0 ? grid.channel : 1;
  if (universe == end.universe) return Taken{first, end.channel + kPixelChannels - 1};
  return Taken{first, first + pixels_from(first) * kPixelChannels - 1};
}

/// What of the feed has one of these channels already; empty: nothing.
std::string owner_of(const Dmx& feed, std::size_t universe, Taken wanted) {
  const auto meets = [wanted](Taken other) { return other.first <= wanted.last && wanted.first <= other.last; };
  for (const DmxChannel& channel : feed.channels) {
    if (universe == 0 && meets({channel.channel, channel.last_channel()}))
      return fmt::format("the [[dmx.channel]] {}", channel.channel);
  }
  for (std::size_t i = 0; i < feed.grids.size(); ++i) {
    const auto taken = taken_by(feed.grids[i], universe);
    if (taken && meets(*taken)) return fmt::format("[[dmx.grid]] {}", i + 1);
  }
  return {};
}

int max_universe(DmxProtocol protocol) {
  return protocol == DmxProtocol::kSacn ? kMaxSacnUniverse : kMaxArtNetUniverse;
}

std::optional<std::string> trouble_with_level(double level, double max) {
  if (level >= 0.0 && level <= max) return std::nullopt;
  return fmt::format("is {}; allowed: 0 to {}", level, max);
}

}  // namespace

DmxGrid::Where DmxGrid::where(std::size_t pixel) const noexcept {
  const std::size_t in_first = pixels_from(channel);
  if (pixel < in_first) return {0, channel + pixel * kPixelChannels};
  const std::size_t further = pixel - in_first;
  const std::size_t each = pixels_from(1);
  return {1 + further / each, 1 + further % each * kPixelChannels};
}

std::size_t Dmx::universe_count() const noexcept {
  std::size_t count = 1;
  for (const DmxGrid& grid : grids) count = std::max(count, grid.where(grid.grid.size() - 1).universe + 1);
  return count;
}

bool Dmx::clashes_with(const Dmx& other) const {
  if (protocol != other.protocol) return false;
  for (std::size_t index = 0; index < universe_count(); ++index) {
    const int number = universe + static_cast<int>(index);
    if (number < other.universe || number >= other.universe + static_cast<int>(other.universe_count())) continue;
    if (target(index) == other.target(static_cast<std::size_t>(number - other.universe))) return true;
  }
  return false;
}

std::string Dmx::target(std::size_t index) const {
  const std::size_t number = static_cast<std::size_t>(universe) + index;
  if (to == kDmxMulticast) {
    // ANSI E1.31-2018 9.3.1
    return fmt::format("239.255.{}.{}:{}", number >> 8U, number & 0xFFU, kSacnPort);
  }
  return to_string(parse_address(to, port_of(protocol)).value());
}

std::span<const Parameter> dmx_parameters() {
  return dmx_fields().parameters();
}
std::span<const Parameter> dmx_channel_parameters() {
  return dmx_channel_fields().parameters();
}
std::span<const Parameter> dmx_grid_parameters() {
  return dmx_grid_fields().parameters();
}

Result<Dmx, ParameterError> dmx_of(std::string name, const ParameterValues& values) {
  auto dmx = made_of(dmx_fields(), values);
  if (!dmx) return dmx;
  dmx->name = std::move(name);
  const bool is_sacn = dmx->protocol == DmxProtocol::kSacn;
  if (!is_sacn && dmx->to == kDmxMulticast)
    return ParameterError{"to", "is \"multicast\", which Art-Net does not have; give the receiver's address"};
  if (is_sacn && dmx->universe == 0) return ParameterError{"universe", "is 0; allowed for sacn: 1 to 63999"};
  if (dmx->universe > max_universe(dmx->protocol))
    return ParameterError{"universe",
                          fmt::format("is {}; allowed for artnet: 0 to {}", dmx->universe, kMaxArtNetUniverse)};
  if (!dmx->interface.empty() && dmx->to != kDmxMulticast)
    return ParameterError{"interface", "applies only if to = \"multicast\"; remove it"};
  return dmx;
}

Result<DmxChannel, ParameterError> dmx_channel_of(const Dmx& feed, const ParameterValues& values,
                                                  const values::Names& names) {
  auto channel = made_of(dmx_channel_fields(), values);
  if (!channel) return channel;
  auto value = value_named(channel->value_text, names);
  if (!value) return value.error();
  channel->from = channel->given_from.value_or(range_of(value->description()));
  channel->to = channel->given_to.value_or(Span{0.0, channel->max_level()});
  channel->value = std::move(*value);
  for (const auto& [key, level] : {std::pair{"to", channel->to.from}, std::pair{"to", channel->to.to},
                                   std::pair{"least", channel->least}, std::pair{"rest", channel->rest}}) {
    if (auto trouble = trouble_with_level(level, channel->max_level())) return ParameterError{key, std::move(*trouble)};
  }
  if (channel->last_channel() > kDmxChannels)
    return ParameterError{"channel", "is 512; a value of 16 bits needs two channels"};
  const std::string owner = owner_of(feed, 0, {channel->channel, channel->last_channel()});
  if (!owner.empty())
    return ParameterError{"channel", fmt::format("{} is taken by {}; give each its own", channel->channel, owner)};
  return channel;
}

Result<DmxGrid, ParameterError> dmx_grid_of(const Dmx& feed, const ParameterValues& values) {
  auto grid = made_of(dmx_grid_fields(), values);
  if (!grid) return grid;
  const auto quantity = values::quantity_named(grid->value_text);
  if (!quantity) {
    std::vector<std::string_view> known;
    for (const auto& one : values::quantities()) known.push_back(one.name);
    return ParameterError{"value", fmt::format("is \"{}\"; allowed: {}", grid->value_text, fmt::join(known, ", "))};
  }
  grid->grid.quantity = *quantity;
  grid->from = grid->given_from.value_or(range_of(values::description_of(*quantity)));
  if (grid->grid.size() > kMaxDmxPixels)
    return ParameterError{"columns",
                          fmt::format("and rows make {} pixels (maximum {})", grid->grid.size(), kMaxDmxPixels)};
  const std::size_t last = grid->where(grid->grid.size() - 1).universe;
  if (feed.universe + static_cast<int>(last) > max_universe(feed.protocol))
    return ParameterError{"columns", fmt::format("and rows need {} universes, beyond the last one", last + 1)};
  for (std::size_t universe = 0; universe <= last; ++universe) {
    const auto wanted = taken_by(*grid, universe);
    const std::string owner = wanted ? owner_of(feed, universe, *wanted) : std::string();
    if (!owner.empty())
      return ParameterError{"channel",
                            fmt::format("to the last pixel's includes channels of {}; give each its own", owner)};
  }
  return grid;
}

}  // namespace yuragi::daemon::settings::feeds
