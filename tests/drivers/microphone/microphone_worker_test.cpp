// The child's side, with a sound input that a test plays and a pipe that it reads.
#include "drivers/microphone/microphone_worker.hpp"

#include <array>
#include <cmath>
#include <csignal>
#include <deque>
#include <numbers>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensing/system_clock.hpp"
#include "drivers/decode/microphone/mic_frame.hpp"
#include "tests/support/descriptor.hpp"

namespace yuragi::drivers::microphone {
namespace {

using testing::HasSubstr;

/// A device that plays a sine, as fast as it is asked, and then does what the test says.
class PlayedInput final : public bus::AudioInput {
 public:
  std::uint64_t frames_to_play = 48000;
  std::uint64_t lose_at = 0;
  bool stops_at_end = true;  ///< or it hangs
  std::optional<Failure> failure;

  Result<std::vector<bus::AudioDevice>, Failure> list() override { return std::vector<bus::AudioDevice>{device_}; }
  Result<bus::AudioDevice, Failure> open(const bus::AudioChoice& choice, std::function<MonoTime()> now) override {
    if (failure) return *failure;
    now_ = std::move(now);
    begun_ = now_();
    device_.channels = choice.channels;
    return device_;
  }
  bool take(bus::AudioBlock& block) override {
    if (played_ >= frames_to_play) return false;
    block.lost_frames = played_ == lose_at && lose_at > 0 ? 1000 : 0;
    block.frames = bus::kAudioBlockFrames;
    for (std::uint32_t i = 0; i < block.frames; ++i, ++played_) {
      const auto sample = static_cast<float>(
          0.5 * std::sin(2.0 * std::numbers::pi * 60.0 * static_cast<double>(played_) / device_.rate_hz));
      for (std::size_t channel = 0; channel < device_.channels; ++channel) {
        block.samples[i * device_.channels + channel] = sample;
      }
    }
    block.end_frame = played_;
    block.end_mono_ns =
        (begun_ + from_seconds(static_cast<double>(played_) / device_.rate_hz)).time_since_epoch().count();
    return true;
  }
  bool is_running() override { return !stops_at_end || played_ < frames_to_play; }

  MonoTime begun() const { return begun_; }

 private:
  bus::AudioDevice device_{.name = "played", .host_api = "test", .channels = 2, .rate_hz = 48000.0, .is_default = true};
  std::function<MonoTime()> now_;
  MonoTime begun_{};
  std::uint64_t played_ = 0;
};

struct Said {
  bool was_told = false;
  std::vector<decode::microphone::MicFrame> frames;
  std::vector<decode::Refusal> refusals;
};

Said work(PlayedInput& input, const MicWorkerOptions& options, std::size_t end_after_frames = 1000) {
  std::array<int, 2> pipe{};
  EXPECT_EQ(pipe2(pipe.data(), O_CLOEXEC), 0);
  const Descriptor output(pipe[1]);
  Descriptor reading_end(pipe[0]);
  std::signal(SIGPIPE, SIG_IGN);

  Said said;
  const daemon::sensing::SystemClock clock;
  const std::atomic<bool> is_over = false;
  std::thread reader([&] {
    decode::microphone::MicFrameReader frames;
    std::array<std::uint8_t, 4096> buffer{};
    for (ssize_t size = 0; (size = read(reading_end.get(), buffer.data(), buffer.size())) > 0;) {
      frames.push(std::span(buffer).first(static_cast<std::size_t>(size)));
      while (const auto item = frames.next()) {
        if (item->frame) {
          said.frames.push_back(*item->frame);
        } else {
          said.refusals.push_back(item->frame.error());
        }
      }
      const bool failed =
          !said.frames.empty() && std::holds_alternative<decode::microphone::MicTrouble>(said.frames.back());
      if (failed || said.frames.size() >= end_after_frames) break;
    }
    reading_end.reset();
  });
  said.was_told = run_microphone_worker(options, input, clock, output.get(), is_over);
  reader.join();
  return said;
}

TEST(MicrophoneWorker, SaysHelloAndThenABlockEveryQuarterOfASecond) {
  PlayedInput input;
  const Said said = work(input, {.choice = {.channels = 2}});
  EXPECT_FALSE(said.was_told);
  EXPECT_TRUE(said.refusals.empty());
  ASSERT_GE(said.frames.size(), 5U);
  const auto& hello = std::get<decode::microphone::MicHello>(said.frames.front());
  EXPECT_EQ(hello.device, "played (test), 2 channels at 48000 Hz");
  EXPECT_EQ(hello.channels, 2);
  for (std::size_t i = 1; i + 1 < said.frames.size(); ++i) {
    const auto& block = std::get<decode::microphone::MicBlock>(said.frames[i]);
    EXPECT_NEAR(static_cast<double>(block.channels[1].total_power), 0.125, 0.01);
    const MonoTime heard = input.begun() + from_seconds(static_cast<double>(block.end_sample) / 48000.0);
    EXPECT_NEAR(static_cast<double>(block.end_mono_ns - heard.time_since_epoch().count()) * 1e-9, 0.0, 2e-3);
  }
  EXPECT_THAT(std::get<decode::microphone::MicTrouble>(said.frames.back()).message,
              HasSubstr("played (test), 2 channels at 48000 Hz stopped"));
}

TEST(MicrophoneWorker, GivesUpADeviceThatHangs) {
  PlayedInput input;
  input.stops_at_end = false;
  const Said said = work(input, {});
  EXPECT_FALSE(said.was_told);
  EXPECT_THAT(std::get<decode::microphone::MicTrouble>(said.frames.back()).message,
              HasSubstr("has been silent for 1.5 s"));
}

TEST(MicrophoneWorker, SaysWhyADeviceCannotBeOpened) {
  PlayedInput input;
  input.failure = Failure{"there is no input called \"x\": plug it in"};
  const Said said = work(input, {});
  EXPECT_FALSE(said.was_told);
  ASSERT_EQ(said.frames.size(), 1U);
  EXPECT_EQ(std::get<decode::microphone::MicTrouble>(said.frames[0]).message,
            "there is no input called \"x\": plug it in");

  PlayedInput other;
  const Said band = work(other, {.low_hz = 30000.0, .high_hz = 60000.0});
  EXPECT_THAT(std::get<decode::microphone::MicTrouble>(band.frames.at(0)).message, HasSubstr("too low for the band"));
}

TEST(MicrophoneWorker, CountsWhatWasLostAndGoesOn) {
  PlayedInput input;
  input.lose_at = 24064;
  const Said said = work(input, {});
  std::uint32_t lost = 0;
  for (const decode::microphone::MicFrame& frame : said.frames) {
    if (const auto* block = std::get_if<decode::microphone::MicBlock>(&frame)) lost += block->lost_samples;
  }
  EXPECT_EQ(lost, 1000U);
}

TEST(MicrophoneWorker, EndsWhenNobodyListens) {
  PlayedInput input;
  input.frames_to_play = 48'000'000;
  EXPECT_TRUE(work(input, {}, 3).was_told);
}

TEST(MicrophoneWorker, ListsInputsALineEach) {
  EXPECT_EQ(list_of_microphones({{"USB\tmic", "ALSA", 2, 48000.0, true}, {"other", "JACK", 1, 44100.0, false}}),
            "ALSA\t2\t48000\tdefault\tUSB mic\nJACK\t1\t44100\t-\tother\n");
}

}  // namespace
}  // namespace yuragi::drivers::microphone
