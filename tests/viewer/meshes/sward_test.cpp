#include "viewer/meshes/sward.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/pose/strand_kinematics.hpp"
#include "tests/viewer/test_meadow.hpp"
#include "viewer/meshes/ground_map.hpp"
#include "viewer/meshes/strand_tiles.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr Thinning kThinning{.blades_per_m2 = 200.0F, .drawn_at_1m_per_m2 = 4000.0F};

View view_from(const CameraPlace& place) {
  OrbitCamera camera;
  camera.frame(place);
  return view_of(camera, 1280, 720);
}

TEST(ThinningTest, ThinsOutWithTheDistanceAndNeverAtOnce) {
  EXPECT_EQ(kThinning.share(0.0F), 1.0F);
  EXPECT_EQ(kThinning.share(2.0F), 1.0F);
  float before = 1.0F;
  for (float r = 0.1F; r < 200.0F; r *= 1.01F) {
    const float share = kThinning.share(r);
    EXPECT_LE(share, before) << r;
    EXPECT_GT(share, 0.97F * before) << r;
    before = share;
  }
  EXPECT_LT(before, 0.01F);
}

TEST(SwardTest, HasTheSameBladesEachTimeAndAnyFirstPartCoversTheTile) {
  const std::vector<SwardBlade> blades = sward_blades(4000);
  const std::vector<SwardBlade> again = sward_blades(4000);
  for (const std::size_t part : {std::size_t{100}, std::size_t{700}, std::size_t{4000}}) {
    // As many in each of 5 x 5 fields, nearly.
    std::array<std::size_t, 25> counts{};
    for (std::size_t i = 0; i < part; ++i) {
      ASSERT_GE(blades[i].x, 0.0F);
      ASSERT_LT(blades[i].x, 1.0F);
      ASSERT_EQ(blades[i].x, again[i].x);
      ASSERT_EQ(blades[i].chance, again[i].chance);
      const auto field = [](float at) { return std::min<std::size_t>(static_cast<std::size_t>(5.0F * at), 4); };
      ++counts[field(blades[i].z) * 5 + field(blades[i].x)];
    }
    for (const std::size_t count : counts) {
      EXPECT_GE(count, part / 50) << part;
      EXPECT_LE(count, part * 2 / 25) << part;
    }
  }
}

constexpr GrassDetail kDetail{.drawn_at_1m_per_m2 = 4000.0F};

bool everywhere(const glm::vec2&, const glm::vec2&) {
  return true;
}

TEST(GrassDetailTest, ABladeHasMoreRingsTheLargerItIsInThePicture) {
  EXPECT_EQ(kDetail.rings(0.7F, 1e9F, 0.001F), 1U);
  EXPECT_EQ(kDetail.rings(0.48F, 10.0F, 0.001F), 3U);  // 48 pixels high: a chord is off by 6, three by 0.7
  EXPECT_EQ(kDetail.rings(0.48F, 10.0F, 0.0005F), 4U);
  EXPECT_GT(kDetail.rings(0.7F, 0.0F, 0.001F), 100U);
}

TEST(SwardTest, LaysTilesWithoutAGapAndNoneTwice) {
  SwardTiles tiles(1250, kThinning, {.drawn_at_1m_per_m2 = 4000.0F, .reach_m = 30.0F}, 0.7F, 1.0F);
  tiles.choose(view_from({{0.0, 0.0, 0.0}, 0.0, 89.0, 60.0}), everywhere);  // from above, higher than the reach
  for (std::size_t level = 0; level < SwardTiles::kLevels; ++level) EXPECT_TRUE(tiles.level(level).empty());

  // From above, nearer: every tile of the ground that is in the picture is there.
  const CameraPlace above{{0.0, 0.0, 0.0}, 0.0, 89.0, 20.0};
  tiles.choose(view_from(above), everywhere);
  std::set<std::pair<float, float>> origins;
  for (std::size_t level = 0; level < SwardTiles::kLevels; ++level) {
    for (const SwardTile& tile : tiles.level(level)) {
      EXPECT_TRUE(origins.insert({tile.origin_m.x, tile.origin_m.y}).second);
      EXPECT_GE(tile.turn, 0.0F);
      EXPECT_LT(tile.turn, 8.0F);
    }
  }
  for (float x_m = -11.0F; x_m < 11.0F; x_m += 1.0F) {
    for (float z_m = -6.0F; z_m < 6.0F; z_m += 1.0F) {
      const auto corner_m = [](float at_m) { return std::floor(at_m / SwardTiles::kTile_m) * SwardTiles::kTile_m; };
      EXPECT_EQ(origins.count({corner_m(x_m), corner_m(z_m)}), 1U) << x_m << " " << z_m;
    }
  }
}

