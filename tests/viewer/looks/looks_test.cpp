// Each renderer, drawn for real by the processor, and looked at: is something there where it
// should be, and does it move and fade?

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"
#include "viewer/gl/cross_fade.hpp"
#include "viewer/gl/edge_smoother.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/stream/scene_timeline.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;
using Pixels = std::vector<std::uint8_t>;

/// How many pixels of two pictures differ by more than a little.
std::size_t changed(const Pixels& a, const Pixels& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    int difference = 0;
    for (std::size_t channel = i; channel < i + 3; ++channel) difference += std::abs(a[channel] - b[channel]);
    if (difference > 12) ++count;
  }
  return count;
}

class OnScreenTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    context_ = std::make_unique<gl::HeadlessContext>(gl::HeadlessOptions{.is_software = true, .has_messages = true});
    gl::report_gl_errors();
  }
  static void TearDownTestSuite() {
    let_go();
    context_.reset();
  }

  void SetUp() override {
    if (!stage_) {
      stage_ = std::make_unique<Stage>();
      target_ = std::make_unique<gl::RenderTarget>(kWidth_px, kHeight_px, 1);
    }
    errors_before_ = gl::gl_error_count();
  }
  void TearDown() override {
    if (!keeps_stage()) let_go();
    EXPECT_EQ(gl::gl_error_count(), errors_before_);
  }

  /// For the next test of the suite: it only exchanges the scenes and draws, and what is new in a stage takes longest.
  virtual bool keeps_stage() const { return false; }

  static void let_go() {
    target_.reset();
    stage_.reset();
  }

  void show(const std::vector<wire::SceneModel>& models) {
    models_ = models;
    stage_->set_scenes(models);
    camera_.frame(stage_->home(static_cast<double>(kWidth_px) / kHeight_px));
  }

  Pixels draw(double strength, const std::vector<float>& opacities, double time_s = 2.0) {
    stream::PoseMoment moment = stream::rest_moment(models_);
    moment.time_s = time_s;
    for (std::size_t i = 0; i < models_.size(); ++i) moment.poses[i] = test_pose(models_[i], time_s, strength);
    moment.opacities = opacities;
    stage_->draw(moment, camera_, *target_);
    return target_->read_rgb();
  }
  Pixels draw(double strength, float opacity) { return draw(strength, std::vector<float>(models_.size(), opacity)); }

  std::vector<wire::SceneModel> models_;
  meshes::OrbitCamera camera_;
  static inline std::unique_ptr<Stage> stage_;
  static inline std::unique_ptr<gl::RenderTarget> target_;

 private:
  static inline std::unique_ptr<gl::HeadlessContext> context_;
  int errors_before_ = 0;
};

class LooksTest : public OnScreenTest, public testing::WithParamInterface<const char*> {
 protected:
  bool keeps_stage() const override { return true; }
};

TEST_P(LooksTest, ShowsSomethingInTheMiddleAndNothingInTheSkysCorners) {
  show({test_model(GetParam())});
  const Pixels with = draw(0.0, 1.0F);
  const Pixels without = draw(0.0, 0.0F);
  EXPECT_GT(changed(with, without), kWidth_px * kHeight_px / 60U);

  // Framed: the outermost columns of the sky are empty.
  const std::size_t sky_rows = kHeight_px / 5;
  for (std::size_t row = 0; row < sky_rows; ++row) {
    for (const std::size_t column : {std::size_t{0}, std::size_t{kWidth_px - 1}}) {
      const std::size_t at = 3 * (row * kWidth_px + column);
      ASSERT_NEAR(with[at], without[at], 8) << row;
    }
  }
}

TEST_P(LooksTest, IsDrawnAsTheSamePictureTwice) {
  show({test_model(GetParam())});
  EXPECT_EQ(draw(0.5, 1.0F), draw(0.5, 1.0F));
}

TEST_P(LooksTest, ShowsThatItMoves) {
  show({test_model(GetParam())});
  EXPECT_GT(changed(draw(0.2, {1.0F}, 2.0), draw(1.0, {1.0F}, 2.4)), 200U);
}

TEST_P(LooksTest, FadesByHalfOfItsPixels) {
  show({test_model(GetParam())});
  // The ground around a fire, trampled and lit, changes everywhere at once, and so does the shadow that half of a
  // curtain's threads throw on its boards: of both, what stands before the sky counts.
  const std::string_view kind = GetParam();
  const bool is_ground_lit = kind.starts_with("flame") || kind == "curtain";
  const auto counted = [&](Pixels pixels) {
    if (is_ground_lit) pixels.resize(pixels.size() * 2 / 5);
    return pixels;
  };
  const Pixels none = counted(draw(0.3, 0.0F));
  const auto whole = static_cast<double>(changed(counted(draw(0.3, 1.0F)), none));
  const auto half = static_cast<double>(changed(counted(draw(0.3, 0.5F)), none));
  const auto little = static_cast<double>(changed(counted(draw(0.3, 0.1F)), none));
  EXPECT_NEAR(half / whole, 0.5, 0.06);
  EXPECT_NEAR(little / whole, 0.1, 0.04);
}

TEST_P(LooksTest, DrawsNothingOfAPoseThatIsNotItsOwn) {
  show({test_model(GetParam())});
  const Pixels without = draw(0.0, 0.0F);
  stream::PoseMoment moment = stream::rest_moment(models_);
  moment.poses[0] = std::holds_alternative<pose::StrandPose>(moment.poses[0]) ? pose::Pose(pose::GridPose{})
                                                                              : pose::Pose(pose::StrandPose{});
  stage_->draw(moment, camera_, *target_);
  EXPECT_EQ(target_->read_rgb(), without);
}

