#pragma once

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <modbus/modbus.h>
#include <poll.h>
#include <pty.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <termios.h>

#include "tests/support/descriptor.hpp"

namespace yuragi {

/// A serial port with the test at its far end.
class SerialPort {
 public:
  SerialPort() {
    int far_end = -1;
    int port = -1;
    std::array<char, 128> name{};
    if (openpty(&far_end, &port, name.data(), nullptr, nullptr) != 0) throw std::runtime_error("no pseudo terminal");
    far_end_ = Descriptor(far_end);
    port_ = Descriptor(port);
    device_ = name.data();
    termios raw{};
    tcgetattr(port, &raw);
    cfmakeraw(&raw);
    tcsetattr(port, TCSANOW, &raw);
  }

  int far_end() const { return far_end_.get(); }
  const std::string& device() const { return device_; }

 private:
  Descriptor far_end_;
  Descriptor port_;  // held open, so that the line survives whoever closes the device
  std::string device_;
};

/// An RS-485 line: what one party sends, all others hear. The parties are the port of device(), libmodbus's own RTU
/// servers, and, if the test wants it, whoever opens another_device().
class SerialBus {
 public:
  struct Device {
    int slave;
    std::vector<std::uint16_t> registers;
  };

  explicit SerialBus(const std::vector<Device>& devices, bool has_another_port = false) {
    if (has_another_port) another_port_.emplace();
    for (const Device& device : devices) {
      std::array<int, 2> ends{};
      if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) throw std::runtime_error("no socket pair");
      taps_.emplace_back(ends[0]);
      threads_.emplace_back([device, end = ends[1]] { serve(device, Descriptor(end)); });
    }
    threads_.emplace_back([this] { carry(); });
  }
  ~SerialBus() {
    eventfd_write(wake_.get(), 1);
    for (const Descriptor& tap : taps_) shutdown(tap.get(), SHUT_RDWR);
    for (std::thread& thread : threads_) thread.join();
  }
  SerialBus(const SerialBus&) = delete;
  SerialBus& operator=(const SerialBus&) = delete;

  const std::string& device() const { return port_.device(); }
  const std::string& another_device() const { return another_port_.value().device(); }

 private:
  /// At the end the parties hang up in no order; who still writes shall see an error, not a signal.
  static void block_broken_pipe_signal() {
    sigset_t signals{};
    sigemptyset(&signals);
    sigaddset(&signals, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  }

  /// The line itself.
  void carry() const {
    block_broken_pipe_signal();
    std::vector<pollfd> ends = {{wake_.get(), POLLIN, 0}, {port_.far_end(), POLLIN, 0}};
    if (another_port_) ends.push_back({another_port_->far_end(), POLLIN, 0});
    for (const Descriptor& tap : taps_) ends.push_back({tap.get(), POLLIN, 0});
    for (;;) {
      poll(ends.data(), ends.size(), -1);
      if (ends[0].revents != 0) return;
      for (std::size_t from = 1; from < ends.size(); ++from) {
        std::array<char, 256> bytes{};
        const ssize_t size = ends[from].revents != 0 ? read(ends[from].fd, bytes.data(), bytes.size()) : 0;
        for (std::size_t to = 1; size > 0 && to < ends.size(); ++to) {
          if (to != from && write(ends[to].fd, bytes.data(), static_cast<std::size_t>(size)) != size) return;
        }
      }
    }
  }

  static void serve(const Device& device, Descriptor line) {
    block_broken_pipe_signal();
    const std::unique_ptr<modbus_t, void (*)(modbus_t*)> context(modbus_new_rtu("unused", 9600, 'N', 8, 1),
                                                                 modbus_free);
    const std::unique_ptr<modbus_mapping_t, void (*)(modbus_mapping_t*)> mapping(
        modbus_mapping_new(0, 0, static_cast<int>(device.registers.size()), 0), modbus_mapping_free);
    std::ranges::copy(device.registers, mapping->tab_registers);
    modbus_set_slave(context.get(), device.slave);
    modbus_set_socket(context.get(), line.get());

    std::array<std::uint8_t, MODBUS_RTU_MAX_ADU_LENGTH> request{};
    for (int size = 0; size >= 0;) {
      size = modbus_receive(context.get(), request.data());
      if (size > 0) modbus_reply(context.get(), request.data(), size, mapping.get());
    }
  }

  SerialPort port_;
  std::optional<SerialPort> another_port_;
  Descriptor wake_{eventfd(0, 0)};
  std::vector<Descriptor> taps_;
  std::vector<std::thread> threads_;
};

}  // namespace yuragi
