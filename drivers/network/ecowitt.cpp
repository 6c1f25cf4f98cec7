// Gateways by Fine Offset (Ecowitt GW1000, GW1100, GW1200, GW2000, Froggit, Ambient Weather), which receive the radio
// sensors of a garden and are asked over TCP for what they know (drivers/SOURCES.md S9.2).
//
// Each request has a connection of its own: a late reply cannot be taken for that to another request, and gateways
// that close their connections are no trouble. A reply has no time in it. The anemometer speaks by radio every 16 s
// (WH65, WS68, WS69), 8.8 s (WS90) or 4.75 s (WS80), and the gateway repeats its last values in between: a reading is
// published when they change, or when the anemometer must have spoken again.
#include "drivers/decode/network/ecowitt.hpp"

#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/network/ecowitt_finder.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::network {
namespace {

struct EcowittSettings {
  bus::BytePortAddress port{.kind = bus::BytePortKind::kTcpClient};
  Nanoseconds sensor_interval = std::chrono::seconds(16);
  Nanoseconds poll_interval = std::chrono::seconds(4);
  Nanoseconds response_timeout = std::chrono::seconds(3);
};

const Fields<EcowittSettings> kEcowittFields = {
    {{.name = "host",
      .default_value = std::string(""),
      .help = "the gateway's name or address; the router should always give it the same address"},
     [](EcowittSettings& settings) -> std::string& { return settings.port.host; }},
    {{"port", "", std::int64_t{45000}, 1, 65535, "the TCP port of the gateway's local interface"},
     [](EcowittSettings& settings) -> std::uint16_t& { return settings.port.port; }},
    {{"sensor_interval", "s", 16.0, 0.1, 3600.0,
      "how often the anemometer sends: WH65, WS68, WS69 16 s; WS90 8.8 s; WS80 4.75 s; unchanged values count as a new "
      "reading only after this time"},
     &EcowittSettings::sensor_interval,
     from_seconds},
    {{"poll_interval", "s", 4.0, 0.1, 3600.0,
      "how often the gateway is asked; set at most half of sensor_interval, or changes are seen late"},
     &EcowittSettings::poll_interval,
     from_seconds},
    {{"response_timeout", "s", 3.0, 0.1, 60.0, "maximum wait for a connection, and for a reply"},
     &EcowittSettings::response_timeout,
     from_seconds},
};

class EcowittSensor final : public sensor::ReopeningSensor {
 public:
  explicit EcowittSensor(const EcowittSettings& settings)
      : sensor::ReopeningSensor(sensor::seed_of("ecowitt" + settings.port.host)),
        settings_(settings),
        where_(describe(settings.port)),
        port_(bus::make_byte_port(settings.port)) {}

