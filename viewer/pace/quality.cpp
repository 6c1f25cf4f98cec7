#include "viewer/pace/quality.hpp"

#include <fmt/format.h>

namespace yuragi::viewer::pace {

look::Quality quality_for(look::Quality wanted, bool is_software_renderer) {
  if (wanted != look::Quality::kAuto) return wanted;
  return is_software_renderer ? look::Quality::kLow : look::Quality::kHigh;
}

std::string quality_text(look::Quality quality, const DrawnPart& drawn, int refreshes) {
  std::string text = "quality " + std::string(name_of(quality));
  if (quality == look::Quality::kLow) text += ": hard shadows, on the ground only; fewer, wider blades";
  if (quality == look::Quality::kMedium) text += ": coarser shadows, fewer blades";
  if (drawn != DrawnPart{}) {
    text += fmt::format(
        "; for the pace {:.0f} % as wide and high, {:.0f} % of the blades, trees, cloth, water and shadows {:.1f} "
        "times as coarse",
        100.0F * drawn.side, 100.0F * drawn.blades, drawn.coarseness);
  }
  if (refreshes > 1) text += fmt::format("; a picture for every {} refreshes of the display", refreshes);
  return text;
}

}  // namespace yuragi::viewer::pace
