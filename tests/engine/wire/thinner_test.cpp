#include "engine/wire/thinner.hpp"

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "tests/engine/wire/samples.hpp"

namespace yuragi::wire {
namespace {

Frame frame_in(const Bytes& bytes) {
  return std::get<Frame>(decode(samples::body(bytes)).value());
}

/// What a client gets: both messages decoded again.
struct Received {
  Scenes scenes;
  Frame frame;
};
Received received(const Thinning& thinning, const Bytes& frame = samples::frame_of_all_kinds()) {
  const Thinner thinner(samples::all_kinds(), thinning);
  return {.scenes = std::get<Scenes>(decode(samples::body(encode(thinner.scenes()))).value()),
          .frame = frame_in(thinner.frame(frame))};
}

template <class Kind>
const Kind& skeleton_of(const Received& got, std::size_t scene) {
  return std::get<Kind>(got.scenes.scenes[scene].skeleton);
}
template <class Kind>
const Kind& pose_of(const Frame& frame, std::size_t scene) {
  return std::get<Kind>(frame.poses[scene]);
}

TEST(Thinner, WhoWantsAllOfItGetsAllOfIt) {
  const Frame whole = frame_in(samples::frame_of_all_kinds());
  const Received got = received({});
  ASSERT_EQ(got.scenes.scenes.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(got.scenes.scenes[i].skeleton, samples::all_kinds().scenes[i].skeleton) << i;
    const pose::Arrays<const float> a(got.frame.poses[i]);
    const pose::Arrays<const float> b(whole.poses[i]);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_TRUE(std::ranges::equal(a[k], b[k])) << i << " " << k;
  }
  EXPECT_EQ(got.frame.opacities, whole.opacities);
  EXPECT_EQ(got.frame.info.sequence, whole.info.sequence);
  EXPECT_EQ(got.frame.info.tick, whole.info.tick);
  EXPECT_EQ(got.frame.info.utc_ns, whole.info.utc_ns);
  EXPECT_EQ(got.frame.info.wind.wind.u_m_s, whole.info.wind.wind.u_m_s);
  EXPECT_EQ(got.frame.info.wind.upwind_m, whole.info.wind.upwind_m);
}

TEST(Thinner, AFrameAlwaysFitsTheScenesThatItComesWith) {
  for (const std::uint32_t every : {1u, 2u, 3u, 5u, 8u, 100u, kMaxEvery}) {
    const Received got = received({.every = every});
    EXPECT_TRUE(fits(got.frame, got.scenes)) << every;
    ASSERT_EQ(got.scenes.scenes.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(got.frame.poses[i].index(), got.scenes.scenes[i].skeleton.index()) << every << " " << i;
      EXPECT_GT(pose::node_count(got.scenes.scenes[i].skeleton), 0u) << every << " " << i;
    }
  }
}

TEST(Thinner, OfStrandsEverySoManythIsLeft) {
  const Frame whole = frame_in(samples::frame_of_all_kinds());
  const Received got = received({.every = 5});
  const auto before = std::get<pose::StrandSkeleton>(samples::all_kinds().scenes[0].skeleton);
  const auto& after = skeleton_of<pose::StrandSkeleton>(got, 0);
  ASSERT_EQ(after.strand_count, 8u);  // 0, 5, ... 35 of 37
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(after.root_z_m[i], before.root_z_m[5 * i]);
    EXPECT_EQ(after.rest_curl_rad[i], before.rest_curl_rad[5 * i]);
    EXPECT_EQ(pose_of<pose::StrandPose>(got.frame, 0).bend_south_rad[i],
              pose_of<pose::StrandPose>(whole, 0).bend_south_rad[5 * i]);
  }
}

TEST(Thinner, StrandsOnAGridStayOnOneWhereItsColumnsDivide) {
  Scenes meadow{{{"meadow", "grass", samples::meadow(36)}}};
  std::get<pose::StrandSkeleton>(meadow.scenes[0].skeleton).columns = 12;
  const auto columns = [&](std::uint32_t every) {
    return std::get<pose::StrandSkeleton>(Thinner(meadow, {.every = every}).scenes().scenes[0].skeleton).columns;
  };
  EXPECT_EQ(columns(1), 12u);
  EXPECT_EQ(columns(4), 3u);
  EXPECT_EQ(columns(5), 0u);
}

TEST(Thinner, AClothKeepsItsEdges) {
  const Frame whole = frame_in(samples::frame_of_all_kinds());
  const Received got = received({.every = 6});
  const pose::GridSkeleton before = samples::cloth();
  const auto& after = skeleton_of<pose::GridSkeleton>(got, 1);
  const std::vector<std::size_t> columns{0, 6, 12, 18, 20};
  const std::vector<std::size_t> rows{0, 6, 8};
  ASSERT_EQ(after.columns, columns.size());
  ASSERT_EQ(after.rows, rows.size());
  EXPECT_TRUE(after.is_first_column_fixed);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t column = 0; column < columns.size(); ++column) {
      const std::size_t to = row * after.stride() + column;
      const std::size_t from = rows[row] * before.stride() + columns[column];
      EXPECT_EQ(after.rest_x_m[to], before.rest_x_m[from]);
      EXPECT_EQ(pose_of<pose::GridPose>(got.frame, 1).offset_y_m[to],
                pose_of<pose::GridPose>(whole, 1).offset_y_m[from]);
    }
  }
}

