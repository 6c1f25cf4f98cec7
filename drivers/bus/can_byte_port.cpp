// Frames of a CAN interface, as the lines that candump -L writes (can-utils): text, as of the gateways to such a bus,
// so that a person, a log and `yuragi decode` read them alike. The socket is one of the kernel's (CAN_RAW), which
// passes on only the frames of the filter, and the error frames of the interface's controller.
#include <algorithm>
#include <cerrno>
#include <utility>

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/bus/can_interfaces.hpp"
#include "drivers/bus/can_socket.hpp"
#include "drivers/bus/descriptor_port.hpp"

namespace yuragi::drivers::bus {
namespace {

template <class Value>
bool set_raw(int socket, int option, const Value& value) {
  return setsockopt(socket, SOL_CAN_RAW, option, &value, sizeof value) == 0;
}

/// Returns true if it receives; otherwise errno has the reason.
bool listen_at(int socket, const BytePortAddress& address) {
  const can_filter wanted = {.can_id = address.can.identifier | CAN_EFF_FLAG,
                             .can_mask = address.can.mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
  const can_err_mask_t told = CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
  if (!set_raw(socket, CAN_RAW_FILTER, wanted) || !set_raw(socket, CAN_RAW_ERR_FILTER, told)) return false;

  sockaddr_can place{};
  place.can_family = AF_CAN;
  place.can_ifindex = static_cast<int>(if_nametoindex(address.path.c_str()));
  if (place.can_ifindex == 0) return false;
  if (bind(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) return false;

  // An interface that is down can be bound to: then that is an error that is pending.
  int pending = 0;
  socklen_t size = sizeof pending;
  if (getsockopt(socket, SOL_SOCKET, SO_ERROR, &pending, &size) == 0 && pending != 0) errno = pending;
  return pending == 0;
}

std::string line_of(const std::string& interface, const can_frame& frame) {
  const canid_t mask = (frame.can_id & CAN_ERR_FLAG) != 0 ? CAN_ERR_MASK | CAN_ERR_FLAG : CAN_EFF_MASK;
  std::string line = fmt::format("{} {:08X}#", interface, frame.can_id & mask);
  for (std::size_t i = 0; i < std::min<std::size_t>(frame.can_dlc, CAN_MAX_DLEN); ++i)
    line += fmt::format("{:02X}", frame.data[i]);
  return line;
}

class CanBytePort final : public DescriptorPort {
 public:
  CanBytePort(const BytePortAddress& address, OpenCanSocket open_socket)
      : DescriptorPort(address), open_socket_(std::move(open_socket)) {}
  ~CanBytePort() override { CanBytePort::close(); }
  CanBytePort(const CanBytePort&) = delete;
  CanBytePort& operator=(const CanBytePort&) = delete;

  Result<void, Failure> open() override {
    close();
    if (interruption().is_set()) return Failure{"interrupted"};
    socket_ = open_socket_(address());
    if (socket_ < 0) return Failure{can_trouble(address().path, errno)};
    return {};
  }

  void close() noexcept override {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }

  ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    can_frame frame{};
    const std::span<std::uint8_t> bytes(reinterpret_cast<std::uint8_t*>(&frame), sizeof frame);
    ByteArrival arrival = DescriptorPort::read(bytes, timeout);
    if (arrival.status != ByteStatus::kBytes) return arrival;
    if (arrival.size != CAN_MTU) return {};
    const std::string line = line_of(address().path, frame);
    arrival.size = std::min(line.size(), buffer.size());
    std::copy_n(line.begin(), arrival.size, buffer.begin());
    arrival.is_whole_datagram = true;
    return arrival;
  }

  /// Always returns false: Yuragi sends nothing on a bus to which it only listens.
  bool write(std::span<const std::uint8_t> /*bytes*/) override { return false; }

 protected:
  int descriptor() noexcept override { return socket_; }

 private:
  OpenCanSocket open_socket_;
  int socket_ = -1;
};

}  // namespace

int open_can_socket(const BytePortAddress& address) {
  const int opened = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (opened < 0 || listen_at(opened, address)) return opened;
  const int error = errno;
  close(opened);
  errno = error;
  return -1;
}

std::unique_ptr<BytePort> make_can_port(const BytePortAddress& address, OpenCanSocket open_socket) {
  return std::make_unique<CanBytePort>(address, std::move(open_socket));
}

}  // namespace yuragi::drivers::bus