TEST(SwardTest, LeavesOutWhatIsBehindTheCameraAndDrawsFewerBladesFarAway) {
  SwardTiles tiles(5000, kThinning, kDetail, 0.7F, 1.0F);
  tiles.choose(view_from({{0.0, 0.5, 0.0}, 0.0, 3.0, 2.0}), everywhere);  // to the north
  float near_by = 0.0F;
  float far_away = 5000.0F;
  for (std::size_t level = 0; level < SwardTiles::kLevels; ++level) {
    for (const SwardTile& tile : tiles.level(level)) {
      EXPECT_LT(tile.origin_m.y, 5.0F);
      EXPECT_GE(tile.blades, 1.0F);
      EXPECT_LE(tile.blades, 5000.0F);
      near_by = std::max(near_by, tile.blades);
      far_away = std::min(far_away, tile.blades);
    }
  }
  EXPECT_EQ(near_by, 5000.0F);
  EXPECT_LT(far_away, 500.0F);
}

TEST(SwardTest, LaysNoTileWhereNoBladeMayStand) {
  SwardTiles tiles(1250, kThinning, kDetail, 0.7F, 1.0F);
  const auto in_the_east = [](const glm::vec2& low_m, const glm::vec2&) { return low_m.x >= 0.0F; };
  tiles.choose(view_from({{0.0, 0.5, 0.0}, 0.0, 3.0, 2.0}), in_the_east);
  std::size_t count = 0;
  for (std::size_t level = 0; level < SwardTiles::kLevels; ++level) {
    for (const SwardTile& tile : tiles.level(level)) EXPECT_GE(tile.origin_m.x, 0.0F);
    count += tiles.level(level).size();
  }
  EXPECT_GT(count, 0U);
}

