#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// Vendor and product id of a USB device.
struct HidId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;

  bool operator==(const HidId&) const = default;
};

/// "0fde:ca01", as lsusb writes it.
std::string describe(const HidId& id);

/// Selects one of several equal devices; empty fields match any.
struct HidPlace {
  std::string serial;
  std::string path;  ///< a USB port ("1-1.2"), which stays the same while the cable stays in its socket; or a file: a
                     ///< /dev/hidrawN, or a link to one that udev keeps
};

/// A HID device that is plugged in.
struct HidInfo {
  HidId id;
  std::string node;    ///< "/dev/hidraw0", for as long as it is plugged in
  std::string port;    ///< "1-1.2"; empty if it is not on USB
  std::string serial;  ///< empty: it has none
  int interface = -1;  ///< of a USB device
};

/// "USB port 1-1.2", or else the node: for people.
std::string where_is(const HidInfo& info);

/// A device and whether it can be used.
struct HidListing {
  HidInfo info;
  std::string trouble;  ///< why it cannot be opened; empty: it can
};

/// Advice for a device node without permission.
extern const char* const kHidPermissionRemedy;

enum class HidStatus : std::uint8_t {
  kReport,
  kSilence,      ///< no report until the timeout; for a requested report, no reply
  kInterrupted,  ///< interrupt() was called
  kLost,         ///< the device is disconnected, or cannot be used any more
};

struct HidArrival {
  HidStatus status = HidStatus::kSilence;
  std::size_t size = 0;  ///< for kReport
};

/// A HID device that can be closed and opened again. Carries reports without interpreting them. A test may substitute
/// another.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class HidDevice {
 public:
  virtual ~HidDevice() = default;

  /// Finds the one device that has one of these ids and is at that place, and opens it. The failure's text: what is
  /// missing, or that there are several, and what to do.
  virtual Result<HidInfo, Failure> open(std::span<const HidId> ids, const HidPlace& place) = 0;
  virtual void close() noexcept = 0;

  /// The next input report, waiting for at most `timeout`; numbered reports begin with their number.
  virtual HidArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) = 0;

  /// Sends an output report: its number (0 if the device has none), then its bytes. Returns false on failure. Waits for
  /// at most 5 s, the kernel's own fixed limit.
  virtual bool write(std::span<const std::uint8_t> report) = 0;

  /// Requests input report `id`, which begins with that number. kSilence if the device refuses or does not reply
  /// (within the kernel's 5 s).
  virtual HidArrival get_input_report(std::uint8_t id, std::span<std::uint8_t> buffer) = 0;

  /// Ends a read() that waits, within 50 ms, and makes all later work end at once.
  virtual void interrupt() noexcept = 0;
};

/// The real one, by hidapi (hidraw). Thread-safe: any number of devices may live on any number of threads.
std::unique_ptr<HidDevice> make_hid_device();

/// The plugged-in devices with one of these ids. Opens each briefly, to check the permission.
std::vector<HidListing> list_hid_devices(std::span<const HidId> ids);

}  // namespace yuragi::drivers::bus
