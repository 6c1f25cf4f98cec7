#include <string>

#include "engine/math/philox.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {

std::uint64_t made_of(std::string_view kind, const ParameterValues& values, const Setup& setup) {
  std::string text(kind);
  const auto add = [&text](std::string_view name, const ParameterValue& value) {
    text.append("\n").append(name).append(" = ").append(value_text(value));
  };
  for (const auto& [name, value] : values.all()) add(name, value);
  text += "\n";
  add("seed", std::to_string(setup.seed));
  add("x", setup.placement.x_m);
  add("y", setup.placement.y_m);
  add("z", setup.placement.z_m);
  add("heading", setup.placement.heading_deg);
  if (setup.gusts) {
    const wind::turbulence::GustNoiseSettings& gusts = setup.gusts->settings();
    add("gusts seed", std::to_string(gusts.seed));
    add("gusts period", gusts.period_m);
    add("gusts samples", std::to_string(gusts.samples));
    add("gusts evolve", gusts.evolves);
  }
  return math::stream_id(text);
}

}  // namespace yuragi::scenes
