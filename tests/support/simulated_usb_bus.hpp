#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/bus/usb_device.hpp"
#include "simulators/usb/usb_device.hpp"
#include "tests/support/manual_clock.hpp"

namespace yuragi {

/// A USB bus in the test's own process: simulated devices in its sockets, in a wind that the test makes, by the clock
/// that the test moves. What waits for its time-out moves the clock on by it.
struct SimulatedUsbBus {
  struct Socket {
    std::string port;
    std::string serial;  ///< as the bus shows it
    std::unique_ptr<simulators::usb::Device> device;
  };

  explicit SimulatedUsbBus(ManualClock& its_clock) : clock(its_clock) {}

  ManualClock& clock;
  std::vector<Socket> sockets;
  simulators::core::PlayedMoment wind = {5.0, 90.0};
  std::optional<simulators::core::FaultKind> fault;  ///< of every device
  bool is_permitted = true;
  bool has_arrived = false;
  Nanoseconds transfer_time{0};  ///< each transfer takes so long; what it brings is from its beginning
  int opened = 0;
  int transfers = 0;
  bool is_interrupted = false;
  MonoTime start = clock.now().mono;

  bool is_unplugged() const { return fault == simulators::core::FaultKind::kUnplug; }
  bool is_silent() const { return fault == simulators::core::FaultKind::kSilence; }

  /// All devices go on to the clock's time.
  void advance() {
    simulators::core::PlayedMoment measured = wind;
    if (fault == simulators::core::FaultKind::kSpike) measured.speed_m_s = 55.0;
    for (Socket& socket : sockets) socket.device->advance(seconds(clock.now().mono - start), measured, fault);
  }
};

/// A driver's way onto it.
class SimulatedUsbDevice final : public drivers::bus::UsbDevice {
 public:
  explicit SimulatedUsbDevice(SimulatedUsbBus& bus) : bus_(bus) {}

  Result<std::vector<drivers::bus::PluggedUsbDevice>, Failure> plugged() override {
    std::vector<drivers::bus::PluggedUsbDevice> all;
    if (bus_.is_unplugged()) return all;
    for (const auto& socket : bus_.sockets) {
      const simulators::usb::Bytes& bytes = socket.device->descriptors().device;
      const auto id = [&bytes](std::size_t at) { return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U); };
      all.push_back({.id = {id(8), id(10)},
                     .port = socket.port,
                     .serial = socket.serial,
                     .node = "/dev/bus/usb/001/001",
                     .is_permitted = bus_.is_permitted});
    }
    return all;
  }

  bool take_arrival() override { return std::exchange(bus_.has_arrived, false); }

  Result<void, Failure> open(const drivers::bus::PluggedUsbDevice& device) override {
    if (!bus_.is_permitted) return Failure{"this user has no permission to open it"};
    const auto found = std::ranges::find(bus_.sockets, device.port, &SimulatedUsbBus::Socket::port);
    if (found == bus_.sockets.end()) return Failure{"it is gone"};
    open_ = found->device.get();
    ++bus_.opened;
    return {};
  }
  void close() noexcept override { open_ = nullptr; }

  drivers::bus::UsbTransfer control(const drivers::bus::UsbRequest& request, std::span<std::uint8_t> data,
                                    Nanoseconds timeout) override {
    if (!begin()) return {drivers::bus::UsbStatus::kGone};
    if (bus_.is_silent()) return time_out(timeout);
    const auto reply = open_->control(
        {request.request_type, request.request, request.value, request.index, static_cast<std::uint16_t>(data.size())},
        data);
    return reply ? copy(*reply, data) : drivers::bus::UsbTransfer{drivers::bus::UsbStatus::kStalled};
  }

  drivers::bus::UsbTransfer read(std::uint8_t endpoint, std::span<std::uint8_t> data, Nanoseconds timeout) override {
    if (!begin()) return {drivers::bus::UsbStatus::kGone};
    const auto reply = bus_.is_silent() ? std::nullopt : open_->in(endpoint, data.size());
    return reply ? copy(*reply, data) : time_out(timeout);
  }

  drivers::bus::UsbTransfer write(std::uint8_t endpoint, std::span<const std::uint8_t> data,
                                  Nanoseconds /*timeout*/) override {
    if (!begin()) return {drivers::bus::UsbStatus::kGone};
    return open_->out(endpoint, data) ? drivers::bus::UsbTransfer{drivers::bus::UsbStatus::kDone, data.size()}
                                      : drivers::bus::UsbTransfer{drivers::bus::UsbStatus::kStalled};
  }

  void interrupt() noexcept override { bus_.is_interrupted = true; }

 private:
  bool begin() {
    ++bus_.transfers;
    bus_.advance();
    bus_.clock.advance(bus_.transfer_time);
    return open_ != nullptr && !bus_.is_unplugged();
  }
  drivers::bus::UsbTransfer time_out(Nanoseconds timeout) {
    bus_.clock.advance(timeout);
    return {drivers::bus::UsbStatus::kTimeout};
  }
  static drivers::bus::UsbTransfer copy(const simulators::usb::Bytes& reply, std::span<std::uint8_t> data) {
    const std::size_t size = std::min(reply.size(), data.size());
    std::copy_n(reply.begin(), size, data.begin());
    return {reply.size() > data.size() ? drivers::bus::UsbStatus::kOverflow : drivers::bus::UsbStatus::kDone, size};
  }

  SimulatedUsbBus& bus_;
  simulators::usb::Device* open_ = nullptr;
};

}  // namespace yuragi
