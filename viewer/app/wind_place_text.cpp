#include "viewer/app/wind_place_text.hpp"

#include <fmt/format.h>

namespace yuragi::viewer::app {

std::string wind_place_text(const wind::State& wind) {
  if (!wind.is_place_configured && wind.upwind_m == 0.0) return {};
  const std::string where = wind.is_place_configured ? "at the sensors" : "at the edge";
  const auto number = [](double value) { return fmt::format("{:.{}f}", value, value < 9.95 ? 1 : 0); };
  if (wind.to_middle_s > 0.0) return where + fmt::format(", {} s to the middle", number(wind.to_middle_s));
  if (wind.upwind_m <= -0.05) return where + fmt::format(", {} m downwind", number(-wind.upwind_m));
  return where;
}

}  // namespace yuragi::viewer::app
