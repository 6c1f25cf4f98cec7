// Prints how far a joint of each scene of a configuration may move in a tick, metres: what the streamed poses are held
// against.
//
// usage: scene_bounds FILE.toml
#include <cstdio>
#include <exception>

#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/settings/config.hpp"

int main(int argc, char** argv) {
  using namespace yuragi;
  if (argc != 2) return 64;
  try {
    const daemon::settings::Config config = daemon::settings::load_config(argv[1]);
    const auto gusts = daemon::sensing::make_gust_noise(config);
    std::uint64_t seed = config.seed;
    for (const daemon::settings::SceneConfig& scene : config.scenes) {
      const auto made = scene.kind->make(scene.values, {.seed = seed++, .placement = scene.placement, .gusts = gusts});
      std::printf("%s %.9g\n", scene.name.c_str(), made->largest_joint_step_m(1.0 / config.animation.rate_hz));
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scene_bounds: %s\n", error.what());
    return 70;
  }
}
