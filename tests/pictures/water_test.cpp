// The drawn pond: over time its contrast does not pulse; foam suits the wind, and is where waves are steep; a tree
// behind it is mirrored below itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/settings/config_file.hpp"
#include "tests/pictures/scenes_in_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/looks/stage.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 160;
constexpr int kHeight_px = 120;
constexpr double kStep_s = 0.1;
constexpr int kPictures = 32;
constexpr int kFromAbove = 8;   // every so many pictures
constexpr int kStepsApart = 3;  // 0.3 s
constexpr double kMaxContrastRatio = 1.3;
constexpr double kFoamGrey = 150.0;  // darker is water, by noon

/// Pictures of the pond's middle over some seconds of a wind, from above and from the side.
struct PondFilm {
  std::vector<double> contrasts;  ///< standard deviation of the luminance seen from the side, a picture each
  double foam_share = 0.0;        ///< of the water seen from above
};

double luminance(const std::vector<std::uint8_t>& rgb, int column, int row) {
  const auto at = 3 * static_cast<std::size_t>(row * kWidth_px + column);
  return 0.2126 * rgb[at] + 0.7152 * rgb[at + 1] + 0.0722 * rgb[at + 2];
}

/// Draws scenes with a pond among them, under a low sun, without a display.
class PondView {
 public:
  /// `more`: values of [look] besides the sun's.
  PondView(const std::vector<wire::SceneModel>& models, look::Quality quality,
           const std::vector<std::string>& more = {}) {
    std::vector<std::string> look{"sun=fixed", "sun_height=25", "sun_azimuth=20"};
    look.insert(look.end(), more.begin(), more.end());
    stage_.set_light(light::light_of(look::edited({}, look).value(), 0.0));
    stage_.set_quality(quality);
    stage_.set_scenes(models);
  }

  std::vector<std::uint8_t> draw(const stream::PoseMoment& moment, const meshes::OrbitCamera& camera) {
    stage_.draw(moment, camera, target_);
    return target_.read_rgb();
  }

 private:
  gl::HeadlessContext context_{{.is_software = true, .has_messages = true}};
  looks::Stage stage_;
  gl::RenderTarget target_{kWidth_px, kHeight_px, 1};
};

/// North is up in the picture, which shows water alone.
meshes::OrbitCamera from_above() {
  meshes::OrbitCamera camera;
  camera.frame({.target_m = {0.0, -0.1, 0.0}, .heading_deg = 0.0, .pitch_deg = 89.0, .distance_m = 3.0});
  return camera;
}

PondFilm film_of(double speed_m_s) {
  ScenesInWind scenes("ripple", speed_m_s);
  scenes.advance(6.0);
  PondView view(scenes.models(), look::Quality::kLow);
  meshes::OrbitCamera side;
  side.frame({.target_m = {0.0, -0.1, 0.0}, .heading_deg = 200.0, .pitch_deg = 25.0, .distance_m = 4.5});
  const meshes::OrbitCamera above = from_above();
  PondFilm film;
  for (int picture = 0; picture < kPictures; ++picture) {
    scenes.advance(kStep_s);
    const stream::PoseMoment moment = scenes.moment();
    const std::vector<std::uint8_t> rgb = view.draw(moment, side);
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (int row = kHeight_px / 3; row < kHeight_px * 2 / 3; ++row) {
      for (int column = kWidth_px / 4; column < kWidth_px * 3 / 4; ++column) {
        const double light = luminance(rgb, column, row);
        sum += light;
        squares += light * light;
        count += 1.0;
      }
    }
    film.contrasts.push_back(std::sqrt(squares / count - sum * sum / count / count));
    if (picture % kFromAbove != 0) continue;
    const std::vector<std::uint8_t> down = view.draw(moment, above);
    double white = 0.0;
    for (int row = 0; row < kHeight_px; ++row) {
      for (int column = 0; column < kWidth_px; ++column) white += luminance(down, column, row) > kFoamGrey ? 1.0 : 0.0;
    }
    constexpr int kCounted = kPictures / kFromAbove;
    film.foam_share += white / (kWidth_px * kHeight_px) / kCounted;
  }
  return film;
}

