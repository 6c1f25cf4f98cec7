// Synthetic wind: a sensor that needs no hardware. The daemon's default, and for trying things.
#include "drivers/sensor/driver.hpp"
#include "engine/base/fields.hpp"
#include "engine/wind/turbulence/synthetic_wind.hpp"

namespace yuragi::drivers::synthetic {
namespace {

using wind::turbulence::SyntheticWindSettings;

struct Keys {
  SyntheticWindSettings wind;
  Nanoseconds interval{};
};

auto of(auto member) {
  return member_of(&Keys::wind, member);
}

const Fields<Keys> kSyntheticFields = {
    {{"speed", "m/s", 5.0, 0.0, 60.0, "mean wind speed"}, of(&SyntheticWindSettings::mean_speed_m_s)},
    {{"direction", "deg", 240.0, 0.0, 360.0, "direction that the wind comes from, clockwise from north"},
     of(&SyntheticWindSettings::mean_direction_deg)},
    {{"turbulence", "", 0.3, 0.0, 1.0, "turbulence intensity: standard deviation over mean speed"},
     of(&SyntheticWindSettings::turbulence_intensity)},
    {{"rate", "Hz", 4.0, 0.01, 100.0, "readings per second"},
     &Keys::interval,
     [](double rate_hz) { return from_seconds(1.0 / rate_hz); }},
    {{.name = "seed", .default_value = std::int64_t{1}, .min = 0, .help = "the same seed gives the same wind"},
     of(&SyntheticWindSettings::seed)},
};

class Sensor final : public sensor::Sensor {
 public:
  explicit Sensor(const Keys& keys) : wind_(keys.wind), interval_(keys.interval) {}

  MonoTime poll(const sensor::Clock& clock, sensor::Sink& sink) override {
    const Instant now = clock.now();
    if (count_ == 0) {
      begun_ = now.mono;
      sink.link(wind::LinkState::kConnected, "synthetic: no hardware is read");
    }
    const MonoTime due = begun_ + count_ * interval_;
    if (now.mono < due) return due;

    const wind::Vector wind = wind_.at(seconds(now.mono - begun_));
    sink.reading({.time = now,
                  .speed_m_s = speed_of(wind),
                  .direction_deg = wind::direction_from_deg(wind),
                  .gust_m_s = std::nullopt,
                  .quality = wind::ReadingQuality::kSimulated});

    // Readings stay on their own grid; those that a halted machine missed are skipped.
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
    .parameters = kSyntheticFields.parameters(),
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      return std::make_unique<Sensor>(kSyntheticFields.of(values));
    },
    .stated_value =
        [](const ParameterValues&) {
          return std::optional(
              sensor::StatedValue{.value = wind::ReadingValue::kInstant, .source = "drivers/synthetic"});
        },
    .simulated = [](const ParameterValues&) -> Result<sensor::SimulatedDevice, Failure> {
      return Failure{"the driver synthetic has no simulated device, because it needs no device"};
    }};

}  // namespace yuragi::drivers::synthetic
