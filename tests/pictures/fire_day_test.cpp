// The fire from near by day, before bright ground and sky: orange and yellow, darker where it ends, and clear instead
// of white where it is thin; its foot is made of flamelets. YURAGI_FIRE_FOLDER=FOLDER also saves what is measured:
// winds from left to right, lights downward.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "engine/look/look.hpp"
#include "tests/pictures/canvas.hpp"
#include "tests/pictures/scenes_in_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/looks/stage.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 200;
constexpr std::array kSpeeds_m_s{0.5, 9.0};
constexpr double kSettling_s = 12.0;

struct DayLight {
  const char* name;
  double sun_height_deg;
};
constexpr std::array kLights{DayLight{"noon", 55.0}, DayLight{"dusk", -1.0}};

struct Color {
  double r = 0.0, g = 0.0, b = 0.0;
  double luminance() const { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }
  double saturation() const { return 1.0 - std::min({r, g, b}) / std::max({r, g, b, 1.0}); }
  double green_over_red() const { return g / std::max(r, 1.0); }
};

Color color_at(const std::vector<std::uint8_t>& rgb, std::size_t pixel) {
  return {static_cast<double>(rgb[3 * pixel]), static_cast<double>(rgb[3 * pixel + 1]),
          static_cast<double>(rgb[3 * pixel + 2])};
}

Color mean_of(const std::vector<Color>& colors) {
  Color mean;
  for (const Color& color : colors) {
    mean.r += color.r / static_cast<double>(colors.size());
    mean.g += color.g / static_cast<double>(colors.size());
    mean.b += color.b / static_cast<double>(colors.size());
  }
  return mean;
}

struct Figures {
  Color core;                ///< mean of the tenth of the flame's pixels in which red is farthest above blue
  Color behind;              ///< mean of what is behind the flame
  double flame_share = 0.0;  ///< of the picture
  double olive_share = 0.0;  ///< of the flame's pixels: the green ground shows through what should be orange
  double dull_share = 0.0;   ///< of the flame's pixels: darker than what is behind
};

/// What the flame does to a picture of the same place without it.
Figures figures_of(const std::vector<std::uint8_t>& with, const std::vector<std::uint8_t>& without) {
  struct Pixel {
    double red_over_blue;
    Color color;
  };
  std::vector<Pixel> flame;
  std::vector<Color> behind;
  double olive = 0.0;
  double dull = 0.0;
  for (std::size_t i = 0; i < with.size() / 3; ++i) {
    const Color now = color_at(with, i);
    const Color was = color_at(without, i);
    // Toward yellow: more red, less blue. That excludes smoke, sparks and the lit bowl.
    if ((now.r - was.r) + (was.b - now.b) < 40.0 || now.b > was.b + 4.0) continue;
    flame.push_back({now.r - now.b, now});
    behind.push_back(was);
    if (now.g > 0.92 * now.r) olive += 1.0;
    if (now.luminance() < was.luminance()) dull += 1.0;
  }
  if (flame.size() < 100) return {};
  std::ranges::sort(flame, [](const Pixel& a, const Pixel& b) { return a.red_over_blue > b.red_over_blue; });
  std::vector<Color> core;
  for (std::size_t i = 0; i < flame.size() / 10; ++i) core.push_back(flame[i].color);
  const auto count = static_cast<double>(flame.size());
  return {.core = mean_of(core),
          .behind = mean_of(behind),
          .flame_share = count / static_cast<double>(with.size() / 3),
          .olive_share = olive / count,
          .dull_share = dull / count};
}

constexpr int kFoot_px = 96;
/// What is shown of the foot: a square within the body in calm.
constexpr meshes::CameraPlace kAtFoot{
    .target_m = {0.10, 0.76, -0.04}, .heading_deg = 340.0, .pitch_deg = 5.0, .distance_m = 0.75};
constexpr int kInFoot_px = 30;  // from the picture's sides
constexpr int kBlur_px = 6;     // about 4 cm

/// The green of a picture of the foot (red is near its maximum everywhere) minus its mean from left to right around, as
/// a part of the square's mean; row after row of the square.
std::vector<double> structure_of(const std::vector<std::uint8_t>& rgb) {
  const auto green = [&](int x, int y) { return color_at(rgb, static_cast<std::size_t>(y * kFoot_px + x)).g; };
  std::vector<double> structure;
  double sum = 0.0;
  for (int y = kInFoot_px; y < kFoot_px - kInFoot_px; ++y) {
    for (int x = kInFoot_px; x < kFoot_px - kInFoot_px; ++x) {
      double around = 0.0;
      for (int by = -kBlur_px; by <= kBlur_px; ++by) around += green(x + by, y);
      structure.push_back(green(x, y) - around / (2 * kBlur_px + 1));
      sum += green(x, y);
    }
  }
  for (double& value : structure) value *= static_cast<double>(structure.size()) / sum;
  return structure;
}

double mean_product(const std::vector<double>& one, const std::vector<double>& other) {
  double sum = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) sum += one[i] * other[i];
  return sum / static_cast<double>(one.size());
}

double correlation(const std::vector<double>& one, const std::vector<double>& other) {
  return mean_product(one, other) / std::max(std::sqrt(mean_product(one, one) * mean_product(other, other)), 1e-12);
}

/// The same moment without fire.
stream::PoseMoment put_out(stream::PoseMoment moment) {
  for (pose::Pose& pose : moment.poses) {
    if (auto* const burning = std::get_if<pose::SurfacePose>(&pose)) std::ranges::fill(burning->heat, 0.0F);
  }
  return moment;
}

