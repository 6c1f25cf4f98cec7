// Wind that another program sends as Open Sound Control messages over UDP (M. Wright, "The Open Sound Control 1.0
// specification", 2002): a patch in Max, Pure Data or TouchDesigner, a script with oscsend.
//
//   oscsend 127.0.0.1 9000 /wind ff 4.2 270   speed in m/s, and where it comes from in degrees
//
// A message proves nothing about its sender. By default only programs of this machine are accepted; others must be
// named (`host` and `from`). No more readings are taken than sensor::ReadingLimit allows.
//
// A bundle has the time for which it is meant. One that is further in the future than the clocks of two machines and a
// sender's latency explain is refused. Everything else is the wind when it arrives.
//
// Address and order of the arguments are configurable; they are numbers of any of OSC's types. An argument that is no
// number, or missing, is an unknown value. Direction and gust can also have addresses of their own, as TouchOSC and
// QLab send them; each speed is then a wind with the last direction and gust.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/bus/osc_message.hpp"
#include "drivers/bus/sender_filter.hpp"
#include "drivers/decode/refusal.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/held_wind.hpp"
#include "drivers/sensor/reading_limit.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::osc {
namespace {

/// The clock is checked at least this often.
constexpr Nanoseconds kOscWait = std::chrono::milliseconds(250);
/// Limit for the time tag of a message ahead of our clock.
constexpr Nanoseconds kFarthestAhead = std::chrono::seconds(1);

struct Settings {
  bus::BytePortAddress port{.kind = bus::BytePortKind::kUdp};
  std::string address;
  std::string direction_address;  ///< empty: the direction is an argument of `address`
  std::string gust_address;       ///< empty: the gust is one
  std::int64_t speed_argument = 0;
  std::int64_t direction_argument = 1;
  std::int64_t gust_argument = -1;
  double metres_per_second = 1.0;
  Nanoseconds hold = std::chrono::seconds(60);
  Nanoseconds silence = std::chrono::seconds(5);
  bool reports_on_change = false;  ///< a silence means that the wind is unchanged
};

auto of(auto member) {
  return member_of(&Settings::port, member);
}

const Fields<Settings> kOscFields = {
    {{"port", "", std::int64_t{9000}, 1, 65535, "the UDP port that messages are received on"},
     of(&bus::BytePortAddress::port)},
    {{.name = "host",
      .default_value = std::string("127.0.0.1"),
      .help = "the local address to listen on: 127.0.0.1: for messages of this machine only; 0.0.0.0: all addresses; "
              "or a multicast address"},
     of(&bus::BytePortAddress::host)},
    {{.name = "from",
      .default_value = std::string(""),
      .help = "who may send: addresses and networks separated by commas (192.168.1.20, 10.0.0.0/8); 0.0.0.0/0: any; "
              "can be empty only if host is an address such as 127.0.0.1"},
     of(&bus::BytePortAddress::senders)},
    {{.name = "address",
      .default_value = std::string("/wind"),
      .help = "the messages' OSC address, or a pattern: /station/*/wind; at most 100 readings a second are accepted"},
     &Settings::address},
    {{.name = "direction_address",
      .default_value = std::string(""),
      .help = "the direction's own OSC address, such as /wind/direction, whose first argument it is; then set address "
              "to the speed's; empty: the direction is an argument of the messages at address"},
     &Settings::direction_address},
    {{.name = "gust_address", .default_value = std::string(""), .help = "the gust's own OSC address, in the same way"},
     &Settings::gust_address},
    {{"speed_argument", "", std::int64_t{0}, 0, 63, "which argument is the speed; the first is 0"},
     &Settings::speed_argument},
    {{"direction_argument", "", std::int64_t{1}, -1, 63,
      "which argument is the direction that the wind comes from, in degrees; -1: none"},
     &Settings::direction_argument},
    {{"gust_argument", "", std::int64_t{-1}, -1, 63, "which argument is the gust; -1: none"}, &Settings::gust_argument},
    {{.name = "speed_unit",
      .default_value = std::string("m/s"),
      .help = "the unit of speed and gust",
      .choices = sensor::kSpeedUnitNames},
     &Settings::metres_per_second,
     sensor::metres_per_second_in},
    {{"hold", "s", 60.0, 0.1, 86400.0,
      "a direction or gust from an address of its own is used for this long with later speeds"},
     &Settings::hold,
     from_seconds},
    {{"silence", "s", 5.0, 0.1, 86400.0, "without a message for this long the sender counts as stopped"},
     &Settings::silence,
     from_seconds},
    {{.name = "on_change",
      .default_value = false,
      .help = "the sender sends only changes: without messages the wind counts as unchanged, for as long as `silence`, "
              "which must be longer than the longest calm"},
     &Settings::reports_on_change},
};

/// Returns true if a daemon of this project sends this beside its wind ([[osc]] of the configuration): such messages
/// are no mistake of the sender. `wind`: the address of the wind, "/wind" behind any prefix.
bool is_of_a_daemon(std::string_view address, std::string_view wind) {
  constexpr std::string_view kWind = "/wind";
  if (!wind.ends_with(kWind)) return false;
  const std::string_view prefix = wind.substr(0, wind.size() - kWind.size());
  if (!address.starts_with(prefix)) return false;
  return std::ranges::any_of(std::array{"/wind/", "/sensor/", "/place/", "/scene/"},
                             [&](std::string_view part) { return address.substr(prefix.size()).starts_with(part); });
}

std::optional<double> argument_of(const bus::OscMessage& message, std::int64_t which) {
  const bool is_there = which >= 0 && which < std::ssize(message.numbers);
  return is_there ? message.numbers[static_cast<std::size_t>(which)] : std::nullopt;
}

class Sensor final : public sensor::ReopeningSensor {
 public:
  explicit Sensor(Settings settings)
      : sensor::ReopeningSensor(sensor::seed_of("osc" + std::to_string(settings.port.port))),
        settings_(std::move(settings)),
        where_(describe(settings_.port)),
        held_(settings_.hold),
        port_(bus::make_byte_port(settings_.port)) {}

