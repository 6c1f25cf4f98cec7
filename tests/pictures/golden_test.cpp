// Each scene in each weather against its golden picture. A picture that differs is written, with the golden one and
// what differs, into the build folder. tests/pictures/renew.sh draws the golden pictures anew.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "tests/pictures/golden_pictures.hpp"
#include "tests/support/places.hpp"
#include "viewer/gl/driver.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/pass_clock.hpp"
#include "viewer/picture/picture_file.hpp"

namespace yuragi::viewer {
namespace {

// Between what differs by itself and what has to be seen. By itself: a picture and its own JPEG file, a mean of 0.26 to
// 0.29 and no square changed; with shaders computed 4 pixels at a time in place of 8, not a bit. To be seen: the least
// that a scene in the next stronger or weaker wind differs by is 0.013 of the squares (a poplar in a breeze, from calm
// air). (One sample a pixel in place of 4 changes up to 0.12.)
constexpr double kMaxMean = 0.60;
constexpr double kMaxChangedPart = 0.001;

bool is_like(const Picture& a, const Picture& b) {
  const PictureDifference differs = difference(a, b);
  return differs.mean <= kMaxMean && differs.changed_part <= kMaxChangedPart;
}

testing::AssertionResult is_golden(const Picture& picture, const std::string& file) {
  const auto golden = read_picture(golden_folder() / file);
  if (golden && is_like(picture, *golden)) return testing::AssertionSuccess();

  const std::filesystem::path folder = test::built_path("tests/pictures/failed");
  const std::string stem = std::filesystem::path(file).stem().string();
  const auto save = [&](const std::string& what, const Picture& of) {
    const std::filesystem::path to = folder / (stem + "-" + what + ".png");
    picture::write_picture(to, of.width_px, of.height_px, of.rgb);
    return to.string();
  };
  std::filesystem::create_directories(folder);
  const std::string drawn = save("drawn", picture);
  if (!golden) {
    return testing::AssertionFailure() << "there is no golden picture " << file << ". Drawn: " << drawn
                                       << "\nIf that is right: tests/pictures/renew.sh";
  }
  const PictureDifference differs = difference(picture, *golden);
  return testing::AssertionFailure() << fmt::format(
             "differs from the golden picture {}: mean {:.2f} (allowed {:.2f}), changed part {:.4f} (allowed "
             "{:.4f})\ndrawn:      {}\ngolden:     {}\ndifference: {}\nIf what is drawn is right: "
             "tests/pictures/renew.sh",
             file, differs.mean, kMaxMean, differs.changed_part, kMaxChangedPart, drawn, save("golden", *golden),
             save("difference", difference_picture(picture, *golden)));
}

Picture golden(std::string_view scene, const Weather& weather) {
  return read_picture(golden_folder() / golden_file(scene, weather)).value_or(Picture{});
}

/// Each value changed by a function of it and its channel.
template <class Change>
Picture changed(Picture picture, Change&& change) {
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    picture.rgb[i] = static_cast<std::uint8_t>(std::clamp(change(static_cast<double>(picture.rgb[i]), i), 0.0, 255.0));
  }
  return picture;
}

class GoldenPictureTest : public testing::TestWithParam<std::string_view> {};

TEST_P(GoldenPictureTest, IsDrawnAsTheGoldenOneInEachWeather) {
  GoldenDrawing drawing;
  for (const Weather& weather : kWeathers) {
    const Picture picture = drawing.draw(golden_moment(GetParam(), weather));
    EXPECT_TRUE(is_golden(picture, golden_file(GetParam(), weather)));
  }
  EXPECT_EQ(gl::gl_error_count(), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenPictureTest, testing::ValuesIn(picture_scenes()),
                         [](const auto& scene) { return std::string(scene.param); });

/// Where Mesa is held down to OpenGL 3.1.
class OldContextTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* const held =
        std::getenv("MESA_GL_VERSION_OVERRIDE");  // NOLINT(concurrency-mt-unsafe): nobody changes it
    if (held == nullptr) {
      GTEST_SKIP() << "MESA_GL_VERSION_OVERRIDE is not set: ctest -R pictures_by_opengl_31 sets it";
    }
  }
};

