// What drivers of text have in common, whatever the lines mean: how bytes become lines, and how a device that is silent
// or talks nonsense is noticed.
#include "drivers/text/text_sensor.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include "tests/support/decoded_text.hpp"
#include "tests/support/scripted_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::text {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

std::string mwv_line(double speed_m_s) {
  return sentence("WIMWV,90.0,R," + std::to_string(speed_m_s) + ",M,A") + "\r\n";
}

class TextSensorTest : public testing::Test, protected ScriptedText {};

/// However the bytes were split on their way, the readings are the same.
TEST_F(TextSensorTest, GivesTheSameReadingsHoweverBytesAreSplit) {
  std::string text;
  for (int i = 0; i < 40; ++i) text += mwv_line(0.25 * i) + (i % 5 == 0 ? "# a comment\r\n" : "");
  std::mt19937_64 random(3);
  for (int round = 0; round < 200; ++round) {
    make_nmea();
    sink = {};
    far_end = {};
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t size = std::min<std::size_t>(rest.size(), 1 + random() % (round % 2 == 0 ? 7 : 200));
      far_end.send(rest.substr(0, size));
      rest.remove_prefix(size);
    }
    run(2s);
    // The first one waits for a better one in its burst, and is overtaken by the second.
    ASSERT_EQ(sink.readings.size(), 39U);
    for (std::size_t i = 0; i < sink.readings.size(); ++i) {
      ASSERT_DOUBLE_EQ(sink.readings[i].speed_m_s, 0.25 * static_cast<double>(i + 1));
    }
    ASSERT_EQ(sink.count(decode::Refusal::kNotMine), 8);
    ASSERT_EQ(std::ssize(sink.refusals), 8);
  }
}

TEST_F(TextSensorTest, KeepsNothingOfALineWithoutEnd) {
  make_nmea();
  receive(mwv_line(1.0));
  const std::size_t before = mallinfo2().uordblks;
  std::size_t most = before;
  const std::string block(std::size_t{64} * 1024, '7');
  for (int i = 0; i < 160; ++i) {
    far_end.send(block);
    while (!far_end.incoming.empty()) clock.advance_to(sensor->poll(clock, sink));
    most = std::max<std::size_t>(most, mallinfo2().uordblks);
  }
  EXPECT_LT(most - before, 1024U * 1024U) << "10 MB have passed";
  EXPECT_EQ(sink.count(decode::Refusal::kMalformed), 1) << "refused once, and skipped";
  receive("\r\n" + mwv_line(2.0));
  EXPECT_EQ(sink.readings.back().speed_m_s, 2.0);
}

TEST_F(TextSensorTest, TracesWhateverComes) {
  make_nmea();
  receive("# comment\r\n" + mwv_line(1.0) + "\xff\xfe\r\n");
  std::vector<std::string> traced;
  for (const auto& raw : sink.raws) traced.emplace_back(raw.message.begin(), raw.message.end());
  EXPECT_THAT(traced, testing::ElementsAre("# comment", sentence("WIMWV,90.0,R,1.000000,M,A"), "\xff\xfe"));
}

TEST_F(TextSensorTest, OpensADeviceAgainAfterTenTimesItsUsualSilence) {
  make_nmea();
  for (int i = 0; i < 10; ++i) {
    receive(mwv_line(1.0));
    run(1750ms);
  }
  EXPECT_EQ(far_end.opened, 1);
  run(14s);
  EXPECT_EQ(far_end.opened, 1);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting) << "it is silent for longer than usual";
  run(10s);
  EXPECT_GE(far_end.opened, 2);
  EXPECT_EQ(far_end.closed, far_end.opened - 1);
  EXPECT_GE(sink.count(decode::Refusal::kTimeout), 1);
  receive(mwv_line(1.0));
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