INSTANTIATE_TEST_SUITE_P(Kinds, LooksTest,
                         testing::Values("grass", "fur", "curtain", "flag", "banner", "tree", "ripple", "flame",
                                         "flame panel"),
                         [](const auto& kind) {
                           std::string name = kind.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

class StageTest : public OnScreenTest {};

TEST_F(StageTest, CrossFadesFromOneCameraToAnotherAsTheirLightsMix) {
  show({test_model("tree")});
  gl::CrossFade cross_fade;
  const Pixels before = draw(0.3, 1.0F);
  cross_fade.keep(*target_);
  meshes::CameraPlace other = camera_.place();
  other.heading_deg += 140.0;
  camera_.go_to(other);
  const Pixels now = draw(0.3, 1.0F);
  ASSERT_GT(changed(before, now), kWidth_px * kHeight_px / 4U);

  const auto faded = [&](float share) {
    draw(0.3, 1.0F);
    cross_fade.draw(*target_, share);
    return target_->read_rgb();
  };
  EXPECT_EQ(changed(faded(0.0F), before), 0U);
  EXPECT_EQ(changed(faded(1.0F), now), 0U);
  const auto light_of = [](std::uint8_t value) { return std::pow((value / 255.0 + 0.055) / 1.055, 2.4); };
  const Pixels half = faded(0.5F);
  for (std::size_t i = 0; i < half.size(); i += 97) {
    if (std::min({before[i], now[i], half[i]}) < 12) continue;  // where the curve is a straight line
    const double light = 0.5 * (light_of(before[i]) + light_of(now[i]));
    ASSERT_NEAR(half[i], 255.0 * (1.055 * std::pow(light, 1.0 / 2.4) - 0.055), 1.5) << i;
  }
  // What is drawn next is as ever: nothing of the renderers' was changed.
  EXPECT_EQ(draw(0.3, 1.0F), now);
}

/// The mean of a channel over one of 4 x 3 fields of a picture.
double mean_of(const Pixels& pixels, std::size_t column, std::size_t row) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t y = row * kHeight_px / 3; y < (row + 1) * kHeight_px / 3; ++y) {
    for (std::size_t x = column * kWidth_px / 4; x < (column + 1) * kWidth_px / 4; ++x) {
      sum += pixels[3 * (y * kWidth_px + x) + 1];
      ++count;
    }
  }
  return sum / static_cast<double>(count);
}

TEST_F(StageTest, APictureOfFewerPixelsIsTheSameAndFillsTheWhole) {
  show(test_garden());
  const Pixels whole = draw(0.5, 1.0F);
  target_->set_drawn_side(0.5F);
  EXPECT_EQ(target_->drawn_width_px(), kWidth_px / 2);
  EXPECT_EQ(target_->width_px(), kWidth_px);
  const Pixels half = draw(0.5, 1.0F);
  EXPECT_NE(half, whole);
  // No blade is thinner than a pixel: of larger ones the grass is a little lighter.
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      EXPECT_NEAR(mean_of(half, column, row), mean_of(whole, column, row), 10.0) << column << " " << row;
    }
  }
  target_->set_drawn_side(1.0F);
  EXPECT_EQ(draw(0.5, 1.0F), whole);
}

TEST_F(StageTest, DrawsFewerBladesWhereThatIsAsked) {
  show({test_model("grass")});
  const Pixels all = draw(0.5, 1.0F);
  stage_->set_blade_share(0.3F);
  EXPECT_GT(changed(draw(0.5, 1.0F), all), 200U);
  stage_->set_blade_share(1.0F);
  EXPECT_EQ(draw(0.5, 1.0F), all);
}

TEST_F(StageTest, DrawsHiddenScenesNotAtAll) {
  show(test_garden());
  const Pixels empty = draw(0.5, 0.0F);
  std::vector<float> opacities(models_.size(), 0.0F);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    opacities[i] = 1.0F;
    EXPECT_GT(changed(draw(0.5, opacities), empty), 20U) << models_[i].name;
    opacities[i] = 0.0F;
  }
  EXPECT_EQ(draw(0.5, opacities), empty);
}

TEST_F(StageTest, ShowsAndFramesOneSceneAlone) {
  show(test_garden());
  const double all_m = stage_->home(1.5).distance_m;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    stage_->show_next();
    EXPECT_LT(stage_->home(1.5).distance_m, all_m) << models_[i].name;
    camera_.frame(stage_->home(1.5));

    // The others may be hidden or not: it makes no difference.
    std::vector<float> only(models_.size(), 0.0F);
    only[i] = 1.0F;
    EXPECT_EQ(draw(0.5, 1.0F), draw(0.5, only)) << models_[i].name;
  }
  stage_->show_next();
  EXPECT_EQ(stage_->home(1.5).distance_m, all_m);
}

/// How many names of each kind of OpenGL object are in use.
std::array<std::size_t, 4> gl_objects() {
  std::array<std::size_t, 4> count{};
  for (GLuint name = 1; name < 4096; ++name) {
    if (glIsBuffer(name) == GL_TRUE) ++count[0];
    if (glIsTexture(name) == GL_TRUE) ++count[1];
    if (glIsVertexArray(name) == GL_TRUE) ++count[2];
    if (glIsProgram(name) == GL_TRUE) ++count[3];
  }
  return count;
}

TEST_F(StageTest, ExchangedScenesLeaveNothingOnTheGpu) {
  const std::vector<wire::SceneModel> garden = test_garden();
  show(garden);
  draw(0.5, 1.0F);
  const auto before = gl_objects();
  EXPECT_GT(before[0], 0U);
  for (int round = 0; round < 4; ++round) {
    show({test_model("curtain", {.east_m = round + 1.0}), garden[0], test_model("flame")});
    draw(0.5, 1.0F);
    show(garden);
    draw(0.5, 1.0F);
    ASSERT_EQ(gl_objects(), before) << round;
  }
}

TEST_F(StageTest, AfterAnExchangeThePictureIsAsIfTheScenesHadAlwaysBeenThere) {
  const std::vector<wire::SceneModel> garden = test_garden();
  show({garden[2], garden[0], garden[1]});
  draw(0.5, 1.0F);
  show({garden[0], garden[2], test_model("flag", {.east_m = 2.0})});
  const Pixels exchanged = draw(0.7, 1.0F);
  stage_ = std::make_unique<Stage>();
  show(models_);
  EXPECT_EQ(draw(0.7, 1.0F), exchanged);
}

TEST_F(StageTest, WhereTheSceneThatAloneWasDrawnIsGoneAllAreDrawn) {
  const std::vector<wire::SceneModel> garden = test_garden();
  show(garden);
  stage_->show_only(garden[1].name);
  show({garden[1], garden[0]});
  const Pixels alone = draw(0.5, 1.0F);
  show({garden[0], garden[2]});
  EXPECT_EQ(draw(0.5, {0.0F, 0.0F}).size(), alone.size());
  EXPECT_GT(changed(draw(0.5, {1.0F, 1.0F}), draw(0.5, {0.0F, 0.0F})), 100U);
}