TEST(FireByDay, IsOrangeBeforeBrightGroundAndFadesToClear) {
  const gl::HeadlessContext context({.is_software = true, .has_messages = true});
  gl::RenderTarget target(kWidth_px, kHeight_px, 4);
  meshes::OrbitCamera camera;
  camera.frame({.target_m = {0.35, 0.95, 0.1}, .heading_deg = 340.0, .pitch_deg = 6.0, .distance_m = 2.0});
  const char* const folder = std::getenv("YURAGI_FIRE_FOLDER");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  Canvas sheet(static_cast<int>(kSpeeds_m_s.size()) * kWidth_px, static_cast<int>(kLights.size()) * kHeight_px);
  for (std::size_t wind = 0; wind < kSpeeds_m_s.size(); ++wind) {
    ScenesInWind scenes("flame", kSpeeds_m_s.at(wind));
    scenes.advance(kSettling_s);
    for (std::size_t i = 0; i < kLights.size(); ++i) {
      const DayLight& light = kLights.at(i);
      const auto draw = [&](const stream::PoseMoment& moment) {
        looks::Stage stage;
        stage.set_light(light::light_of(
            look::edited({},
                         std::vector<std::string>{"sun=fixed", "sun_height=" + std::to_string(light.sun_height_deg)})
                .value(),
            0.0));
        stage.set_quality(look::Quality::kLow);
        stage.set_scenes(scenes.models());
        stage.draw(moment, camera, target);
        return target.read_rgb();
      };
      const std::vector<std::uint8_t> with = draw(scenes.moment());
      const Figures figures = figures_of(with, draw(put_out(scenes.moment())));
      sheet.put(static_cast<int>(wind) * kWidth_px, static_cast<int>(i) * kHeight_px, kWidth_px, with);
      std::printf(
          "%s, %4.1f m/s: core %3.0f %3.0f %3.0f (saturation %.2f, green/red %.2f, luminance %.2f of what is behind), "
          "flame "
          "%.3f of the picture, olive %.3f of it, dull %.3f\n",
          light.name, kSpeeds_m_s.at(wind), figures.core.r, figures.core.g, figures.core.b, figures.core.saturation(),
          figures.core.green_over_red(), figures.core.luminance() / std::max(figures.behind.luminance(), 1.0),
          figures.flame_share, figures.olive_share, figures.dull_share);
      EXPECT_GE(figures.core.saturation(), 0.80);
      EXPECT_GE(figures.core.green_over_red(), 0.55) << "red";
      EXPECT_LE(figures.core.green_over_red(), 0.82) << "yellow or white";
      EXPECT_GE(figures.core.luminance(), 1.08 * figures.behind.luminance());
      // Before sunlit grass: 0.23 to 0.56 was olive, and 0.03 of the picture flame, when it hid no more than it shone.
      EXPECT_LE(figures.olive_share, 0.15);
      // Tips that are darker than sunlit grass: 0.57 in 9 m/s when they had no more light by day than by night.
      EXPECT_LE(figures.dull_share, 0.50);
      EXPECT_GE(figures.core.r, 160.0);
      EXPECT_GE(figures.flame_share, 0.05);
    }
  }
  if (folder != nullptr) sheet.save(std::filesystem::path(folder) / "day.png");
}

TEST(FireByDay, ItsFootIsMadeOfFlameletsThatMove) {
  const gl::HeadlessContext context({.is_software = true, .has_messages = true});
  gl::RenderTarget target(kFoot_px, kFoot_px, 1);
  meshes::OrbitCamera camera;
  camera.frame(kAtFoot);
  ScenesInWind scenes("flame", 0.5);
  scenes.advance(4.0);
  looks::Stage stage;
  stage.set_light(
      light::light_of(look::edited({}, std::vector<std::string>{"sun=fixed", "sun_height=-1"}).value(), 0.0));
  stage.set_quality(look::Quality::kLow);
  stage.set_scenes(scenes.models());
  constexpr int kPictures = 6;
  std::vector<std::vector<double>> film;
  Canvas strip(kPictures * kFoot_px, kFoot_px);
  double contrast = 0.0;
  for (int picture = 0; picture < kPictures; ++picture) {
    scenes.advance(0.1);
    stage.draw(scenes.moment(), camera, target);
    const std::vector<std::uint8_t> rgb = target.read_rgb();
    film.push_back(structure_of(rgb));
    strip.put(picture * kFoot_px, 0, kFoot_px, rgb);
    contrast += std::sqrt(mean_product(film.back(), film.back())) / kPictures;
  }
  double next = 0.0;
  for (std::size_t i = 1; i < film.size(); ++i) next += correlation(film[i - 1], film[i]) / (kPictures - 1);
  const double last = correlation(film.front(), film.back());
  std::printf("the foot: contrast %.4f, correlation %.2f after 0.1 s, %.2f after 0.5 s\n", contrast, next, last);
  EXPECT_GE(contrast, 0.019);  // of a smooth body 0.015
  EXPECT_LE(last, 0.80) << "a texture that stands still";
  EXPECT_GE(next, 0.30) << "noise";
  const char* const folder = std::getenv("YURAGI_FIRE_FOLDER");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  if (folder != nullptr) strip.save(std::filesystem::path(folder) / "foot.png");
}

}  // namespace
}  // namespace yuragi::viewer
