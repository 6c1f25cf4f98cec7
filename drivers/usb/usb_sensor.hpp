#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/decode/usb/cup_counter.hpp"
#include "drivers/decode/usb/potentiometer_vane.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "drivers/usb/usb_daq.hpp"

namespace yuragi::drivers::usb {

/// Calibration of a cup and a vane on a counter and ADC device, and which device it is.
struct Settings {
  std::vector<const DaqModel*> models;  ///< any of these
  std::string port;                     ///< the one that is plugged in there; empty: anywhere
  std::string serial;                   ///< the one with this serial number; empty: any
  DaqWiring wiring;
  decode::usb::CupCalibration cup;
  decode::usb::VaneCalibration vane;
  double reference_v = 5.0;                             ///< over the vane's track, if it is not measured
  Nanoseconds period = std::chrono::milliseconds(100);  ///< from one round of requests to the next
  Nanoseconds timeout = std::chrono::milliseconds(500);
};

/// The mean of directions around the circle. Thread-safe: no.
class MeanDirection {
 public:
  void add(double direction_deg);
  void clear() { *this = {}; }
  /// [0, 360); empty if nothing was added, or the directions cancel.
  std::optional<double> mean_deg() const;

 private:
  double east_ = 0.0;
  double north_ = 0.0;
};

/// A cup anemometer on the counter and a potentiometer vane on the ADC of a USB device. Samples both at a steady rate
/// and publishes whenever the cup's window closes: its speed, and the mean of the vane's directions in that window.
class Sensor final : public sensor::ReopeningSensor {
 public:
  Sensor(Settings settings, std::uint32_t seed, std::unique_ptr<bus::UsbDevice> device);
  ~Sensor() override;

  void interrupt() noexcept override { device_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  void close() noexcept override { device_->close(); }
  bool poll_for_return() override { return device_->take_arrival(); }

 private:
  bool is_wanted(const bus::PluggedUsbDevice& device) const;
  const DaqModel& model_of(const bus::UsbId& id) const;
  std::string name_of_wanted() const;
  Failure wrong_device(const std::string& serial);
  Result<MonoTime, Failure> suffer(const DaqTrouble& trouble, MonoTime again, sensor::Sink& sink);
  void take(const DaqSample& sample, MonoTime requested_at, Instant now, sensor::Sink& sink);

  Settings settings_;
  std::unique_ptr<bus::UsbDevice> device_;

  // Of the device that is open.
  std::unique_ptr<Daq> daq_;
  std::string name_;
  bool is_started_ = false;
  int failures_ = 0;             // rounds in a row
  bool is_jumpy_ = false;        // the counter has jumped, and no window has closed correctly since
  std::size_t turn_ = 0;         // which of several that fit is tried
  MonoTime counted_at_{};        // the last count that was taken,
  Nanoseconds counted_doubt_{};  // which can be older by this
  decode::usb::CupState cup_;
  MeanDirection direction_;
};

}  // namespace yuragi::drivers::usb