/// A flag on a lawn gives way to a curtain, as the daemon exchanges them: a picture of each frame. None differs from
/// the one before by more than a cross-fade moves.
TEST_F(StageTest, ScenesThatAreExchangedFadeWithoutAFlicker) {
  const wire::SceneModel lawn = test_model("grass", {.east_m = -2.0});
  const wire::SceneModel flag = test_model("flag");
  const wire::SceneModel curtain = test_model("curtain");
  stream::SceneTimeline timeline;
  double time_s = 0.0;
  Pixels before;
  std::size_t most_changed = 0;
  const auto show_now = [&](double now_s) {
    const stream::PoseMoment& moment = timeline.advance(now_s);
    if (auto scenes = timeline.take_new_scenes()) {
      const bool is_first = stage_->scenes().empty();
      stage_->set_scenes(std::move(*scenes));
      if (is_first) camera_.frame(stage_->home(1.33));
    }
    stage_->draw(moment, camera_, *target_);
    Pixels now = target_->read_rgb();
    if (!before.empty()) most_changed = std::max(most_changed, changed(before, now));
    before = std::move(now);
  };
  const auto run = [&](const std::vector<wire::SceneModel>& models, int frames, const auto& opacities) {
    timeline.set_scenes({models});
    if (!before.empty()) show_now(time_s + 0.005);  // the scenes have come, and no frame of them yet
    for (int i = 0; i < frames; ++i) {
      wire::Frame frame;
      frame.info.time_s = time_s += 1.0 / 60.0;
      for (const wire::SceneModel& model : models) frame.poses.push_back(test_pose(model, 0.05 * time_s, 0.3));
      frame.opacities = opacities(static_cast<double>(i + 1) / frames);
      EXPECT_TRUE(timeline.accept(frame, time_s));
      show_now(time_s);
    }
  };
  run({lawn, flag}, 20, [](double) { return std::vector{1.0F, 1.0F}; });
  const std::size_t most_at_rest = most_changed;
  const Pixels with_flag = before;
  run({lawn, curtain, flag}, 60, [](double share) {
    const auto smooth = static_cast<float>(share * share * (3.0 - 2.0 * share));
    return std::vector{1.0F, smooth, 1.0F - smooth};
  });
  run({lawn, curtain}, 20, [](double) { return std::vector{1.0F, 1.0F}; });
  const std::size_t whole = changed(with_flag, before);
  std::printf("changed pixels: %zu in all, %zu at most from a picture to the next, %zu while nothing was exchanged\n",
              whole, most_changed, most_at_rest);
  EXPECT_GT(whole, 2000U);
  // At its fastest the cross-fade takes 2.5 % of the pixels a frame, and the grass that makes room for the curtain's
  // floor changes in each.
  EXPECT_LT(most_changed, most_at_rest + whole / 12);
}

TEST_F(StageTest, AClothHasTheColorsAndThePictureThatAreWanted) {
  const auto reds = [&](const look::ClothLook& look) {
    wire::SceneModel flag = test_model("flag");
    flag.cloth = look;
    show({flag});
    const Pixels pixels = draw(0.3, 1.0F);
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 3) {
      count += pixels[i] > 2 * pixels[i + 1] && pixels[i] > 2 * pixels[i + 2] ? 1U : 0U;
    }
    return count;
  };
  constexpr look::Color kRed{220, 10, 10};
  constexpr look::Color kBlue{10, 10, 220};
  EXPECT_LT(reds({}), 100U);
  const std::size_t all = reds({.color = kRed});
  EXPECT_GT(all, 500U);
  const std::size_t pattern = reds({.color = kBlue, .color_2 = kRed});
  EXPECT_GT(pattern, 50U);
  EXPECT_LT(pattern, all / 2);
  const auto half_red = std::make_shared<look::Image>(look::Image{2, 1, {220, 10, 10, 10, 10, 220}});
  const std::size_t printed = reds({.image = half_red});
  EXPECT_GT(printed, all / 4);
  EXPECT_LT(printed, all * 3 / 4);
}

TEST_F(StageTest, LightThatComesThroughACurtainHasItsColorOnTheBoards) {
  // From above, where hardly anything is seen of the curtain itself.
  const auto draw_in = [&](const look::Color& color) {
    wire::SceneModel model = test_model("curtain");
    model.cloth.color = color;
    show({model});
    const meshes::Bounds bounds = stage_->bounds();
    camera_.frame({glm::dvec3((bounds.low_m + bounds.high_m) / 2.0F), 0.0, 88.0, 8.0});
    return draw(0.0, 1.0F);
  };
  for (const look::Quality quality : {look::Quality::kLow, look::Quality::kMedium}) {
    stage_->set_quality(quality);
    const Pixels red = draw_in({255, 40, 40});
    const Pixels blue = draw_in({40, 40, 255});
    std::size_t redder = 0;
    for (std::size_t i = 0; i + 2 < red.size(); i += 3) {
      if (red[i] > blue[i] + 3 && red[i + 2] + 3 < blue[i + 2] && red[i] < 160) ++redder;
    }
    EXPECT_GT(redder, 250U) << name_of(quality);
  }
}

TEST_F(StageTest, OpensTheGroundOverWater) {
  // Troughs go below the ground, and are seen: no turf in the middle of the pond.
  show({test_model("ripple")});
  camera_.frame({{0.0, 0.0, 0.0}, 200.0, 60.0, 6.0});
  const Pixels calm = draw(0.0, 1.0F);
  const Pixels storm = draw(1.0, 1.0F);
  std::size_t green = 0;
  for (int row = kHeight_px / 2 - 6; row < kHeight_px / 2 + 6; ++row) {
    for (int column = kWidth_px / 2 - 30; column < kWidth_px / 2 + 30; ++column) {
      const auto at = 3 * static_cast<std::size_t>(row * kWidth_px + column);
      if (2 * storm[at + 2] < storm[at + 1]) ++green;
    }
  }
  EXPECT_EQ(green, 0U);
  EXPECT_GT(changed(calm, storm), 1000U);
}

