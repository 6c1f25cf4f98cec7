#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/bus/http_client.hpp"
#include "drivers/decode/network/json_wind.hpp"
#include "drivers/json/observation_watch.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "engine/platform/backoff.hpp"

namespace yuragi::drivers::json {

struct Settings {
  bus::HttpResource resource{};
  decode::network::JsonPlaces places{};
  Nanoseconds every = std::chrono::seconds(60);
  Nanoseconds interval{};  ///< 0: ten times `every`
  Nanoseconds silence = std::chrono::minutes(90);
};

/// How often the source has a new value, as far as the settings know.
Nanoseconds interval_of(const Settings& settings);

/// Polls a server for JSON. A repeated observation is no reading. After an error of the server or the network it waits
/// longer each time, and at least as long as the server asks for, up to an hour. Its status and its log lines have
/// nothing of the URL but host and port.
class Sensor final : public sensor::ReopeningSensor {
 public:
  /// `where`: the server, for people. `client`: of settings.resource.
  Sensor(const Settings& settings, std::string where, std::unique_ptr<bus::HttpClient> client);

  void interrupt() noexcept override { client_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  void close() noexcept override {}

 private:
  Nanoseconds take_failure(const bus::HttpFailure& failure, sensor::Sink& sink);
  Nanoseconds take_error_status(const bus::HttpReply& reply, sensor::Sink& sink);
  void take_body(const bus::HttpReply& reply, const Instant& now, sensor::Sink& sink);
  void publish(Novelty novelty, const Instant& now, sensor::Sink& sink);
  void refuse(decode::Refusal why, const std::string& detail, sensor::Sink& sink);
  std::string trouble_of(decode::Refusal why, const std::string& body) const;

  Settings settings_;
  std::string where_;
  std::unique_ptr<bus::HttpClient> client_;
  platform::Backoff errors_;
  ObservationWatch watch_;
  std::string etag_;  ///< of the answer that the watch knows
};

}  // namespace yuragi::drivers::json
