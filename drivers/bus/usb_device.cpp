// libusb 1.0.26. Every transfer is an asynchronous one that the calling thread waits for: libusb's own synchronous
// calls cannot be ended by another thread, and wait without end for a transfer whose cancellation fails (libusb issue
// 369). The hot-plug callback only sets a flag, since nothing may be opened, closed or waited for in it.
#include "drivers/bus/usb_device.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>

#include <fmt/format.h>
#include <libusb.h>
#include <unistd.h>

namespace yuragi::drivers::bus {
namespace {

using UsbClock = std::chrono::steady_clock;

/// How long a transfer may outlive its own time-out before it is cancelled, and its cancellation before it is given up.
constexpr Nanoseconds kTransferGrace = std::chrono::milliseconds(500);
constexpr int kFirstInterface = 0;
constexpr std::size_t kSetupSize = LIBUSB_CONTROL_SETUP_SIZE;

struct FreeDeviceList {
  void operator()(libusb_device** list) const noexcept { libusb_free_device_list(list, 1); }
};
using DeviceList = std::unique_ptr<libusb_device*, FreeDeviceList>;

/// A transfer and its data, kept for as long as libusb uses it.
struct PendingTransfer {
  explicit PendingTransfer(std::size_t size) : transfer(libusb_alloc_transfer(0)), buffer(size) {
    if (transfer == nullptr) throw std::bad_alloc();
  }
  ~PendingTransfer() { libusb_free_transfer(transfer); }
  PendingTransfer(const PendingTransfer&) = delete;
  PendingTransfer& operator=(const PendingTransfer&) = delete;

  static void LIBUSB_CALL finish(libusb_transfer* transfer) noexcept {
    static_cast<PendingTransfer*>(transfer->user_data)->is_finished = 1;
  }

  libusb_transfer* transfer;
  std::vector<std::uint8_t> buffer;
  int is_finished = 0;
};

UsbStatus status_of(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return UsbStatus::kDone;
    case LIBUSB_TRANSFER_TIMED_OUT:
    case LIBUSB_TRANSFER_CANCELLED:  // by us, past its time
      return UsbStatus::kTimeout;
    case LIBUSB_TRANSFER_STALL:
      return UsbStatus::kStalled;
    case LIBUSB_TRANSFER_OVERFLOW:
      return UsbStatus::kOverflow;
    case LIBUSB_TRANSFER_ERROR:  // the bus's error while a plug is being pulled
    case LIBUSB_TRANSFER_NO_DEVICE:
      break;
  }
  return UsbStatus::kGone;
}

UsbId id_of(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  return {descriptor.idVendor, descriptor.idProduct};
}

/// The name that the kernel has for where the device is plugged in; it is in use for the device in /sys too.
std::string port_of(libusb_device* device) {
  constexpr int kDeepest = 7;
  std::array<std::uint8_t, kDeepest> ports{};
  const int depth = libusb_get_port_numbers(device, ports.data(), kDeepest);
  const int bus = libusb_get_bus_number(device);
  if (depth <= 0) return fmt::format("usb{}", bus);
  return fmt::format("{}-{}", bus, fmt::join(ports.begin(), ports.begin() + depth, "."));
}

/// An attribute that the kernel read from the device when it was plugged in; needs no permission.
std::string attribute_of(const std::string& port, const char* name) {
  std::ifstream file("/sys/bus/usb/devices/" + port + "/" + name);
  std::string text;
  std::getline(file, text);
  return text;
}

PluggedUsbDevice look_at(libusb_device* device) {
  PluggedUsbDevice plugged;
  plugged.id = id_of(device);
  plugged.port = port_of(device);
  plugged.serial = attribute_of(plugged.port, "serial");
  plugged.node =
      fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(device), libusb_get_device_address(device));
  plugged.is_permitted = access(plugged.node.c_str(), R_OK | W_OK) == 0;
  return plugged;
}

class LibusbDevice final : public UsbDevice {
 public:
  explicit LibusbDevice(std::vector<UsbId> kinds) : kinds_(std::move(kinds)) {}
  ~LibusbDevice() override {
    LibusbDevice::close();
    if (libusb_context* const context = context_.load()) libusb_exit(context);
  }
  LibusbDevice(const LibusbDevice&) = delete;
  LibusbDevice& operator=(const LibusbDevice&) = delete;