TEST_F(StageTest, OfPondsAtTwoHeightsTheWidestHasTheMirrorWhicheverComesFirst) {
  const wire::SceneModel low = test_model("ripple");
  wire::SceneModel high = low;
  high.name = "high";
  auto& surface = std::get<pose::SurfaceSkeleton>(high.skeleton);
  for (float& y_m : surface.rest_y_m) y_m += 0.6F;
  for (float& x_m : surface.rest_x_m) x_m += 40.0F;
  show({low, high});
  camera_.frame({{10.0, 0.0, 0.0}, 270.0, 14.0, 20.0});
  const Pixels first = draw(0.5, 1.0F);
  models_ = {high, low};
  stage_->set_scenes(models_);
  EXPECT_EQ(changed(first, draw(0.5, 1.0F)), 0U);
}

TEST_F(StageTest, WhatIsSeenNowhereIsNotMoved) {
  show({test_model("curtain"), test_model("tree")});
  camera_.frame({{0.0, 1.0, 0.0}, 0.0, 5.0, 8.0});
  const auto uploaded_by = [&](double strength) {
    const std::size_t before = gl::uploaded_bytes();
    draw(strength, 1.0F);
    return gl::uploaded_bytes() - before;
  };
  uploaded_by(0.2);
  const std::size_t in_view = uploaded_by(0.4);
  camera_.frame({{0.0, 400.0, 0.0}, 0.0, -80.0, 8.0});  // up into the sky
  uploaded_by(0.6);
  EXPECT_LT(uploaded_by(0.8), in_view / 4);
}

TEST_F(StageTest, ThrowsShadowsOnTheGround) {
  // Toward the north-east of a tree, seen from above, the ground is darker.
  show({test_model("tree")});
  camera_.frame({{2.5, 0.0, -1.5}, 239.0, 60.0, 3.0});
  for (const look::Quality quality : {look::Quality::kLow, look::Quality::kMedium, look::Quality::kHigh}) {
    stage_->set_quality(quality);
    const Pixels with = draw(0.0, 1.0F);
    const Pixels without = draw(0.0, 0.0F);
    std::size_t darker = 0;
    for (std::size_t i = 0; i + 2 < with.size(); i += 3) {
      if (with[i + 1] + 8 < without[i + 1]) ++darker;
    }
    EXPECT_GT(darker, 500U) << name_of(quality);
  }
}

/// Brightness of a screen's pixel, 0 to 255 (Rec. 709).
double luminance_at(const Pixels& pixels, std::size_t pixel) {
  return 0.2126 * pixels[3 * pixel] + 0.7152 * pixels[3 * pixel + 1] + 0.0722 * pixels[3 * pixel + 2];
}

/// The mean luminance of those pixels for which `is_counted`; 0 if there are none.
template <class IsCounted>
double mean_luminance(const Pixels& pixels, IsCounted&& is_counted) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t pixel = 0; pixel < pixels.size() / 3; ++pixel) {
    if (!is_counted(pixel)) continue;
    sum += luminance_at(pixels, pixel);
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

light::Light noon() {
  const std::vector<std::string> look{"sun=fixed", "sun_height=60", "sun_azimuth=180", "clouds=0"};
  return light::light_of(look::edited({}, look).value(), 0.0);
}

TEST_F(StageTest, GrassIsDarkInTheShadowOfACrownAtNoon) {
  // The sun is in the south: the shadow's middle lies north of the trunk, and the eye sees it from beyond.
  show({test_model("tree")});
  stage_->set_light(noon());
  const meshes::Bounds tree = stage_->bounds();
  const double crown_m = 0.65 * static_cast<double>(tree.high_m.y);
  camera_.frame({{0.0, 0.0, -crown_m / std::tan(60.0 * 0.017453292519943295)}, 180.0, 25.0, 2.0});
  for (const look::Quality quality : {look::Quality::kLow, look::Quality::kMedium, look::Quality::kHigh}) {
    stage_->set_quality(quality);
    const Pixels with = draw(0.0, 1.0F);
    const Pixels without = draw(0.0, 0.0F);
    // Squares of 8 pixels, so that no single blade counts: the darkest tenth of those on the ground.
    constexpr int kSide_px = 8;
    std::vector<double> shares;
    for (int top = kHeight_px / 2; top < kHeight_px; top += kSide_px) {
      for (int left = 0; left < kWidth_px; left += kSide_px) {
        const auto is_here = [&](std::size_t pixel) {
          const int row = static_cast<int>(pixel) / kWidth_px - top;
          const int column = static_cast<int>(pixel) % kWidth_px - left;
          return row >= 0 && row < kSide_px && column >= 0 && column < kSide_px;
        };
        shares.push_back(mean_luminance(with, is_here) / mean_luminance(without, is_here));
      }
    }
    std::ranges::sort(shares);
    std::printf("%s: shadowed over lit grass %.2f\n", std::string(name_of(quality)).c_str(),
                shares[shares.size() / 10]);
    EXPECT_LE(shares[shares.size() / 10], 0.45) << name_of(quality);
  }
}

TEST_F(StageTest, ShadowsOfCloudsFallOnTreesClothWaterAndFur) {
  for (const char* kind : {"tree", "flag", "curtain", "ripple", "fur"}) {
    show({test_model(kind)});
    const auto picture = [&](float held_back, float opacity) {
      light::Light light = noon();
      light.drift = {0.0F, 0.0F, held_back, -1.0F};  // a cloud everywhere
      stage_->set_light(light);
      return draw(0.0, opacity);
    };
    const Pixels lit = picture(0.0F, 1.0F);
    const Pixels shaded = picture(0.6F, 1.0F);
    const Pixels without = picture(0.0F, 0.0F);
    const auto is_thing = [&](std::size_t pixel) {
      return std::abs(luminance_at(lit, pixel) - luminance_at(without, pixel)) > 12.0 &&
             pixel < kWidth_px * kHeight_px * 2 / 3;
    };
    const double share = mean_luminance(shaded, is_thing) / mean_luminance(lit, is_thing);
    std::printf("%s below a cloud: %.2f as bright\n", kind, share);
    EXPECT_LT(share, 0.93) << kind;
  }
}

TEST_F(StageTest, AnOvercastNightWithoutAMoonIsTheDarkest) {
  show({test_model("grass"), test_model("tree", {.east_m = 3.0})});
  constexpr double kFullMoon_s = 1795561200.0;  // 2026-11-24, 23:00
  constexpr double kNewMoon_s = 1796770800.0;   // 2026-12-08, 23:00
  const auto brightness = [&](double utc_s, double clouds, double hour) {
    look::Look look{.sun = look::SunChoice::kTime, .latitude_deg = 48.0, .longitude_deg = 0.0, .clouds = clouds};
    look.solar_time_h = hour;
    stage_->set_light(light::light_of(look, utc_s));
    return mean_luminance(draw(0.0, 1.0F), [](std::size_t) { return true; });
  };
  const double full_moon = brightness(kFullMoon_s, 0.0, 23.0);
  const double stars = brightness(kNewMoon_s, 0.0, 23.0);
  const double overcast = brightness(kNewMoon_s, 1.0, 23.0);
  const double dusk = brightness(kNewMoon_s, 1.0, 16.4);
  std::printf("full moon %.1f, stars %.1f, overcast %.1f; overcast dusk %.1f\n", full_moon, stars, overcast, dusk);
  EXPECT_LT(stars, 0.85 * full_moon);
  EXPECT_LT(overcast, 0.45 * full_moon);
  EXPECT_LT(overcast, 0.35 * dusk);
  EXPECT_GT(overcast, 6.0) << "something is seen";
}

TEST_F(StageTest, ASmoothedPictureOfGrassHardlyFlickersAsTheCameraTurns) {
  show({test_model("grass")});
  gl::EdgeSmoother smoother;
  const double pixel_deg = 40.0 / kHeight_px;
  const auto flickering = [&](bool is_smoothed) {
    const auto picture = [&](double turned_px) {
      meshes::CameraPlace place = stage_->home(static_cast<double>(kWidth_px) / kHeight_px);
      place.heading_deg += turned_px * pixel_deg;
      camera_.go_to(place);
      draw(0.3, 1.0F);
      if (is_smoothed) smoother.draw(*target_);
      return target_->read_rgb();
    };
    const Pixels before = picture(0.0);
    const Pixels now = picture(0.3);
    std::size_t count = 0;
    const std::size_t from = before.size() / 2 / 3;
    for (std::size_t pixel = from; pixel < before.size() / 3; ++pixel) {
      int most = 0;
      for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) most = std::max(most, std::abs(before[i] - now[i]));
      count += most > 30 ? 1U : 0U;
    }
    return 100.0 * static_cast<double>(count) / static_cast<double>(before.size() / 3 - from);
  };
  const double plain = flickering(false);
  const double smoothed = flickering(true);
  std::printf("turned by 0.3 pixel, %.1f %% of the pixels change by more than 30 levels; smoothed %.1f %%\n", plain,
              smoothed);
  EXPECT_LE(smoothed, 5.0);
  EXPECT_LT(smoothed, 0.6 * plain);
}

