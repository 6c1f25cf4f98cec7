// A replay as the stream of a daemon: what comes in which order, every tick of it, and always the same bytes.
#include "daemon/tools/offline/replay_stream.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensing/recorded_installation.hpp"
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

class ReplayStreamTest : public ::testing::Test {
 protected:
  ReplayStreamTest() {
    // From half a minute before noon on.
    record_session(file_, kFridayNoon - std::chrono::seconds(30), 60.0,
                   recorded_text(installation_text() + kTwoCameras), three_winds());
  }

  wire::Bytes stream(double duration_s) const {
    const auto installation = sensing::recorded_installation(file_, {}).value();
    wire::Bytes bytes;
    ReplayStream stream(installation.config, [&bytes](std::span<const std::uint8_t> more) {
      bytes.insert(bytes.end(), more.begin(), more.end());
    });
    replay_in_lockstep(installation, duration_s, {}, [&stream](const ReplayTick& tick) { stream.write(tick); }).value();
    return bytes;
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
}

}  // namespace
}  // namespace yuragi::daemon::tools::offline