constexpr std::string_view kOfEachFamilyOfShaders[] = {"grass", "fur", "banner", "cherry", "ripple", "flame"};

// In calm air, the first weather: grass far away remembers what was before.
TEST_F(OldContextTest, DrawsTheGoldenPictures) {
  GoldenDrawing drawing;
  const gl::Driver driver = gl::current_driver();
  ASSERT_LE(driver.gl_version, 31) << "Mesa is not held down: " << driver.version;
  EXPECT_EQ(gl::glsl_version_line(), "#version 140");
  const Weather& calm = kWeathers.front();
  for (const std::string_view scene : kOfEachFamilyOfShaders) {
    EXPECT_TRUE(is_golden(drawing.draw(golden_moment(scene, calm)), golden_file(scene, calm)));
  }
  EXPECT_EQ(gl::gl_error_count(), 0);
}

/// Where Mesa is held down to OpenGL ES 3.0, which browsers have as WebGL 2.
class BrowserContextTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* const held =
        std::getenv("MESA_GLES_VERSION_OVERRIDE");  // NOLINT(concurrency-mt-unsafe): nobody changes it
    if (held == nullptr) {
      GTEST_SKIP() << "MESA_GLES_VERSION_OVERRIDE is not set: ctest -R pictures_by_opengl_es_30 sets it";
    }
  }

  /// Since the test began.
  int errors() const { return gl::gl_error_count() - errors_before_; }

 private:
  const int errors_before_ = gl::gl_error_count();
};

TEST_F(BrowserContextTest, ReportsWhatOpenglEsDoesNotHave) {
  const GoldenDrawing drawing(1, gl::kVersionsOfBrowsers);
  glBindTexture(GL_TEXTURE_BUFFER, 0);
  EXPECT_EQ(errors(), 1);
}

TEST_F(BrowserContextTest, DrawsTheGoldenPictures) {
  GoldenDrawing drawing(4, gl::kVersionsOfBrowsers);
  const gl::Driver driver = gl::current_driver();
  ASSERT_TRUE(driver.is_es && driver.gl_version == 30) << "Mesa is not held down: " << driver.version;
  const Weather& calm = kWeathers.front();
  for (const std::string_view scene : kOfEachFamilyOfShaders) {
    EXPECT_TRUE(is_golden(drawing.draw(golden_moment(scene, calm)), golden_file(scene, calm)));
  }
  EXPECT_EQ(errors(), 0);
}

Picture drawn_in(look::Quality quality, std::span<const gl::Version> versions, const GoldenMoment& moment) {
  GoldenDrawing drawing(1, versions);
  EXPECT_EQ(gl::current_driver().is_es, versions.front().is_es);
  drawing.set_quality(quality);
  return drawing.draw(moment);
}

// It has what low, that of the golden pictures, has not: soft shadows, and all of the water.
TEST_F(BrowserContextTest, DrawsTheGardenInHighAsTheDesktopDoes) {
  const GoldenMoment garden = golden_moment("garden", kWeathers.front());
  const Picture by_es = drawn_in(look::Quality::kHigh, gl::kVersionsOfBrowsers, garden);
  const Picture by_desktop = drawn_in(look::Quality::kHigh, gl::kVersionsToAskFor, garden);
  EXPECT_GT(signal_to_noise_db(by_es, by_desktop), 40.0);
  EXPECT_EQ(errors(), 0);
}

TEST_F(OldContextTest, TimesPassesWithoutTimestamps) {
  const gl::HeadlessContext context({.is_software = true, .has_messages = true});
  ASSERT_FALSE(epoxy_has_gl_extension("GL_ARB_timer_query")) << "Mesa is not held down";
  gl::report_gl_errors();
  gl::PassClock clock(gl::PassClock::By::kGpu);
  clock.begin();
  clock.mark("first");
  clock.mark("second");
  const std::vector<gl::PassClock::Pass> passes = clock.end();
  ASSERT_EQ(passes.size(), 2U);
  for (const gl::PassClock::Pass& pass : passes) EXPECT_GE(pass.time_ms, 0.0) << pass.name;
  EXPECT_EQ(gl::gl_error_count(), 0);
}

