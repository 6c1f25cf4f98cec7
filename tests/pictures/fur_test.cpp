// How deep a drawn coat is.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/scenes_in_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/looks/stage.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;

/// The luminance of each pixel of a picture.
using Greys = std::vector<double>;

/// A scene in its wind, seen from one place in the light of the sun from one side.
class CoatPicture {
 public:
  CoatPicture(const daemon::settings::Config& config, double sun_azimuth_deg, const meshes::CameraPlace& camera)
      : scenes_(config) {
    const std::vector<std::string> sun{"sun=fixed", "sun_height=25", fmt::format("sun_azimuth={}", sun_azimuth_deg)};
    stage_.set_light(light::light_of(look::edited({}, sun).value(), 0.0));
    stage_.set_quality(look::Quality::kLow);
    scenes_.advance(8.0);
    stage_.set_scenes(scenes_.models());
    camera_.frame(camera);
  }

  Greys draw() {
    stage_.draw(scenes_.moment(), camera_, target_);
    const std::vector<std::uint8_t> rgb = target_.read_rgb();
    Greys greys;
    for (std::size_t at = 0; at < rgb.size(); at += 3) {
      greys.push_back(0.2126 * rgb[at] + 0.7152 * rgb[at + 1] + 0.0722 * rgb[at + 2]);
    }
    return greys;
  }

 private:
  gl::HeadlessContext context_{{.is_software = true, .has_messages = true}};
  looks::Stage stage_;
  gl::RenderTarget target_{kWidth_px, kHeight_px, 1};
  ScenesInWind scenes_;
  meshes::OrbitCamera camera_;
};

TEST(FurPicture, IsDarkBetweenItsHairs) {
  // From near by hairs can be told apart: the darkest tenth of the lower half is what lies deep.
  const daemon::settings::Config config =
      daemon::settings::parse_config("[wind]\ndefault_speed = 0.0\n[[scene]]\nkind = \"fur\"\n", "fur");
  CoatPicture coat(config, 240.0,
                   {.target_m = {0.0, 0.6, 0.0}, .heading_deg = 210.0, .pitch_deg = 12.0, .distance_m = 2.2});
  Greys greys = coat.draw();
  greys.erase(greys.begin(), greys.begin() + static_cast<std::ptrdiff_t>(greys.size() / 2));
  std::sort(greys.begin(), greys.end());
  const double dark = greys[greys.size() / 10];
  const double middle = greys[greys.size() / 2];
  std::printf("fur: the darkest tenth %.1f, the middle %.1f\n", dark, middle);
  EXPECT_LE(dark, 0.62 * middle);
}

}  // namespace
}  // namespace yuragi::viewer
