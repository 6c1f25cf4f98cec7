// The grass around the scenes, drawn by the processor and measured: a lawn reads as grass, and gusts travel over it.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/looks/stage.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;

/// Of a pixel among the luminances of a picture.
std::size_t index_of(int row, int column) {
  return static_cast<std::size_t>(row) * kWidth_px + static_cast<std::size_t>(column);
}

light::Light clear_noon() {
  const std::vector<std::string> look{"sun=fixed", "sun_height=60", "sun_azimuth=180", "clouds=0"};
  return light::light_of(look::edited({}, look).value(), 0.0);
}

/// A flag, and nothing else: the viewer's own grass grows around it.
class MeadowTest : public testing::Test {
 protected:
  MeadowTest() : target_(kWidth_px, kHeight_px, 4) {
    show("flag");
    stage_.set_light(clear_noon());
  }

  void show(const char* kind) {
    models_ = {test_model(kind)};
    stage_.set_scenes(models_);
  }

  /// Luminances, row after row from the top, 0 to 255. The wind blows toward east.
  std::vector<double> draw(const meshes::CameraPlace& place, double time_s, double speed_m_s) {
    meshes::OrbitCamera camera;
    camera.frame(place);
    stream::PoseMoment moment = stream::rest_moment(models_);
    moment.time_s = time_s;
    moment.wind.wind.u_m_s = speed_m_s;
    stage_.draw(moment, camera, target_);
    const std::vector<std::uint8_t> rgb = target_.read_rgb();
    std::vector<double> luminances;
    for (std::size_t i = 0; i < rgb.size(); i += 3)
      luminances.push_back(0.2126 * rgb[i] + 0.7152 * rgb[i + 1] + 0.0722 * rgb[i + 2]);
    return luminances;
  }

  gl::HeadlessContext context_{{.is_software = true, .has_messages = true}};
  std::vector<wire::SceneModel> models_;
  Stage stage_;
  gl::RenderTarget target_;
};

double deviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(values.size());
  return std::sqrt(std::max(squares / count - sum * sum / count / count, 0.0));
}

TEST_F(MeadowTest, ALawnNearByChangesFromPatchToPatchMoreThanFromBladeToBlade) {
  const std::vector<double> picture =
      draw({.target_m = {3.0, 0.0, 3.0}, .heading_deg = 20.0, .pitch_deg = 30.0, .distance_m = 2.5}, 2.0, 0.0);
  // Squares as wide as a few blades are apart.
  constexpr int kSide_px = 16;
  std::vector<double> means, deviations;
  for (int top = kHeight_px / 3; top + kSide_px <= kHeight_px; top += kSide_px) {
    for (int left = 0; left < kWidth_px; left += kSide_px) {
      std::vector<double> square;
      for (int row = top; row < top + kSide_px; ++row) {
        for (int column = left; column < left + kSide_px; ++column) square.push_back(picture.at(index_of(row, column)));
      }
      double sum = 0.0;
      for (const double value : square) sum += value;
      means.push_back(sum / static_cast<double>(square.size()));
      deviations.push_back(deviation(square));
    }
  }
  double from_blade_to_blade = 0.0;
  for (const double value : deviations) from_blade_to_blade += value / static_cast<double>(deviations.size());
  const double from_patch_to_patch = deviation(means);
  std::printf("luminance deviates by %.1f from blade to blade, by %.1f from patch to patch\n", from_blade_to_blade,
              from_patch_to_patch);
  EXPECT_LT(from_blade_to_blade, from_patch_to_patch);
  EXPECT_GT(from_blade_to_blade, 2.0);  // blades are seen
}