  Result<std::vector<PluggedUsbDevice>, Failure> plugged() override {
    std::vector<PluggedUsbDevice> all;
    const auto visited = for_each_device([&all](libusb_device* device) { all.push_back(look_at(device)); });
    if (!visited) return visited.error();
    std::ranges::sort(all, {}, &PluggedUsbDevice::port);
    return all;
  }

  bool take_arrival() override {
    if (!start()) return false;
    timeval no_time{};
    libusb_handle_events_timeout_completed(context_, &no_time, nullptr);
    return std::exchange(has_arrived_, false);
  }

  Result<void, Failure> open(const PluggedUsbDevice& wanted) override {
    close();
    int error = LIBUSB_ERROR_NO_DEVICE;
    const auto visited = for_each_device([&](libusb_device* device) {
      if (handle_ == nullptr && id_of(device) == wanted.id && port_of(device) == wanted.port) {
        error = libusb_open(device, &handle_);
      }
    });
    if (!visited) return visited.error();
    if (error == LIBUSB_SUCCESS) {
      libusb_set_auto_detach_kernel_driver(handle_, 1);
      error = libusb_claim_interface(handle_, kFirstInterface);
    }
    if (error == LIBUSB_SUCCESS) return {};
    close();
    return Failure{explain(error, wanted)};
  }

  void close() noexcept override {
    if (handle_ == nullptr) return;
    libusb_release_interface(handle_, kFirstInterface);
    libusb_close(std::exchange(handle_, nullptr));
  }

  UsbTransfer control(const UsbRequest& request, std::span<std::uint8_t> data, Nanoseconds timeout) override {
    if (handle_ == nullptr) return {UsbStatus::kGone};
    auto pending = std::make_unique<PendingTransfer>(kSetupSize + data.size());
    libusb_fill_control_setup(pending->buffer.data(), request.request_type, request.request, request.value,
                              request.index, static_cast<std::uint16_t>(data.size()));
    std::ranges::copy(data, pending->buffer.begin() + kSetupSize);
    libusb_fill_control_transfer(pending->transfer, handle_, pending->buffer.data(), &PendingTransfer::finish,
                                 pending.get(), milliseconds(timeout));
    const bool reads = (request.request_type & LIBUSB_ENDPOINT_IN) != 0;
    return run(std::move(pending), kSetupSize, reads ? data : std::span<std::uint8_t>(), timeout);
  }

  UsbTransfer read(std::uint8_t endpoint, std::span<std::uint8_t> data, Nanoseconds timeout) override {
    auto pending = std::make_unique<PendingTransfer>(data.size());
    return bulk(std::move(pending), static_cast<std::uint8_t>(endpoint | LIBUSB_ENDPOINT_IN), data, timeout);
  }

  UsbTransfer write(std::uint8_t endpoint, std::span<const std::uint8_t> data, Nanoseconds timeout) override {
    auto pending = std::make_unique<PendingTransfer>(data.size());
    std::ranges::copy(data, pending->buffer.begin());
    return bulk(std::move(pending), endpoint, {}, timeout);
  }

  void interrupt() noexcept override {
    is_interrupted_ = true;
    if (libusb_context* const context = context_.load()) libusb_interrupt_event_handler(context);
  }

 private:
  static unsigned milliseconds(Nanoseconds timeout) {
    // libusb takes 0 for no time-out at all.
    return static_cast<unsigned>(std::max<std::int64_t>(timeout / std::chrono::milliseconds(1), 1));
  }

  static int LIBUSB_CALL note_arrival(libusb_context* /*context*/, libusb_device* device,
                                      libusb_hotplug_event /*event*/, void* self) noexcept {
    auto* const me = static_cast<LibusbDevice*>(self);
    if (std::ranges::count(me->kinds_, id_of(device)) != 0) me->has_arrived_ = true;
    return 0;
  }

  /// Makes the context and listens for devices that come, the first time that it can. Where the kernel does not
  /// report them they are found all the same, by the next attempt to open.
  bool start() {
    if (context_.load() != nullptr) return true;
    libusb_context* context = nullptr;
    if (libusb_init(&context) != LIBUSB_SUCCESS) return false;
    libusb_set_option(context, LIBUSB_OPTION_LOG_LEVEL, LIBUSB_LOG_LEVEL_NONE);
    libusb_hotplug_register_callback(context, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED, 0, LIBUSB_HOTPLUG_MATCH_ANY,
                                     LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, &note_arrival, this, nullptr);
    context_ = context;
    return true;
  }

