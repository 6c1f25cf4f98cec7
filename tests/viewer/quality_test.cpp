#include "viewer/quality.hpp"

#include <gtest/gtest.h>

namespace yuragi::viewer {
namespace {

TEST(Quality, IsLowByItselfOnlyWithoutGraphicsHardware) {
  EXPECT_EQ(quality_for(look::Quality::kAuto, true), look::Quality::kLow);
  EXPECT_EQ(quality_for(look::Quality::kAuto, false), look::Quality::kHigh);
  EXPECT_EQ(quality_for(look::Quality::kHigh, true), look::Quality::kHigh);
}

TEST(Quality, SaysWhatItLeavesOut) {
  EXPECT_EQ(quality_text(look::Quality::kHigh), "quality high");
  EXPECT_EQ(quality_text(look::Quality::kLow), "quality low: hard shadows, on the ground only; fewer, wider blades");
  EXPECT_EQ(quality_text(look::Quality::kLow, 0.72F),
            "quality low: hard shadows, on the ground only; fewer, wider blades; 72 % as wide and high, for the pace");
}

}  // namespace
}  // namespace yuragi::viewer
