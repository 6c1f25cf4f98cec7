// The parent's side, fed by a port that a test plays: protocol, watchdog, what is published.
#include "drivers/microphone/microphone_sensor.hpp"

#include <deque>
#include <functional>
#include <variant>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/manual_clock.hpp"
#include "tests/support/mic_sounds.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::drivers::microphone {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Plays what was put into it; then nothing comes until the time-out, which it lets pass.
class PlayedPort final : public bus::BytePort {
 public:
  struct Played {
    std::deque<std::variant<std::vector<std::uint8_t>, bus::ByteStatus>> next;
    bool opens = true;
    int opened = 0;
    int closed = 0;
  };
  PlayedPort(Played& played, ManualClock& clock) : played_(played), clock_(clock) {}

  Result<void, Failure> open() override {
    if (!played_.opens) return Failure{"cannot start it"};
    ++played_.opened;
    return {};
  }
  void close() noexcept override { ++played_.closed; }
  bus::ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (played_.next.empty()) {
      clock_.advance(timeout);
      return {.status = bus::ByteStatus::kSilence};
    }
    auto next = played_.next.front();
    played_.next.pop_front();
    if (const auto* status = std::get_if<bus::ByteStatus>(&next)) return {.status = *status};
    const auto& bytes = std::get<0>(next);
    const std::size_t size = std::min(bytes.size(), buffer.size());
    std::copy_n(bytes.begin(), size, buffer.begin());
    if (size < bytes.size()) {
      played_.next.emplace_front(
          std::vector<std::uint8_t>(bytes.begin() + static_cast<std::ptrdiff_t>(size), bytes.end()));
    }
    clock_.advance(1ms);
    return {.status = bus::ByteStatus::kBytes, .size = size};
  }
  bool write(std::span<const std::uint8_t> /*bytes*/) override { return false; }
  void interrupt() noexcept override { played_.next.emplace_front(bus::ByteStatus::kInterrupted); }

 private:
  Played& played_;
  ManualClock& clock_;
};

class MicrophoneSensorTest : public testing::Test {
 protected:
  MicrophoneSensorTest() {
    decode::microphone::MicAnalyser analyser({.rate_hz = 8000.0, .channels = 2});
    std::tie(hello_, blocks_) = test::blocks_of(test::wind_noise(8000.0, 2, 20.0, 0.05));
    hello_.device = "windmic";
  }

  Sensor& sensor() {
    if (!sensor_) {
      settings_.estimator.noise_floor_db = -120.0;
      sensor_.emplace(settings_, 1, std::make_unique<PlayedPort>(port_, clock_));
    }
    return *sensor_;
  }
  void say(const std::vector<std::uint8_t>& bytes) { port_.next.emplace_back(bytes); }
  void say(bus::ByteStatus status) { port_.next.emplace_back(status); }
  void send_hello() { say(decode::microphone::encode_mic_frame(hello_)); }
  void send_blocks(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      say(decode::microphone::encode_mic_frame(blocks_.at(next_block_++), hello_));
  }

  /// Polls as the daemon would, until all that was said has been heard, and no further.
  void hear() {
    sensor();
    while (!port_.next.empty()) poll();
  }
  void poll() { clock_.advance_to(sensor().poll(clock_, sink_)); }

  Settings settings_{.is_calibrated = true};
  ManualClock clock_;
  RecordingSink sink_;
  PlayedPort::Played port_;
  decode::microphone::MicHello hello_;
  std::vector<decode::microphone::MicBlock> blocks_;
  std::size_t next_block_ = 0;
  std::optional<Sensor> sensor_;
};

class MicrophoneFault : public MicrophoneSensorTest {};

TEST_F(MicrophoneSensorTest, PublishesAReadingABlockOnceAWindowIsFull) {
  poll();
  send_hello();
  send_blocks(12);
  hear();
  ASSERT_EQ(sink_.readings.size(), 9U);
  for (const wind::Reading& reading : sink_.readings) {
    EXPECT_NEAR(reading.speed_m_s, 2.5, 0.6);
    EXPECT_EQ(reading.quality, wind::ReadingQuality::kGood);
    EXPECT_FALSE(reading.direction_deg);
    EXPECT_TRUE(wind::is_plausible(reading));
  }
  EXPECT_EQ(sink_.raws.size(), 13U);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
  EXPECT_EQ(sink_.last_detail(), "windmic");
  EXPECT_TRUE(sink_.refusals.empty());
}

