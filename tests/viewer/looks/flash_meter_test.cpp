#include "tests/viewer/looks/flash_meter.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 96;
constexpr int kHeight_px = 72;
constexpr double kRate_hz = 60.0;

using Color = std::array<std::uint8_t, 3>;

/// The screen's value of a grey of this relative luminance.
std::uint8_t grey(double luminance) {
  const double value = luminance <= 0.0031308 ? 12.92 * luminance : 1.055 * std::pow(luminance, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * value));
}
Color of(double luminance) {
  return {grey(luminance), grey(luminance), grey(luminance)};
}

/// Three seconds of pictures of which the first `columns` change between two colours so many times a second.
FlashMeter flashing(double flashes_hz, Color dark, Color bright, int columns = kWidth_px) {
  FlashMeter meter(kWidth_px, kHeight_px);
  for (int frame = 0; frame < 180; ++frame) {
    const double time_s = frame / kRate_hz;
    const bool is_bright = std::fmod(time_s * flashes_hz + 1e-6, 1.0) >= 0.5;
    std::vector<std::uint8_t> rgb;
    for (int i = 0; i < kWidth_px * kHeight_px; ++i) {
      const Color& color = is_bright && i % kWidth_px < columns ? bright : dark;
      rgb.insert(rgb.end(), color.begin(), color.end());
    }
    meter.add(rgb, time_s);
  }
  return meter;
}

TEST(FlashMeter, ThreeFlashesInASecondPassAndFourDoNot) {
  const FlashMeter three = flashing(3.0, of(0.2), of(0.4));
  EXPECT_EQ(three.general_share(), 0.0);
  EXPECT_FALSE(three.has_field_that_flashes());
  const FlashMeter four = flashing(4.0, of(0.2), of(0.4));
  EXPECT_EQ(four.general_share(), 1.0);
  EXPECT_TRUE(four.has_field_that_flashes());
}

TEST(FlashMeter, SmallChangesAndThoseOfBrightPicturesPass) {
  EXPECT_EQ(flashing(10.0, of(0.2), of(0.29)).general_share(), 0.0);
  EXPECT_EQ(flashing(10.0, of(0.82), of(1.0)).general_share(), 0.0);
  EXPECT_EQ(flashing(10.0, of(0.78), of(1.0)).general_share(), 1.0);
}

TEST(FlashMeter, AQuarterOfAFieldPasses) {
  // A field is 31 columns wide.
  EXPECT_LT(flashing(10.0, of(0.2), of(0.4), 7).general_share(), 0.25);
  EXPECT_GT(flashing(10.0, of(0.2), of(0.4), 8).general_share(), 0.25);
}

TEST(FlashMeter, SaturatedRedCountsWhereLuminanceDoesNot) {
  const Color dark_red{90, 0, 0};
  const Color red{140, 0, 0};  // relative luminance 0.02 and 0.055
  EXPECT_EQ(flashing(4.0, dark_red, red).general_share(), 0.0);
  EXPECT_EQ(flashing(4.0, dark_red, red).red_share(), 1.0);
  EXPECT_EQ(flashing(3.0, dark_red, red).red_share(), 0.0);
  EXPECT_EQ(flashing(4.0, {90, 70, 60}, {140, 110, 90}).red_share(), 0.0);  // brown
}

TEST(FlashMeter, ASlowFireIsNotToldFromItsPixelsAlone) {
  // Each quarter of the columns flashes three times a second, one after the other: no pixel does more often, the
  // whole field does.
  FlashMeter meter(kWidth_px, kHeight_px);
  for (int frame = 0; frame < 180; ++frame) {
    const double time_s = frame / kRate_hz;
    std::vector<std::uint8_t> rgb;
    for (int i = 0; i < kWidth_px * kHeight_px; ++i) {
      const double phase = time_s * 3.0 - (i % kWidth_px % 4) / 4.0 + 1e-6;
      const std::uint8_t value = grey(phase - std::floor(phase) < 0.125 ? 0.9 : 0.1);
      rgb.insert(rgb.end(), {value, value, value});
    }
    meter.add(rgb, time_s);
  }
  EXPECT_EQ(meter.general_share(), 0.0);
  EXPECT_TRUE(meter.has_field_that_flashes());
}

}  // namespace
}  // namespace yuragi::viewer