TEST(Thinner, ATreeKeepsWhatItsStrandsGrowOn) {
  const Frame whole = frame_in(samples::frame_of_all_kinds());
  const Received got = received({.every = 4});
  const pose::TreeSkeleton before = samples::tree();
  const auto& after = skeleton_of<pose::TreeSkeleton>(got, 2);
  ASSERT_EQ(after.levels.size(), 3u);
  EXPECT_EQ(after.levels[0].strands.strand_count, 1u);
  EXPECT_EQ(after.levels[1].strands.strand_count, 5u) << "leaves that stay grow on each limb";
  ASSERT_EQ(after.levels[2].strands.strand_count, 20u);  // of 77
  EXPECT_TRUE(before.levels[2].is_turned_by_block);
  EXPECT_FALSE(after.levels[2].is_turned_by_block);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(after.levels[2].strands.root_x_m[i], before.levels[2].strands.root_x_m[4 * i]);
    EXPECT_EQ(after.levels[2].base_radius_m[i], before.levels[2].base_radius_m[4 * i]);
    EXPECT_EQ(after.levels[2].parent_link[i], before.levels[2].parent_link[4 * i]);
    const auto limb = [](const pose::TreeSkeleton& tree, std::size_t leaf) {
      return tree.levels[1].strands.root_x_m[tree.levels[2].parent[leaf]];
    };
    EXPECT_EQ(limb(after, i), limb(before, 4 * i));
    EXPECT_EQ(pose_of<pose::TreePose>(got.frame, 2).levels[2].bend_east_rad[i],
              pose_of<pose::TreePose>(whole, 2).levels[2].bend_east_rad[4 * i]);
  }
  EXPECT_EQ(after.copies, before.copies);
}

TEST(Thinner, ParentsThatMoveUpInTheListAreFoundThere) {
  const Received got = received({.every = 40});  // leaves 0 and 40: limbs 0 and 2
  const auto& after = skeleton_of<pose::TreeSkeleton>(got, 2);
  ASSERT_EQ(after.levels[1].strands.strand_count, 2u);
  EXPECT_EQ(after.levels[2].parent[0], 0u);
  EXPECT_EQ(after.levels[2].parent[1], 1u);
  EXPECT_EQ(after.levels[1].strands.root_x_m[1], samples::tree().levels[1].strands.root_x_m[2]);
}

