// What the OSC simulator sends, as liblo reads it.
#include "simulators/network/osc_simulator.hpp"

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lo/lo.h>

#include "simulators/core/common_options.hpp"

namespace yuragi::simulators::network {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;

constexpr int kHang_ms = 60'000;

/// A server of liblo's, at a port that the system gives.
class LoServer {
 public:
  LoServer() : server_(lo_server_new(nullptr, nullptr)) {
    lo_server_add_method(server_.get(), nullptr, nullptr, &take, this);
  }

  std::uint16_t port() const { return static_cast<std::uint16_t>(lo_server_get_port(server_.get())); }
  /// Waits for the next message.
  void receive() { EXPECT_GT(lo_server_recv_noblock(server_.get(), kHang_ms), 0); }

  std::string address{};
  std::string types{};
  std::vector<float> numbers{};

 private:
  struct Freed {
    void operator()(lo_server server) const { lo_server_free(server); }
  };

  static int take(const char* path, const char* types, lo_arg** arguments, int count, lo_message, void* user) {
    auto& self = *static_cast<LoServer*>(user);
    self.address = path;
    self.types = types;
    self.numbers.clear();
    for (int i = 0; i < count; ++i) self.numbers.push_back(arguments[i]->f);
    return 0;
  }

  std::unique_ptr<std::remove_pointer_t<lo_server>, Freed> server_;
};

core::MeasuredWind constant_wind() {
  core::CommonOptions options;
  options.synthetic.mean_speed_m_s = 8.0;
  options.synthetic.turbulence_intensity = 0.0;
  options.synthetic.mean_direction_deg = 225.0;
  return options.make_wind();
}

TEST(OscSimulator, IsUnderstoodByTheLibrary) {
  LoServer server;
  OscSimulator simulator({.port = server.port(), .address = "/roof/wind", .speed_argument = 2, .direction_argument = 0},
                         constant_wind());
  simulator.serve({}, 0.0, std::nullopt);
  server.receive();
  EXPECT_EQ(server.address, "/roof/wind");
  EXPECT_EQ(server.types, "fff");
  EXPECT_THAT(server.numbers, ElementsAre(FloatNear(225.0F, 1e-3F), 0.0F, FloatNear(8.0F, 1e-3F)));
}

TEST(OscSimulator, SendsAtItsIntervalAndFailsOnDemand) {
  LoServer server;
  OscSimulator simulator({.port = server.port(), .interval_s = 0.5}, constant_wind());
  simulator.serve({}, 0.0, core::FaultKind::kSilence);
  simulator.serve({}, 0.1, core::FaultKind::kWrongId);
  server.receive();
  EXPECT_EQ(server.address, "/elsewhere");
  simulator.serve({}, 0.4, std::nullopt);  // not due
  simulator.serve({}, 0.6, std::nullopt);
  server.receive();
  EXPECT_EQ(server.address, "/wind");
  EXPECT_THAT(simulator.status(), testing::HasSubstr("2 messages"));
}

}  // namespace
}  // namespace yuragi::simulators::network