/// Each wind is filmed once.
const PondFilm& film_in(double speed_m_s) {
  static std::map<double, PondFilm> films;
  const auto known = films.find(speed_m_s);
  return known != films.end() ? known->second : films.emplace(speed_m_s, film_of(speed_m_s)).first->second;
}

class PondPicture : public testing::TestWithParam<double> {};

TEST_P(PondPicture, ItsContrastDoesNotPulse) {
  const std::vector<double>& contrasts = film_in(GetParam()).contrasts;
  double largest = 1.0;
  for (std::size_t i = kStepsApart; i < contrasts.size(); ++i) {
    const double ratio = contrasts[i] / contrasts[i - kStepsApart];
    largest = std::max({largest, ratio, 1.0 / ratio});
  }
  std::printf("%.0f m/s: contrast x%.2f within 0.3 s\n", GetParam(), largest);
  EXPECT_LE(largest, kMaxContrastRatio);
}

INSTANTIATE_TEST_SUITE_P(Winds, PondPicture, testing::Values(4.0, 9.0, 16.0),
                         [](const auto& speed) { return std::to_string(std::lround(speed.param)); });

/// E. Monahan, I. O'Muircheartaigh 1980: the share of whitecaps on the open sea, where waves are higher than on a pond.
double whitecaps_at_sea(double speed_m_s) {
  return 3.84e-6 * std::pow(speed_m_s, 3.41);
}

TEST(PondFoam, IsLessThanAtSeaAndTellsAStormFromAFreshBreeze) {
  const double breeze = film_in(4.0).foam_share;
  const double fresh = film_in(9.0).foam_share;
  const double storm = film_in(16.0).foam_share;
  std::printf("foam: %.4f at 4 m/s, %.4f at 9 (sea %.4f), %.4f at 16 (sea %.4f)\n", breeze, fresh,
              whitecaps_at_sea(9.0), storm, whitecaps_at_sea(16.0));
  EXPECT_LE(breeze, whitecaps_at_sea(4.0));
  EXPECT_LE(fresh, whitecaps_at_sea(9.0));
  EXPECT_LE(storm, whitecaps_at_sea(16.0));
  EXPECT_GE(storm, 2.0 * fresh);
}

/// The wind is from 250 degrees, so that foam drifts away from the western half.
TEST(PondFoam, IsWhereWavesAreSteep) {
  constexpr float kLeftOfTheWaves = 0.25F;
  ScenesInWind scenes("ripple", 16.0);
  scenes.advance(6.0);
  const std::vector<wire::SceneModel> models = scenes.models();
  PondView view(models, look::Quality::kLow);
  const auto& water = std::get<pose::SurfaceSkeleton>(models.at(0).skeleton);
  std::array<double, 2> white{};  // in the west, in the east
  for (int picture = 0; picture < kPictures; ++picture) {
    scenes.advance(kStep_s);
    stream::PoseMoment moment = scenes.moment();
    auto& moved = std::get<pose::SurfacePose>(moment.poses.at(0));
    for (std::size_t i = 0; i < moved.displacement_m.size(); ++i) {
      if (water.rest_x_m[i] < 0.0F) moved.displacement_m[i] *= kLeftOfTheWaves;
    }
    const std::vector<std::uint8_t> rgb = view.draw(moment, from_above());
    for (int row = 0; row < kHeight_px; ++row) {
      for (int column = 0; column < kWidth_px; ++column) {
        const bool is_at_the_step = std::abs(column - kWidth_px / 2) < kWidth_px / 10;
        if (!is_at_the_step && luminance(rgb, column, row) > kFoamGrey) white.at(column < kWidth_px / 2 ? 0 : 1) += 1.0;
      }
    }
  }
  std::printf("foam: %.0f pixels where waves are a quarter as high, %.0f beside them\n", white[0], white[1]);
  EXPECT_GE(white[1], 1.0 * kPictures);
  EXPECT_LE(white[0], 0.02 * white[1]);
}

