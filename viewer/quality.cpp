#include "viewer/quality.hpp"

namespace yuragi::viewer {

look::Quality quality_for(look::Quality wanted, bool is_software_renderer) {
  if (wanted != look::Quality::kAuto) return wanted;
  return is_software_renderer ? look::Quality::kLow : look::Quality::kHigh;
}

std::string quality_text(look::Quality quality) {
  std::string text = "quality " + std::string(name_of(quality));
  if (quality == look::Quality::kLow) text += ": hard shadows, on the ground only; fewer, wider blades";
  if (quality == look::Quality::kMedium) text += ": coarser shadows, fewer blades";
  return text;
}

}  // namespace yuragi::viewer