/// It says a few words whenever it starts, which is whenever it is opened, and a reading a minute.
TEST_F(TextSensorTest, WaitsForAnArduinoThatStartsAnewWheneverItIsOpened) {
  make_nmea();
  int started = 0;
  MonoTime since{};
  for (const MonoTime end = clock.now().mono + 20min; clock.now().mono < end;) {
    if (far_end.opened > started) {
      started = far_end.opened;
      since = clock.now().mono;
      far_end.send("# Arduino\r\n# wind station\r\n");
    }
    if (clock.now().mono - since >= 60s) {
      since = clock.now().mono;
      far_end.send(mwv_line(1.0));
    }
    clock.advance_to(sensor->poll(clock, sink));
  }
  EXPECT_GE(sink.readings.size(), 15U);
  EXPECT_LE(far_end.opened, 3);
}

/// An outage is no pause that is usual for the device.
TEST_F(TextSensorTest, DoesNotGetUsedToOutages) {
  make_nmea({{"silence_timeout", 3600.0}});
  for (int outage = 0; outage < 20; ++outage) {
    for (int i = 0; i < 5; ++i) receive(mwv_line(1.0));
    EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
    run(3500ms);
    EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
    run(20s);
  }
}

/// A device that was quick and is set to be slow.
TEST_F(TextSensorTest, GetsUsedToASlowerPace) {
  make_nmea({{"silence_timeout", 3600.0}});
  for (int i = 0; i < 20; ++i) receive(mwv_line(1.0));
  for (int i = 0; i < 6; ++i) {
    run(20s);
    receive(mwv_line(1.0));
  }
  const std::size_t reported = sink.links.size();
  for (int i = 0; i < 6; ++i) {
    run(20s);
    receive(mwv_line(1.0));
  }
  EXPECT_EQ(sink.links.size(), reported);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

TEST_F(TextSensorTest, IsPatientWithASlowDevice) {
  make_nmea();
  for (int minute = 0; minute < 20; ++minute) {
    receive(mwv_line(1.0));
    run(59'750ms);
  }
  EXPECT_EQ(far_end.opened, 1);
  EXPECT_EQ(sink.readings.size(), 20U);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

TEST_F(TextSensorTest, OpensAgainAfterTheSilenceThatItIsTold) {
  make_nmea({{"silence_timeout", 2.0}});
  receive(mwv_line(1.0));
  run(60s);
  EXPECT_GE(far_end.opened, 6);
  EXPECT_LE(far_end.opened, 16) << "the waits between grow";
}

TEST_F(TextSensorTest, SaysThatBytesComeButNoLine) {
  make_nmea();
  std::mt19937_64 random(5);
  for (int i = 0; i < 100; ++i) {
    std::string noise(24, '\0');
    for (char& byte : noise) byte = static_cast<char>(0x80U | random());  // as a wrong baud rate makes of text
    receive(noise);
  }
  EXPECT_THAT(sink.last_detail(), HasSubstr("bytes arrive from /dev/script at 9600 8N1, but no lines: check baud"));
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
  receive("\r\n" + mwv_line(3.0));
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

TEST_F(TextSensorTest, SaysWhichLinesItCannotUse) {
  make_nmea();
  for (int i = 0; i < 20; ++i) receive("$GPGGA,094736,5251.0094,N*00\r\n# hello\r\n");
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(sink.last_detail(), HasSubstr("wrong checksums"));
  make_nmea();
  sink = {};
  for (int i = 0; i < 20; ++i) receive("T=21.5 H=40\r\n");
  EXPECT_THAT(sink.last_detail(), HasSubstr("without wind (the first: \"T=21.5 H=40\")"));
  EXPECT_LE(sink.links.size(), 3U) << "what has not changed is not told again";
}

TEST_F(TextSensorTest, TriesAgainForEverWhatCannotBeOpenedReadOrWritten) {
  far_end.can_open = false;
  make_nmea({{"format", std::string("umb")}});
  run(60s);
  EXPECT_EQ(sink.last_detail(), "cannot open the script: try again");
  far_end.can_open = true;
  far_end.can_write = false;
  run(30s);
  EXPECT_GE(far_end.opened, 2);
  EXPECT_THAT(sink.last_detail(), HasSubstr("does not accept requests"));
  far_end.can_write = true;
  far_end.on_request = [this](const std::string&) { far_end.send(mwv_line(1.0)); };
  run(15s);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  far_end.incoming.push_front({bus::ByteStatus::kLost, "", false});
  run(100ms);
  EXPECT_THAT(sink.last_detail(), HasSubstr("is gone"));
  run(15s);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
}

TEST_F(TextSensorTest, PlaysAFileAtItsPaceAndFinishes) {
  make_nmea({{"transport", std::string("file")}, {"file", std::string("script")}, {"play_rate", 2.0}});
  for (int i = 0; i < 20; ++i) far_end.send(mwv_line(i));
  far_end.incoming.push_back({bus::ByteStatus::kEnd, "", false});
  const MonoTime begin = clock.now().mono;
  run(60s);
  ASSERT_EQ(sink.readings.size(), 19U);
  EXPECT_NEAR(seconds(sink.readings.back().time.mono - begin), 9.0, 0.1);
  EXPECT_EQ(sink.last_state(), wind::LinkState::kFinished);
  EXPECT_EQ(far_end.opened, 1);
}

TEST_F(TextSensorTest, SaysThatOnlyOthersSend) {
  make_nmea({{"transport", std::string("udp")}, {"sender", std::string("192.0.2.7")}});
  for (int i = 0; i < 50; ++i) {
    far_end.incoming.push_back({bus::ByteStatus::kForeign, "", false});
    run(200ms);
  }
  EXPECT_THAT(sink.last_detail(), HasSubstr("none from 192.0.2.7: check sender"));
  EXPECT_EQ(sink.count(decode::Refusal::kNotMine), 50);
}

TEST_F(TextSensorTest, TakesTheEndOfADatagramForTheEndOfALine) {
  make_nmea({{"transport", std::string("udp")}});
  for (const double speed_m_s : {1.0, 2.0}) {
    const std::string line = mwv_line(speed_m_s);
    far_end.incoming.push_back({bus::ByteStatus::kBytes, line.substr(0, line.size() - 2), true});
  }
  run(1s);
  EXPECT_EQ(sink.readings.size(), 1U) << "the first is overtaken in its burst";
  EXPECT_TRUE(sink.refusals.empty());
}

/// Nothing that comes may stop the driver, or make it publish what is no wind.
TEST_F(TextSensorTest, SurvivesWhateverComes) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 50; ++round) {
    if (round % 2 == 0) {
      make_nmea({{"missing_checksum", std::string("accept")}});
    } else {
      make_line();
    }
    for (int i = 0; i < 50; ++i) {
      std::string bytes(random() % 400, '\0');
      constexpr std::string_view kAlphabet = "0123456789.,-+MNKSRTLAVDWQ$*=:e \x02\x03\r\n\xff";
      for (char& byte : bytes) byte = kAlphabet[random() % kAlphabet.size()];
      const auto status = static_cast<bus::ByteStatus>(random() % 8 == 0 ? random() % 6 : 0);
      far_end.incoming.push_back({status, status == bus::ByteStatus::kBytes ? bytes : "", random() % 2 == 0});
    }
    run(120s);
  }
  for (const wind::Reading& reading : sink.readings) ASSERT_TRUE(wind::is_plausible(reading));
  EXPECT_FALSE(sink.refusals.empty());
}

TEST(TextSensorFind, ListsSerialPortsAsTheyCanBeWrittenIntoAConfiguration) {
  for (const std::string name : {"nmea", "line"}) {
    const sensor::DriverDescription& driver = driver_named(name);
    ASSERT_NE(driver.find, nullptr);
    for (const sensor::FoundDevice& found : driver.find()) {
      EXPECT_THAT(found.settings, HasSubstr("transport = \"serial\"\ndevice = \"/dev/"));
      EXPECT_EQ(found.trouble.empty(), found.remedy.empty());
    }
  }
}

}  // namespace
}  // namespace yuragi::drivers::text
