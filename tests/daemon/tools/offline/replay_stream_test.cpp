// A replay as the stream of a daemon: what comes in which order, every tick of it, and always the same bytes.
#include "daemon/tools/offline/replay_stream.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensing/recorded_installation.hpp"
#include "engine/base/units.hpp"
#include "engine/wire/message_reader.hpp"
#include "tests/daemon/tools/offline/recorded_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

constexpr const char* kTwoCameras = R"(
[look]
clouds = 0.75

[[camera]]
name = "day"
from = "06:00"

[[camera]]
name = "noon"
from = "12:00"
)";

constexpr double kLead_s = 15.0;
constexpr double kLiftedInAGale_deg = 60.0;

/// From straight down to the line from the middle of the hoist to that of the fly.
double lift_of_flag_deg(const wire::Scenes& scenes, const wire::Frame& frame) {
  const auto& grid = std::get<pose::GridSkeleton>(scenes.scenes.at(0).skeleton);
  const auto& offsets = std::get<pose::GridPose>(frame.poses.at(0));
  const std::size_t hoist = grid.columns / 2;
  const std::size_t fly = (grid.rows - 1) * grid.stride() + hoist;
  const auto from_hoist_m = [&](const auto& rest_m, const auto& offset_m) {
    return static_cast<double>(rest_m[fly] + offset_m[fly] - rest_m[hoist]);
  };
  const double east_m = from_hoist_m(grid.rest_x_m, offsets.offset_x_m);
  const double up_m = from_hoist_m(grid.rest_y_m, offsets.offset_y_m);
  const double south_m = from_hoist_m(grid.rest_z_m, offsets.offset_z_m);
  return std::atan2(std::hypot(east_m, south_m), -up_m) / kRadPerDeg;
}

class ReplayStreamTest : public ::testing::Test {
 protected:
  ReplayStreamTest() {
    // From half a minute before noon on.
    record_session(file_, kFridayNoon - std::chrono::seconds(30), 60.0,
                   recorded_text(installation_text() + kTwoCameras), three_winds());
  }

  wire::Bytes stream(double duration_s, double lead_s = 0.0, const std::string& start = "") const {
    const auto installation = sensing::recorded_installation(file_, {.playback = {.start = start}}).value();
    wire::Bytes bytes;
    ReplayStream stream(installation.config, [&bytes](std::span<const std::uint8_t> more) {
      bytes.insert(bytes.end(), more.begin(), more.end());
    });
    replay_in_lockstep(installation, lead_s, duration_s, {}, [&stream](const ReplayTick& tick) {
      stream.write(tick);
    }).value();
    return bytes;
  }

