// A CAN interface of the kernel, real or virtual (vcan). It takes frames in the kernel's format (linux/can.h), 16 bytes
// each.
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include "simulators/text/text_wire.hpp"

namespace yuragi::simulators::text {
namespace {

class CanWire final : public Wire {
 public:
  explicit CanWire(const std::string& interface) : interface_(interface) {
    if (!connect()) {
      throw std::runtime_error(fmt::format("--can {}: {}", interface, std::generic_category().message(errno)));
    }
  }
  ~CanWire() override { CanWire::take_away(); }
  CanWire(const CanWire&) = delete;
  CanWire& operator=(const CanWire&) = delete;

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override { return {}; }
  std::string read(std::span<const int> /*ready*/) override { return {}; }

  /// Writes one frame; ignores bytes that are not one. Searches again each time for an interface that has disappeared.
  void write(std::string_view bytes) override {
    if (bytes.size() != CAN_MTU) return;
    if (socket_ < 0 && !connect()) return;
    if (::write(socket_, bytes.data(), bytes.size()) < 0 && errno != EAGAIN && errno != ENOBUFS) take_away();
  }
  void take_away() override {
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  void bring_back() override {
    if (socket_ < 0) connect();
  }
  std::string place() const override { return "sending to CAN interface " + interface_; }

 private:
  /// Returns false on failure, with the reason in errno.
  bool connect() {
    sockaddr_can place{};
    place.can_family = AF_CAN;
    place.can_ifindex = static_cast<int>(if_nametoindex(interface_.c_str()));
    if (place.can_ifindex == 0) return false;
    socket_ = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
    if (socket_ < 0) return false;
    // It receives nothing: without a filter no frame arrives.
    const bool is_bound = setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) == 0 &&
                          bind(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
    if (is_bound) return true;
    const int error = errno;
    take_away();
    errno = error;
    return false;
  }

  std::string interface_;
  int socket_ = -1;
};

}  // namespace

std::unique_ptr<Wire> make_can_wire(const std::string& interface) {
  return std::make_unique<CanWire>(interface);
}

}  // namespace yuragi::simulators::text
