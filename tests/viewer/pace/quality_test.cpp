#include "viewer/pace/quality.hpp"

#include <gtest/gtest.h>

namespace yuragi::viewer::pace {
namespace {

TEST(Quality, IsLowByItselfOnlyWithoutGraphicsHardware) {
  EXPECT_EQ(quality_for(look::Quality::kAuto, true), look::Quality::kLow);
  EXPECT_EQ(quality_for(look::Quality::kAuto, false), look::Quality::kHigh);
  EXPECT_EQ(quality_for(look::Quality::kHigh, true), look::Quality::kHigh);
}

TEST(Quality, SaysWhatItLeavesOut) {
  EXPECT_EQ(quality_text(look::Quality::kHigh), "quality high");
  EXPECT_EQ(quality_text(look::Quality::kLow), "quality low: hard shadows, on the ground only; fewer, wider blades");
  EXPECT_EQ(
      quality_text(look::Quality::kLow, Ladder::kParts[1]),
      "quality low: hard shadows, on the ground only; fewer, wider blades; for the pace 72 % as wide and high, 70 % of "
      "the blades, trees, cloth, water and shadows 1.2 times as coarse");
  EXPECT_EQ(quality_text(look::Quality::kMedium, {}, 2),
            "quality medium: coarser shadows, fewer blades; a picture for every 2 refreshes of the display");
}

}  // namespace
}  // namespace yuragi::viewer::pace
