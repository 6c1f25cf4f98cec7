#include "engine/wind/turbulence/site_spectrum.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/wind/blend/blend_run.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kSiteDay_s = 86400.0;

double db_of(double power) {
  return 10.0 * std::log10(power);
}

TEST(SiteSpectrum, KnowsNothingAndChangesNothing) {
  const SiteSpectrum site;
  for (const double frequency_hz : {0.001, 0.05, 0.4, 5.0}) EXPECT_EQ(site.power(frequency_hz, 14.0), 1.0);
}

TEST(SiteSpectrum, IsBelievedByAndByAndForgottenOverDays) {
  SiteSpectrum site;
  double last_db = 0.0;
  for (int step = 0; step < 100; ++step) {
    site.learn(1, 4.0, 14.0);
    const double now_db = site.octaves_db()[1];
    EXPECT_GT(now_db, last_db);
    EXPECT_LT(now_db - last_db, 0.1);
    last_db = now_db;
  }
  EXPECT_NEAR(last_db, 4.0 * 1400.0 / 2000.0, 0.05);
  for (double time_s = 0.0; time_s < 2.0 * kSiteDay_s; time_s += 14.0) site.learn(1, 4.0, 14.0);
  EXPECT_NEAR(site.octaves_db()[1], 4.0, 0.05);
  for (double time_s = 0.0; time_s < 10.0 * kSiteDay_s; time_s += 14.0) site.learn(1, -2.0, 14.0);
  EXPECT_NEAR(site.octaves_db()[1], -2.0, 0.4);
  EXPECT_LE(site.known_s()[1], 3.0 * kSiteDay_s * 1.001);
}

TEST(SiteSpectrum, CorrectsWhatASourceDoesNotTellItself) {
  SiteSpectrum site;
  site.expect(std::vector<double>{2.0, 4.0, 6.0});
  EXPECT_NEAR(db_of(site.power(SiteSpectrum::centre_hz(0), 14.0)), 2.0, 0.02);
  EXPECT_NEAR(db_of(site.power(SiteSpectrum::centre_hz(1), 14.0)), 4.0, 0.02);
  EXPECT_NEAR(db_of(site.power(std::numbers::sqrt2 * SiteSpectrum::centre_hz(1), 14.0)), 5.0, 0.02);
  // Above all that is known it goes on as it is there; below, where a source of 14 s tells itself, there is nothing.
  EXPECT_NEAR(db_of(site.power(5.0, 14.0)), 6.0, 0.02);
  EXPECT_EQ(site.power(0.02, 14.0), 1.0);
  // A quicker source is corrected from where it ends; a quick one not at all.
  const double ends_hz = 0.37 / 4.0;
  EXPECT_EQ(site.power(ends_hz, 4.0), 1.0);
  EXPECT_NEAR(db_of(site.power(ends_hz * 1.001, 4.0)), 0.0, 0.01);
  EXPECT_NEAR(db_of(site.power(5.0, 4.0)), 6.0 - 4.0 + 2.0 * std::log2(SiteSpectrum::centre_hz(1) / ends_hz), 0.02);
  EXPECT_EQ(site.power(0.4, 1.0), 1.0);
}

TEST(SiteSpectrum, IsBoundedWhateverItIsTold) {
  SiteSpectrum site;
  site.learn(0, std::numeric_limits<double>::quiet_NaN(), 14.0);
  site.learn(0, std::numeric_limits<double>::infinity(), 14.0);
  site.learn(SiteSpectrum::kOctaves, 3.0, 14.0);
  site.learn(0, 3.0, 0.0);
  EXPECT_EQ(site.known_s()[0], 0.0);
  for (double time_s = 0.0; time_s < kSiteDay_s; time_s += 14.0) site.learn(2, -300.0, 14.0);
  EXPECT_EQ(site.octaves_db()[2], -SiteSpectrum::kMost_db);
  site.expect(std::vector<double>(20, 500.0));
  EXPECT_LE(site.octaves_db()[0], SiteSpectrum::kMost_db);
}

TEST(SiteSpectrum, IsTheSameFromAFile) {
  SiteSpectrum site;
  for (int i = 0; i < 300; ++i) {
    site.learn(0, 1.5, 14.0);
    site.learn(3, -2.5, 14.0);
  }
  SiteSpectrum other;
  ASSERT_TRUE(other.restore(site.known_s(), site.learnt_db()));
  EXPECT_EQ(other.octaves_db(), site.octaves_db());
  const std::vector<double> wrong(SiteSpectrum::kOctaves, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(other.restore(wrong, site.learnt_db()));
  EXPECT_FALSE(other.restore(site.known_s(), wrong));
  EXPECT_FALSE(other.restore({}, {}));
  EXPECT_EQ(other.octaves_db(), site.octaves_db());
}

/// An hour of gusts from a quick source beside a slow one, each as it may.
std::shared_ptr<SiteSpectrum> fitted(bool may_fit, double interval_s) {
  auto site = std::make_shared<SiteSpectrum>();
  blend::Settings settings = blend::BlendRun::usual();
  settings.site = site;
  settings.sources = {{.fits_site = may_fit}};
  blend::BlendRun blend(1, settings);
  blend::TestGusts gusts(7);
  for (double time_s = 0.0; time_s < 1200.0; time_s += interval_s) {
    blend.read(5.0 + gusts.next(), 180.0);
    blend.run_for(interval_s);
  }
  return site;
}

TEST(SiteSpectrum, IsFittedFromFastSourcesThatMay) {
  const auto site = fitted(true, 1.0);
  EXPECT_GT(site->known_s()[0], 600.0);
  EXPECT_GT(site->known_s()[3], 600.0);
  EXPECT_EQ(site->known_s()[4], 0.0) << "no reading a second tells of that";
  EXPECT_EQ(fitted(false, 1.0)->known_s()[0], 0.0);
  EXPECT_EQ(fitted(true, 2.0)->known_s()[0], 0.0);
}

TEST(SiteSpectrum, WhatItLearnsMovesTheWindNoMoreThanItMovesAnyway) {
  const auto largest_step = [](bool learns) {
    auto site = std::make_shared<SiteSpectrum>();
    blend::Settings settings = blend::BlendRun::usual();
    settings.site = site;
    blend::BlendRun blend(1, settings);
    blend::TestGusts gusts(5);
    for (int i = 0; i < 40; ++i) {
      // All at once, as nothing in the daemon does.
      if (learns && i == 20) site->expect(std::vector<double>(SiteSpectrum::kOctaves, SiteSpectrum::kMost_db));
      if (i == 20) blend.take_largest_step_m_s();
      blend.read(5.0 + gusts.next(), 180.0);
      blend.run_for(14.0);
      if (i == 20) return blend.take_largest_step_m_s();
    }
    return 0.0;
  };
  // Ten times the power has steps of 3.2 times the size, and no jump besides.
  EXPECT_LT(largest_step(true), 3.3 * largest_step(false));
}

}  // namespace
}  // namespace yuragi::wind::turbulence
