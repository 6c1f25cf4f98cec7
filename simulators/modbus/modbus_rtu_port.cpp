#include <algorithm>

#include "simulators/core/pty.hpp"
#include "simulators/modbus/modbus_port.hpp"

namespace yuragi::simulators::modbus {
namespace {

class RtuPort final : public Port {
 public:
  explicit RtuPort(const std::string& link) : pty_(link) {}

  bool is_rtu() const override { return true; }
  std::string name() const override { return pty_.path(); }

  std::vector<int> descriptors() const override {
    return pty_.is_plugged_in() ? std::vector<int>{pty_.descriptor()} : std::vector<int>{};
  }

  std::vector<ClientRequest> receive(std::span<const int> ready) override {
    std::vector<ClientRequest> received;
    if (std::ranges::count(ready, pty_.descriptor()) == 0) return received;
    const auto bytes = pty_.read();
    incoming_.insert(incoming_.end(), bytes.begin(), bytes.end());
    while (const auto request = take_rtu_request(incoming_)) received.push_back({0, *request});
    return received;
  }

  void send(int /*client*/, std::span<const std::uint8_t> bytes) override { pty_.write(bytes); }

  void leave() override {
    pty_.unplug();
    incoming_.clear();
  }
  void come_back() override { pty_.plug_in(); }

 private:
  core::Pty pty_;
  Bytes incoming_;
};

}  // namespace

std::unique_ptr<Port> make_modbus_rtu_port(const std::string& link) {
  return std::make_unique<RtuPort>(link);
}

}  // namespace yuragi::simulators::modbus