TEST(SwardTest, RibbonsHaveTheirTrianglesOneBehindTheOther) {
  EXPECT_EQ(ribbon_triangles(2, 1), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(ribbon_triangles(1, 2), (std::vector<std::uint32_t>{0, 1, 2, 1, 2, 3, 2, 3, 4}));
}

class StrandTilesTest : public testing::Test {
 protected:
  const pose::Skeleton meadow_ = test_meadow(60, 8.0);
  const pose::StrandSkeleton& strands_ = std::get<pose::StrandSkeleton>(meadow_);
  StrandTiles all_{strands_, {.blades_per_m2 = 1.0F, .drawn_at_1m_per_m2 = 1e9F}, kDetail};
};

TEST_F(StrandTilesTest, HoldEveryStrandOnceAndDrawAllThatAreInView) {
  all_.choose(view_from({{0.0, 0.0, 0.0}, 0.0, 60.0, 30.0}));
  std::size_t drawn = 0;
  for (const StrandTiles::Level& level : all_.levels()) {
    for (const StrandTiles::Drawn& tile : level.tiles) drawn += tile.strands;
  }
  EXPECT_EQ(drawn, strands_.strand_count);

  // A pose that tells each strand from all others.
  pose::StrandPose pose{std::vector<float>(strands_.padded_count()), std::vector<float>(strands_.padded_count())};
  for (std::size_t i = 0; i < strands_.strand_count; ++i) pose.bend_east_rad[i] = static_cast<float>(i);
  const std::span<const glm::vec2> bends = all_.bends(pose);
  std::set<float> seen;
  for (const StrandTiles::Level& level : all_.levels()) {
    for (const StrandTiles::Drawn& tile : level.tiles) {
      for (std::size_t slot = tile.first_slot; slot < tile.first_slot + tile.strands; ++slot) {
        const std::size_t i = all_.blocks()[slot / 16] * std::size_t{16} + slot % 16;
        const auto strand = static_cast<std::size_t>(bends[slot].x);
        EXPECT_TRUE(seen.insert(bends[slot].x).second);
        EXPECT_EQ(all_.blades()[i].root_m.x, strands_.root_x_m[strand]);
        EXPECT_EQ(all_.blades()[i].root_m.z, strands_.root_z_m[strand]);
      }
    }
  }
  EXPECT_EQ(seen.size(), strands_.strand_count);
}

TEST_F(StrandTilesTest, DrawFewerFarAwayAndNoneBehindTheCamera) {
  StrandTiles tiles(strands_, kThinning, {.drawn_at_1m_per_m2 = 4000.0F, .reach_m = 100.0F});
  const auto drawn = [&](const CameraPlace& place) {
    tiles.choose(view_from(place));
    std::size_t count = 0;
    for (const StrandTiles::Level& level : tiles.levels()) {
      for (const StrandTiles::Drawn& tile : level.tiles) count += tile.strands;
    }
    return count;
  };
  const std::size_t at_10m = drawn({{0.0, 0.0, 0.0}, 0.0, 60.0, 15.0});
  const std::size_t at_40m = drawn({{0.0, 0.0, 0.0}, 0.0, 60.0, 45.0});
  EXPECT_GT(at_40m, 0U);
  EXPECT_LT(2 * at_40m, at_10m);
  EXPECT_EQ(drawn({{0.0, 0.5, -30.0}, 0.0, 2.0, 5.0}), 0U);
}

glm::vec3 leaning(const glm::vec2& lean) {
  const float angle = glm::length(lean);
  const float sine = angle > 1e-4F ? std::sin(angle) / angle : 1.0F;
  return {lean.x * sine, std::cos(angle), lean.y * sine};
}

/// The point of an arc of length 1, at part t of it, that leaves its foot leaning by `foot` (toward east and south,
/// radians from upright) and turns by `turned` up to its tip: a strand without its joints, as blade.part.glsl has it.
glm::vec3 arc_point(const glm::vec2& foot, const glm::vec2& turned, float t) {
  const float half_2 = 0.25F * t * t * glm::dot(turned, turned);
  return t * (1.0F - half_2 * (1.0F / 6.0F - half_2 / 120.0F)) * leaning(foot + turned * (0.5F * t));
}

TEST_F(StrandTilesTest, ArcsAreWhatTheForwardKinematicsSays) {
  pose::JointPositions joints(strands_);
  for (const double bend_rad : {0.0, 0.4, 1.1}) {
    const pose::Pose pose = test_pose(meadow_, 0.3, 0.7 * bend_rad, 0.3 * bend_rad, 70.0);
    const auto& bends = std::get<pose::StrandPose>(pose);
    ASSERT_EQ((pose::StrandKinematicsJob{.skeleton = &strands_, .pose = &bends, .joints = &joints}.run()),
              pose::StrandKinematicsJob::Problem::kNone);
    all_.choose(view_from({{0.0, 0.0, 0.0}, 0.0, 60.0, 30.0}));
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < all_.blades().size(); ++i) {
      const TiledBlade& blade = all_.blades()[i];
      const auto at = std::ranges::find(strands_.root_x_m, blade.root_m.x);
      const auto strand = static_cast<std::size_t>(at - strands_.root_x_m.begin());
      const glm::vec2 bend(bends.bend_east_rad[strand], bends.bend_south_rad[strand]);
      for (const std::size_t link : {std::size_t{4}, std::size_t{9}}) {
        const pose::JointPosition joint = joints.joint(strand, link);
        const glm::vec3 place_m = blade.root_m + blade.length_m * arc_point(blade.foot_rad, blade.turned_rad + bend,
                                                                            0.1F * static_cast<float>(link + 1));
        const glm::vec3 off_m = place_m - glm::vec3(joint.x_m, joint.y_m, joint.z_m);
        const auto off = static_cast<double>(glm::length(off_m) / blade.length_m);
        EXPECT_LT(off, 0.12) << bend_rad << " " << link;
        sum += off;
        ++count;
      }
    }
    EXPECT_LT(sum / static_cast<double>(count), 0.04) << bend_rad;
  }
}

