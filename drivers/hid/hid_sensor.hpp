#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "drivers/bus/hid_device.hpp"
#include "drivers/hid/hid_station.hpp"
#include "drivers/sensor/reopening_sensor.hpp"

namespace yuragi::drivers::hid {

/// A USB HID weather station of one of several families, whichever is found at the place. Between two requests to a
/// station that sends nothing unrequested, its presence is checked once a second, so that an unplugged one is noticed.
class Sensor final : public sensor::ReopeningSensor {
 public:
  /// `kinds` must outlive this. `seed` makes the waits of several sensors differ.
  Sensor(std::span<const StationKind> kinds, bus::HidPlace place, const StationTiming& timing, std::uint32_t seed,
         std::unique_ptr<bus::HidDevice> device);

  void interrupt() noexcept override;

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  void close() noexcept override;

 private:
  Result<MonoTime, Failure> look_after(Exchange& exchange);
  static std::string why_useless(Exchange& exchange);

  std::span<const StationKind> kinds_;
  bus::HidPlace place_;
  StationTiming timing_;
  std::unique_ptr<bus::HidDevice> device_;
  std::unique_ptr<Station> station_;  ///< while the device is open
  std::string name_;                  ///< of the open station and its place
  MonoTime next_step_{};
  std::atomic<bool> is_interrupted_ = false;
};

}  // namespace yuragi::drivers::hid
