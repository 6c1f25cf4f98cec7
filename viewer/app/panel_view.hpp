#pragma once

#include "viewer/app/panel.hpp"

namespace yuragi::viewer::app {

inline constexpr float kPanelWidthInLetters = 30.0F;

/// Draws the panel within a window of ImGui, as wide as that is, and sends it what a person has moved. What cannot be
/// set is shown without a handle.
void draw_panel(Panel& panel);

}  // namespace yuragi::viewer::app
