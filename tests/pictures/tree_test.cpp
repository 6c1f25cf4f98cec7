// What a drawn tree looks like: the sky seen through its crown, its outline, what a storm does to it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/pictures/scenes_in_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/picture/picture_file.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 240;
constexpr int kHeight_px = 240;
using Pixels = std::vector<std::uint8_t>;

/// A tree of a species in a wind that blows to the right of the picture, seen from near the ground: its crown is before
/// a clear sky.
class TreeFilm {
 public:
  TreeFilm(std::string_view species, double speed_m_s, double crown_m, double distance_m, double pitch_deg = -30.0)
      : context_({.is_software = true, .has_messages = true}),
        target_(kWidth_px, kHeight_px, 4),
        scenes_(species, speed_m_s) {
    stage_.set_light(light::light_of(
        look::edited({}, std::vector<std::string>{"sun=fixed", "sun_height=50", "sun_azimuth=190", "clouds=0"}).value(),
        0.0));
    stage_.set_quality(look::Quality::kLow);
    scenes_.advance(8.0);
    stage_.set_scenes(scenes_.models());
    camera_.frame(
        {.target_m = {0.0, crown_m, 0.0}, .heading_deg = 330.0, .pitch_deg = pitch_deg, .distance_m = distance_m});
  }

  Pixels next(double step_s) {
    scenes_.advance(step_s);
    stage_.draw(scenes_.moment(), camera_, target_);
    return target_.read_rgb();
  }

 private:
  gl::HeadlessContext context_;
  looks::Stage stage_;
  gl::RenderTarget target_;
  ScenesInWind scenes_;
  meshes::OrbitCamera camera_;
};

/// The sky is bluer than it is green, and leaves are not; bark neither.
bool is_sky(const Pixels& rgb, int column, int row) {
  const auto at = 3 * static_cast<std::size_t>(row * kWidth_px + column);
  return rgb[at + 2] > rgb[at + 1];
}

/// A crown's pixels: those above the lowest quarter of the picture, in which ground and trunk are.
constexpr int kCrownRows = kHeight_px * 3 / 4;

/// Of the pixels that have leaves on the left, on the right, above and below, the share that shows the sky.
double gap_share(const Pixels& rgb) {
  std::array<std::pair<int, int>, kWidth_px> in_column;
  std::array<std::pair<int, int>, kCrownRows> in_row;
  in_column.fill({kCrownRows, -1});
  in_row.fill({kWidth_px, -1});
  for (int row = 0; row < kCrownRows; ++row) {
    for (int column = 0; column < kWidth_px; ++column) {
      if (is_sky(rgb, column, row)) continue;
      auto& [top, bottom] = in_column.at(static_cast<std::size_t>(column));
      auto& [left, right] = in_row.at(static_cast<std::size_t>(row));
      top = std::min(top, row);
      bottom = std::max(bottom, row);
      left = std::min(left, column);
      right = std::max(right, column);
    }
  }
  double gaps = 0.0;
  double all = 0.0;
  for (int row = 0; row < kCrownRows; ++row) {
    for (int column = 0; column < kWidth_px; ++column) {
      const auto& [top, bottom] = in_column.at(static_cast<std::size_t>(column));
      const auto& [left, right] = in_row.at(static_cast<std::size_t>(row));
      if (row < top || row > bottom || column < left || column > right) continue;
      all += 1.0;
      gaps += is_sky(rgb, column, row) ? 1.0 : 0.0;
    }
  }
  return gaps / all;
}

/// The mean column of what is not sky, pixels.
double middle_px(const Pixels& rgb) {
  double sum = 0.0;
  double count = 0.0;
  for (int row = 0; row < kCrownRows; ++row) {
    for (int column = 0; column < kWidth_px; ++column) {
      if (is_sky(rgb, column, row)) continue;
      sum += column;
      count += 1.0;
    }
  }
  return sum / count;
}

/// The width that holds all but a tenth of them.
double width_px(const Pixels& rgb) {
  std::vector<int> columns;
  for (int row = 0; row < kCrownRows; ++row) {
    for (int column = 0; column < kWidth_px; ++column) {
      if (!is_sky(rgb, column, row)) columns.push_back(column);
    }
  }
  std::sort(columns.begin(), columns.end());
  return columns[columns.size() * 19 / 20] - columns[columns.size() / 20];
}

constexpr double kCherryCrown_m = 4.6;
constexpr double kCherryDistance_m = 15.0;
constexpr double kZelkovaCrown_m = 6.8;
constexpr double kZelkovaDistance_m = 17.0;

TEST(TreePicture, TheSkyShowsThroughTheCrown) {
  const double cherry = gap_share(TreeFilm("cherry", 4.0, kCherryCrown_m, kCherryDistance_m).next(0.1));
  const double zelkova = gap_share(TreeFilm("zelkova", 4.0, kZelkovaCrown_m, kZelkovaDistance_m).next(0.1));
  std::printf("sky in the crown: %.3f of a cherry, %.3f of a zelkova\n", cherry, zelkova);
  for (const double share : {cherry, zelkova}) {
    EXPECT_GE(share, 0.08);
    EXPECT_LE(share, 0.35);
  }
}

// From its fork to its first twigs a limb is steep below and leans more above: between, the vase is narrower than if
// its limbs were straight.
TEST(TreePicture, AZelkovasLimbsCurveOutward) {
  TreeFilm film("zelkova", 0.5, 4.0, 9.0, -19.0);
  const Pixels rgb = film.next(0.1);
  const char* const folder = std::getenv("YURAGI_TREE_FOLDER");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  if (folder != nullptr)
    picture::write_picture(std::filesystem::path(folder) / "limbs.png", kWidth_px, kHeight_px, rgb);
  const auto width_px = [&](int row) {
    int left = kWidth_px, right = -1;
    for (int column = 0; column < kWidth_px; ++column) {
      if (is_sky(rgb, column, row)) continue;
      left = std::min(left, column);
      right = std::max(right, column);
    }
    return right - left + 1;
  };
  constexpr int kTwigsBegin = 115, kFork = 167;  // rows
  const double straight_px = 0.5 * (width_px(kTwigsBegin) + width_px(kFork));
  const double share = width_px((kTwigsBegin + kFork) / 2) / straight_px;
  std::printf("halfway from fork to twigs: %.2f of the width of straight limbs\n", share);
  EXPECT_LE(share, 0.78);  // 0.90 of a fan of straight limbs
  EXPECT_GE(share, 0.45) << "the limbs are one stem";
}

TEST(TreePicture, AStormMovesAZelkovasLeavesToTheLee) {
  std::array<double, 2> middles_px{};
  double wide_px = 0.0;
  for (const std::size_t is_storm : {0U, 1U}) {
    TreeFilm film("zelkova", is_storm == 1 ? 16.0 : 4.0, kZelkovaCrown_m, kZelkovaDistance_m);
    for (int picture = 0; picture < 4; ++picture) {
      const Pixels rgb = film.next(1.0);
      middles_px.at(is_storm) += 0.25 * middle_px(rgb);
      if (is_storm == 0) wide_px += 0.25 * width_px(rgb);
    }
  }
  const double share = (middles_px[1] - middles_px[0]) / wide_px;
  std::printf("%.3f of its width to the lee\n", share);
  EXPECT_GE(share, 0.13);
}

}  // namespace
}  // namespace yuragi::viewer
