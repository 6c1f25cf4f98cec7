#include "viewer/brightness.hpp"

#include <gtest/gtest.h>

#include "viewer/black_rest.hpp"

namespace yuragi::viewer {
namespace {

TEST(Brightness, ComesAndGoesWithoutAJumpAndBecomesBlack) {
  Brightness brightness(0.0);
  double before = 0.0;
  for (int picture = 0; picture < 240; ++picture) {
    brightness.advance(1.0, 1.0 / 60);
    EXPECT_GE(brightness.value(), before);
    EXPECT_LT(brightness.value() - before, 0.05);
    before = brightness.value();
  }
  EXPECT_GT(before, 0.999);
  for (int picture = 0; picture < 240; ++picture) brightness.advance(0.0, 1.0 / 60);
  EXPECT_EQ(brightness.value(), 0.0);
}

TEST(Brightness, IsThereAtOnceAfterItsTime) {
  Brightness brightness(0.0);
  brightness.advance(0.3, Brightness::kTime_s);
  EXPECT_DOUBLE_EQ(brightness.value(), 0.3);
  brightness.advance(0.8, 100.0);
  EXPECT_DOUBLE_EQ(brightness.value(), 0.8);
}

constexpr PixelSize kSize{.width_px = 640, .height_px = 480};

TEST(BlackRest, ShowsOneBlackPictureAndAnotherNowAndThen) {
  BlackRest rest;
  int shown = 0;
  for (int look = 0; look < 200; ++look) shown += rest.may_rest(true, kSize, 0.05 * look) ? 0 : 1;
  EXPECT_NEAR(shown, 20, 1) << "in 10 s";
}

TEST(BlackRest, WakesAtOnceForAPictureAndForAnotherSize) {
  BlackRest rest;
  EXPECT_FALSE(rest.may_rest(true, kSize, 0.0));
  EXPECT_TRUE(rest.may_rest(true, kSize, 0.01));
  EXPECT_FALSE(rest.may_rest(false, kSize, 0.02));
  EXPECT_FALSE(rest.may_rest(false, kSize, 0.03)) << "each picture that is not black is shown";
  EXPECT_FALSE(rest.may_rest(true, kSize, 0.04)) << "the first that is black again";
  EXPECT_TRUE(rest.may_rest(true, kSize, 0.05));
  EXPECT_FALSE(rest.may_rest(true, {.width_px = 800, .height_px = 600}, 0.06));
}

}  // namespace
}  // namespace yuragi::viewer