TEST_F(MicrophoneSensorTest, TimesAReadingByTheMiddleOfItsWindow) {
  poll();
  send_hello();
  for (auto& block : blocks_) block.end_mono_ns = (clock_.now().mono - 50ms).time_since_epoch().count();
  send_blocks(4);
  hear();
  ASSERT_EQ(sink_.readings.size(), 1U);
  const double age_s = seconds(clock_.now().mono - sink_.readings[0].time.mono);
  EXPECT_NEAR(age_s, 0.55, 0.02);
  EXPECT_NEAR(seconds(clock_.now().utc - sink_.readings[0].time.utc), age_s, 1e-6);

  // A stamp of another clock is not believed.
  for (auto& block : blocks_) block.end_mono_ns = 42;
  send_blocks(1);
  hear();
  EXPECT_NEAR(seconds(clock_.now().mono - sink_.readings.back().time.mono), 0.5, 0.02);
}

TEST_F(MicrophoneSensorTest, IsUncertainUntilItIsCalibrated) {
  settings_.is_calibrated = false;
  poll();
  send_hello();
  send_blocks(5);
  hear();
  ASSERT_FALSE(sink_.readings.empty());
  EXPECT_EQ(sink_.readings.back().quality, wind::ReadingQuality::kUncertain);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("not calibrated"));
}

TEST_F(MicrophoneSensorTest, IsUncertainWhileItClipsAndSaysSo) {
  for (decode::microphone::MicBlock& block : blocks_) block.channels[0].clipped = 0.1F;
  poll();
  send_hello();
  send_blocks(5);
  hear();
  ASSERT_FALSE(sink_.readings.empty());
  EXPECT_EQ(sink_.readings.back().quality, wind::ReadingQuality::kUncertain);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("clips"));
}

TEST_F(MicrophoneSensorTest, IsUnusableWhileTwoChannelsCarryTheSameSignalAndSaysWhatToDo) {
  const std::vector<decode::microphone::MicBlock> both = blocks_;
  for (decode::microphone::MicBlock& block : blocks_) {
    block.channels[1] = block.channels[0];
    for (std::size_t band = 0; band < hello_.bands; ++band) block.cross[0][band] = block.channels[0].power[band];
  }
  poll();
  send_hello();
  send_blocks(9);
  hear();
  EXPECT_TRUE(sink_.readings.empty()) << "no calm is told";
  EXPECT_EQ(sink_.count(decode::Refusal::kInvalid), 2);
  EXPECT_NE(sink_.last_state(), wind::LinkState::kConnected);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("windmic: channels 1 and 2 carry the same signal"));
  EXPECT_THAT(sink_.last_detail(), HasSubstr("set channels = 1"));

  blocks_ = both;
  send_blocks(8);
  hear();
  EXPECT_FALSE(sink_.readings.empty());
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
}

TEST_F(MicrophoneSensorTest, SaysWhatTheWorkerSaysIsWrongAndBeginsItAgain) {
  for (int i = 0; i < 3; ++i) {
    poll();
    say(decode::microphone::encode_mic_frame(
        decode::microphone::MicTrouble{"there is no input called \"foo\": plug it in"}));
    say(bus::ByteStatus::kLost);
    hear();
    EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
    EXPECT_EQ(sink_.last_detail(), "there is no input called \"foo\": plug it in");
    EXPECT_EQ(port_.closed, i + 1);
  }
  EXPECT_EQ(port_.opened, 3);
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(MicrophoneSensorTest, KillsAWorkerThatNeverBegins) {
  poll();
  const MonoTime begun = clock_.now().mono;
  poll();
  EXPECT_GE(seconds(clock_.now().mono - begun), 15.0);
  EXPECT_EQ(port_.closed, 1);
  EXPECT_EQ(sink_.count(decode::Refusal::kTimeout), 1);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("has not started"));
}

