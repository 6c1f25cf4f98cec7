// The dialogue with a device of Lufft's, with a script at the far end.
#include "drivers/lufft/umb_sensor.hpp"

#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/scripted_port.hpp"

namespace yuragi::drivers::lufft {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

std::string framed(const std::string& text) {
  std::string frame =
      std::string("\x01\x10\x01\xF0\x01\x70", 6) + static_cast<char>(text.size()) + '\x02' + text + '\x03';
  const std::uint16_t sum =
      decode::lufft::umb_checksum({reinterpret_cast<const std::uint8_t*>(frame.data()), frame.size()});
  return frame + static_cast<char>(sum & 0xFFU) + static_cast<char>(sum >> 8U) + '\x04';
}

/// 22.5 m/s (channel 400) without a direction; or no speed, by this status.
const std::string kWind = framed(std::string("\x2F\x10\x00\x01\x08\x00\x90\x01\x16\x00\x00\xB4\x41", 13));
std::string no_wind(char status) {
  return framed(std::string("\x2F\x10\x00\x01\x03", 5) + status + "\x90\x01");
}

struct ScriptedUmb {
  FarEnd far_end;
  ManualClock clock;
  RecordingSink sink;
  std::unique_ptr<UmbSensor> sensor;

  explicit ScriptedUmb(ParameterValues::Map given = {}) {
    given.try_emplace("device", std::string("/dev/script"));
    sensor = std::make_unique<UmbSensor>(umb_settings_of(values_for("umb", given)),
                                         std::make_unique<ScriptedPort>(far_end, clock));
  }
  void run(Nanoseconds duration) {
    const MonoTime end = clock.now().mono + duration;
    for (int idle = 0; clock.now().mono < end && idle < 100'000; ++idle) clock.advance_to(sensor->poll(clock, sink));
  }
};

TEST(Umb, IsAskedAtItsInterval) {
  ScriptedUmb umb({{"poll_interval", 0.25}});
  umb.far_end.on_request = [&](const std::string&) { umb.far_end.send(kWind); };
  umb.run(10s);
  EXPECT_GE(umb.sink.readings.size(), 39U);
  EXPECT_LE(umb.sink.readings.size(), 41U);
  EXPECT_EQ(umb.sink.readings.front().speed_m_s, 22.5);
  EXPECT_FALSE(umb.sink.readings.front().direction_deg.has_value());
  EXPECT_EQ(umb.sink.last_detail(), "Lufft 7001h at /dev/script at 19200 8N1");
}

TEST(Umb, DropsWhatCameBeforeItsRequest) {
  ScriptedUmb umb;
  umb.far_end.send(kWind);
  umb.far_end.send(kWind.substr(0, 9));
  umb.run(400ms);
  EXPECT_TRUE(umb.sink.readings.empty());
  EXPECT_TRUE(umb.sink.refusals.empty());
  EXPECT_EQ(umb.far_end.written.size(), 1U);
}

/// The next request waits until a late reply has passed; after four the port is opened again.
TEST(Umb, IsAskedLessOftenWhileItDoesNotReply) {
  ScriptedUmb umb;
  umb.run(9s);
  EXPECT_EQ(umb.far_end.written.size(), 4U);
  EXPECT_EQ(umb.sink.count(decode::Refusal::kTimeout), 4);
  EXPECT_EQ(umb.far_end.closed, 1);
  EXPECT_EQ(umb.sink.last_state(), wind::LinkState::kConnecting);
  umb.far_end.on_request = [&](const std::string&) { umb.far_end.send(kWind); };
  umb.run(5s);
  EXPECT_GE(umb.sink.readings.size(), 3U);
  EXPECT_EQ(umb.sink.last_state(), wind::LinkState::kConnected);
}

TEST(Umb, SaysWhyItHasNoWind) {
  for (const auto& [status, why] : {std::pair('\x55', "the weather prevents it"), std::pair('\x28', "not ready yet"),
                                    std::pair('\x24', "it measures no wind"), std::pair('\x2A', "check the device")}) {
    ScriptedUmb umb;
    umb.far_end.on_request = [&umb, code = status](const std::string&) { umb.far_end.send(no_wind(code)); };
    umb.run(8s);
    EXPECT_TRUE(umb.sink.readings.empty());
    EXPECT_GE(umb.sink.count(decode::Refusal::kInvalid), 7);
    EXPECT_EQ(umb.sink.last_state(), wind::LinkState::kConnected)
        << "it is there; whether that is a wind is judged elsewhere";
    EXPECT_THAT(umb.sink.last_detail(), HasSubstr(why));
  }
}

TEST(Umb, IsRefusedWithSettingsThatContradictEachOther) {
  const auto refusal = [](const ParameterValues::Map& given) -> std::string {
    try {
      umb_settings_of(values_for("umb", given));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal({}), HasSubstr("device: is missing"));
  EXPECT_THAT(refusal({{"transport", std::string("tcp")}}), HasSubstr("host: is missing"));
  EXPECT_THAT(refusal({{"device", std::string("x")}, {"baud", std::int64_t{12345}}}), HasSubstr("baud: is 12345"));
  EXPECT_EQ(umb_settings_of(values_for("umb", {{"device", std::string("x")}, {"class", std::int64_t{8}}})).device,
            0x8001);
}

}  // namespace
}  // namespace yuragi::drivers::lufft