TEST(GrowthMapTest, IsShortAroundThingsTallElsewhereAndTakenByWater) {
  GrowthMap map;
  EXPECT_EQ(map.growth_at(3.0F, 3.0F), 1.0F);
  const std::vector<Standing> things{
      {.kind = Standing::Kind::kOther, .bounds = {{-1.0F, 0.0F, -1.0F}, {1.0F, 2.0F, 1.0F}}},
      {.kind = Standing::Kind::kWater, .bounds = {{20.0F, 0.0F, 20.0F}, {24.0F, 0.1F, 24.0F}}}};
  map.make(things);
  EXPECT_LT(map.growth_at(0.0F, 0.0F), 0.3F);
  EXPECT_GT(map.growth_at(0.0F, 0.0F), 0.0F);
  EXPECT_EQ(map.water_at(22.0F, 22.0F), 1.0F);
  EXPECT_EQ(map.water_at(0.0F, 0.0F), 0.0F);
  EXPECT_EQ(map.growth_at(-30.0F, 10.0F), 1.0F);
  EXPECT_FALSE(map.is_free({21.0F, 21.0F}, {23.0F, 23.0F}, false));
  EXPECT_TRUE(map.is_free({-30.0F, 10.0F}, {-28.0F, 12.0F}, true));
  // And nowhere a step that is seen as a line: half a metre changes it by less than a third.
  for (float x_m = 0.0F; x_m < 15.0F; x_m += 0.5F) {
    EXPECT_LT(std::abs(map.growth_at(x_m + 0.5F, 0.0F) - map.growth_at(x_m, 0.0F)), 0.33F) << x_m;
  }

  // Nor does a blade stand on a floor.
  const std::vector<Standing> on_floor{
      {.kind = Standing::Kind::kOther,
       .bounds = {{-1.0F, 0.0F, -0.1F}, {1.0F, 2.0F, 0.1F}},
       .floor = Floor{.middle_m = {0.0F, 0.1F, 0.0F}, .along = {0.6F, 0.8F}, .half_m = {3.0F, 2.0F}}}};
  map.make(on_floor);
  EXPECT_EQ(map.water_at(1.5F, 2.0F), 1.0F);
  EXPECT_EQ(map.water_at(2.5F, -2.0F), 0.0F);
}

TEST(GrowthMapTest, HasLawnsWhoseBordersWanderButNeverIntoThings) {
  const float half_m = 1.0F;
  const std::vector<Standing> things{
      {.kind = Standing::Kind::kOther, .bounds = {{-1.0F, 0.0F, -1.0F}, {1.0F, 2.0F, 1.0F}}}};
  GrowthMap map;
  map.make(things);
  // Within 0.8 m of the thing, less a texel, is lawn everywhere.
  for (float x_m = -1.4F; x_m <= 1.4F; x_m += 0.1F) {
    for (float z_m = -1.4F; z_m <= 1.4F; z_m += 0.1F) EXPECT_LE(map.growth_at(x_m, z_m), 0.25F) << x_m << " " << z_m;
  }
  // How far it is from the thing to grass that is half as tall as any, on 72 bearings.
  float least_m = 100.0F;
  float most_m = 0.0F;
  for (int bearing = 0; bearing < 72; ++bearing) {
    const float angle_rad = 0.0872665F * static_cast<float>(bearing);
    const glm::vec2 toward(std::cos(angle_rad), std::sin(angle_rad));
    float away_m = 0.0F;
    while (away_m < 20.0F && map.growth_at(away_m * toward.x, away_m * toward.y) < 0.6F) away_m += 0.1F;
    const glm::vec2 out_m = glm::max(glm::abs(away_m * toward) - half_m, glm::vec2(0.0F));
    least_m = std::min(least_m, glm::length(out_m));
    most_m = std::max(most_m, glm::length(out_m));
  }
  EXPECT_GT(most_m - least_m, 0.9F) << least_m << " to " << most_m;  // texels alone make 0.6 m
  EXPECT_GT(least_m, 1.5F);
  EXPECT_LT(most_m, 6.0F);

  GrowthMap again;
  again.make(things);
  EXPECT_TRUE(std::ranges::equal(map.texels(), again.texels()));
}

/// How far from the middle of a fire bare earth ends in a direction, as the shader interpolates the map.
float bare_earth_m(const GrowthMap& map, const glm::vec2& middle_m, float bearing_rad) {
  const auto growth_at = [&](const glm::vec2& at_m) {
    const float texels_per_m = static_cast<float>(GrowthMap::kTexels) / GrowthMap::kSide_m;
    const glm::vec2 at = (at_m + 0.5F * GrowthMap::kSide_m) * texels_per_m - 0.5F;
    const glm::vec2 low = glm::floor(at);
    const auto texel = [&](float column, float row) {
      return static_cast<float>(map.texels()[3 * (static_cast<std::size_t>(row) * GrowthMap::kTexels +
                                                  static_cast<std::size_t>(column))]) /
             255.0F;
    };
    const glm::vec2 part = at - low;
    return glm::mix(glm::mix(texel(low.x, low.y), texel(low.x + 1.0F, low.y), part.x),
                    glm::mix(texel(low.x, low.y + 1.0F), texel(low.x + 1.0F, low.y + 1.0F), part.x), part.y);
  };
  float out_m = 0.0F;
  while (growth_at(middle_m + out_m * glm::vec2(std::cos(bearing_rad), std::sin(bearing_rad))) < 0.05F) out_m += 0.01F;
  return out_m;
}

