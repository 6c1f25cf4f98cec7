#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/bus/byte_port.hpp"
#include "drivers/davis/http_exchange.hpp"
#include "drivers/decode/davis/weatherlink_live.hpp"
#include "drivers/sensor/reading_limit.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::davis {

struct WeatherLinkLiveSettings {
  bus::BytePortAddress http;        ///< of the WeatherLink Live
  bus::BytePortAddress broadcasts;  ///< where they are received
  int transmitter = 0;              ///< 1 to 8; 0: the first that has a wind
};

/// The values of kWeatherLinkLiveDriver's parameters. Throws std::runtime_error if they cannot work together.
WeatherLinkLiveSettings weatherlink_live_settings_of(const ParameterValues& values);

/// A WeatherLink Live. Over HTTP it is repeatedly asked for its conditions (its id and the weather), and for broadcasts
/// of the wind every 2.5 s. Without broadcasts the wind is that of the conditions.
class WeatherLinkLiveSensor final : public sensor::ReopeningSensor {
 public:
  WeatherLinkLiveSensor(const WeatherLinkLiveSettings& settings, std::unique_ptr<bus::BytePort> http,
                        std::unique_ptr<bus::BytePort> broadcasts);

  void interrupt() noexcept override;

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  void close() noexcept override;

 private:
  enum class Request : std::uint8_t { kConditions, kBroadcasts };

  void begin_request(const sensor::Clock& clock, sensor::Sink& sink);
  void advance_request(const Instant& now, sensor::Sink& sink);
  void fail_request(MonoTime now, const std::string& why, sensor::Sink& sink);
  void take_conditions(std::string_view json, const Instant& now, sensor::Sink& sink);
  void take_broadcast_port(std::string_view json, MonoTime now, sensor::Sink& sink);
  void take_broadcast(std::string_view json, const Instant& now, sensor::Sink& sink);
  void publish(const decode::davis::LiveConditions& conditions, const Instant& now, const std::string& how,
               sensor::Sink& sink);
  bool has_broadcasts(MonoTime now) const;

  WeatherLinkLiveSettings settings_;
  std::string where_;
  HttpExchange http_;
  std::unique_ptr<bus::BytePort> broadcasts_;
  std::vector<std::uint8_t> buffer_;

  Request request_ = Request::kConditions;
  MonoTime request_due_{};
  MonoTime next_conditions_{};
  MonoTime next_renewal_{};
  std::string trouble_;      ///< of the last request for conditions, if it failed
  std::string advice_;       ///< what may be wrong if no broadcasts arrive
  std::string device_;       ///< whose broadcasts are taken; empty: not known yet
  int transmitter_ = 0;      ///< which one was taken first
  bool is_received_ = true;  ///< by the last conditions: the station reaches the WeatherLink Live
  MonoTime last_broadcast_{};
  bool has_broadcast_ = false;
  MonoTime last_message_{};
  sensor::ReadingLimit limit_;  ///< others can send datagrams, too
};

}  // namespace yuragi::drivers::davis
