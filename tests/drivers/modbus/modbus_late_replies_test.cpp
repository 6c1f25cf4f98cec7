// Answers that come when nobody waits for them any more, on a serial line, where nothing tells them apart: with the
// real libmodbus on a pseudo terminal whose far end is the test.
#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "drivers/modbus/modbus_bus.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/modbus_servers.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::drivers::modbus {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;
using Kind = Trouble::Kind;

const Bytes kLate = {0x01, 0x03, 0x02, 0x00, 0x57, 0xF9, 0xBA};   // 87
const Bytes kRight = {0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A};  // 86

class ModbusLateAnswerTest : public testing::Test {
 protected:
  ModbusLateAnswerTest() {
    bus::ModbusLine line;
    line.framing = decode::modbus::Framing::kRtu;
    line.device = port_.device();
    bus_ = shared_modbus_bus(line);
    EXPECT_TRUE(bus_->open(interruption_, clock_));
  }

  void say(const Bytes& bytes) { EXPECT_EQ(write(port_.far_end(), bytes.data(), bytes.size()), std::ssize(bytes)); }

  /// Waits for a request, so many bytes; false if none comes.
  bool receive_request() {
    std::array<std::uint8_t, 8> request{};
    for (std::size_t size = 0; size < request.size();) {
      pollfd wait{port_.far_end(), POLLIN, 0};
      if (poll(&wait, 1, 60'000) != 1) return false;
      const ssize_t got = read(port_.far_end(), &request[size], request.size() - size);
      if (got <= 0) return false;
      size += static_cast<std::size_t>(got);
    }
    return true;
  }

  Bus::Reply exchange(Nanoseconds timeout) {
    return bus_->exchange({.unit = 1}, {.response_timeout = timeout, .byte_timeout = byte_timeout_}, interruption_,
                          clock_, sink_);
  }

  /// Asks once in vain, which leaves an answer outstanding.
  void time_out() {
    const auto reply = exchange(20ms);
    ASSERT_FALSE(reply);
    EXPECT_EQ(reply.error().kind, Kind::kSilence);
    ASSERT_TRUE(receive_request());
  }

  Nanoseconds byte_timeout_ = 100ms;
  SerialPort port_;
  ManualClock clock_;
  bus::Interruption interruption_;
  RecordingSink sink_;
  std::shared_ptr<Bus> bus_;
};

TEST_F(ModbusLateAnswerTest, ThatIsThereBeforeTheNextRequestIsDroppedAndCounted) {
  time_out();
  say(kLate);
  std::thread device([this] {
    EXPECT_TRUE(receive_request());
    say(kRight);
  });
  const auto reply = exchange(60s);
  device.join();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->values[0], 86);
  EXPECT_THAT(sink_.refusals, testing::ElementsAre(decode::Refusal::kTimeout, decode::Refusal::kNotMine));
}

TEST_F(ModbusLateAnswerTest, ThatComesWhileTheNextRequestIsAboutToBeSentIsWaitedOut) {
  // Its beginning is there, its end comes within the byte time-out: nothing is sent before it is over.
  time_out();
  byte_timeout_ = 2s;  // between the bytes there is far less, also on a machine that has other things to do
  say({kLate.begin(), kLate.begin() + 2});
  std::thread device([this] {
    for (auto byte = kLate.begin() + 2; byte != kLate.end(); ++byte) {
      // The line is still busy, so that nobody may have asked yet.
      pollfd wait{port_.far_end(), POLLIN, 0};
      EXPECT_EQ(poll(&wait, 1, 30), 0) << "a request was sent into an answer";
      say({*byte});
    }
    EXPECT_TRUE(receive_request());
    say(kRight);
  });
  const auto reply = exchange(60s);
  device.join();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->values[0], 86);
  EXPECT_EQ(sink_.count(decode::Refusal::kNotMine), 1);
}

TEST_F(ModbusLateAnswerTest, FallsIntoTheTimeForWhichItsSlaveIsLetBe) {
  time_out();
  EXPECT_EQ(bus_->ready_at(1), clock_.now().mono + 20ms);
}

TEST_F(ModbusLateAnswerTest, OfAnotherSlaveIsKnownByItsIdAndPassedOver) {
  std::thread device([this] {
    EXPECT_TRUE(receive_request());
    say({0x02, 0x03, 0x02, 0x00, 0x25, 0x3D, 0x9F});
    say(kRight);
  });
  const auto reply = exchange(60s);
  device.join();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->values[0], 86);
  EXPECT_THAT(sink_.refusals, testing::ElementsAre(decode::Refusal::kNotMine));
}

TEST_F(ModbusLateAnswerTest, DoesNotHoldUpALineThatNeverGetsQuietForLongerThanATimeOut) {
  time_out();
  std::atomic<bool> stop = false;
  std::thread chatter([&] {
    while (!stop) {
      pollfd wait{port_.far_end(), POLLIN, 0};
      if (poll(&wait, 1, 10) == 1) tcflush(port_.far_end(), TCIFLUSH);
      const std::uint8_t noise = 0xA5;
      EXPECT_EQ(write(port_.far_end(), &noise, 1), 1);
    }
  });
  const auto reply = exchange(300ms);  // comes back, though the line is never quiet
  stop = true;
  chatter.join();
  EXPECT_FALSE(reply);
}

TEST_F(ModbusLateAnswerTest, CannotKeepAnInterruptedSensorWaiting) {
  interruption_.set();
  const auto reply = exchange(60s);
  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.error().kind, Kind::kInterrupted);
}

}  // namespace
}  // namespace yuragi::drivers::modbus
