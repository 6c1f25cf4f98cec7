// A stand-in for the daemon, to look at the viewer with: streams a meadow, or a model of every kind, in a made-up wind
// until it is stopped.
//
//   fake_daemon [PORT [BLADES_A_SIDE [METRES]]] & yuragi-viewer --connect 127.0.0.1:PORT
//   fake_daemon PORT garden                       each scene in turn fades out and in again

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string_view>
#include <thread>

#include "tests/viewer/test_meadow.hpp"
#include "tests/viewer/test_models.hpp"

namespace {

using namespace yuragi;

constexpr double kTurn_s = 6.0;  // of each scene to fade out and in again

wire::Bytes sensor_status() {
  wire::Sensors sensors;
  sensors.sensors.resize(1);
  sensors.sensors[0].name = "mast";
  sensors.sensors[0].driver = "modbus";
  sensors.sensors[0].health = wind::SourceHealth::kLive;
  sensors.sensors[0].speed_m_s = 6.1;
  sensors.sensors[0].direction_deg = 281.0;
  return wire::encode(sensors);
}

/// Sends what frame(tick, time_s) makes, 60 times a second, for ever.
[[noreturn]] void stream(viewer::StreamServer& server, const std::function<wire::Bytes(std::uint64_t, double)>& frame) {
  std::printf("on port %d\n", server.port());
  std::fflush(stdout);
  const auto began = std::chrono::steady_clock::now();
  for (std::uint64_t tick = 0;; ++tick) {
    const double time_s = static_cast<double>(tick) / 60.0;
    server.send(frame(tick, time_s));
    if (tick % 30 == 0) server.send(sensor_status());
    std::this_thread::sleep_until(began + from_seconds(time_s + 1.0 / 60.0));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int i, double otherwise) { return argc > i ? std::strtod(argv[i], nullptr) : otherwise; };
  const auto port = static_cast<std::uint16_t>(argument(1, wire::kDefaultPort));
  wire::FrameEncoder encoder;
  if (argc > 2 && std::string_view(argv[2]) == "garden") {
    const std::vector<wire::SceneModel> garden = viewer::test_garden();
    viewer::StreamServer server(viewer::greeting_for(garden), port);
    std::vector<float> opacities(garden.size(), 1.0F);
    stream(server, [&](std::uint64_t tick, double time_s) {
      const auto turn = static_cast<std::size_t>(time_s / kTurn_s) % garden.size();
      std::fill(opacities.begin(), opacities.end(), 1.0F);
      opacities[turn] = static_cast<float>(std::max(0.0, std::cos(2 * std::numbers::pi * time_s / kTurn_s)));
      return viewer::frame_of(garden, opacities, time_s, 0.5 + 0.4 * std::sin(0.3 * time_s), tick, encoder);
    });
  }
  const pose::Skeleton meadow = viewer::test_meadow(static_cast<std::size_t>(argument(2, 100)), argument(3, 10.0));
  viewer::StreamServer server(viewer::greeting_for(meadow), port);
  stream(server, [&](std::uint64_t tick, double time_s) {
    const double toward_deg = 100.0 + 15.0 * std::sin(0.2 * time_s);
    return viewer::frame_of(meadow, viewer::test_pose(meadow, time_s, 0.15, 0.9, toward_deg), tick, time_s, toward_deg,
                            encoder);
  });
}
