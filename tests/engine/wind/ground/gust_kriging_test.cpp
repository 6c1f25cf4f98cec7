#include "engine/wind/ground/gust_kriging.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::wind::ground {
namespace {

constexpr std::size_t kWaves = 16;
using Kriging = GustKriging<kWaves>;
using Waves = Kriging::Lanes;
using AllWaves = std::array<Waves, Kriging::kMost>;

/// Sensors somewhere, a wind from anywhere, and a place among them.
struct Layout {
  explicit Layout(std::mt19937& random, std::size_t count) : pens(count) {
    const auto uniform = [&](double from, double to) {
      return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
    };
    for (WindPen& pen : pens) {
      pen.east_m = uniform(-40.0, 40.0);
      pen.south_m = uniform(-40.0, 40.0);
      pen.presence = random() % 4 == 0 ? 1.0 : uniform(0.0, 1.0);
    }
    east_m = uniform(-60.0, 60.0);
    south_m = uniform(-60.0, 60.0);
    const double angle_rad = uniform(0.0, 6.28);
    ahead = {std::sin(angle_rad), std::cos(angle_rad)};
    law.speed_m_s = uniform(0.3, 15.0);
    law.decay_along = uniform(0.5, 10.0);
    for (std::size_t wave = 0; wave < kWaves; ++wave) {
      loss_per_m[wave] = static_cast<float>(law.loss_per_m(std::ldexp(0.002, static_cast<int>(wave))));
    }
  }

  double between(double from_east_m, double from_south_m, double to_east_m, double to_south_m, std::size_t wave) const {
    const double east = to_east_m - from_east_m;
    const double north = from_south_m - to_south_m;
    const double distance_m = law.distance_m(east * ahead.u_m_s + north * ahead.v_m_s,  //
                                             north * ahead.u_m_s - east * ahead.v_m_s);
    return std::exp(-distance_m * static_cast<double>(loss_per_m[wave]));
  }
  double between_pens(std::size_t i, std::size_t j, std::size_t wave) const {
    return between(pens[i].east_m, pens[i].south_m, pens[j].east_m, pens[j].south_m, wave);
  }
  double to_place(std::size_t i, std::size_t wave) const {
    return between(pens[i].east_m, pens[i].south_m, east_m, south_m, wave);
  }

  AllWaves weights() const {
    Kriging kriging;
    return weights(kriging);
  }
  AllWaves weights(Kriging& kriging) const {
    kriging.prepare(pens, ahead, law, [this](std::size_t, double distance_m) {
      Kriging::Lanes left{};
      for (std::size_t wave = 0; wave < kWaves; ++wave) {
        left[wave] = static_cast<float>(std::exp(-distance_m * static_cast<double>(loss_per_m[wave])));
      }
      return left;
    });
    AllWaves coherent{};
    for (std::size_t i = 0; i < pens.size(); ++i) {
      for (std::size_t wave = 0; wave < kWaves; ++wave) coherent[i][wave] = static_cast<float>(to_place(i, wave));
    }
    AllWaves weights{};
    kriging.weigh(coherent, weights);
    return weights;
  }

  std::vector<WindPen> pens;
  double east_m = 0.0, south_m = 0.0;
  Vector ahead;
  GustCoherence law;
  Waves loss_per_m{};
};

/// x of A x = b, with pivots.
std::vector<double> solved(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t count = b.size();
  for (std::size_t column = 0; column < count; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column; row < count; ++row) {
      if (std::abs(a[row][column]) > std::abs(a[pivot][column])) pivot = row;
    }
    std::swap(a[column], a[pivot]);
    std::swap(b[column], b[pivot]);
    for (std::size_t row = column + 1; row < count; ++row) {
      const double factor = a[row][column] / a[column][column];
      for (std::size_t k = column; k < count; ++k) a[row][k] -= factor * a[column][k];
      b[row] -= factor * b[column];
    }
  }
  for (std::size_t row = count; row-- > 0;) {
    for (std::size_t k = row + 1; k < count; ++k) b[row] -= a[row][k] * b[k];
    b[row] /= a[row][row];
  }
  return b;
}

Waves known(const Kriging& kriging, const AllWaves& weights) {
  return kriging.power(weights, [](std::size_t, std::size_t, std::size_t) { return 1.0F; });
}