TEST_F(StageTest, SeesABodyFromOutsideWhereverTheCameraStands) {
  show({test_model("fur")});
  const meshes::Bounds bounds = stage_->bounds();
  const meshes::CameraPlace within{glm::dvec3((bounds.low_m + bounds.high_m) / 2.0F), 160.0, 5.0, 0.25};
  const meshes::CameraPlace outside = stage_->outside(within);
  EXPECT_GT(outside.distance_m, 0.4);
  camera_.frame(outside);
  const Pixels seen = draw(0.0, 1.0F);
  camera_.frame(within);
  EXPECT_EQ(draw(0.0, 1.0F), seen);
}

TEST_F(StageTest, ShowsATreesGroveAndItsShadows) {
  const wire::SceneModel alone = test_model("tree");
  wire::SceneModel grove = alone;
  auto& copies = std::get<pose::TreeSkeleton>(grove.skeleton).copies;
  copies = {.x_m = {12.0F}, .z_m = {0.0F}, .turn_rad = {1.5F}, .scale = {1.0F}};
  for (const look::Quality quality : {look::Quality::kLow, look::Quality::kHigh}) {
    stage_->set_quality(quality);
    show({alone});
    camera_.frame({{12.0, 1.5, 0.0}, 0.0, 20.0, 9.0});
    const Pixels without = draw(0.0, 1.0F);
    show({grove});
    camera_.frame({{12.0, 1.5, 0.0}, 0.0, 20.0, 9.0});
    const Pixels with = draw(0.0, 1.0F);
    EXPECT_GT(changed(without, with), 500U) << name_of(quality);
    EXPECT_GT(changed(with, draw(3.0, 1.0F)), 100U) << "it moves";
  }
}

TEST_F(StageTest, ShowsFarTreesByPicturesInTheirPlaceAndLight) {
  // The copy is 30 m from the eye: an impostor.
  wire::SceneModel far = test_model("tree");
  auto& copies = std::get<pose::TreeSkeleton>(far.skeleton).copies;
  copies = {.x_m = {60.0F}, .z_m = {0.0F}, .turn_rad = {1.5F}, .scale = {1.0F}};
  for (const look::Quality quality : {look::Quality::kLow, look::Quality::kHigh}) {
    stage_->set_quality(quality);
    show({test_model("tree")});
    camera_.frame({{60.0, 1.5, 0.0}, 0.0, 5.0, 30.0});
    const Pixels without = draw(0.0, 1.0F);
    show({far});
    camera_.frame({{60.0, 1.5, 0.0}, 0.0, 5.0, 30.0});
    const Pixels with = draw(0.0, 1.0F);
    EXPECT_GT(changed(without, with), 20U) << name_of(quality);
    EXPECT_LT(changed(without, with), 5000U) << "a tree, not its sheet";
    EXPECT_EQ(changed(with, draw(0.0, 1.0F)), 0U) << "the second picture is as the first";
  }
}

