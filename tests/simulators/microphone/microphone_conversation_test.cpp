// The driver hears the simulator through real sound systems: PortAudio on alsa-lib, with the card of tests/support, and
// on PulseAudio.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/microphone_rig.hpp"
#include "tests/support/pulse_server.hpp"

namespace yuragi::simulators::microphone {
namespace {

using test::MicrophoneRig;
using test::MicrophoneSimulatorProcess;
using testing::HasSubstr;

const test::TemporaryFolder& sockets() {
  static const test::TemporaryFolder folder;
  return folder;
}

std::string card(const std::string& socket, int channels) {
  return "pcm_type.windsim { lib \"" + test::built_path("lib/libasound_module_pcm_windsim.so") +
         "\" }\npcm.windmic { type windsim path \"" + socket + "\" channels " + std::to_string(channels) +
         " rate 48000 }\n";
}

TEST(MicrophoneAndSimulator, FourFacesTellSpeedAndDirection) {
  const std::string socket = sockets() / "faces.sock";
  const MicrophoneSimulatorProcess simulator(
      {"--listen", socket, "--channels", "4", "--faces", "--speed", "8", "--direction", "300", "--turbulence", "0"});
  MicrophoneRig rig(card(socket, 4));
  rig.open({{"device", std::string("windmic")},
            {"channels", std::int64_t{4}},
            {"gain", 28.0},
            {"noise_floor", -150.0},
            {"faces", std::string("0 90 180 270")},
            {"direction_smoothing", 2.0}});
  rig.next_speed_m_s(20);
  const wind::Reading& reading = rig.sink.readings.back();
  ASSERT_TRUE(reading.direction_deg) << rig.sink.last_detail();
  const double off_deg = std::remainder(*reading.direction_deg - 300.0, 360.0);
  std::printf("direction off by %.1f degrees, speed %.2f m/s\n", off_deg, reading.speed_m_s);
  EXPECT_LT(std::abs(off_deg), 15.0);
  EXPECT_EQ(reading.quality, wind::ReadingQuality::kGood);
  EXPECT_TRUE(rig.sink.refusals.empty());

  // Readings come four a second, each stamped with the middle of its second of sound.
  const auto& readings = rig.sink.readings;
  const double span_s = seconds(readings.back().time.mono - readings[4].time.mono);
  EXPECT_NEAR(span_s / static_cast<double>(readings.size() - 5), 0.256, 0.02);
  const double age_s = seconds(std::chrono::steady_clock::now() - readings.back().time.mono);
  EXPECT_TRUE(age_s > 0.0 && age_s < 60.0) << age_s << " s; only a machine that hangs takes so long";
  for (std::size_t i = 5; i < readings.size(); ++i) {
    EXPECT_NEAR(seconds(readings[i].time.mono - readings[i - 1].time.mono), 0.256, 0.12)
        << "the time stamps are smoothed";
  }
}

TEST(MicrophoneAndSimulator, AVoiceDoesNotBlow) {
  const std::string socket = sockets() / "voice.sock";
  // In the band, the voice is ten times as loud as this breeze.
  const MicrophoneSimulatorProcess simulator(
      {"--listen", socket, "--channels", "2", "--speed", "2", "--turbulence", "0", "--voice", "-35"});
  MicrophoneRig rig(card(socket, 2));
  ParameterValues::Map values = {
      {"device", std::string("windmic")}, {"channels", std::int64_t{2}}, {"gain", 28.0}, {"noise_floor", -150.0}};
  rig.open(values);
  const double speed_m_s = rig.next_speed_m_s(20);
  values["ignore_sound"] = false;
  rig.open(values);
  const double deaf_m_s = rig.next_speed_m_s(20);
  std::printf("a breeze and a voice read %.2f m/s, without telling them apart %.2f m/s\n", speed_m_s, deaf_m_s);
  EXPECT_LT(speed_m_s, 0.6 * deaf_m_s);
}

/// A source of PulseAudio, fed by the simulator through a named pipe.
class MicrophoneFault : public testing::Test {
 protected:
  MicrophoneFault()
      : server_(folder_.path()),
        rig_("pcm_type.pulse { lib \"libasound_module_pcm_pulse.so\" }\npcm.windpulse { type pulse server \"" +
             server_.address() + "\" device \"windsource\" }\n") {}

  /// PulseAudio makes the pipe, and takes it away with the source.
  void plug_in() {
    module_ = server_.load({"module-pipe-source", "source_name=windsource", "file=" + pipe(), "format=float32le",
                            "rate=48000", "channels=2", "channel_map=front-left,front-right"});
  }
  std::string pipe() const { return folder_ / "wind.pipe"; }

  test::TemporaryFolder folder_;
  test::PulseServer server_;
  MicrophoneRig rig_;
  std::string module_;
};

TEST_F(MicrophoneFault, UnplugUnderPulseAudio) {
  plug_in();
  const MicrophoneSimulatorProcess simulator(
      {"--pipe", pipe(), "--channels", "2", "--speed", "8", "--turbulence", "0"});
  rig_.open({{"device", std::string("windpulse")},
             {"channels", std::int64_t{2}},
             {"rate", 48000.0},
             {"gain", 28.0},
             {"noise_floor", -150.0}});
  const double usual_m_s = rig_.next_speed_m_s();
  EXPECT_GT(usual_m_s, 2.0);
  EXPECT_THAT(rig_.sink.last_detail(), HasSubstr("windpulse (ALSA), 2 channels at 48000 Hz"));

  // The source is unloaded, as when a USB microphone is pulled out.
  server_.unload(module_);
  EXPECT_TRUE(rig_.wait_until([&] { return rig_.sink.last_state() == wind::LinkState::kConnecting; }));
  rig_.sink.readings.clear();
  EXPECT_FALSE(rig_.wait_until([&] { return !rig_.sink.readings.empty(); }, std::chrono::seconds(2)));

  plug_in();
  EXPECT_NEAR(rig_.next_speed_m_s(), usual_m_s, 0.25 * usual_m_s);
  EXPECT_EQ(rig_.sink.last_state(), wind::LinkState::kConnected);
}

}  // namespace
}  // namespace yuragi::simulators::microphone
