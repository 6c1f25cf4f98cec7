#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/units.hpp"
#include "engine/pose/strand_kinematics.hpp"
#include "engine/scenes/coat.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {

extern const Description kFurScene;

namespace {

std::unique_ptr<Scene> fur(const ParameterValues::Map& given = {}) {
  return kFurScene.make(ParameterValues::resolve(kFurScene.parameters, given).value(), {.seed = 1});
}

TEST(FurTest, HasThePapers300000NodesByDefault) {
  const auto scene = fur();
  const auto& skeleton = std::get<pose::StrandSkeleton>(scene->skeleton());
  EXPECT_EQ(skeleton.strand_count * skeleton.links_per_strand, 300'000U);
}

TEST(FurTest, RootsAreOnTheBodyAndHairsLeaveItOutward) {
  const Coat coat = make_coat({.seed = 4});
  const pose::StrandSkeleton& hairs = coat.skeleton;
  for (std::size_t i = 0; i < hairs.strand_count; ++i) {
    const double x = static_cast<double>(hairs.root_x_m[i]) / 1.5;
    const double y = static_cast<double>(hairs.root_y_m[i]) / 0.75;
    const double z = static_cast<double>(hairs.root_z_m[i]) / 1.0;
    EXPECT_NEAR(x * x + y * y + z * z, 1.0, 1e-5);
    EXPECT_GE(hairs.root_y_m[i], 0.0F);  // none grows under the ground

    const double length = std::sqrt(x * x / 2.25 + y * y / 0.5625 + z * z);
    const double outward =
        (static_cast<double>(hairs.rest_x[i]) * x / 1.5 + static_cast<double>(hairs.rest_y[i]) * y / 0.75 +
         static_cast<double>(hairs.rest_z[i]) * z) /
        length;
    EXPECT_GT(outward, 0.08);  // cos 85 deg
    const double rest = static_cast<double>(std::hypot(hairs.rest_x[i], hairs.rest_y[i], hairs.rest_z[i]));
    const double across = static_cast<double>(hairs.rest_x[i] * hairs.curl_x[i] + hairs.rest_y[i] * hairs.curl_y[i] +
                                              hairs.rest_z[i] * hairs.curl_z[i]);
    EXPECT_NEAR(rest, 1.0, 1e-5);
    EXPECT_NEAR(across, 0.0, 1e-5);
  }
}

TEST(FurTest, NeighboursLieAlike) {
  const Coat coat = make_coat({.seed = 4});
  const pose::StrandSkeleton& hairs = coat.skeleton;
  const auto alike = [&hairs](std::size_t i, std::size_t j) {
    return static_cast<double>(hairs.rest_x[i] * hairs.rest_x[j] + hairs.rest_y[i] * hairs.rest_y[j] +
                               hairs.rest_z[i] * hairs.rest_z[j]);
  };
  double neighbours = 0.0;
  double strangers = 0.0;
  for (std::size_t i = 0; i + 20'000 < hairs.strand_count; ++i) {
    neighbours += alike(i, i + 1);
    strangers += alike(i, i + 20'000);
  }
  const auto pairs = static_cast<double>(hairs.strand_count - 20'000);
  EXPECT_GT(neighbours / pairs, 0.97);
  EXPECT_LT(strangers / pairs, 0.8);
}

TEST(FurTest, LinksKeepTheirLengthTo1e5) {
  const auto scene = fur();
  const auto& skeleton = std::get<pose::StrandSkeleton>(scene->skeleton());
  pose::JointPositions joints(skeleton);
  for (const double speed_m_s : {0.0, 5.0, 40.0}) {
    for (int tick = 0; tick < 30; ++tick) scene->tick(wind::Vector{speed_m_s, -0.5 * speed_m_s}, 1.0 / 60.0);
    ASSERT_EQ((pose::StrandKinematicsJob{
                  .skeleton = &skeleton, .pose = &std::get<pose::StrandPose>(scene->pose()), .joints = &joints}
                   .run()),
              pose::StrandKinematicsJob::Problem::kNone);
    for (std::size_t i = 0; i < skeleton.strand_count; i += 7) {
      pose::JointPosition from{skeleton.root_x_m[i], skeleton.root_y_m[i], skeleton.root_z_m[i]};
      for (std::size_t link = 0; link < skeleton.links_per_strand; ++link) {
        const pose::JointPosition to = joints.joint(i, link);
        const double length_m = std::hypot(static_cast<double>(to.x_m) - static_cast<double>(from.x_m),
                                           static_cast<double>(to.y_m) - static_cast<double>(from.y_m),
                                           static_cast<double>(to.z_m) - static_cast<double>(from.z_m));
        // To 1e-5 of the length, beyond what floats a metre off can say.
        ASSERT_NEAR(length_m, skeleton.link_length_m[i], 1e-5 * static_cast<double>(skeleton.link_length_m[i]) + 2e-7);
        from = to;
      }
    }
  }
}

TEST(FurTest, StrokesRunOverTheRidgeWithoutASeam) {
  const auto scene = fur();
  for (int tick = 0; tick < 600; ++tick) scene->tick(wind::Vector{0.0, -8.0}, 1.0 / 60.0);
  const auto& pose = std::get<pose::StrandPose>(scene->pose());
  double largest_rad = 0.0;
  // Two hairs in the middle of a row stand to either side of the ridge.
  for (std::size_t ring = 40; ring < 160; ++ring) {
    const std::size_t first = 150 * ring + 74;
    largest_rad = std::max(
        largest_rad, static_cast<double>(std::hypot(pose.bend_east_rad[first] - pose.bend_east_rad[first + 1],
                                                    pose.bend_south_rad[first] - pose.bend_south_rad[first + 1])));
  }
  EXPECT_LT(largest_rad, 12.0 * kRadPerDeg);
}

TEST(FurTest, PartingsOpenInTheWind) {
  const auto spread_deg = [](double speed_m_s) {
    const auto scene = fur();
    for (int tick = 0; tick < 600; ++tick) scene->tick(wind::Vector{0.0, -speed_m_s}, 1.0 / 60.0);
    const auto& pose = std::get<pose::StrandPose>(scene->pose());
    double sum = 0.0;
    double squares = 0.0;
    // Near the ridge, where the skin is level and the bend would be the same.
    std::size_t count = 0;
    for (std::size_t ring = 70; ring < 130; ++ring) {
      for (std::size_t hair = 71; hair < 79; ++hair, ++count) {
        const auto bend = static_cast<double>(pose.bend_south_rad[150 * ring + hair]);
        sum += bend;
        squares += bend * bend;
      }
    }
    const double mean = sum / static_cast<double>(count);
    return std::sqrt(squares / static_cast<double>(count) - mean * mean) / kRadPerDeg;
  };
  EXPECT_LT(spread_deg(0.9), 1.0);
  EXPECT_GT(spread_deg(9.4), 6.0);
}

TEST(FurTest, IsStrokedMoreByMoreWindUntilItLiesFlat) {
  double before = 0.0;
  for (const double speed_m_s : {1.0, 3.0, 6.0, 12.0, 24.0, 48.0}) {
    const auto scene = fur({{"hairs_along", std::int64_t{40}}, {"hairs_around", std::int64_t{32}}});
    double mean_rad = 0.0;
    for (int tick = 0; tick < 900; ++tick) {
      scene->tick(wind::Vector{speed_m_s, 0.0}, 1.0 / 60.0);
      const auto& pose = std::get<pose::StrandPose>(scene->pose());
      if (tick >= 300) {
        for (std::size_t i = 0; i < 1280; ++i)
          mean_rad += static_cast<double>(pose.bend_east_rad[i]) / (1280.0 * 600.0);
      }
    }
    EXPECT_GT(mean_rad, before);
    EXPECT_LT(mean_rad, 80.0 * kRadPerDeg);
    before = mean_rad;
  }
}

}  // namespace
}  // namespace yuragi::scenes