TEST_F(StageTest, TreesLoseTheirLeavesOneAfterTheOtherNearAndFar) {
  // The copy at 60 m is an impostor, with quality low by its distance.
  wire::SceneModel tree = test_model("tree");
  std::get<pose::TreeSkeleton>(tree.skeleton).copies = {
      .x_m = {60.0F}, .z_m = {0.0F}, .turn_rad = {1.5F}, .scale = {1.0F}};
  light::Light light = light::light_of({}, 0.0);
  for (const double x_m : {0.0, 60.0}) {
    show({tree});
    camera_.frame({{x_m, 1.5, 0.0}, 0.0, 5.0, x_m == 0.0 ? 7.0 : 25.0});
    const auto picture = [&](float hanging) {
      light.leaves.w = hanging;
      stage_->set_light(light);
      return draw(0.0, 1.0F);
    };
    const Pixels summer = picture(1.0F);
    const Pixels winter = picture(0.0F);
    const std::size_t all = changed(summer, winter);
    EXPECT_GT(all, x_m == 0.0 ? 1000U : 30U) << x_m;
    Pixels before = summer;
    for (int step = 1; step <= 20; ++step) {
      Pixels now = picture(1.0F - static_cast<float>(step) / 20.0F);
      EXPECT_LT(changed(before, now), all / 3) << "a leap at step " << step << " of the tree at " << x_m;
      before = std::move(now);
    }
    EXPECT_EQ(changed(before, winter), 0U);
  }
}

TEST_F(StageTest, BlossomAndBareTreesAreTheSameInEverySeason) {
  for (const pose::FoliageColor foliage : {pose::FoliageColor::kBlossom, pose::FoliageColor::kBare}) {
    wire::SceneModel tree = test_model("tree");
    std::get<pose::TreeSkeleton>(tree.skeleton).foliage = foliage;
    show({tree});
    light::Light light = light::light_of({}, 0.0);
    const Pixels summer = draw(0.0, 1.0F);
    light.leaves.w = 0.0F;
    stage_->set_light(light);
    EXPECT_EQ(changed(summer, draw(0.0, 1.0F)), 0U);
  }
}

TEST_F(StageTest, IsDarkerByNightThanAtNoonAndShowsBoth) {
  show({test_model("tree")});
  const auto brightness = [&](double sun_height_deg) {
    stage_->set_light(light::light_of({.sun = look::SunChoice::kFixed, .sun_height_deg = sun_height_deg}, 0.0));
    const Pixels picture = draw(0.0, 1.0F);
    return std::accumulate(picture.begin(), picture.end(), 0.0) / static_cast<double>(picture.size());
  };
  const double noon = brightness(60.0);
  const double night = brightness(-25.0);
  EXPECT_LT(night, 0.5 * noon);
  EXPECT_GT(night, 8.0) << "something is seen";
}

/// Nodes of the ground, all bent alike toward the east.
wire::SceneModel ground_model() {
  pose::StrandSkeleton nodes;
  nodes.strand_count = 64;
  nodes.links_per_strand = 1;
  nodes.columns = 8;
  const std::vector<float> zeros(64, 0.0F);
  const std::vector<float> ones(64, 1.0F);
  nodes.root_x_m = nodes.root_y_m = nodes.root_z_m = nodes.rest_x = nodes.rest_z = zeros;
  nodes.curl_y = nodes.curl_z = nodes.rest_curl_rad = zeros;
  nodes.rest_y = nodes.curl_x = nodes.link_length_m = ones;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::size_t row = i / 8;
    nodes.root_x_m[i] = 8.0F * (static_cast<float>(i % 8) - 3.5F);
    nodes.root_z_m[i] = 8.0F * (static_cast<float>(row) - 3.5F);
  }
  return {.name = "ground", .kind = "ground", .skeleton = nodes};
}

TEST_F(StageTest, TheMeadowHasNoEdgeSeenFromAbove) {
  show({test_model("grass")});
  const meshes::Bounds box = stage_->bounds();
  const double distance_m = 16.0;
  const glm::dvec3 middle((box.low_m.x + box.high_m.x) / 2, 0.0, (box.low_m.z + box.high_m.z) / 2);
  camera_.frame({middle, 0.0, 89.0, distance_m});
  const Pixels pixels = draw(0.3, 1.0F);

  // North is up: the mean light of the streamed blades' ground, and of the ground around it.
  const double px_per_m =
      kHeight_px / (2.0 * distance_m * meshes::tangent_up(40.0, static_cast<double>(kWidth_px) / kHeight_px));
  std::array<double, 2> sums{};
  std::array<double, 2> counts{};
  for (int row = 0; row < kHeight_px; ++row) {
    for (int column = 0; column < kWidth_px; ++column) {
      const double out_x_m =
          std::abs(column - kWidth_px / 2) / px_per_m - static_cast<double>(box.high_m.x - box.low_m.x) / 2;
      const double out_z_m =
          std::abs(row - kHeight_px / 2) / px_per_m - static_cast<double>(box.high_m.z - box.low_m.z) / 2;
      const double out_m = std::max(out_x_m, out_z_m);
      if (std::abs(out_m) < 0.3 || out_m > 2.0) continue;
      const std::size_t side = out_m > 0.0 ? 1 : 0;
      sums[side] += pixels[3 * static_cast<std::size_t>(row * kWidth_px + column) + 1];
      counts[side] += 1.0;
    }
  }
  ASSERT_GT(counts[0], 200.0);
  ASSERT_GT(counts[1], 200.0);
  std::printf("light within %.1f, around %.1f\n", sums[0] / counts[0], sums[1] / counts[1]);
  EXPECT_NEAR(sums[0] / counts[0] / (sums[1] / counts[1]), 1.0, 0.12);
}