TEST(GustKriging, IsTheSolutionOfItsEquationsLimitedToAllPower) {
  std::mt19937 random(1);
  int limited = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t count = 1 + static_cast<std::size_t>(trial) % Kriging::kMost;
    const Layout layout(random, count);
    const AllWaves weights = layout.weights();
    for (std::size_t wave = 0; wave < kWaves; ++wave) {
      // The mean over who is there.
      std::vector<double> expected(count);
      for (unsigned there = 0; there < 1U << count; ++there) {
        std::vector<std::size_t> who;
        double part = 1.0;
        for (std::size_t i = 0; i < count; ++i) {
          const double presence = layout.pens[i].presence;
          if ((there >> i & 1U) != 0) who.push_back(i);
          part *= (there >> i & 1U) != 0 ? presence : 1.0 - presence;
        }
        std::vector<std::vector<double>> matrix(who.size(), std::vector<double>(who.size()));
        std::vector<double> coherent(who.size());
        for (std::size_t i = 0; i < who.size(); ++i) {
          for (std::size_t j = 0; j < who.size(); ++j) matrix[i][j] = layout.between_pens(who[i], who[j], wave);
          matrix[i][i] += 0.001;
          coherent[i] = layout.to_place(who[i], wave);
        }
        const std::vector<double> solution = solved(matrix, coherent);
        for (std::size_t i = 0; i < who.size(); ++i) expected[who[i]] += part * solution[i];
      }
      double power = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
          power += expected[i] * expected[j] * layout.between_pens(i, j, wave);
        }
      }
      if (power > 1.0) ++limited;
      for (std::size_t i = 0; i < count; ++i) {
        const double within = expected[i] / std::sqrt(std::max(power, 1.0));
        ASSERT_NEAR(static_cast<double>(weights[i][wave]), within, 2e-3 * (1.0 + std::abs(within)))
            << trial << ' ' << i << ' ' << wave;
      }
    }
  }
  EXPECT_LT(limited, 400 * 16 / 50) << "the limit is for few layouts";
}

TEST(GustKriging, KnowsAllAtMost) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 3000; ++trial) {
    Layout layout(random, 2 + static_cast<std::size_t>(trial) % 3);
    for (WindPen& pen : layout.pens) pen.presence = 1.0;
    Kriging kriging;
    const AllWaves weights = layout.weights(kriging);
    for (const float power : known(kriging, weights)) {
      ASSERT_LE(power, 1.0F + 1e-4F);
      ASSERT_GE(power, -1e-5F);
    }
  }
}

TEST(GustKriging, OneThatIsGoneHasNoWeightAndTheOthersAreAsWithoutIt) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    Layout layout(random, 3);
    layout.pens[1].presence = 0.0;
    const AllWaves with = layout.weights();
    layout.pens.erase(layout.pens.begin() + 1);
    const AllWaves without = layout.weights();
    for (std::size_t wave = 0; wave < kWaves; ++wave) {
      ASSERT_EQ(with[1][wave], 0.0F);
      ASSERT_NEAR(with[0][wave], without[0][wave], 1e-5F);
      ASSERT_NEAR(with[2][wave], without[1][wave], 1e-5F);
    }
  }
}

TEST(GustKriging, NoWeightWithoutAPresentPen) {
  std::mt19937 random(4);
  Layout layout(random, 4);
  for (WindPen& pen : layout.pens) pen.presence = 0.0;
  for (const Waves& weights : layout.weights()) {
    for (const float weight : weights) EXPECT_EQ(weight, 0.0F);
  }
}

TEST(GustKriging, OneThatGoesMovesNothingAtOnce) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    Layout layout(random, 3);
    for (WindPen& pen : layout.pens) pen.presence = 1.0;
    // Even where it stands beside another: a thousandth of its presence is as much of its weight.
    layout.pens[1].east_m = layout.pens[0].east_m + 0.6;
    layout.pens[1].south_m = layout.pens[0].south_m;
    AllWaves before = layout.weights();
    double largest = 0.0;
    for (int step = 999; step >= 0; --step) {
      layout.pens[1].presence = step / 1000.0;
      const AllWaves now = layout.weights();
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t wave = 0; wave < kWaves; ++wave) {
          largest = std::max(largest, static_cast<double>(std::abs(now[i][wave] - before[i][wave])));
        }
      }
      before = now;
    }
    EXPECT_LT(largest, 1.5e-3);
  }
}

TEST(GustKriging, SensorsAtOnePlaceShareItEqually) {
  std::mt19937 random(6);
  Layout layout(random, 4);
  for (WindPen& pen : layout.pens) {
    pen.presence = 1.0;
    pen.east_m = layout.east_m;
    pen.south_m = layout.south_m;
  }
  for (const Waves& weights : layout.weights()) {
    for (const float weight : weights) EXPECT_NEAR(weight, 0.25F, 1e-3F);
  }
}

}  // namespace
}  // namespace yuragi::wind::ground
