// The stations of WeatherFlow (Tempest; Sky before it), whose hub broadcasts their messages in the local network
// (WeatherFlow, "Tempest UDP Reference", v171; drivers/SOURCES.md S9.1). This driver sends nothing.
//
// The wind is that of `rapid_wind`, usually every 3 s: every 6 s, minute or 5 minutes if the station saves its battery.
// A station that sends none between two of its observations (each minute) gives the mean wind of those.
#include "drivers/decode/network/tempest.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/bus/sender_filter.hpp"
#include "drivers/network/followed_station.hpp"
#include "drivers/network/station_silence.hpp"
#include "drivers/network/tempest_finder.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/reading_limit.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::network {
namespace {

using decode::network::TempestKind;
using decode::network::TempestMessage;

/// The clock is checked at least this often.
constexpr Nanoseconds kTempestWait = std::chrono::milliseconds(250);
/// So many of its usual pauses are silence.
constexpr int kSilentPauses = 5;

struct TempestSettings {
  bus::BytePortAddress port{.kind = bus::BytePortKind::kUdp, .is_port_shared = true};
  std::string serial_number;
  Nanoseconds silence = std::chrono::seconds(60);
};

auto of(auto member) {
  return member_of(&TempestSettings::port, member);
}

const Fields<TempestSettings> kTempestFields = {
    {{.name = "serial_number",
      .default_value = std::string(""),
      .help = "the station, as printed on it: ST-00000512 (Tempest), SK-00008453 (Sky); empty: the first one received, "
              "with a warning if there are others"},
     &TempestSettings::serial_number},
    {{"port", "", std::int64_t{50222}, 1, 65535,
      "the UDP port that hubs broadcast to; other programs on this machine may listen there, too"},
     of(&bus::BytePortAddress::port)},
    {{.name = "host",
      .default_value = std::string(""),
      .help = "the local address to listen at; empty: all, which broadcasts need"},
     of(&bus::BytePortAddress::host)},
    {{.name = "from",
      .default_value = std::string(""),
      .help = "accept only these hubs: addresses and networks (192.168.1.20, 10.0.0.0/8) separated by commas; empty: "
              "any; at most 100 readings a second are accepted"},
     of(&bus::BytePortAddress::senders)},
    {{"silence", "s", 60.0, 0.1, 86400.0,
      "without wind for this long, and for five times its usual interval, the station counts as silent"},
     &TempestSettings::silence,
     from_seconds},
};

class TempestSensor final : public sensor::ReopeningSensor {
 public:
  explicit TempestSensor(TempestSettings settings)
      : sensor::ReopeningSensor(sensor::seed_of("tempest" + settings.serial_number)),
        settings_(std::move(settings)),
        where_(describe(settings_.port)),
        port_(bus::make_byte_port(settings_.port)),
        station_(settings_.serial_number),
        silence_(settings_.silence, kSilentPauses) {}

