// Synthetic wind: a sensor that needs no hardware. The daemon's default, and for trying things.
#include <array>

#include "drivers/sensor/driver.hpp"
#include "engine/wind/turbulence/synthetic_wind.hpp"

namespace yuragi::drivers::synthetic {
namespace {

const std::array kSyntheticParameters = {
    Parameter{.name = "speed", .unit = "m/s", .default_value = 5.0, .min = 0.0, .max = 60.0, .help = "mean wind speed"},
    Parameter{.name = "direction",
              .unit = "deg",
              .default_value = 240.0,
              .min = 0.0,
              .max = 360.0,
              .help = "where the wind comes from, clockwise from north"},
    Parameter{.name = "turbulence",
              .unit = "",
              .default_value = 0.3,
              .min = 0.0,
              .max = 1.0,
              .help = "turbulence intensity: standard deviation over mean speed"},
    Parameter{
        .name = "rate", .unit = "Hz", .default_value = 4.0, .min = 0.01, .max = 100.0, .help = "readings per second"},
    Parameter{.name = "seed",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 0,
              .help = "the same seed gives the same wind"},
};

class SyntheticSensor final : public sensor::Sensor {
 public:
  explicit SyntheticSensor(const ParameterValues& values)
      : wind_({.mean_speed_m_s = values.number("speed"),
               .mean_direction_deg = values.number("direction"),
               .turbulence_intensity = values.number("turbulence"),
               .seed = static_cast<std::uint64_t>(values.integer("seed"))}),
        interval_(from_seconds(1.0 / values.number("rate"))) {}

  MonoTime poll(const sensor::Clock& clock, sensor::SensorSink& sink) override {
    const Instant now = clock.now();
    if (count_ == 0) {
      begun_ = now.mono;
      sink.link(wind::LinkState::kConnected, "synthetic: no hardware is read");
    }
    const MonoTime due = begun_ + count_ * interval_;
    if (now.mono < due) return due;

    const wind::WindVector wind = wind_.at(seconds(now.mono - begun_));
    sink.reading({.time = now,
                  .speed_m_s = speed_of(wind),
                  .direction_deg = wind::direction_from_deg(wind),
                  .gust_m_s = std::nullopt,
                  .quality = wind::ReadingQuality::kSimulated});

    // Readings stay on their own grid; those that a halted machine missed are not made up for.
    count_ = (now.mono - begun_) / interval_ + 1;
    return begun_ + count_ * interval_;
  }

 private:
  wind::turbulence::SyntheticWind wind_;
  Nanoseconds interval_;
  MonoTime begun_{};
  std::int64_t count_ = 0;
};

}  // namespace

extern const sensor::DriverDescription kSyntheticDriver;
const sensor::DriverDescription kSyntheticDriver{
    .name = "synthetic",
    .summary = "seeded synthetic wind; no hardware",
    .parameters = kSyntheticParameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      return std::make_unique<SyntheticSensor>(values);
    },
    .stated_value =
        [](const ParameterValues&) {
          return std::optional(
              sensor::StatedValue{.value = wind::ReadingValue::kInstant, .source = "drivers/synthetic"});
        }};

}  // namespace yuragi::drivers::synthetic