TEST_F(StageTest, AMeadowFromAboveIsAsBrightAsFromTheSideAndShowsItsGusts) {
  show({test_model("grass"), ground_model()});
  stage_->set_light(noon());
  // The mean light of the grass, bent so much more than on the average in a band from west to east.
  const auto grass_light = [&](double pitch_deg, double distance_m, float gust_rad) {
    camera_.frame({{0.0, 0.0, 0.0}, 0.0, pitch_deg, distance_m});
    stream::PoseMoment moment = stream::rest_moment(models_);
    auto& nodes = std::get<pose::StrandPose>(moment.poses[1]);
    std::ranges::fill(nodes.bend_east_rad, 0.35F);
    for (std::size_t node = 24; node < 40; ++node) nodes.bend_east_rad[node] += gust_rad;
    stage_->draw(moment, camera_, *target_);
    const Pixels pixels = target_->read_rgb();
    return mean_luminance(pixels, [](std::size_t pixel) { return pixel / kWidth_px > kHeight_px / 3; });
  };
  for (const look::Quality quality : {look::Quality::kLow, look::Quality::kHigh}) {
    stage_->set_quality(quality);
    const double side = grass_light(15.0, 12.0, 0.0F);
    for (const double distance_m : {10.0, 25.0}) {
      const double top = grass_light(88.0, distance_m, 0.0F);
      const double lull = grass_light(88.0, distance_m, -0.25F);
      const double gust = grass_light(88.0, distance_m, 0.25F);
      std::printf("%s, %.0f m: side %.1f, top %.1f, in a lull %.1f, in a gust %.1f\n",
                  std::string(name_of(quality)).c_str(), distance_m, side, top, lull, gust);
      EXPECT_GT(top, 0.8 * side) << name_of(quality);
      EXPECT_LT(top, 1.35 * side) << name_of(quality);
      EXPECT_GT(gust, (distance_m > 20.0 ? 1.38 : 1.15) * lull) << name_of(quality);
    }
  }
}

TEST_F(StageTest, TheNodesOfTheGroundBendTheGrassAroundAndAreNoThing) {
  const wire::SceneModel grass = test_model("grass");
  show({grass});
  const double home_m = stage_->home(1.33).distance_m;
  show({grass, ground_model()});
  EXPECT_EQ(stage_->home(1.33).distance_m, home_m);
  camera_.frame({{20.0, 0.0, 20.0}, 45.0, 15.0, 12.0});  // far from the streamed blades

  stream::PoseMoment moment = stream::rest_moment(models_);
  stage_->draw(moment, camera_, *target_);
  const Pixels calm = target_->read_rgb();
  auto& nodes = std::get<pose::StrandPose>(moment.poses[1]);
  std::ranges::fill(nodes.bend_east_rad, 1.0F);
  stage_->draw(moment, camera_, *target_);
  EXPECT_GT(changed(calm, target_->read_rgb()), 5000U);
}

TEST_F(StageTest, APictureLiesOnTheBareGround) {
  // Its middle is at x = z = 0: red to the west, blue to the east.
  wire::SceneModel ground = ground_model();
  look::Image halves{64, 1, {}};
  for (int i = 0; i < 64; ++i) {
    for (const int value : {i < 32 ? 220 : 10, 10, i < 32 ? 10 : 220}) {
      halves.rgb.push_back(static_cast<std::uint8_t>(value));
    }
  }
  ground.cloth.image = std::make_shared<look::Image>(halves);
  const auto share_of = [&](std::size_t channel, double width_m, float opacity) {
    camera_.frame({{0.0, 0.0, 0.0}, 0.0, 89.0, 4.0});  // north is up
    std::vector<std::string> look{"ground=stone", "ground_image_width=" + std::to_string(width_m)};
    stage_->set_light(light::light_of(look::edited({}, look).value(), 0.0));
    stream::PoseMoment moment = stream::rest_moment(models_);
    moment.opacities[0] = opacity;
    stage_->draw(moment, camera_, *target_);
    const Pixels pixels = target_->read_rgb();
    std::size_t left = 0;
    for (std::size_t i = 0; i + 2 < pixels.size(); i += 3) {
      const bool is_left = i / 3 % kWidth_px < kWidth_px / 2;
      if (is_left && pixels[i + channel] > 2 * pixels[i + 2 - channel]) ++left;
    }
    return static_cast<double>(left) / (0.5 * kWidth_px * kHeight_px);
  };
  show({ground_model()});
  EXPECT_LT(share_of(0, 4.0, 1.0F) + share_of(2, 4.0, 1.0F), 0.01) << "stone has no color";
  show({ground});
  EXPECT_GT(share_of(0, 20.0, 1.0F), 0.8);
  EXPECT_LT(share_of(2, 20.0, 1.0F), 0.01);
  EXPECT_GT(share_of(2, 2.0, 1.0F), 0.2) << "it is repeated";
  EXPECT_LT(share_of(0, 20.0, 0.3F), 0.01) << "it has faded out";
}

TEST_F(StageTest, WaterIsDarkerWhereAGustTouchesIt) {
  show({test_model("ripple"), ground_model()});
  camera_.frame({{0.0, -0.1, 0.0}, 200.0, 14.0, 5.0});
  double time_s = 0.0;
  // The mean light of the water's middle while the grass around it is bent so much more than on the average.
  const auto water_light = [&](float gust_rad) {
    stream::PoseMoment moment = stream::rest_moment(models_);
    moment.time_s = time_s += 60.0;  // the water has settled
    moment.poses[0] = test_pose(models_[0], 2.0, 0.5);
    auto& nodes = std::get<pose::StrandPose>(moment.poses[1]);
    std::ranges::fill(nodes.bend_east_rad, 0.3F);
    for (const std::size_t near : {27U, 28U, 35U, 36U}) nodes.bend_east_rad[near] += gust_rad;
    stage_->draw(moment, camera_, *target_);
    const Pixels pixels = target_->read_rgb();
    double sum = 0.0;
    for (int row = kHeight_px / 2 - 4; row < kHeight_px / 2 + 4; ++row) {
      for (int column = kWidth_px / 2 - 20; column < kWidth_px / 2 + 20; ++column) {
        sum += pixels[3 * static_cast<std::size_t>(row * kWidth_px + column) + 2];
      }
    }
    return sum / (8.0 * 40.0);
  };
  const double lull = water_light(-0.2F);
  const double gust = water_light(0.2F);
  std::printf("water in a lull %.1f, in a gust %.1f\n", lull, gust);
  EXPECT_LT(gust, 0.95 * lull);
}

TEST_F(StageTest, ATrunkDarkensTheGroundAtItsFootOnTheSunnySideToo) {
  show({test_model("tree")});
  camera_.frame({{-0.40, 0.0, 0.25}, 0.0, 89.0, 0.6});
  const Pixels with = draw(0.0, 1.0F);
  const Pixels without = draw(0.0, 0.0F);
  std::size_t darker = 0;
  for (std::size_t i = 0; i + 2 < with.size(); i += 3) {
    if (with[i + 1] + 4 < without[i + 1]) ++darker;
  }
  EXPECT_GT(darker, kWidth_px * kHeight_px / 4U);
}