TEST(GrowthMapTest, BareEarthAroundAFireHasNoCorners) {
  for (const float off_m : {0.0F, 0.1F, 0.25F, 0.4F}) {
    const glm::vec2 middle_m(3.0F + off_m, -2.0F + 0.7F * off_m);
    GrowthMap map;
    map.make(std::array{
        Standing{Standing::Kind::kFire,
                 {{middle_m.x - 0.6F, 0.0F, middle_m.y - 0.6F}, {middle_m.x + 0.6F, 1.0F, middle_m.y + 0.6F}}}});
    // From one of 24 directions to the next: the lawn's border wanders, but a corner of the map's texels is a step.
    constexpr float kTurn_rad = 6.2831853F / 24.0F;
    for (int i = 0; i < 24; ++i) {
      const float here_m = bare_earth_m(map, middle_m, static_cast<float>(i) * kTurn_rad);
      EXPECT_GT(here_m, 0.6F);
      EXPECT_LT(here_m, 1.7F);
      EXPECT_NEAR(bare_earth_m(map, middle_m, static_cast<float>(i + 1) * kTurn_rad), here_m, 0.12F)
          << i << ", " << off_m;
    }
  }
}

TEST(GrowthMapTest, IsTallUpToFur) {
  GrowthMap map;
  const Bounds box{{-1.5F, 0.0F, -1.0F}, {1.5F, 0.7F, 1.0F}};
  map.make(std::vector<Standing>{{.kind = Standing::Kind::kFur, .bounds = box}});
  EXPECT_LT(map.growth_at(0.0F, 0.0F), 0.3F);
  EXPECT_EQ(map.growth_at(2.2F, 0.0F), 1.0F);
  EXPECT_EQ(map.growth_at(0.0F, -1.6F), 1.0F);
}

TEST(GrowthMapTest, KnowsWhereStreamedBladesStand) {
  const pose::Skeleton meadow = test_meadow(60, 8.0);
  const std::vector<Standing> things{
      {.kind = Standing::Kind::kGrass, .bounds = {}, .blades = &std::get<pose::StrandSkeleton>(meadow)}};
  GrowthMap map;
  map.make(things);
  EXPECT_EQ(map.blades_at(0.1F, 0.1F), 1.0F);
  EXPECT_EQ(map.blades_at(2.6F, -2.6F), 1.0F);
  EXPECT_EQ(map.blades_at(6.0F, 0.0F), 0.0F);
  EXPECT_FALSE(map.is_free({-2.0F, -2.0F}, {2.0F, 2.0F}, true));
  EXPECT_TRUE(map.is_free({-2.0F, -2.0F}, {2.0F, 2.0F}, false));
  EXPECT_TRUE(map.is_free({2.5F, -2.0F}, {5.0F, 2.0F}, true));
  EXPECT_EQ(map.growth_at(0.0F, 0.0F), 1.0F);
  map.make({});
  EXPECT_EQ(map.blades_at(0.1F, 0.1F), 0.0F);
}

TEST(BendGridTest, IsReadFromStrandsOnAGridOnly) {
  pose::StrandSkeleton nodes;
  nodes.strand_count = 6;
  nodes.links_per_strand = 1;
  nodes.root_x_m = {-2, 0, 2, -2, 0, 2};
  nodes.root_z_m = {-1, -1, -1, 1, 1, 1};
  EXPECT_EQ(bend_grid_of(nodes).columns, 0U);
  nodes.columns = 3;
  const BendGrid grid = bend_grid_of(nodes);
  EXPECT_EQ(grid.columns, 3U);
  EXPECT_EQ(grid.rows, 2U);
  EXPECT_EQ(grid.first_m, glm::vec2(-2.0F, -1.0F));
  EXPECT_EQ(grid.to_next_m, glm::vec2(2.0F, 0.0F));
  EXPECT_EQ(grid.to_next_row_m, glm::vec2(0.0F, 2.0F));
  nodes.root_x_m[2] = -2.0F;  // of no width
  EXPECT_EQ(bend_grid_of(nodes).columns, 0U);
}

}  // namespace
}  // namespace yuragi::viewer::meshes
