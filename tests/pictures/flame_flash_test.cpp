// The flame as large as the picture, by night, in every wind: it may not flash (WCAG 2.2, success criterion 2.3.1).

#include <gtest/gtest.h>

#include "engine/look/look.hpp"
#include "tests/pictures/scenes_in_wind.hpp"
#include "tests/viewer/looks/flash_meter.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/looks/stage.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 64;
constexpr int kHeight_px = 48;
constexpr double kRate_hz = 60.0;
constexpr int kPictures = 80;  // a second and a third
constexpr double kSettling_s = 6.0;
constexpr double kMostShare = 0.25;  // of a field, W3C

class FlameFlash : public testing::TestWithParam<Weather> {};

/// A second and more of it. (What it shines on cannot flash: FireFlickerTest.)
FlashMeter seen(const Weather& weather) {
  const gl::HeadlessContext context({.is_software = true, .has_messages = true});
  looks::Stage stage;
  stage.set_light(
      light::light_of(look::edited({}, std::vector<std::string>{"sun=fixed", "sun_height=-15"}).value(), 0.0));
  stage.set_quality(look::Quality::kLow);
  gl::RenderTarget target(kWidth_px, kHeight_px, 1);
  ScenesInWind scenes("flame", weather.speed_m_s);
  scenes.advance(kSettling_s);
  stage.set_scenes(scenes.models());
  meshes::OrbitCamera camera;
  camera.frame({.target_m = {0.0, 0.85, 0.0}, .heading_deg = 340.0, .pitch_deg = 4.0, .distance_m = 1.1});
  FlashMeter meter(kWidth_px, kHeight_px);
  for (int picture = 0; picture < kPictures; ++picture) {
    scenes.advance(1.0 / kRate_hz);
    stage.draw(scenes.moment(), camera, target);
    meter.add(target.read_rgb(), picture / kRate_hz);
  }
  return meter;
}

TEST_P(FlameFlash, FlashesNoMoreThanThreeTimesInASecond) {
  const FlashMeter meter = seen(GetParam());
  EXPECT_LE(meter.general_share(), kMostShare);
  EXPECT_LE(meter.red_share(), kMostShare);
  EXPECT_FALSE(meter.has_field_that_flashes());
  RecordProperty("general_share", std::to_string(meter.general_share()));
  RecordProperty("red_share", std::to_string(meter.red_share()));
}

INSTANTIATE_TEST_SUITE_P(Winds, FlameFlash, testing::ValuesIn(kWeathers),
                         [](const auto& weather) { return std::string(weather.param.name); });

}  // namespace
}  // namespace yuragi::viewer
