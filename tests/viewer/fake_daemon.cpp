// A stand-in for the daemon, to look at the viewer with: streams a meadow in a made-up wind until it is stopped.
//
//   fake_daemon [PORT [BLADES_A_SIDE [METRES]]] & yuragi-viewer --connect 127.0.0.1:PORT

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tests/viewer/test_meadow.hpp"

int main(int argc, char** argv) {
  using namespace yuragi;
  const auto argument = [&](int i, double otherwise) { return argc > i ? std::strtod(argv[i], nullptr) : otherwise; };
  const Skeleton meadow = test_meadow(static_cast<std::size_t>(argument(2, 100)), argument(3, 10.0));
  StreamServer server(greeting_for(meadow), static_cast<std::uint16_t>(argument(1, wire::kDefaultPort)));
  std::printf("on port %d\n", server.port());
  std::fflush(stdout);

  wire::FrameEncoder encoder;
  const auto began = std::chrono::steady_clock::now();
  for (std::uint64_t tick = 0;; ++tick) {
    const double time_s = static_cast<double>(tick) / 60.0;
    const double toward_deg = 100.0 + 15.0 * std::sin(0.2 * time_s);
    server.send(frame_of(meadow, test_pose(meadow, time_s, 0.15, 0.9, toward_deg), tick, time_s, toward_deg, encoder));
    if (tick % 30 == 0) {
      wire::Sensors sensors;
      sensors.sensors.resize(1);
      sensors.sensors[0].name = "mast";
      sensors.sensors[0].driver = "modbus";
      sensors.sensors[0].health = 1;
      sensors.sensors[0].speed_m_s = 6.1;
      sensors.sensors[0].direction_deg = 281.0;
      server.send(wire::encode(sensors));
    }
    std::this_thread::sleep_until(began + from_seconds(time_s + 1.0 / 60.0));
  }
}