TEST_F(StageTest, HasNoTroubleWithModelsOfNothing) {
  pose::StrandSkeleton no_strands;
  no_strands.links_per_strand = 1;
  pose::TreeSkeleton no_branches;
  no_branches.levels.resize(1);
  no_branches.levels[0].strands.links_per_strand = 1;
  pose::SurfaceSkeleton no_flame;
  no_flame.ramp_rgba.resize(1024);
  show({{"a", "grass", no_strands},
        {"b", "fur", no_strands},
        {"c", "curtain", pose::GridSkeleton{}},
        {"d", "tree", pose::TreeSkeleton{}},
        {"e", "tree", no_branches},
        {"f", "ripple", pose::SurfaceSkeleton{}},
        {"g", "flame", no_flame}});
  stage_->set_quality(look::Quality::kHigh);
  EXPECT_TRUE(std::isfinite(stage_->home(1.5).distance_m));
  stage_->draw(stream::rest_moment(models_), camera_, *target_);
}

/// How much brighter the lowest rows of a picture are than those of another, of 255.
double brighter_ground(const Pixels& a, const Pixels& b) {
  double sum = 0.0;
  const std::size_t from = std::size_t{3} * kWidth_px * (kHeight_px - kHeight_px / 8);
  for (std::size_t i = from; i < a.size(); ++i) sum += static_cast<double>(a[i]) - static_cast<double>(b[i]);
  return sum / static_cast<double>(a.size() - from);
}

TEST_F(StageTest, AFlameShinesOnTheGroundByNightAndHardlyByDay) {
  show({test_model("flame")});
  double time_s = 0.0;
  const auto picture = [&](bool burns) {
    stream::PoseMoment moment = stream::rest_moment(models_);
    if (burns) moment.poses[0] = test_pose(models_[0], 2.0, 0.3);
    moment.time_s = time_s += 10.0;
    stage_->draw(moment, camera_, *target_);
    return target_->read_rgb();
  };
  const auto shines = [&](const std::string& sun_height) {
    const std::vector<std::string> look{"sun=fixed", "sun_height=" + sun_height};
    stage_->set_light(light::light_of(look::edited({}, look).value(), 0.0));
    const Pixels lit = picture(true);
    return brighter_ground(lit, picture(false));
  };
  const double by_night = shines("-15");
  EXPECT_GT(by_night, 20.0);
  EXPECT_LT(shines("60"), 0.5 * by_night);
}

TEST_F(StageTest, ASmallerSkyIsTheSameSky) {
  show({});
  meshes::CameraPlace place = stage_->home(static_cast<double>(kWidth_px) / kHeight_px);
  place.target_m = {0.0, 8.0, 0.0};  // the sky fills the upper half
  camera_.frame(place);
  const auto sky = [&](look::Quality quality, const std::vector<std::string>& look) {
    stage_->set_quality(quality);
    stage_->set_light(light::light_of(look::edited({}, look).value(), 0.0));
    Pixels picture = draw(0.0, {});
    picture.resize(picture.size() / 2);
    return picture;
  };
  for (const std::vector<std::string>& look : {std::vector<std::string>{"clouds=0.5"},
                                               {"clouds=1"},
                                               {"sun=fixed", "sun_height=-30"},
                                               {"sun=fixed", "sun_height=8", "sun_azimuth=0"},
                                               {"sun=fixed", "sun_height=8", "sun_azimuth=180"}}) {
    const Pixels small = sky(look::Quality::kLow, look);
    const Pixels full = sky(look::Quality::kMedium, look);
    // The edges of clouds are softer, in so small a picture the most; hills have fewer corners.
    EXPECT_LT(changed(small, full), small.size() / 3 / 20) << look.back();
    const auto bright = [](const Pixels& picture) {
      return static_cast<double>(std::ranges::count_if(picture, [](std::uint8_t value) { return value > 240; }));
    };
    EXPECT_NEAR(bright(small), bright(full), 0.1 * bright(full) + 60.0) << look.back();
  }
}

TEST_F(StageTest, TheFirstPictureHasAllCloudsThatItShows) {
  target_ = std::make_unique<gl::RenderTarget>(96, 72, 1);
  const auto look_at = [&](double heading_deg, double pitch_deg) {
    meshes::CameraPlace place = stage_->home(4.0 / 3.0);
    place.target_m = {0.0, 8.0, 0.0};
    place.heading_deg = heading_deg;
    place.pitch_deg = pitch_deg;
    camera_.go_to(place);
    return draw(0.0, 1.0F);
  };
  const auto open_stage = [&] {
    stage_ = std::make_unique<Stage>();
    show({test_model("ripple")});  // which mirrors the sky
    stage_->set_light(light::light_of(look::edited({}, std::vector<std::string>{"clouds=0.5"}).value(), 0.0));
  };
  const std::vector<std::array<double, 2>> views = {{0.0, 3.0}, {110.0, 3.0}, {230.0, -20.0}, {300.0, -45.0}};
  open_stage();
  for (int picture = 0; picture < 140; ++picture) look_at(0.0, 3.0);  // by then all are there, whatever is in view
  std::vector<Pixels> complete;
  complete.reserve(views.size());
  for (const auto& [heading_deg, pitch_deg] : views) complete.push_back(look_at(heading_deg, pitch_deg));
  for (std::size_t view = 0; view < views.size(); ++view) {
    open_stage();
    EXPECT_EQ(changed(look_at(views[view][0], views[view][1]), complete[view]), 0U) << view;
    const std::size_t turned = (view + 1) % views.size();
    EXPECT_EQ(changed(look_at(views[turned][0], views[turned][1]), complete[turned]), 0U) << "turned from " << view;
  }
}

TEST_F(StageTest, IsAtHomeInNothing) {
  show({});
  EXPECT_TRUE(std::isfinite(stage_->home(1.5).distance_m));
  EXPECT_FALSE(draw(0.0, {}).empty());
}

}  // namespace
}  // namespace yuragi::viewer::looks