  template <class Use>
  Result<void, Failure> for_each_device(Use&& use) {
    if (!start()) return Failure{"libusb cannot start: check that this system has USB and shows it in /dev/bus/usb"};
    libusb_device** list = nullptr;
    const ssize_t count = libusb_get_device_list(context_, &list);
    if (count < 0) {
      return Failure{fmt::format("cannot list the USB devices ({}): check /dev/bus/usb",
                                 libusb_error_name(static_cast<int>(count)))};
    }
    const DeviceList owner(list);
    for (libusb_device* const device : std::span(list, static_cast<std::size_t>(count))) {
      if (std::ranges::count(kinds_, id_of(device)) != 0) use(device);
    }
    return {};
  }

  UsbTransfer bulk(std::unique_ptr<PendingTransfer> pending, std::uint8_t endpoint, std::span<std::uint8_t> data,
                   Nanoseconds timeout) {
    if (handle_ == nullptr) return {UsbStatus::kGone};
    libusb_fill_bulk_transfer(pending->transfer, handle_, endpoint, pending->buffer.data(),
                              static_cast<int>(pending->buffer.size()), &PendingTransfer::finish, pending.get(),
                              milliseconds(timeout));
    return run(std::move(pending), 0, data, timeout);
  }

  /// Submits, waits, and copies what was read from `offset` on into `data`.
  UsbTransfer run(std::unique_ptr<PendingTransfer> pending, std::size_t offset, std::span<std::uint8_t> data,
                  Nanoseconds timeout) {
    if (is_interrupted_) return {UsbStatus::kInterrupted};
    if (libusb_submit_transfer(pending->transfer) != LIBUSB_SUCCESS) return {UsbStatus::kGone};

    // Wait until it is done, or interrupted, or libusb has forgotten it.
    auto deadline = UsbClock::now() + timeout + kTransferGrace;
    for (bool is_cancelled = false; pending->is_finished == 0;) {
      const bool is_over = UsbClock::now() >= deadline;
      if (is_over && is_cancelled) {
        static_cast<void>(pending.release());  // libusb may write into it yet: lost rather than corrupted
        return {is_interrupted_ ? UsbStatus::kInterrupted : UsbStatus::kGone};
      }
      if ((is_over || is_interrupted_) && !is_cancelled) {
        libusb_cancel_transfer(pending->transfer);
        is_cancelled = true;
        deadline = UsbClock::now() + kTransferGrace;
      }
      timeval slice = {0, 100'000};
      libusb_handle_events_timeout_completed(context_, &slice, &pending->is_finished);
    }

    if (is_interrupted_) return {UsbStatus::kInterrupted};
    const auto size = static_cast<std::size_t>(std::max(pending->transfer->actual_length, 0));
    const auto read = std::span(pending->buffer).subspan(offset);
    std::ranges::copy(read.first(std::min({size, data.size(), read.size()})), data.begin());
    return {status_of(pending->transfer->status), size};
  }

  static std::string explain(int error, const PluggedUsbDevice& device) {
    const std::string what = fmt::format("USB device {} at port {}", describe(device.id), device.port);
    switch (error) {
      case LIBUSB_ERROR_ACCESS:
        return fmt::format(
            "this user has no permission to open {} ({}): install config/udev/70-yuragi.rules, join the group plugdev, "
            "and plug the "
            "device in again",
            what, device.node);
      case LIBUSB_ERROR_BUSY:
        return fmt::format(
            "{} is in use by another program: stop that program, or remove the device from this configuration", what);
      case LIBUSB_ERROR_NO_DEVICE:
      case LIBUSB_ERROR_NOT_FOUND:
        return fmt::format("{} was unplugged: plug it in again", what);
      default:
        return fmt::format("cannot open {} ({}): plug it in again, at another port if necessary", what,
                           libusb_error_name(error));
    }
  }

  std::vector<UsbId> kinds_;
  std::atomic<libusb_context*> context_ = nullptr;
  std::atomic<bool> is_interrupted_ = false;
  libusb_device_handle* handle_ = nullptr;
  bool has_arrived_ = false;  // of the thread that handles events, which is the calling one
};

}  // namespace

std::string describe(const UsbId& id) {
  return fmt::format("{:04x}:{:04x}", id.vendor, id.product);
}

std::unique_ptr<UsbDevice> make_usb_device(std::vector<UsbId> kinds) {
  return std::make_unique<LibusbDevice>(std::move(kinds));
}

}  // namespace yuragi::drivers::bus