/// The columns of the pixels of some rows that are darker than in another picture: how many, and their mean.
struct Darkened {
  double count = 0.0;
  double column = 0.0;
};

Darkened darkened(const std::vector<std::uint8_t>& rgb, const std::vector<std::uint8_t>& than, int from_row,
                  int to_row) {
  constexpr double kDarker = 20.0;  // grey levels
  Darkened found;
  for (int row = from_row; row < to_row; ++row) {
    for (int column = 0; column < kWidth_px; ++column) {
      if (luminance(than, column, row) - luminance(rgb, column, row) < kDarker) continue;
      found.count += 1.0;
      found.column += column;
    }
  }
  found.column /= std::max(found.count, 1.0);
  return found;
}

/// Two trees on the far shore of calm water, one shown at a time, with quality medium under clouds, which cast no
/// shadow.
TEST(PondMirror, ShowsATreeBelowItselfAndNoSunBehindClouds) {
  constexpr int kSkyEnds = 38;  // rows
  constexpr int kWaterBegins = 52;
  constexpr int kWaterEnds = 86;
  constexpr double kAside_px = 0.1 * kWidth_px;
  constexpr double kOvercastGrey = 190.0;
  const daemon::settings::Config config = daemon::settings::parse_config(
      "[wind]\ndefault_speed = 0.0\n"
      "[[scene]]\nkind = \"ripple\"\n"
      "[[scene]]\nkind = \"tree\"\nname = \"left\"\nx = -2.5\nz = -7.0\n"
      "[[scene]]\nkind = \"tree\"\nname = \"right\"\nx = 2.5\nz = -7.0\n",
      "a pond");
  ScenesInWind scenes(config);
  scenes.advance(0.1);
  PondView view(scenes.models(), look::Quality::kMedium, {"clouds=1"});
  meshes::OrbitCamera camera;
  camera.frame({.target_m = {0.0, 0.5, 0.0}, .heading_deg = 0.0, .pitch_deg = 16.0, .distance_m = 7.0});
  stream::PoseMoment moment = scenes.moment();
  const auto picture_with = [&](float left, float right) {
    moment.opacities.at(1) = left;
    moment.opacities.at(2) = right;
    return view.draw(moment, camera);
  };
  const std::vector<std::uint8_t> empty = picture_with(0.0F, 0.0F);
  double brightest = 0.0;
  for (int row = kWaterBegins; row < kWaterEnds; ++row) {
    for (int column = 0; column < kWidth_px; ++column) brightest = std::max(brightest, luminance(empty, column, row));
  }
  EXPECT_LE(brightest, kOvercastGrey) << "the sun's glitter from behind the clouds";
  std::array<double, 2> mirrored_at{};
  for (const int side : {0, 1}) {
    const std::vector<std::uint8_t> rgb = picture_with(side == 0 ? 1.0F : 0.0F, side == 0 ? 0.0F : 1.0F);
    const Darkened crown = darkened(rgb, empty, 0, kSkyEnds);
    const Darkened mirrored = darkened(rgb, empty, kWaterBegins, kWaterEnds);
    std::printf("crown: %.0f pixels about column %.0f; in the water %.0f about %.0f\n", crown.count, crown.column,
                mirrored.count, mirrored.column);
    EXPECT_GE(mirrored.count, 100.0);
    EXPECT_NEAR(mirrored.column, crown.column, kAside_px);
    mirrored_at.at(static_cast<std::size_t>(side)) = mirrored.column;
  }
  EXPECT_GE(mirrored_at[1] - mirrored_at[0], kAside_px);
}

}  // namespace
}  // namespace yuragi::viewer