TEST_F(MicrophoneSensorTest, OnASlowMachineGivesTheWorkerMoreTimeToBeginFromStartToStart) {
  poll();
  for (const double wait_s : {15.0, 30.0, 60.0, 120.0, 120.0}) {
    const MonoTime begun = clock_.now().mono;
    poll();
    EXPECT_GE(seconds(clock_.now().mono - begun), wait_s);
    EXPECT_THAT(sink_.last_detail(), HasSubstr(fmt::format("not started within {:g} s", wait_s)));
    while (port_.opened == port_.closed) poll();
  }
  send_hello();
  hear();
  say(bus::ByteStatus::kLost);
  hear();
  while (port_.opened == port_.closed) poll();
  poll();
  EXPECT_THAT(sink_.last_detail(), HasSubstr("not started within 15 s")) << "it has begun since";
}

TEST_F(MicrophoneSensorTest, KillsAWorkerThatTalksWithoutSayingAnything) {
  poll();
  send_hello();
  send_blocks(4);
  hear();
  const MonoTime last_block = clock_.now().mono;
  int sent = 0;
  while (port_.closed == 0 && sent < 100000) {
    say({'b', 'l', 'a'});
    ++sent;
    poll();
  }
  EXPECT_EQ(port_.closed, 1);
  EXPECT_NEAR(seconds(clock_.now().mono - last_block), 3.0, 0.5);
}

TEST_F(MicrophoneSensorTest, KeepsWhatItKnowsOfTheMicrophoneFromWorkerToWorker) {
  settings_.estimator.window_s = 0.5;
  poll();
  send_hello();
  send_blocks(20);
  hear();
  ASSERT_TRUE(sink_.readings.back().gust_m_s);
  say(bus::ByteStatus::kLost);
  hear();
  poll();
  send_hello();
  send_blocks(3);
  hear();
  EXPECT_TRUE(sink_.readings.back().gust_m_s) << "the gusts of the last minutes are still known";
}

TEST_F(MicrophoneSensorTest, EndsAtOnceWhenItIsInterrupted) {
  poll();
  send_hello();
  hear();
  sensor().interrupt();
  const MonoTime before = clock_.now().mono;
  sensor().poll(clock_, sink_);
  EXPECT_EQ(clock_.now().mono, before);
}

TEST_F(MicrophoneFault, BadChecksum) {
  poll();
  send_hello();
  send_blocks(6);
  hear();
  const auto before = sink_.readings.size();
  for (int i = 0; i < 3; ++i) {
    auto bytes = decode::microphone::encode_mic_frame(blocks_.at(next_block_++), hello_);
    bytes.back() ^= 1U;
    say(bytes);
  }
  hear();
  EXPECT_GE(sink_.count(decode::Refusal::kBadChecksum), 3);
  EXPECT_EQ(sink_.readings.size(), before);
  send_blocks(2);
  hear();
  EXPECT_EQ(sink_.readings.size(), before + 2);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
}

TEST_F(MicrophoneFault, Partial) {
  poll();
  send_hello();
  send_blocks(6);
  hear();
  const auto before = sink_.readings.size();
  auto bytes = decode::microphone::encode_mic_frame(blocks_.at(next_block_++), hello_);
  bytes.resize(bytes.size() / 2);
  say(bytes);
  say(bus::ByteStatus::kLost);
  hear();
  EXPECT_EQ(sink_.readings.size(), before);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("ended without a message"));

  poll();
  send_hello();
  send_blocks(5);
  hear();
  EXPECT_EQ(sink_.readings.size(), before + 2) << "half a frame of the old worker is not put before the new one's";
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
}

TEST_F(MicrophoneFault, SplitInThePipe) {
  poll();
  std::vector<std::uint8_t> bytes = decode::microphone::encode_mic_frame(hello_);
  for (int i = 0; i < 8; ++i) {
    const auto block = decode::microphone::encode_mic_frame(blocks_.at(next_block_++), hello_);
    bytes.insert(bytes.end(), block.begin(), block.end());
  }
  for (const std::uint8_t byte : bytes) say({byte});
  hear();
  EXPECT_EQ(sink_.readings.size(), 5U);
  EXPECT_TRUE(sink_.refusals.empty());
}

}  // namespace
}  // namespace yuragi::drivers::microphone
