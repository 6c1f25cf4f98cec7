// A replay that begins further on has the poses of one from the beginning, whether or not their states are kept.
#include "daemon/tools/offline/kept_states.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/tools/offline/lockstep_replay.hpp"
#include "engine/pose/pose_hash.hpp"
#include "tests/daemon/tools/offline/recorded_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kScenes = R"(
[animation]
rate = 10.0
[[scene]]
kind = "grass"
blades_across = 8
blades_deep = 8
[[scene]]
kind = "flag"
columns = 8
rows = 8
)";
constexpr double kRate_hz = 10.0;

class KeptStatesTest : public ::testing::Test {
 protected:
  KeptStatesTest() { record_session(recording_, kFridayNoon, 130.0, "", {{.sensor = "mast", .speed_m_s = gusty_m_s}}); }

  /// A hash of the poses of each tick, from `start` on.
  Result<std::vector<std::uint64_t>, Failure> poses(const std::string& start, const fs::path& states,
                                                    const std::string& text = kScenes, double duration_s = 2.0) const {
    std::vector<std::uint64_t> hashes;
    const auto replayed = replay_in_lockstep(
        settings::parse_config(text, "wall.toml"), recording_, {.playback = {.start = start}, .lead_s = 1.0},
        duration_s, {},
        [&hashes](const ReplayTick& tick) {
          std::uint64_t hash = 0;
          for (const pose::Pose* pose : tick.animation.poses()) hash = pose::pose_hash(hash, *pose);
          hashes.push_back(hash);
        },
        states);
    if (!replayed) return replayed.error();
    return hashes;
  }

  /// The same from a replay of the whole.
  std::vector<std::uint64_t> poses_of_the_whole(double start_s) const {
    const std::vector<std::uint64_t> all = poses("", "", kScenes, start_s + 2.0).value();
    return {all.begin() + std::lround(start_s * kRate_hz), all.end()};
  }

  std::vector<fs::path> kept() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(states_)) files.push_back(entry.path());
    // After the hash comes the number of ticks.
    std::ranges::sort(files, {}, [](const fs::path& file) { return std::stoi(file.filename().string().substr(17)); });
    return files;
  }

  test::TemporaryFolder folder_;
  fs::path recording_ = folder_ / "wall.windlog";
  fs::path states_ = folder_ / "states";
};

TEST_F(KeptStatesTest, APartHasThePosesThatItHasInTheWhole) {
  const std::vector<std::uint64_t> whole = poses_of_the_whole(121.5);
  EXPECT_THAT(poses("121.5", "").value(), Not(ElementsAreArray(whole))) << "its lead-in is short";
  EXPECT_THAT(poses("121.5", states_).value(), ElementsAreArray(whole));
  EXPECT_EQ(kept().size(), 2U) << "one a minute";
  EXPECT_THAT(poses("121.5", states_).value(), ElementsAreArray(whole)) << "from a state";
  EXPECT_THAT(poses("2026-05-01T12:01:10Z", states_).value(), ElementsAreArray(poses_of_the_whole(70.0)));
}

TEST_F(KeptStatesTest, TheScenesGoOnFromTheLastState) {
  const std::vector<std::uint64_t> whole = poses("121.5", states_).value();
  const auto files = kept();
  fs::copy_file(files.at(0), files.at(1), fs::copy_options::overwrite_existing);
  EXPECT_THAT(poses("121.5", states_).value(), Not(ElementsAreArray(whole))) << "it was another minute's";
}

TEST_F(KeptStatesTest, ADamagedFileCountsAsNoneAndIsReplaced) {
  const std::vector<std::uint64_t> whole = poses("121.5", states_).value();
  const auto size = fs::file_size(kept().at(0));
  for (const fs::path& file : kept()) fs::resize_file(file, size - 1);
  EXPECT_THAT(poses("121.5", states_).value(), ElementsAreArray(whole));
  for (const fs::path& file : kept()) EXPECT_EQ(fs::file_size(file), size) << "it is replaced";
}

TEST_F(KeptStatesTest, AnotherConfigurationOrRecordingHasItsOwn) {
  ASSERT_TRUE(poses("61", states_));
  const std::size_t before = kept().size();
  ASSERT_TRUE(poses("61", states_, std::string("seed = 7\n") + kScenes));
  EXPECT_EQ(kept().size(), 2 * before);
  record_session(recording_, kFridayNoon + std::chrono::minutes(3), 5.0, "",
                 {{.sensor = "mast", .speed_m_s = gusty_m_s}});
  ASSERT_TRUE(poses("61", states_));
  EXPECT_EQ(kept().size(), 3 * before);
}

TEST_F(KeptStatesTest, AFolderThatCannotBeWrittenIsNamed) {
  std::ofstream(folder_ / "file") << "no folder";
  const auto refused = poses("61", folder_ / "file");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr((folder_ / "file").string()));
}

}  // namespace
}  // namespace yuragi::daemon::tools::offline
