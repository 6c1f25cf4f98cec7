#include "viewer/quality.hpp"

#include <fmt/format.h>

namespace yuragi::viewer {

look::Quality quality_for(look::Quality wanted, bool is_software_renderer) {
  if (wanted != look::Quality::kAuto) return wanted;
  return is_software_renderer ? look::Quality::kLow : look::Quality::kHigh;
}

std::string quality_text(look::Quality quality, float drawn_side) {
  std::string text = "quality " + std::string(name_of(quality));
  if (quality == look::Quality::kLow) text += ": hard shadows, on the ground only; fewer, wider blades";
  if (quality == look::Quality::kMedium) text += ": coarser shadows, fewer blades";
  if (drawn_side < 1.0F) text += fmt::format("; {:.0f} % as wide and high, for the pace", 100.0F * drawn_side);
  return text;
}

}  // namespace yuragi::viewer