TEST_F(MeadowTest, NoEdgeIsSeenWhereTheBladesOfAMeadowEnd) {
  show("grass");
  // Across the last blades, at 40 m, toward west.
  const meshes::CameraPlace place{
      .target_m = {-10.0, 0.0, 0.0}, .heading_deg = 270.0, .pitch_deg = 4.0, .distance_m = 40.0};
  const std::vector<double> picture = draw(place, 2.0, 0.0);
  meshes::OrbitCamera camera;
  camera.frame(place);
  const glm::mat4 clip(meshes::view_of(camera, kWidth_px, kHeight_px).to_clip);
  const auto row_at = [&](float distance_m) {
    const glm::vec4 seen = clip * glm::vec4(30.0F - distance_m, 0.0F, 0.0F, 1.0F);
    return static_cast<int>(std::lround((0.5F - 0.5F * seen.y / seen.w) * static_cast<float>(kHeight_px)));
  };
  // The mean luminance of the rows between two distances, and the mean deviation of a pixel from those beside it.
  const auto light_between = [&](float near_m, float far_m) {
    constexpr int kBeside_px = 4;
    double sum = 0.0, deviations = 0.0, count = 0.0;
    for (int row = row_at(far_m); row < row_at(near_m); ++row) {
      const auto* line = &picture.at(index_of(row, 0));
      for (int column = kBeside_px; column < kWidth_px - kBeside_px; ++column) {
        double beside = 0.0;
        for (int other = column - kBeside_px; other <= column + kBeside_px; ++other)
          beside += line[other] / (2 * kBeside_px + 1);
        sum += line[column];
        deviations += std::abs(line[column] - beside);
        count += 1.0;
      }
    }
    return std::pair(sum / count, deviations / count);
  };
  const auto [blades, blades_vary] = light_between(27.0F, 34.0F);
  const auto [beyond, beyond_vary] = light_between(42.0F, 60.0F);
  std::printf("blades: luminance %.1f, varies by %.1f; beyond them %.1f, %.1f\n", blades, blades_vary, beyond,
              beyond_vary);
  EXPECT_NEAR(blades, beyond, 4.0);
  EXPECT_GT(beyond_vary, 0.4 * blades_vary);
  EXPECT_LT(beyond_vary, 1.6 * blades_vary);
}

TEST_F(MeadowTest, GustsTravelOverTheGrassAroundAFlagAtTheWindsSpeed) {
  constexpr double kSpeed_m_s = 8.0;
  const meshes::CameraPlace above{
      .target_m = {60.0, 0.0, 60.0}, .heading_deg = 0.0, .pitch_deg = 89.0, .distance_m = 60.0};
  const double px_per_m =
      kHeight_px / (2.0 * above.distance_m * meshes::tangent_up(40.0, static_cast<double>(kWidth_px) / kHeight_px));
  const std::vector<double> first = draw(above, 10.0, kSpeed_m_s);
  const std::vector<double> middle = draw(above, 10.5, kSpeed_m_s);
  const std::vector<double> last = draw(above, 11.0, kSpeed_m_s);
  // What does not move is the same in all pictures, and is left out.
  std::vector<double> before, after;
  for (std::size_t i = 0; i < first.size(); ++i) {
    before.push_back(middle[i] - first[i]);
    after.push_back(last[i] - middle[i]);
  }
  std::printf("within half a second luminance changes by %.1f\n", deviation(before));
  EXPECT_GT(deviation(before), 2.0);

  const auto likeness = [&](int shift_px) {
    double sum = 0.0, squares_before = 0.0, squares_after = 0.0;
    for (int row = 0; row < kHeight_px; ++row) {
      for (int column = std::max(0, -shift_px); column < std::min(kWidth_px, kWidth_px - shift_px); ++column) {
        const double a = before[index_of(row, column)];
        const double b = after[index_of(row, column + shift_px)];
        sum += a * b;
        squares_before += a * a;
        squares_after += b * b;
      }
    }
    return sum / std::sqrt(squares_before * squares_after);
  };
  int best_px = 0;
  for (int shift_px = -kWidth_px / 4; shift_px <= kWidth_px / 4; ++shift_px) {
    if (likeness(shift_px) > likeness(best_px)) best_px = shift_px;
  }
  const double found_m_s = best_px / px_per_m / 0.5;
  std::printf("gusts travel at %.1f m/s in a wind of %.1f m/s, correlation %.2f\n", found_m_s, kSpeed_m_s,
              likeness(best_px));
  EXPECT_NEAR(found_m_s, kSpeed_m_s, 0.8);
  EXPECT_GT(likeness(best_px), 0.8);
}

}  // namespace
}  // namespace yuragi::viewer::looks
