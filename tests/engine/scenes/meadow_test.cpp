#include "engine/scenes/meadow.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/bits.hpp"

namespace yuragi::scenes {
namespace {

double mean_of(const std::vector<float>& values, std::size_t count) {
  return std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
         static_cast<double>(count);
}

TEST(MeadowTest, HasItsBladesOnTheFieldAroundTheOrigin) {
  const MeadowSpec spec{.blades_across = 50, .blades_deep = 30, .links = 4, .width_m = 5.0, .depth_m = 3.0, .seed = 1};
  const Meadow meadow = make_meadow(spec);
  EXPECT_EQ(meadow.skeleton.strand_count, 1500U);
  EXPECT_EQ(meadow.skeleton.links_per_strand, 4U);
  for (std::size_t i = 0; i < 1500; ++i) {
    EXPECT_LE(std::abs(meadow.skeleton.root_x_m[i]), 2.5F + 0.15F);
    EXPECT_LE(std::abs(meadow.skeleton.root_z_m[i]), 1.5F + 0.15F);
    EXPECT_EQ(meadow.skeleton.root_y_m[i], 0.0F);
  }
  EXPECT_NEAR(mean_of(meadow.skeleton.root_x_m, 1500), 0.0, 0.05);
  EXPECT_NEAR(mean_of(meadow.skeleton.root_z_m, 1500), 0.0, 0.05);
}

TEST(MeadowTest, RestAndCurlAreUnitVectorsAcrossEachOther) {
  const Meadow meadow = make_meadow({.seed = 2});
  const pose::StrandSkeleton& skeleton = meadow.skeleton;
  for (std::size_t i = 0; i < skeleton.padded_count(); ++i) {
    const float rest = std::hypot(skeleton.rest_x[i], skeleton.rest_y[i], skeleton.rest_z[i]);
    const float curl = std::hypot(skeleton.curl_x[i], skeleton.curl_y[i], skeleton.curl_z[i]);
    const float product = skeleton.rest_x[i] * skeleton.curl_x[i] + skeleton.rest_y[i] * skeleton.curl_y[i] +
                          skeleton.rest_z[i] * skeleton.curl_z[i];
    EXPECT_NEAR(rest, 1.0F, 1e-6F);
    EXPECT_NEAR(curl, 1.0F, 1e-6F);
    EXPECT_NEAR(product, 0.0F, 1e-6F);
  }
}

TEST(MeadowTest, BladesStandAsTheSpecSaysOnAverageAndDifferAmongThemselves) {
  const MeadowSpec spec{.seed = 3};
  const Meadow meadow = make_meadow(spec);
  const pose::StrandSkeleton& skeleton = meadow.skeleton;
  const std::size_t count = skeleton.strand_count;
  EXPECT_NEAR(mean_of(skeleton.link_length_m, count) * 10.0, spec.length_m, 0.02);
  EXPECT_NEAR(mean_of(skeleton.rest_curl_rad, count) * 10.0, spec.curl_deg * 3.14159265 / 180.0, 0.03);
  EXPECT_NEAR(mean_of(meadow.flexibility, count), 1.0, 0.05);

  // Headings are spread all around: no direction is left out.
  std::size_t quadrants[4] = {};
  for (std::size_t i = 0; i < count; ++i) {
    ++quadrants[(skeleton.rest_x[i] > 0.0F ? 1U : 0U) + (skeleton.rest_z[i] > 0.0F ? 2U : 0U)];
  }
  EXPECT_GT(*std::min_element(quadrants, quadrants + 4), count / 8);
  const auto [shortest, longest] = std::minmax_element(
      skeleton.link_length_m.begin(), skeleton.link_length_m.begin() + static_cast<std::ptrdiff_t>(count));
  EXPECT_GT(*longest, 2.0F * *shortest);
}

TEST(MeadowTest, TheSameSeedGivesTheSameMeadowAndAnotherSeedAnother) {
  const MeadowSpec spec{.blades_across = 20, .blades_deep = 20, .seed = 4};
  MeadowSpec other = spec;
  other.seed = 5;
  EXPECT_EQ(bits_of(make_meadow(spec).skeleton.root_x_m), bits_of(make_meadow(spec).skeleton.root_x_m));
  EXPECT_NE(bits_of(make_meadow(spec).skeleton.root_x_m), bits_of(make_meadow(other).skeleton.root_x_m));
}

}  // namespace
}  // namespace yuragi::scenes
