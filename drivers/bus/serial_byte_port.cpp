// A serial port, which Boost.Asio opens and sets up: raw, 8-bit clean, no flow control, modem lines ignored. What it
// does not do is done here: locks, and forgetting what came before.
#include <cerrno>
#include <system_error>

#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>

#include "drivers/bus/descriptor_port.hpp"
#include "engine/base/close_on_exec.hpp"

namespace yuragi::drivers::bus {
namespace {

using boost::asio::serial_port;
using boost::asio::serial_port_base;

serial_port_base::parity parity_of(char letter) {
  if (letter == 'E') return serial_port_base::parity(serial_port_base::parity::even);
  if (letter == 'O') return serial_port_base::parity(serial_port_base::parity::odd);
  return serial_port_base::parity(serial_port_base::parity::none);
}

serial_port_base::stop_bits stop_bits_of(int count) {
  return serial_port_base::stop_bits(count == 2 ? serial_port_base::stop_bits::two : serial_port_base::stop_bits::one);
}

std::string remedy_of(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "check that it is plugged in, and its name (ls -l /dev/serial/by-id)";
    case EACCES:
    case EPERM:
      return "add the user that Yuragi runs as to the group that owns it, usually dialout (sudo usermod -aG dialout "
             "USER)";
    case EBUSY:
    case EWOULDBLOCK:
      return "another program has it open; find that with \"fuser -v\", it is often gpsd, ModemManager or a terminal";
    case ENOTTY:
      return "it is not a serial port";
    case EINVAL:
      return "it does not support this rate or these bits";
    default:
      return "check its name and cable, and plug it in again";
  }
}

class SerialBytePort final : public DescriptorPort {
 public:
  using DescriptorPort::DescriptorPort;
  ~SerialBytePort() override { SerialBytePort::close(); }
  SerialBytePort(const SerialBytePort&) = delete;
  SerialBytePort& operator=(const SerialBytePort&) = delete;

  Result<void, Failure> open() override {
    close();
    if (interruption().is_set()) return Failure{"interrupted"};
    if (const boost::system::error_code error = open_alone()) {
      close();
      return Failure{"cannot open " + describe(address()) + " (" + error.message() + "): " + remedy_of(error.value())};
    }
    return {};
  }

  void close() noexcept override {
    if (!port_.is_open()) return;
    // Others may hold the port for longer than we do, and shall find it unlocked; but not by us if it was theirs.
    if (is_ours_) {
      ioctl(port_.native_handle(), TIOCNXCL);
      tcflush(port_.native_handle(), TCOFLUSH);
    }
    is_ours_ = false;
    boost::system::error_code ignored;
    port_.close(ignored);
  }

 protected:
  int descriptor() noexcept override { return port_.is_open() ? port_.native_handle() : -1; }

 private:
  boost::system::error_code open_alone() {
    boost::system::error_code error;
    if (port_.open(address().path, error)) return error;

    // No other program may read: each would get a part of the bytes.
    const int handle = port_.native_handle();
    close_on_exec(handle);
    if (flock(handle, LOCK_EX | LOCK_NB) != 0 || ioctl(handle, TIOCEXCL) != 0) {
      return {errno, boost::system::system_category()};
    }
    is_ours_ = true;

    const auto& wanted = address();
    if (port_.set_option(serial_port_base::baud_rate(static_cast<unsigned>(wanted.baud)), error)) return error;
    if (port_.set_option(serial_port_base::character_size(static_cast<unsigned>(wanted.data_bits)), error))
      return error;
    if (port_.set_option(parity_of(wanted.parity), error)) return error;
    if (port_.set_option(stop_bits_of(wanted.stop_bits), error)) return error;
    using FlowControl = serial_port_base::flow_control;
    if (port_.set_option(FlowControl(FlowControl::none), error)) return error;

    // The age of bytes that were already waiting is unknown.
    if (tcflush(handle, TCIFLUSH) != 0) return {errno, boost::system::system_category()};
    return {};
  }

  boost::asio::io_context context_;
  serial_port port_{context_};
  bool is_ours_ = false;
};

}  // namespace

std::unique_ptr<BytePort> make_serial_port(const BytePortAddress& address) {
  return std::make_unique<SerialBytePort>(address);
}

}  // namespace yuragi::drivers::bus