  void interrupt() noexcept override { port_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override {
    if (const auto opened = port_->open(); !opened) return opened.error();
    is_silent_ = true;
    hub_.clear();
    const MonoTime now = clock.now().mono;
    silence_.begin(now);
    return now;
  }

  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override {
    const bus::ByteArrival arrival = port_->read(buffer_, kTempestWait);
    if (arrival.overrun > 0) sink.refused(decode::Refusal::kOverrun, arrival.overrun);
    const Instant now = clock.now();
    if (arrival.status == bus::ByteStatus::kInterrupted) return Failure{"interrupted"};
    if (arrival.status == bus::ByteStatus::kLost || arrival.status == bus::ByteStatus::kEnd)
      return Failure{"lost " + where_};
    if (arrival.status == bus::ByteStatus::kForeign) sink.refused(decode::Refusal::kNotMine);
    if (arrival.status == bus::ByteStatus::kBytes) take_datagram(std::span(buffer_).first(arrival.size), now, sink);

    if (silence_.is_long(now.mono)) {
      is_silent_ = true;
      station_.lose();
    }
    if (is_silent_) report_unusable(sink, trouble(now.mono));
    return now.mono;
  }

  void close() noexcept override { port_->close(); }

 private:
  void take_datagram(std::span<const std::uint8_t> datagram, const Instant& now, sensor::Sink& sink) {
    sink.raw(sensor::RawDirection::kReceived, datagram);
    const auto message =
        decode::network::decode_tempest({reinterpret_cast<const char*>(datagram.data()), datagram.size()});
    if (!message) return sink.refused(message.error());
    hub_ = message->hub_serial_number;
    hub_heard_at_ = now.mono;
    if (message->kind == TempestKind::kOther) return sink.refused(decode::Refusal::kNotMine);
    if (!station_.hears(message->serial_number, message->serial_number, now.mono)) {
      other_ = message->serial_number;
      return sink.refused(decode::Refusal::kNotMine);
    }
    if (!winds_.is_new(*message)) return;
    if (message->kind == TempestKind::kObservation) {
      wind::StationQuantities said = message->quantities;
      said.time = now;
      sink.quantities(said);
    }
    if (!message->wind) return sink.refused(message->wind.error());
    if (winds_.is_wind(*message)) publish(*message, now, sink);
  }

  void publish(const TempestMessage& message, const Instant& now, sensor::Sink& sink) {
    if (!limit_.admits(now.mono)) return sink.refused(decode::Refusal::kTooFrequent);
    silence_.end(message.serial_number, now.mono);
    is_silent_ = false;
    const std::string rival = station_.rival(now.mono);
    const std::string warning =
        rival.empty() ? "" : fmt::format("; {} is received, too, but not used: select one with serial_number", rival);
    report_connected(sink, fmt::format("station {} of hub {} at {}{}", message.serial_number, hub_, where_, warning));
    sink.reading({.time = now,
                  .speed_m_s = *message.wind->speed_m_s,
                  .direction_deg = message.wind->direction_deg,
                  .gust_m_s = message.wind->gust_m_s,
                  .quality = wind::ReadingQuality::kGood});
  }

  /// Why there is no wind.
  std::string trouble(MonoTime now) const {
    const bool has_waited = silence_.length(now) >= settings_.silence;
    const std::string station = settings_.serial_number.empty() ? "a station" : settings_.serial_number;
    if (!hub_.empty() && now - hub_heard_at_ < std::max(settings_.silence, kHubPatience)) {
      if (!settings_.serial_number.empty() && !other_.empty())
        return fmt::format(
            "receives hub {} and station {} at {}, but not {}: check serial_number, and that station's battery", hub_,
            other_, where_, station);
      return fmt::format("receives hub {} at {}, but no wind of {}{}", hub_, where_, station,
                         has_waited ? ": check the station's battery, and that the hub is within its reach" : " yet");
    }
    if (!has_waited) return fmt::format("waits for a hub's broadcasts at {}", where_);
    return fmt::format(
        "no hub has been received at {} for {:g} s: check that it is on, that it is in this network, and that no "
        "firewall blocks UDP port {}",
        where_, seconds(settings_.silence), settings_.port.port);
  }

  /// A hub sends its own state every 10 s.
  static constexpr Nanoseconds kHubPatience = std::chrono::seconds(30);

  TempestSettings settings_;
  std::string where_;
  std::unique_ptr<bus::BytePort> port_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(bus::kMaxDatagram);
  sensor::ReadingLimit limit_;
  FollowedStation station_;
  StationSilence silence_;
  std::string hub_;    // that was heard last; empty: none
  std::string other_;  // a station that is not followed; empty: none
  MonoTime hub_heard_at_{};
  bool is_silent_ = true;
  decode::network::TempestWinds winds_;
};

std::unique_ptr<sensor::Sensor> open_tempest(const ParameterValues& values) {
  TempestSettings settings = kTempestFields.of(values);
  if (const auto filter = bus::SenderFilter::parse(settings.port.senders); !filter)
    throw std::runtime_error("from: " + filter.error().message);
  if (const std::string& host = settings.port.host; !host.empty()) {
    if (const auto address = bus::is_loopback(host); !address)
      throw std::runtime_error("host: " + address.error().message);
  }
  return std::make_unique<TempestSensor>(std::move(settings));
}

/// Sensors of different stations share the port.
sensor::ValueSelection tempest_selection(const ParameterValues& values) {
  const TempestSettings settings = kTempestFields.of(values);
  return sensor::selection_at(settings.port,
                              {{.key = "serial_number", .value = settings.serial_number},
                               {.key = "from", .value = settings.port.senders, .covers = bus::senders_cover}});
}

Result<sensor::SimulatedDevice, Failure> tempest_simulated(const ParameterValues& values) {
  std::vector<std::string> options = {"--interval", "1"};  // otherwise too few messages in the time available
  const std::string station = kTempestFields.of(values).serial_number;
  if (!station.empty()) options.insert(options.end(), {"--station", station});
  return sensor::simulated_sender("tempest", "--udp", values, options);
}

}  // namespace

extern const sensor::DriverDescription kTempestDriver;
const sensor::DriverDescription kTempestDriver{
    .name = "tempest",
    .summary = "weather stations of WeatherFlow (Tempest, Sky), by their hub's broadcasts in the local network",
    .parameters = kTempestFields.parameters(),
    .open = open_tempest,
    .find_in_network = find_tempest_stations,
    .endpoints = [](const ParameterValues& values) { return sensor::endpoints_at(kTempestFields.of(values).port); },
    .selection = tempest_selection,
    .simulated = tempest_simulated,
    .formats = "tempest"};

}  // namespace yuragi::drivers::network
