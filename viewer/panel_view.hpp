#pragma once

#include "viewer/panel.hpp"

namespace yuragi::viewer {

/// Draws the panel with ImGui, within a frame of it, at the right edge of the picture, and tells it what a person has
/// moved. What cannot be set is shown without a handle.
void draw_panel(Panel& panel);

}  // namespace yuragi::viewer