  /// The lift of the flag in the first frame that is streamed, of a wind of 16 m/s.
  double first_lift_deg(const std::filesystem::path& file, const std::string& start, double lead_s) const {
    const settings::Config config = settings::parse_config("[[scene]]\nkind = \"flag\"\n", "flag");
    wire::Bytes bytes;
    ReplayStream stream(
        config, [&bytes](std::span<const std::uint8_t> more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
    const auto replayed = replay_in_lockstep(config, file, {.playback = {.start = start}, .lead_s = lead_s}, 0.1, {},
                                             [&stream](const ReplayTick& tick) { stream.write(tick); });
    EXPECT_TRUE(replayed) << (replayed ? "" : replayed.error().message);
    const auto messages = messages_of(bytes);
    const auto frame = std::ranges::find_if(
        messages, [](const wire::Message& message) { return std::holds_alternative<wire::Frame>(message); });
    EXPECT_EQ(std::get<wire::Frame>(*frame).info.time_s, 0.0);
    return lift_of_flag_deg(std::get<wire::Scenes>(messages.at(1)), std::get<wire::Frame>(*frame));
  }
  std::filesystem::path gale(const std::string& name, double duration_s, double interval_s) const {
    record_session(folder_ / name, kFridayNoon, duration_s, "",
                   {{.sensor = "mast",
                     .speed_m_s = [](double time_s) { return 11.0 + gusty_m_s(time_s); },
                     .interval_s = interval_s}});
    return folder_ / name;
  }

  static std::vector<wire::Message> messages_of(const wire::Bytes& bytes) {
    wire::MessageReader reader;
    reader.feed(bytes);
    std::vector<wire::Message> messages;
    while (auto message = reader.next()) messages.push_back(std::move(message->value()));
    EXPECT_EQ(reader.buffered_bytes(), 0U);
    return messages;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "wall.windlog";
};

TEST_F(ReplayStreamTest, BeginsLikeADaemonsAndHoldsEveryTick) {
  const auto messages = messages_of(stream(2.0));
  ASSERT_GT(messages.size(), 4U);
  EXPECT_EQ(std::get<wire::Hello>(messages[0]).tick_rate_hz, 60.0);
  EXPECT_TRUE(std::get<wire::Hello>(messages[0]).wind_from_deg) << "for the first view";
  const auto& scenes = std::get<wire::Scenes>(messages[1]);
  EXPECT_NEAR(std::get<wire::ControlReply>(messages[2]).players.at(0).length_s, 59.0, 1.0);
  const auto& status = std::get<wire::Sensors>(messages[3]);
  EXPECT_EQ(status.look.clouds, 0.75);
  ASSERT_EQ(status.cameras.size(), 2U);
  EXPECT_EQ(status.camera, 0U);
  std::uint64_t tick = 0;
  for (std::size_t i = 4; i < messages.size(); ++i, ++tick) {
    const auto& frame = std::get<wire::Frame>(messages[i]);
    EXPECT_EQ(frame.info.tick, tick);
    EXPECT_DOUBLE_EQ(frame.info.time_s, static_cast<double>(tick) / 60.0);
    EXPECT_NEAR(1e-9 * static_cast<double>(frame.info.utc_ns),
                seconds(kFridayNoon.time_since_epoch()) - 30.0 + frame.info.time_s, 1e-3);
    EXPECT_TRUE(wire::fits(frame, scenes));
  }
  EXPECT_EQ(tick, 120U);
}

TEST_F(ReplayStreamTest, HasTheWindThatCamerasFollowInEveryFrameAndTheSameTwice) {
  const wire::Bytes bytes = stream(2.0);
  EXPECT_EQ(bytes, stream(2.0));
  std::size_t frames = 0;
  for (const wire::Message& message : messages_of(bytes)) {
    const auto* frame = std::get_if<wire::Frame>(&message);
    if (frame == nullptr) continue;
    ++frames;
    ASSERT_TRUE(frame->info.view_wind_from_deg);
    EXPECT_TRUE(*frame->info.view_wind_from_deg >= 0.0 && *frame->info.view_wind_from_deg < 360.0);
  }
  EXPECT_GT(frames, 100U);
}

TEST_F(ReplayStreamTest, SaysWhichCameraIsOnByTheRecordedClock) {
  std::size_t frames = 0;
  std::vector<std::pair<std::size_t, std::size_t>> changes;  // after so many frames, to this camera
  for (const wire::Message& message : messages_of(stream(40.0))) {
    if (std::holds_alternative<wire::Frame>(message)) ++frames;
    if (const auto* status = std::get_if<wire::Sensors>(&message)) changes.emplace_back(frames, status->camera);
  }
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0], (std::pair<std::size_t, std::size_t>{0, 0}));
  EXPECT_EQ(changes[1].second, 1U);
  EXPECT_NEAR(static_cast<double>(changes[1].first), 30.0 * 60.0, 60.0);
}

TEST_F(ReplayStreamTest, IsTheSameEveryTime) {
  EXPECT_EQ(stream(1.0), stream(1.0));
  EXPECT_EQ(stream(1.0, kLead_s), stream(1.0, kLead_s));
}

TEST_F(ReplayStreamTest, ScenesHaveLivedInTheWindBeforeTheFirstFrame) {
  const auto fast = gale("fast.windlog", 60.0, 0.1);
  EXPECT_LT(first_lift_deg(fast, "20", 0.0), 40.0) << "they begin limp";
  EXPECT_GE(first_lift_deg(fast, "20", kLead_s), kLiftedInAGale_deg);
  EXPECT_GE(first_lift_deg(fast, "", kLead_s), kLiftedInAGale_deg) << "before the recording its first reading is held";
  EXPECT_GE(first_lift_deg(fast, "7", kLead_s), kLiftedInAGale_deg);
  EXPECT_GE(first_lift_deg(fast, "59.9", kLead_s), kLiftedInAGale_deg) << "its last reading";
  EXPECT_GE(first_lift_deg(gale("slow.windlog", 600.0, 60.0), "70", kLead_s), kLiftedInAGale_deg)
      << "no reading in the lead-in";
}

TEST_F(ReplayStreamTest, AGapBeforeTheFirstFrameHoldsTheReadingAfterIt) {
  const auto file = gale("gap.windlog", 30.0, 0.1);
  record_session(file, kFridayNoon + std::chrono::hours(80), 30.0, "",
                 {{.sensor = "mast", .speed_m_s = [](double) { return 16.0; }, .interval_s = 0.1}});
  EXPECT_GE(first_lift_deg(file, "2026-05-04T20:00:00Z", kLead_s), kLiftedInAGale_deg);
  EXPECT_GE(first_lift_deg(file, "2026-05-04T20:00:05Z", kLead_s), kLiftedInAGale_deg);
}

TEST_F(ReplayStreamTest, TheLeadInIsNeitherStreamedNorCounted) {
  for (const char* const start : {"", "20"}) {
    const auto messages = messages_of(stream(1.0, kLead_s, start));
    const double place_s = *start == '\0' ? 0.0 : 20.0;
    EXPECT_NEAR(std::get<wire::ControlReply>(messages.at(2)).players.at(0).length_s, 59.0 - place_s, 0.1);
    std::uint64_t tick = 0;
    for (const wire::Message& message : messages) {
      const auto* const frame = std::get_if<wire::Frame>(&message);
      if (frame == nullptr) continue;
      EXPECT_EQ(frame->info.tick, tick);
      EXPECT_DOUBLE_EQ(frame->info.time_s, static_cast<double>(tick++) / 60.0);
      EXPECT_NEAR(1e-9 * static_cast<double>(frame->info.utc_ns),
                  seconds(kFridayNoon.time_since_epoch()) - 30.0 + place_s + frame->info.time_s, 1e-3);
    }
    EXPECT_EQ(tick, 60U);
    const auto installation = sensing::recorded_installation(file_, {.playback = {.start = start}}).value();
    EXPECT_EQ(replay_in_lockstep(installation, kLead_s, 10.0, {}).value().readings, 30U);
  }
}

}  // namespace
}  // namespace yuragi::daemon::tools::offline
