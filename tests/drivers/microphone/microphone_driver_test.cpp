// The driver as the daemon opens it: its parameters, and the faults of a real PortAudio on alsa-lib, whose sound card
// is the simulator's (tests/support/alsa_windsim.cpp).
#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/microphone/microphone_sensor.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/microphone_rig.hpp"

namespace yuragi::drivers::microphone {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::unique_ptr<sensor::Sensor> open_with(const ParameterValues::Map& given) {
  return driver_named("microphone").open(values_for("microphone", given));
}

TEST(MicrophoneDriver, SaysWhatIsWrongWithItsParameters) {
  const auto opening = [](const ParameterValues::Map& given) { return [given] { open_with(given); }; };
  EXPECT_THAT(opening({{"curve", std::string("-60:1")}}), ThrowsMessage<std::runtime_error>(HasSubstr("dB:m/s")));
  EXPECT_THAT(opening({{"faces", std::string("0 120 240")}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("one direction for each channel")));
  EXPECT_THAT(opening({{"faces", std::string("0 x")}}), ThrowsMessage<std::runtime_error>(HasSubstr("degrees")));
  EXPECT_THAT(opening({{"faces", std::string("0 0 9")}, {"channels", std::int64_t{3}}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("spread them out")));
  EXPECT_THAT(opening({{"band_low", 100.0}, {"band_high", 120.0}}),
              ThrowsMessage<std::runtime_error>(HasSubstr("band_high")));
  EXPECT_NO_THROW(open_with(
      {{"faces", std::string("0, 120, 240")}, {"channels", std::int64_t{3}}, {"curve", std::string("-60:0 -30:8")}}));
}

/// PortAudio on a card whose microphones are a simulator's, in a steady wind.
class MicrophoneFault : public testing::Test {
 protected:
  MicrophoneFault()
      : rig_("pcm_type.windsim { lib \"" + test::built_path("lib/libasound_module_pcm_windsim.so") +
             "\" }\npcm.windmic { type windsim path \"" + socket() + "\" channels 2 rate 48000 }\n"),
        simulator_({"--listen", socket(), "--channels", "2", "--speed", "8", "--turbulence", "0"}) {
    rig_.open({{"device", std::string("WINDmic")},
               {"channels", std::int64_t{2}},
               {"gain", 40.0},
               {"timeout", 2.0},
               {"noise_floor", -150.0}});
    usual_m_s_ = rig_.next_speed_m_s(4);
  }

  static std::string socket() {
    static const test::TemporaryFolder folder;
    return folder / "mic.sock";
  }

  RecordingSink& sink() { return rig_.sink; }
  bool becomes(wind::LinkState state) {
    return rig_.wait_until([&] { return sink().last_state() == state; });
  }
  /// Listens for a while, in which nothing may be published.
  void expect_no_reading_for(Nanoseconds duration) {
    sink().readings.clear();
    EXPECT_FALSE(rig_.wait_until([&] { return !sink().readings.empty(); }, duration));
  }
  void expect_usual_readings_again() {
    simulator_.recover();
    sink().readings.clear();
    EXPECT_NEAR(rig_.next_speed_m_s(4), usual_m_s_, 0.25 * usual_m_s_);
    EXPECT_EQ(sink().last_state(), wind::LinkState::kConnected);
  }

  test::MicrophoneRig rig_;
  test::MicrophoneSimulatorProcess simulator_;
  double usual_m_s_ = 0.0;
};

TEST_F(MicrophoneFault, Silence) {
  simulator_.suffer("silence");
  EXPECT_TRUE(becomes(wind::LinkState::kConnecting));
  EXPECT_THAT(sink().last_detail(), HasSubstr("has been silent"));
  expect_no_reading_for(2s);
  expect_usual_readings_again();
}

TEST_F(MicrophoneFault, Freeze) {
  simulator_.suffer("freeze");
  rig_.next_speed_m_s(6);  // until the last of the live sound is out of the window
  sink().readings.clear();
  sink().refusals.clear();
  rig_.next_speed_m_s(4);
  const auto [slowest, fastest] = std::ranges::minmax(sink().readings, {}, &wind::Reading::speed_m_s);
  EXPECT_LT(fastest.speed_m_s - slowest.speed_m_s, 0.15 * usual_m_s_) << "the same second again and again";
  EXPECT_EQ(sink().last_state(), wind::LinkState::kConnected);
  EXPECT_TRUE(sink().refusals.empty());
  expect_usual_readings_again();
}

TEST_F(MicrophoneFault, Spike) {
  simulator_.suffer("spike");
  EXPECT_TRUE(rig_.wait_until([&] { return sink().readings.back().speed_m_s > 2.0 * usual_m_s_; }));
  EXPECT_EQ(sink().last_state(), wind::LinkState::kConnected);
  EXPECT_TRUE(sink().refusals.empty());
  simulator_.recover();
  EXPECT_TRUE(rig_.wait_until([&] { return sink().readings.back().speed_m_s < 1.25 * usual_m_s_; }));
  expect_usual_readings_again();
}

TEST_F(MicrophoneFault, Garbage) {
  sink().readings.clear();
  simulator_.suffer("garbage");
  EXPECT_TRUE(rig_.wait_until([&] { return sink().count(decode::Refusal::kImplausible) >= 4; }));
  for (const wind::Reading& reading : sink().readings) EXPECT_LT(reading.speed_m_s, 1.5 * usual_m_s_);
  EXPECT_EQ(sink().last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(sink().last_detail(), HasSubstr("noise at full scale"));
  expect_no_reading_for(1500ms);
  expect_usual_readings_again();
}

TEST_F(MicrophoneFault, Split) {
  sink().refusals.clear();
  simulator_.suffer("split");
  EXPECT_NEAR(rig_.next_speed_m_s(4), usual_m_s_, 0.25 * usual_m_s_);
  EXPECT_EQ(sink().last_state(), wind::LinkState::kConnected);
  EXPECT_TRUE(sink().refusals.empty());
  expect_usual_readings_again();
}

TEST_F(MicrophoneFault, Disconnect) {
  simulator_.suffer("disconnect");
  EXPECT_TRUE(becomes(wind::LinkState::kConnecting));
  expect_no_reading_for(2s);
  expect_usual_readings_again();
}

TEST_F(MicrophoneFault, Unplug) {
  simulator_.suffer("unplug");
  EXPECT_TRUE(rig_.wait_until([&] { return sink().last_detail().find("there is no input") != std::string::npos; }))
      << sink().last_detail();
  EXPECT_THAT(sink().last_detail(), HasSubstr("(\"default\")")) << "what there is instead";
  EXPECT_EQ(sink().last_state(), wind::LinkState::kConnecting);
  expect_no_reading_for(1s);
  expect_usual_readings_again();
}

TEST_F(MicrophoneFault, InterruptEndsTheWaitForSound) {
  simulator_.suffer("silence");
  rig_.close();
  EXPECT_EQ(sink().last_detail(), "interrupted") << "shutting down waits for nobody";
}

TEST_F(MicrophoneFault, TheInputIsFoundByItsName) {
  const auto found = find_microphones(test::built_path("bin/yuragi"));
  const auto windmic = std::ranges::find_if(
      found, [](const sensor::FoundDevice& device) { return device.what.starts_with("microphone windmic"); });
  ASSERT_NE(windmic, found.end());
  EXPECT_EQ(windmic->what, "microphone windmic (ALSA), 2 channels, 48000 Hz");
  EXPECT_EQ(windmic->settings, "device = \"windmic\"\nchannels = 2");
  EXPECT_EQ(windmic->trouble, "");
}

}  // namespace
}  // namespace yuragi::drivers::microphone
