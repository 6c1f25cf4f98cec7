#include <gtest/gtest.h>

#include "viewer/app/overlay.hpp"

namespace yuragi::viewer::app {
namespace {

TEST(OverlayScale, IsTheMonitorsOrWhatItsPixelsAskForOrAPersons) {
  const PixelSize hd{.width_px = 1920, .height_px = 1080};
  const PixelSize four_k{.width_px = 3840, .height_px = 2160};
  EXPECT_EQ(overlay_scale(1.0, hd, {}), 1.0);
  EXPECT_EQ(overlay_scale(1.0, {.width_px = 320, .height_px = 180}, {}), 1.0);
  EXPECT_EQ(overlay_scale(1.5, hd, {}), 1.5);
  EXPECT_EQ(overlay_scale(1.0, four_k, {}), 2.0) << "GLFW says 1.0 on many of them";
  EXPECT_EQ(overlay_scale(1.0, {.width_px = 2160, .height_px = 3840}, {}), 2.0);
  EXPECT_EQ(overlay_scale(1.0, four_k, 1.25), 1.25);
}

}  // namespace
}  // namespace yuragi::viewer::app
