#include "engine/wind/blend/mean_wind_plane.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::wind::blend {
namespace {

/// What the plane says at a place, as the wind over the ground reads it, of sources that say `values`.
double plane_at(const MeanWindPlane& plane, const std::vector<double>& shares, const std::vector<double>& values,
                double east_m, double south_m, double part = 1.0) {
  std::vector<PlaceWeights> weights(shares.size());
  plane.weigh(shares, part, weights);
  double middle = 0.0;
  ground::WindSlope slope = plane.ends();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    middle += weights[i].middle * values[i];
    slope.per_m_east.u_m_s += weights[i].per_m_east * values[i];
    slope.per_m_south.u_m_s += weights[i].per_m_south * values[i];
  }
  return middle + slope.at(east_m, south_m).u_m_s;
}

TEST(MeanWindPlane, AllAtOnePlaceShareWithoutASlope) {
  const MeanWindPlane plane(std::vector<SourceSettings>{{.east_m = 3.0}, {.east_m = 3.0}});
  EXPECT_TRUE(plane.is_point());
  EXPECT_NEAR(plane_at(plane, {0.25, 0.75}, {4.0, 8.0}, 0.0, 0.0), 7.0, 1e-12);
  EXPECT_NEAR(plane_at(plane, {0.25, 0.75}, {4.0, 8.0}, 50.0, 9.0), 7.0, 1e-12);
}

TEST(MeanWindPlane, GoesFromOneSensorToTheOtherAndOnLevel) {
  const MeanWindPlane plane(std::vector<SourceSettings>{{.east_m = -10.0}, {.east_m = 10.0}});
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, -10.0, 0.0), 4.0, 0.05);
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 10.0, 0.0), 8.0, 0.05);
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 0.0, 0.0), 6.0, 1e-9);
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 5.0, 0.0), 7.0, 0.05);
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 500.0, 70.0), 8.0, 0.05);
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 10.0, 0.0, 0.0), 6.0, 1e-9) << "no slope is wanted";
}

TEST(MeanWindPlane, ASceneBesideTheWallHasWhatTheNearerEndHas) {
  const MeanWindPlane plane(std::vector<SourceSettings>{{.east_m = 20.0}, {.east_m = 40.0}});
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 0.0, 0.0), 4.0, 0.05);
  EXPECT_NEAR(plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 40.0, 0.0), 8.0, 0.05);
}

TEST(MeanWindPlane, AWallMayRunAnyWay) {
  const MeanWindPlane plane(std::vector<SourceSettings>{
      {.east_m = -6.0, .south_m = -8.0}, {.east_m = 0.0, .south_m = 0.0}, {.east_m = 6.0, .south_m = 8.0}});
  const std::vector<double> shares(3, 1.0 / 3.0);
  EXPECT_NEAR(plane_at(plane, shares, {2.0, 5.0, 8.0}, 6.0, 8.0), 8.0, 0.1);
  EXPECT_NEAR(plane_at(plane, shares, {2.0, 5.0, 8.0}, -3.0, -4.0), 3.5, 0.1);
}

TEST(MeanWindPlane, ASensorThatFailsFadesOutOfItSteadily) {
  const MeanWindPlane plane(std::vector<SourceSettings>{{.east_m = -10.0}, {.east_m = 10.0}});
  double before = plane_at(plane, {0.5, 0.5}, {4.0, 8.0}, 10.0, 0.0);
  for (double share = 0.5; share > 1e-12; share *= 0.9) {
    // Normalised, as the blend's are.
    const double now = plane_at(plane, {1.0 - share, share}, {4.0, 8.0}, 10.0, 0.0);
    EXPECT_LE(std::abs(now - before), 0.15);
    EXPECT_LE(now, 8.0);
    before = now;
  }
  EXPECT_NEAR(before, 4.0, 1e-6);
  EXPECT_NEAR(plane_at(plane, {1.0, 0.0}, {4.0, 8.0}, 10.0, 0.0), 4.0, 1e-9);
}

TEST(MeanWindPlane, TheSumOfTheWeightsIsThatOfTheSharesAndAllIsFinite) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    std::vector<SourceSettings> sources(1 + random() % 5);
    std::vector<double> shares;
    double sum = 0.0;
    for (SourceSettings& source : sources) {
      source.east_m = 40.0 * unit(random) - 20.0;
      source.south_m = random() % 2 == 0 ? 0.0 : 10.0 * unit(random);
      shares.push_back(random() % 4 == 0 ? 0.0 : std::pow(unit(random), 8.0));
      sum += shares.back();
    }
    const MeanWindPlane plane(sources);
    std::vector<PlaceWeights> weights(shares.size());
    plane.weigh(shares, 1.0, weights);
    double middle = 0.0;
    for (const PlaceWeights& weight : weights) {
      middle += weight.middle;
      ASSERT_TRUE(std::isfinite(weight.per_m_east) && std::isfinite(weight.per_m_south));
    }
    EXPECT_NEAR(middle, sum, 1e-9);
  }
}

}  // namespace
}  // namespace yuragi::wind::blend
