#pragma once

#include "viewer/app/panel.hpp"

namespace yuragi::viewer::app {

inline constexpr float kPanelWidthInLetters = 30.0F;

/// Draws the panel in the current window of ImGui, with its width, and passes on what a person has set. Values that
/// cannot be set are shown without a handle.
void draw_panel(Panel& panel);

}  // namespace yuragi::viewer::app
