// hidapi 0.13, on Linux's hidraw. What it does not do is done here: its enumeration and its opening share one global
// state without a lock; it does not report where a device is plugged in, so that a device that was away cannot be
// distinguished from its twin; it returns -1 both when a device refuses and when it is gone; and nothing can wake a
// read.
#include "drivers/bus/hid_device.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <cwchar>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <tuple>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

namespace yuragi::drivers::bus {

const char* const kHidPermissionRemedy =
    "install config/udev/70-yuragi.rules, join the group plugdev, and plug the device in again";

namespace {

using HidSteadyClock = std::chrono::steady_clock;
constexpr Nanoseconds kSlice = std::chrono::milliseconds(50);      // how often a read checks for interruption
constexpr Nanoseconds kSpinGuard = std::chrono::milliseconds(10);  // when the system reports "ready" without data

/// hidapi's one global state, set up once and taken down at the end of the process.
class HidLibrary {
 public:
  /// Held while anything is done that touches the global state.
  static std::unique_lock<std::mutex> lock() {
    static HidLibrary library;
    return std::unique_lock(library.mutex_);
  }

 private:
  HidLibrary() { hid_init(); }
  ~HidLibrary() { hid_exit(); }

  std::mutex mutex_;
};

struct CloseHid {
  void operator()(hid_device* device) const noexcept {
    const auto lock = HidLibrary::lock();
    hid_close(device);
  }
};

/// A device's own description, fit to be printed: anything but plain ASCII is replaced.
std::string printable(const wchar_t* text) {
  std::string plain;
  for (; text != nullptr && *text != 0; ++text) {
    const bool is_plain = *text >= L' ' && *text < 0x7F && *text != L'"' && *text != L'\\';
    plain += is_plain ? static_cast<char>(*text) : '?';
  }
  return plain;
}

/// The USB port of a node, as the kernel names it: of .../usb1/1-1/1-1.2/1-1.2:1.0/0003:0FDE:CA01.0001 the "1-1.2".
std::string port_of_node(const std::string& node) {
  std::error_code error;
  const std::filesystem::path link =
      std::filesystem::path("/sys/class/hidraw") / std::filesystem::path(node).filename() / "device";
  const std::filesystem::path device = std::filesystem::canonical(link, error);
  if (error) return "";
  for (const auto& part : device) {
    const std::string name = part.string();
    const std::size_t colon = name.find(':');
    const bool is_interface =
        colon != std::string::npos && name.find('-') < colon && name.find('.', colon) != std::string::npos;
    if (is_interface) return name.substr(0, colon);
  }
  return "";
}

/// Every device with one of these ids, in the order of their ports; of a device with several HID interfaces the first.
std::vector<HidInfo> enumerate(std::span<const HidId> ids) {
  std::vector<HidInfo> found;
  {
    const auto lock = HidLibrary::lock();
    hid_device_info* const all = hid_enumerate(0, 0);
    for (const hid_device_info* one = all; one != nullptr; one = one->next) {
      const HidId id = {one->vendor_id, one->product_id};
      if (one->path == nullptr || std::ranges::find(ids, id) == ids.end()) continue;
      found.push_back({.id = id,
                       .node = one->path,
                       .port = "",
                       .serial = printable(one->serial_number),
                       .interface = one->interface_number});
    }
    hid_free_enumeration(all);
  }
  for (HidInfo& info : found) info.port = port_of_node(info.node);
  std::ranges::sort(found, [](const HidInfo& left, const HidInfo& right) {
    return std::tie(left.port, left.interface, left.node) < std::tie(right.port, right.interface, right.node);
  });
  // hidapi names a node once for each usage in it.
  const auto is_same_device = [](const HidInfo& left, const HidInfo& right) {
    return left.node == right.node || (!left.port.empty() && left.port == right.port);
  };
  found.erase(std::unique(found.begin(), found.end(), is_same_device), found.end());
  return found;
}

bool is_at(const HidInfo& info, const HidPlace& place) {
  if (!place.serial.empty() && place.serial != info.serial) return false;
  if (place.path.empty() || place.path == info.port || place.path == info.node) return true;
  std::error_code error;
  return place.path.starts_with('/') && std::filesystem::equivalent(place.path, info.node, error);
}

std::string describe_wanted(std::span<const HidId> ids, const HidPlace& place) {
  std::string wanted;
  for (const HidId& id : ids) wanted += (wanted.empty() ? "" : " or ") + describe(id);
  if (!place.serial.empty()) wanted += ", serial number " + place.serial;
  if (!place.path.empty()) wanted += ", at " + place.path;
  return wanted;
}

std::string trouble_of_node(const std::string& node) {
  const int descriptor = ::open(node.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return std::generic_category().message(errno);
  ::close(descriptor);
  return "";
}

class HidapiDevice final : public HidDevice {
 public:
  Result<HidInfo, Failure> open(std::span<const HidId> ids, const HidPlace& place) override {
    close();
    std::vector<HidInfo> found = enumerate(ids);
    std::erase_if(found, [&place](const HidInfo& info) { return !is_at(info, place); });
    if (found.empty()) {
      return Failure{"no device " + describe_wanted(ids, place) + " on USB: plug it in and switch it on"};
    }
    if (found.size() > 1) {
      std::string places;
      for (const HidInfo& info : found) places += (places.empty() ? "" : ", ") + info.port + " (" + info.node + ")";
      return Failure{fmt::format("{} devices match: set `path` to one of {}", found.size(), places)};
    }
    HidInfo& info = found.front();
    {
      const auto lock = HidLibrary::lock();
      device_.reset(hid_open_path(info.node.c_str()));
    }
    if (!device_) {
      const std::string trouble = trouble_of_node(info.node);
      return Failure{fmt::format("cannot open {} ({}): {}", info.node, trouble.empty() ? "not a HID device" : trouble,
                                 kHidPermissionRemedy)};
    }
    return std::move(info);
  }

  void close() noexcept override { device_.reset(); }

  HidArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (!device_) return {HidStatus::kLost};
    const auto deadline = HidSteadyClock::now() + timeout;
    for (;;) {
      if (is_interrupted_) return {HidStatus::kInterrupted};
      const auto begin = HidSteadyClock::now();
      const Nanoseconds left = std::clamp<Nanoseconds>(deadline - begin, Nanoseconds::zero(), kSlice);
      const auto wait_ms = std::chrono::ceil<std::chrono::milliseconds>(left).count();
      errno = 0;
      const int size = hid_read_timeout(device_.get(), buffer.data(), buffer.size(), static_cast<int>(wait_ms));
      if (size > 0) return {HidStatus::kReport, static_cast<std::size_t>(size)};
      if (size < 0 && errno != EINTR) return {HidStatus::kLost};
      const auto now = HidSteadyClock::now();
      if (now >= deadline) return {HidStatus::kSilence};
      if (now - begin < left / 2) rest(std::min<Nanoseconds>(kSpinGuard, deadline - now));
    }
  }

  bool write(std::span<const std::uint8_t> report) override {
    if (!device_ || is_interrupted_) return false;
    const int written = hid_write(device_.get(), report.data(), report.size());
    return written >= 0 && static_cast<std::size_t>(written) == report.size();
  }

  HidArrival get_input_report(std::uint8_t id, std::span<std::uint8_t> buffer) override {
    if (!device_ || buffer.empty()) return {HidStatus::kLost};
    if (is_interrupted_) return {HidStatus::kInterrupted};
    buffer[0] = id;
    const int size = hid_get_input_report(device_.get(), buffer.data(), buffer.size());
    if (size > 0) return {HidStatus::kReport, std::min(static_cast<std::size_t>(size), buffer.size())};
    // It refused, or is disconnected: then the node has hung up.
    std::array<std::uint8_t, 64> spare{};
    const bool is_lost = hid_read_timeout(device_.get(), spare.data(), spare.size(), 0) < 0;
    return {is_lost ? HidStatus::kLost : HidStatus::kSilence};
  }

  void interrupt() noexcept override {
    is_interrupted_ = true;
    wake_.notify_all();
  }

 private:
  void rest(Nanoseconds duration) {
    std::unique_lock lock(wake_mutex_);
    wake_.wait_for(lock, duration, [this] { return is_interrupted_.load(); });
  }

  std::unique_ptr<hid_device, CloseHid> device_;
  std::atomic<bool> is_interrupted_ = false;
  std::mutex wake_mutex_;
  std::condition_variable wake_;
};

}  // namespace

std::string describe(const HidId& id) {
  return fmt::format("{:04x}:{:04x}", id.vendor, id.product);
}

std::string where_is(const HidInfo& info) {
  return info.port.empty() ? info.node : "USB port " + info.port;
}

std::unique_ptr<HidDevice> make_hid_device() {
  return std::make_unique<HidapiDevice>();
}

std::vector<HidListing> list_hid_devices(std::span<const HidId> ids) {
  std::vector<HidListing> listings;
  for (HidInfo& info : enumerate(ids)) {
    std::string trouble = trouble_of_node(info.node);
    listings.push_back({std::move(info), std::move(trouble)});
  }
  return listings;
}

}  // namespace yuragi::drivers::bus
