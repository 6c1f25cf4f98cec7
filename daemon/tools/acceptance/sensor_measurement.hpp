#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/acceptance/acceptance.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::acceptance {

/// Measures one sensor by the stream of a daemon whose only sensor it is: takes every message as it comes. The delay of
/// a reading is its age in the first frame in which it takes part, to within one tick, and the time that this frame
/// needed to the client; client and daemon share a clock. Thread-safe: no.
class SensorMeasurement {
 public:
  explicit SensorMeasurement(std::string sensor) : sensor_(std::move(sensor)) {}

  /// `now`: when the message came.
  void take(const wire::Message& message, Instant now);

  bool has_reading() const { return first_reading_.has_value(); }
  std::optional<double> direction_deg() const { return measured_.status.direction_deg; }

  /// The result until `now`.
  SensorMeasured result(Instant now) const;

 private:
  void take_frame(const wire::Frame& frame, Instant now);
  void take_status(const wire::SensorStatus& status, Instant now);

  std::string sensor_;
  SensorMeasured measured_;
  std::optional<MonoTime> begun_;
  std::optional<MonoTime> first_reading_;
  std::vector<double> speeds_m_s_;
  std::vector<double> delays_s_;
  struct SeenFrame {
    double reading_age_s;
    std::uint64_t poses;
  };
  std::optional<SeenFrame> last_frame_;
};

}  // namespace yuragi::daemon::tools::acceptance