  void interrupt() noexcept override { port_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override {
    if (const auto opened = port_->open(); !opened) return opened.error();
    has_received_ = false;
    held_.clear();
    strangers_.clear();
    future_.clear();
    separate_.clear();
    received_at_ = clock.now().mono;
    return received_at_;
  }

  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override {
    if (!has_received_)
      report_unusable(sink, fmt::format("waits for OSC messages {} at {}{}", settings_.address, where_, notes()));
    const bus::ByteArrival arrival = port_->read(buffer_, kOscWait);
    if (arrival.overrun > 0) sink.refused(decode::Refusal::kOverrun, arrival.overrun);
    const Instant now = clock.now();
    if (arrival.status == bus::ByteStatus::kInterrupted) return Failure{"interrupted"};
    if (arrival.status == bus::ByteStatus::kLost || arrival.status == bus::ByteStatus::kEnd)
      return Failure{"lost " + where_};
    if (arrival.status == bus::ByteStatus::kForeign) refuse_sender(arrival.sender, sink);
    if (arrival.status == bus::ByteStatus::kBytes) take_datagram(std::span(buffer_).first(arrival.size), now, sink);
    if (now.mono - received_at_ >= settings_.silence) {
      has_received_ = true;  // the status now reports more than waiting
      report_unusable(sink, fmt::format("no wind has been received on {} for {:g} s: check that the sender is running, "
                                        "that it sends {} there, and "
                                        "that no firewall blocks it{}",
                                        where_, seconds(settings_.silence), settings_.address, notes()));
    }
    return now.mono;
  }

  void close() noexcept override { port_->close(); }

 private:
  /// The first one is named, so that neither a flood nor forged addresses change the status without end.
  void refuse_sender(const std::string& sender, sensor::Sink& sink) {
    sink.refused(decode::Refusal::kNotMine);
    if (strangers_.empty()) strangers_ = "; refuses " + sender + ", which is not in `from`";
  }

  /// The status names the first one only, as above.
  void refuse_future(const bus::OscMessage& message, Instant now, sensor::Sink& sink) {
    sink.refused(decode::Refusal::kInvalid);
    if (future_.empty()) {
      future_ = fmt::format("; refuses messages with a time {:.0f} s in the future: set the clocks of both machines",
                            seconds(*message.meant_for - now.utc));
    }
  }

  void take_datagram(std::span<const std::uint8_t> datagram, Instant now, sensor::Sink& sink) {
    sink.raw(sensor::RawDirection::kReceived, datagram);
    const auto messages = bus::decode_osc(datagram);
    if (!messages) return sink.refused(messages.error());
    // The values of one bundle belong together, in any order: a speed waits for its direction and gust.
    for (const bus::OscMessage& message : *messages) hold_own(message, now, sink);
    for (const bus::OscMessage& message : *messages) take(message, now, sink);
  }

  bool is_at(const bus::OscMessage& message, const std::string& address) const {
    return !address.empty() && bus::osc_address_matches(message.address, address);
  }

  bool is_of_the_future(const bus::OscMessage& message, Instant now) const {
    return message.meant_for && *message.meant_for - now.utc > kFarthestAhead;
  }

  /// Holds a direction or gust that has an address of its own.
  void hold_own(const bus::OscMessage& message, Instant now, sensor::Sink& sink) {
    const bool is_direction = is_at(message, settings_.direction_address);
    const bool is_gust = is_at(message, settings_.gust_address);
    if (!is_direction && !is_gust) return;
    if (is_of_the_future(message, now)) {
      if (!is_at(message, settings_.address)) refuse_future(message, now, sink);
      return;
    }
    const auto number = argument_of(message, 0);
    if (!number) sink.refused(message.numbers.empty() ? decode::Refusal::kTooShort : decode::Refusal::kInvalid);
    if (is_direction) hold_direction(number, now, sink);
    if (is_gust) hold_gust(number, now, sink);
  }

  void hold_direction(std::optional<double> direction_deg, Instant now, sensor::Sink& sink) {
    if (!held_.hold_direction(direction_deg, now.mono)) sink.refused(decode::Refusal::kImplausible);
  }

  bool hold_gust(std::optional<double> gust, Instant now, sensor::Sink& sink) {
    if (gust) *gust *= settings_.metres_per_second;
    const bool is_possible = held_.hold_gust(gust, now.mono);
    if (!is_possible) sink.refused(decode::Refusal::kImplausible);
    return is_possible;
  }

  void take(const bus::OscMessage& message, Instant now, sensor::Sink& sink) {
    if (!is_at(message, settings_.address)) return take_other(message, sink);
    if (is_of_the_future(message, now)) return refuse_future(message, now, sink);
    if (settings_.speed_argument >= std::ssize(message.numbers)) return sink.refused(decode::Refusal::kTooShort);
    const auto speed = argument_of(message, settings_.speed_argument);
    if (!speed) return sink.refused(decode::Refusal::kInvalid);
    if (settings_.direction_address.empty())
      hold_direction(argument_of(message, settings_.direction_argument), now, sink);
    if (settings_.gust_address.empty() && !hold_gust(argument_of(message, settings_.gust_argument), now, sink)) return;
    const auto reading = held_.reading_of(*speed * settings_.metres_per_second, now);
    if (!reading) return sink.refused(reading.error());
    if (!limit_.admits(now.mono)) return sink.refused(decode::Refusal::kTooFrequent);
    has_received_ = true;
    received_at_ = now.mono;
    separate_.clear();
    report_connected(sink, fmt::format("OSC messages {} at {}{}", settings_.address, where_, notes()));
    sink.reading(*reading);
  }

  /// A message without a speed.
  void take_other(const bus::OscMessage& message, sensor::Sink& sink) {
    if (is_at(message, settings_.direction_address) || is_at(message, settings_.gust_address)) return;
    if (!has_received_ && separate_.empty() && message.address == settings_.address + "/speed") {
      separate_ = fmt::format(
          "; {} arrives: for one value per address set address to \"{}\", and direction_address and "
          "gust_address",
          message.address, message.address);
    }
    if (!is_of_a_daemon(message.address, settings_.address)) sink.refused(decode::Refusal::kNotMine);
  }

  std::string notes() const { return strangers_ + future_ + separate_; }

  Settings settings_;
  std::string where_;
  sensor::HeldWind held_;
  std::unique_ptr<bus::BytePort> port_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(bus::kMaxDatagram);
  sensor::ReadingLimit limit_;
  std::string strangers_;      // the first refused sender, for the status; empty: none
  std::string future_;         // how far ahead the first was that was refused for its time; empty: none
  std::string separate_;       // that speeds arrive at an address of their own; empty: they do not
  bool has_received_ = false;  // of the wind, since it has the port
  MonoTime received_at_{};     // or since when wind could have been received
};

/// Throws, naming the setting, if it is not set who may send.
void check_senders(const std::string& host, const std::string& from) {
  const auto is_loopback = bus::is_loopback(host);
  if (!is_loopback) throw std::runtime_error("host: " + is_loopback.error().message);
  if (const auto filter = bus::SenderFilter::parse(from); !filter)
    throw std::runtime_error("from: " + filter.error().message);
  if (from.empty() && !*is_loopback) {
    throw std::runtime_error(
        "from: is missing; host " + host +
        " accepts other machines: give those that may send (192.168.1.20, 10.0.0.0/8), or 0.0.0.0/0 for "
        "any");
  }
}

std::unique_ptr<sensor::Sensor> open_osc(const ParameterValues& values) {
  Settings settings = kOscFields.of(values);
  check_senders(settings.port.host, settings.port.senders);
  if (!settings.address.starts_with('/')) throw std::runtime_error("address: must begin with a slash, as in /wind");
  for (const auto& [name, address] : {std::pair("direction_address", &settings.direction_address),
                                      std::pair("gust_address", &settings.gust_address)}) {
    if (address->empty()) continue;
    if (!address->starts_with('/'))
      throw std::runtime_error(fmt::format("{}: must begin with a slash, as in /wind/direction", name));
    if (*address == settings.address)
      throw std::runtime_error(
          fmt::format("{}: is the same as address; leave it out, and set which argument it is", name));
  }
  return std::make_unique<Sensor>(std::move(settings));
}

bool osc_address_covers(const std::string& wide, const std::string& narrow) {
  return bus::osc_address_matches(narrow, wide);
}

sensor::ValueSelection osc_selection(const ParameterValues& values) {
  const Settings settings = kOscFields.of(values);
  return sensor::selection_at(settings.port,
                              {{.key = "address", .value = settings.address, .covers = osc_address_covers},
                               {.key = "from", .value = settings.port.senders, .covers = bus::senders_cover},
                               {.key = "speed_argument", .value = std::to_string(settings.speed_argument)}});
}

double osc_unchanged_for_s(const ParameterValues& values) {
  const Settings settings = kOscFields.of(values);
  return settings.reports_on_change ? seconds(settings.silence) : 0.0;
}

Result<sensor::SimulatedDevice, Failure> osc_simulated(const ParameterValues& values) {
  const Settings settings = kOscFields.of(values);
  if (settings.address.find_first_of("?*[]{}") != std::string::npos)
    return Failure{"yuragi-sim sends to one OSC address, but address is a pattern"};
  if (settings.metres_per_second != 1.0) return Failure{"yuragi-sim sends speeds only in m/s: set speed_unit to m/s"};
  if (!settings.direction_address.empty() || !settings.gust_address.empty())
    return Failure{"yuragi-sim sends all values to one OSC address: leave out direction_address and gust_address"};
  if (settings.direction_argument < 0) return Failure{"yuragi-sim always sends a direction: set direction_argument"};
  return sensor::simulated_sender(
      "osc", "--to", values,
      {"--address", settings.address, "--speed-argument", std::to_string(settings.speed_argument),
       "--direction-argument", std::to_string(settings.direction_argument)});
}

}  // namespace

extern const sensor::DriverDescription kOscDriver;
const sensor::DriverDescription kOscDriver{
    .name = "osc",
    .summary = "wind that another program sends as Open Sound Control messages",
    .parameters = kOscFields.parameters(),
    .open = open_osc,
    .endpoints = [](const ParameterValues& values) { return sensor::endpoints_at(kOscFields.of(values).port); },
    .service_type = "_osc._udp",
    .selection = osc_selection,
    .unchanged_for_s = osc_unchanged_for_s,
    .simulated = osc_simulated};

}  // namespace yuragi::drivers::osc