TEST(GoldenPicturesTest, AreThoseOfTheScenesAndSmall) {
  std::set<std::string> expected;
  for (const std::string_view scene : picture_scenes()) {
    for (const Weather& weather : kWeathers) expected.insert(golden_file(scene, weather));
  }
  std::set<std::string> found;
  std::uintmax_t bytes = 0;
  for (const auto& file : std::filesystem::directory_iterator(golden_folder())) {
    found.insert(file.path().filename().string());
    bytes += file.file_size();
  }
  EXPECT_EQ(found, expected);
  EXPECT_LT(bytes, 3'000'000U);
}

// What the comparison has to see, and what not.

TEST(GoldenComparisonTest, TellsEachSceneFromEachOtherAndEachWeatherFromTheOthers) {
  std::vector<std::pair<std::string, Picture>> all;
  for (const std::string_view scene : picture_scenes()) {
    for (const Weather& weather : kWeathers) all.emplace_back(golden_file(scene, weather), golden(scene, weather));
  }
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      EXPECT_FALSE(is_like(all[a].second, all[b].second)) << all[a].first << " and " << all[b].first;
    }
  }
}

TEST(GoldenComparisonTest, TellsWrongColorsAndLessLight) {
  for (const std::string_view scene : picture_scenes()) {
    const Picture right = golden(scene, kWeathers[0]);
    const auto dimmed = changed(right, [](double value, std::size_t) { return 0.97 * value; });
    const auto redder = changed(right, [](double value, std::size_t i) { return i % 3 == 0 ? value + 4.0 : value; });
    EXPECT_FALSE(is_like(right, dimmed)) << scene;
    EXPECT_FALSE(is_like(right, redder)) << scene;
  }
}

TEST(GoldenComparisonTest, ForgivesNoiseOfSinglePixels) {
  const math::RandomStream chance(1, 0);
  const Picture right = golden("grass", kWeathers[1]);
  const auto noisy =
      changed(right, [&](double value, std::size_t i) { return value + 8.0 * (chance.uniform(i) - 0.5); });
  EXPECT_TRUE(is_like(right, noisy));
}

TEST(GoldenComparisonTest, TellsPicturesOfDifferentSizesAndNoPicture) {
  const Picture picture{2, 1, {9, 9, 9, 9, 9, 9}};
  EXPECT_TRUE(is_like(picture, picture));
  EXPECT_FALSE(is_like(picture, Picture{1, 2, picture.rgb}));
  EXPECT_FALSE(is_like(Picture{}, Picture{}));
}

TEST(GoldenComparisonTest, TellsATreeWithoutItsLeaves) {
  GoldenDrawing drawing;
  for (const std::string_view species : {"cherry", "zelkova", "poplar"}) {
    GoldenMoment bare = golden_moment(species, kWeathers[1]);
    std::get<pose::TreeSkeleton>(bare.models[0].skeleton).levels.pop_back();
    std::get<pose::TreePose>(bare.poses.poses[0]).levels.pop_back();
    EXPECT_FALSE(is_like(drawing.draw(bare), golden(species, kWeathers[1]))) << species;
  }
}

TEST(GoldenComparisonTest, TellsAGardenWithoutAnyOneOfItsScenes) {
  GoldenDrawing drawing;
  const GoldenMoment whole = golden_moment("garden", kWeathers[1]);
  for (std::size_t scene = 0; scene < whole.models.size(); ++scene) {
    if (whole.models[scene].name == "sleeper" || whole.models[scene].name == "fire")
      continue;                                          // ten pixels in the distance
    if (whole.poses.opacities[scene] == 0.0F) continue;  // hidden from the beginning
    GoldenMoment rest = whole;
    rest.poses.opacities[scene] = 0.0F;
    EXPECT_FALSE(is_like(drawing.draw(rest), golden("garden", kWeathers[1]))) << whole.models[scene].name;
  }
}

}  // namespace
}  // namespace yuragi::viewer