TEST(Thinner, AnOpenSurfaceKeepsItsEdgesAndRingsKeepThreePoints) {
  const Received got = received({.every = 100});
  EXPECT_EQ(skeleton_of<pose::SurfaceSkeleton>(got, 3).columns, 2u);
  EXPECT_EQ(skeleton_of<pose::SurfaceSkeleton>(got, 3).rows, 2u);
  const auto& fire = skeleton_of<pose::SurfaceSkeleton>(got, 4);
  EXPECT_EQ(fire.shells, 3u);
  EXPECT_GE(fire.columns / fire.shells, 3u);
  EXPECT_EQ(fire.rows, 2u);
  const auto& risen = pose_of<pose::SurfacePose>(got.frame, 4);
  const auto whole = pose_of<pose::SurfacePose>(frame_in(samples::frame_of_all_kinds()), 4);
  EXPECT_EQ(risen.heat.size(), risen.displacement_m.size());
  EXPECT_EQ(risen.row_east_m.back(), whole.row_east_m.back());
  EXPECT_EQ(risen.displacement_m.front(), whole.displacement_m.front());
}

TEST(Thinner, OnlyTheScenesThatAreWantedCome) {
  const Received got = received({.scenes = {"elm", "window", "a name that no scene has"}});
  ASSERT_EQ(got.scenes.scenes.size(), 2u);
  EXPECT_EQ(got.scenes.scenes[0].name, "window") << "in the server's order";
  EXPECT_EQ(got.scenes.scenes[1].name, "elm");
  EXPECT_TRUE(fits(got.frame, got.scenes));
  EXPECT_EQ(got.frame.opacities, (std::vector<float>{0.5f, 1.0f}));
  EXPECT_TRUE(received({.scenes = {"nothing"}}).scenes.scenes.empty());
}

TEST(Thinner, TheWindAloneHasNoScenesAndAllElseOfTheFrame) {
  const Bytes whole = samples::frame_of_all_kinds();
  const Thinner thinner(samples::all_kinds(), {.is_wind_alone = true});
  EXPECT_TRUE(thinner.scenes().scenes.empty());
  const Bytes bytes = thinner.frame(whole);
  EXPECT_EQ(bytes.size(), 144U) << "as pose.fbs states";
  const Frame wind = frame_in(bytes);
  const Frame all = frame_in(whole);
  EXPECT_TRUE(wind.poses.empty());
  EXPECT_TRUE(fits(wind, thinner.scenes()));
  EXPECT_EQ(wind.info.sequence, all.info.sequence);
  EXPECT_EQ(wind.info.tick, all.info.tick);
  EXPECT_EQ(wind.info.time_s, all.info.time_s);
  EXPECT_EQ(wind.info.utc_ns, all.info.utc_ns);
  EXPECT_EQ(wind.info.view_wind_from_deg, all.info.view_wind_from_deg);
  EXPECT_EQ(wind.info.wind.wind.u_m_s, all.info.wind.wind.u_m_s);
  EXPECT_EQ(wind.info.wind.upwind_m, all.info.wind.upwind_m);
}

TEST(Thinner, TheNamesOfScenesAreReadFromTheirMessage) {
  std::vector<std::string> names;
  for (const SceneModel& scene : samples::all_kinds().scenes) names.push_back(scene.name);
  EXPECT_EQ(scene_names(encode(samples::all_kinds())), names);
  EXPECT_TRUE(scene_names(encode(Scenes{})).empty());
  EXPECT_TRUE(scene_names(encode(Hello{})).empty());
}

TEST(Thinner, AHiddenSceneStaysHidden) {
  const Received got = received({.every = 2}, samples::frame_of_all_kinds({1.0f, 0.0f, 1.0f, 0.0f, 1.0f}));
  EXPECT_EQ(got.frame.opacities, (std::vector<float>{1.0f, 0.0f, 1.0f, 0.0f, 1.0f}));
  EXPECT_TRUE(fits(got.frame, got.scenes));
}

TEST(Thinner, APoseOfAnotherSizeIsLeftOut) {
  const Thinner thinner(samples::scenes(37), {.every = 2});
  EXPECT_EQ(frame_in(thinner.frame(samples::frame_bytes(21))).opacities, (std::vector<float>{0.0f, 1.0f}));
}

}  // namespace
}  // namespace yuragi::wire
