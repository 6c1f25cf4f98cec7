#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/bus/usb_device.hpp"
#include "drivers/sensor/sensor.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::usb {

/// Where the cup and the vane are connected.
struct DaqWiring {
  std::uint8_t counter = 0;
  std::optional<std::uint8_t> vane_channel = 0;  ///< the vane's wiper; empty: there is no vane
  std::optional<std::uint8_t> reference_channel =
      {};  ///< the voltage across the vane's potentiometer; empty: it is known
};

/// A device's own description.
struct DaqIdentity {
  std::string serial;  ///< empty if it has only the serial number that the bus shows
};

/// The values of one round of requests.
struct DaqSample {
  std::uint32_t count = 0;
  std::optional<double> wiper_v;
  std::optional<double> reference_v;
};

/// Why a round failed. Refusals have been counted.
struct DaqTrouble {
  std::string message;   ///< after the device's name: "does not reply"
  bool is_lost = false;  ///< the device has to be opened again; otherwise the next round may succeed
};

/// The protocol of one kind of counter and ADC device. Holds the device's state from start() on; one is made each time
/// that the device is opened. Every message is shown to the sink, every refusal counted there.
class Daq {
 public:
  virtual ~Daq() = default;

  /// Configures the device and reads its calibration.
  virtual Result<DaqIdentity, DaqTrouble> start(bus::UsbDevice& device, sensor::Sink& sink) = 0;

  virtual Result<DaqSample, DaqTrouble> sample(bus::UsbDevice& device, sensor::Sink& sink) = 0;
};

/// A kind of such devices.
struct DaqModel {
  std::string_view name;  ///< in a configuration
  std::string_view what;  ///< for people
  bus::UsbId id;
  std::uint8_t counters = 1;
  std::uint8_t channels = 1;
  std::unique_ptr<Daq> (*make)(const DaqWiring& wiring, Nanoseconds timeout);
};

extern const DaqModel kMcc1208Model;
extern const DaqModel kLabjackModel;

/// Every model.
std::span<const DaqModel* const> usb_daq_models();

/// A channel of the wiring that the model does not have; empty: none.
std::string wrong_wiring(const DaqModel& model, const DaqWiring& wiring);

/// The trouble of a failed transfer, counted in `sink`.
DaqTrouble trouble_of(bus::UsbStatus status, sensor::Sink& sink);

/// The trouble of a refused reply, counted in `sink`.
DaqTrouble trouble_of(decode::Refusal why, sensor::Sink& sink);

}  // namespace yuragi::drivers::usb