  void interrupt() noexcept override { port_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override { return clock.now().mono; }

  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override {
    const MonoTime next = clock.now().mono + settings_.poll_interval;
    if (const auto opened = port_->open(); !opened) return opened.error();
    if (!port_->write(decode::network::kEcowittRequest)) return Failure{where_ + " has closed the connection"};
    sink.raw(sensor::RawDirection::kSent, decode::network::kEcowittRequest);

    const auto received = receive(clock);
    port_->close();
    if (!reply_.empty()) sink.raw(sensor::RawDirection::kReceived, reply_);
    if (!received) return received.error();
    if (reply_.empty()) {
      refuse(decode::Refusal::kTimeout, sink);
    } else if (const auto values = decode::network::decode_ecowitt(reply_); !values) {
      refuse(values.error(), sink);
    } else {
      take(*values, clock.now(), sink);
    }
    return next;
  }

  void close() noexcept override { port_->close(); }

 private:
  /// Reads into `reply_` until it is complete, invalid, or late. The end of the connection ends the reply.
  Result<void, Failure> receive(const sensor::Clock& clock) {
    reply_.clear();
    const MonoTime due = clock.now().mono + settings_.response_timeout;
    for (;;) {
      const auto size = decode::network::ecowitt_reply_size(reply_);
      if (size ? reply_.size() >= *size : size.error() != decode::Refusal::kTooShort) return {};
      const Nanoseconds left = due - clock.now().mono;
      if (left <= Nanoseconds::zero()) return {};
      const bus::ByteArrival arrival = port_->read(buffer_, left);
      if (arrival.status == bus::ByteStatus::kInterrupted) return Failure{"interrupted"};
      if (arrival.status == bus::ByteStatus::kLost) {
        if (reply_.empty()) return Failure{where_ + " has closed the connection without a reply"};
        return {};
      }
      if (arrival.status == bus::ByteStatus::kBytes)
        reply_.insert(reply_.end(), buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(arrival.size));
    }
  }

  void take(const decode::network::EcowittValues& values, const Instant& now, sensor::Sink& sink) {
    const bool is_repeated = values.wind && last_wind_ == *values.wind && now.mono - published_at_ < sensor_interval();
    if (is_repeated) return;
    wind::StationQuantities said = values.quantities;
    said.time = now;
    sink.quantities(said);
    if (!values.wind) return refuse(values.wind.error(), sink);

    last_wind_ = *values.wind;
    published_at_ = now.mono;
    report_connected(sink, "gateway at " + where_);
    sink.reading({.time = now,
                  .speed_m_s = *values.wind->speed_m_s,
                  .direction_deg = values.wind->direction_deg,
                  .gust_m_s = values.wind->gust_m_s,
                  .quality = wind::ReadingQuality::kGood});
  }

  /// A little less than the configured one, so that a request that comes somewhat early does not count as too early.
  Nanoseconds sensor_interval() const { return settings_.sensor_interval - settings_.poll_interval / 2; }

  void refuse(decode::Refusal why, sensor::Sink& sink) {
    sink.refused(why);
    report_unusable(sink, trouble_of(why));
  }

  std::string trouble_of(decode::Refusal why) const {
    if (why == decode::Refusal::kTimeout)
      return fmt::format("{} does not reply within {:g} s: check that it is a gateway of Ecowitt or Fine Offset",
                         where_, seconds(settings_.response_timeout));
    if (why == decode::Refusal::kInvalid)
      return fmt::format("{} receives no anemometer: check its battery, and that it is registered in the gateway",
                         where_);
    return fmt::format("the replies of {} cannot be used ({}): check that it is a gateway of Ecowitt or Fine Offset",
                       where_, name_of(why));
  }

  EcowittSettings settings_;
  std::string where_;
  std::unique_ptr<bus::BytePort> port_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(decode::network::kMaxEcowittReply);
  std::vector<std::uint8_t> reply_;
  std::optional<decode::DecodedWind> last_wind_;
  MonoTime published_at_{};
};

EcowittSettings ecowitt_settings_of(const ParameterValues& values) {
  EcowittSettings settings = kEcowittFields.of(values);
  settings.port.connect_timeout = settings.response_timeout;
  return settings;
}

std::unique_ptr<sensor::Sensor> open_ecowitt(const ParameterValues& values) {
  const EcowittSettings settings = ecowitt_settings_of(values);
  if (settings.port.host.empty())
    throw std::runtime_error("host: is missing; give the gateway's name or address, such as 192.168.1.30");
  return std::make_unique<EcowittSensor>(settings);
}

sensor::ValueSelection ecowitt_selection(const ParameterValues& values) {
  return {.device = "gateway " + bus::device_of(ecowitt_settings_of(values).port), .device_keys = "host, port"};
}

Result<sensor::SimulatedDevice, Failure> ecowitt_simulated(const ParameterValues& values) {
  sensor::SimulatedDevice simulated = sensor::simulated_server("ecowitt", values, {"--interval", "1"});
  simulated.values.set("sensor_interval", 1.0);
  simulated.values.set("poll_interval", 0.5);
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kEcowittDriver;
const sensor::DriverDescription kEcowittDriver{
    .name = "ecowitt",
    .summary = "gateways of Ecowitt and Fine Offset (GW1000, GW1100, GW2000), asked over the local network",
    .parameters = kEcowittFields.parameters(),
    .open = open_ecowitt,
    .find_in_network = find_ecowitt_gateways,
    .endpoints = [](const ParameterValues& values) { return sensor::endpoints_at(kEcowittFields.of(values).port); },
    .selection = ecowitt_selection,
    .simulated = ecowitt_simulated,
    .formats = "ecowitt"};

}  // namespace yuragi::drivers::network
