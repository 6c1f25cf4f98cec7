#include "drivers/sensor/reopening_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::drivers::sensor {
namespace {

/// A device that a test can take away.
class FickleSensor final : public ReopeningSensor {
 public:
  FickleSensor() : ReopeningSensor(1) {}

  bool is_there = true;
  bool is_faulty = false;
  bool makes_sense = true;
  bool is_back = false;
  int opened = 0;
  int closed = 0;
  int worked = 0;

 protected:
  Result<MonoTime, Failure> open(const Clock& clock) override {
    if (!is_there) return Failure{"it is not there: plug it in"};
    ++opened;
    return clock.now().mono;
  }
  Result<MonoTime, Failure> work(const Clock& clock, Sink& sink) override {
    if (!is_there) return Failure{"it went away"};
    if (is_faulty) throw std::runtime_error("a fault");
    ++worked;
    if (makes_sense) {
      report_connected(sink, "fickle");
    } else {
      report_unusable(sink, "it babbles");
    }
    return clock.now().mono + std::chrono::seconds(1);
  }
  void close() noexcept override { ++closed; }
  bool poll_for_return() override { return std::exchange(is_back, false); }
};

class ReopeningSensorTest : public testing::Test {
 protected:
  /// One poll at the moment that the sensor asked for. Returns how long it then wants to wait.
  double poll_s() {
    const MonoTime next = sensor_.poll(clock_, sink_);
    const Nanoseconds wait = next - clock_.now().mono;
    if (wait > Nanoseconds::zero()) clock_.advance(wait);
    return seconds(wait);
  }

  ManualClock clock_;
  RecordingSink sink_;
  FickleSensor sensor_;
};

TEST_F(ReopeningSensorTest, OpensOnceAndWorksAsOftenAsItAsks) {
  EXPECT_LE(poll_s(), 0.0);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(poll_s(), 1.0, 1e-9);
  EXPECT_EQ(sensor_.opened, 1);
  EXPECT_EQ(sensor_.worked, 5);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
  EXPECT_EQ(sink_.links.size(), 1U) << "what has not changed is told once";
}

TEST_F(ReopeningSensorTest, DoesNothingBeforeItsTime) {
  poll_s();
  const MonoTime next = sensor_.poll(clock_, sink_);
  EXPECT_EQ(sensor_.poll(clock_, sink_), next);
  EXPECT_EQ(sensor_.worked, 1);
}

TEST_F(ReopeningSensorTest, WaitsLongerAndLongerForADeviceThatIsNotThere) {
  sensor_.is_there = false;
  double longest_s = 0.0;
  for (int attempt = 0; attempt < 12; ++attempt) {
    const double wait_s = poll_s();
    const double full_s = std::min(10.0, 0.25 * std::pow(2.0, attempt));
    EXPECT_GT(wait_s, 0.74 * full_s);
    EXPECT_LE(wait_s, full_s);
    longest_s = std::max(longest_s, wait_s);
  }
  EXPECT_LE(longest_s, 10.0);
  EXPECT_EQ(sensor_.closed, 0);
  EXPECT_EQ(sink_.last_detail(), "it is not there: plug it in");
}

TEST_F(ReopeningSensorTest, ClosesOnceWhatFailedAndFindsItAgain) {
  poll_s();
  poll_s();
  sensor_.is_there = false;
  for (int i = 0; i < 3; ++i) poll_s();
  EXPECT_EQ(sensor_.closed, 1);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
  sensor_.is_there = true;
  poll_s();
  poll_s();
  EXPECT_EQ(sensor_.opened, 2);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
}

TEST_F(ReopeningSensorTest, OpensAgainAfterAnException) {
  poll_s();
  poll_s();
  sensor_.is_faulty = true;
  poll_s();
  EXPECT_EQ(sensor_.closed, 1);
  EXPECT_EQ(sink_.last_detail(), "its driver failed (a fault): reopening it");
  sensor_.is_faulty = false;
  poll_s();
  poll_s();
  EXPECT_EQ(sensor_.opened, 2);
  EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnected);
}

TEST_F(ReopeningSensorTest, DoesNotTakeAnOpenedDeviceForOneThatIsWell) {
  sensor_.makes_sense = false;
  double last_s = 0.0;
  for (int round = 0; round < 6; ++round) {
    sensor_.is_there = true;
    poll_s();
    poll_s();
    EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
    sensor_.is_there = false;
    last_s = poll_s();
  }
  EXPECT_GT(last_s, 5.0) << "opening alone does not make the waits small again";
}

TEST_F(ReopeningSensorTest, DoesNotWaitOnceTheDeviceIsBack) {
  sensor_.is_there = false;
  for (int attempt = 0; attempt < 8; ++attempt) poll_s();
  sensor_.poll(clock_, sink_);
  sensor_.is_there = true;
  const MonoTime later = sensor_.poll(clock_, sink_);
  EXPECT_GT(later, clock_.now().mono) << "nobody has told it";
  sensor_.is_back = true;
  EXPECT_LE(sensor_.poll(clock_, sink_), clock_.now().mono);
  EXPECT_EQ(sensor_.opened, 1);
}

TEST_F(ReopeningSensorTest, WaitsLittleAgainForADeviceThatIsBackButNotYetToBeOpened) {
  sensor_.is_there = false;
  for (int attempt = 0; attempt < 8; ++attempt) poll_s();
  sensor_.poll(clock_, sink_);
  sensor_.is_back = true;
  EXPECT_LE(sensor_.poll(clock_, sink_) - clock_.now().mono, std::chrono::milliseconds(250));
}

}  // namespace
}  // namespace yuragi::drivers::sensor
