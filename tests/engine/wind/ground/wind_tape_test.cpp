#include "engine/wind/ground/wind_tape.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::wind::ground {
namespace {

/// A pen whose every number is this.
WindPen pen_of(double value) {
  WindPen pen;
  pen.now.east_m_s.fill(static_cast<float>(value));
  pen.now.north_m_s.fill(static_cast<float>(-value));
  pen.now.known_along.fill(static_cast<float>(value));
  pen.now.known_across.fill(static_cast<float>(value));
  pen.now.mean = {value, 2.0 * value};
  pen.now.way = {3.0 * value, 4.0 * value};
  pen.now.east_m = 5.0 * value;
  pen.now.south_m = 6.0 * value;
  pen.now.gain = value;
  pen.written = pen.now;
  return pen;
}

WindSample read(const WindTape& tape, double back_m) {
  const WindTape::Place place = tape.back(back_m);
  return between(*place.first, *place.second, place.fraction);
}

void expect_all_are(const WindSample& sample, double value, double tolerance) {
  for (const float number : sample.east_m_s) EXPECT_NEAR(static_cast<double>(number), value, tolerance);
  for (const float number : sample.north_m_s) EXPECT_NEAR(static_cast<double>(number), -value, tolerance);
  for (const float number : sample.known_along) EXPECT_NEAR(static_cast<double>(number), value, tolerance);
  for (const float number : sample.known_across) EXPECT_NEAR(static_cast<double>(number), value, tolerance);
  EXPECT_NEAR(sample.mean.u_m_s, value, tolerance);
  EXPECT_NEAR(sample.mean.v_m_s, 2.0 * value, tolerance);
  EXPECT_NEAR(sample.way.u_m_s, 3.0 * value, tolerance);
  EXPECT_NEAR(sample.way.v_m_s, 4.0 * value, tolerance);
  EXPECT_NEAR(sample.east_m, 5.0 * value, tolerance);
  EXPECT_NEAR(sample.south_m, 6.0 * value, tolerance);
  EXPECT_NEAR(sample.gain, value, tolerance);
}

/// What stands on the tape for a value that has grown evenly with the way: its place, wherever it is read.
void expect_reads_the_way(double speed_m_s, double tick_s, double begin_m = 0.0) {
  WindTape tape;
  double way_m = begin_m;
  tape.write(pen_of(way_m - begin_m), way_m);
  while (way_m < begin_m + 300.0) {
    way_m += speed_m_s * tick_s;
    tape.write(pen_of(way_m - begin_m), way_m);
  }
  for (const double back_m : {0.0, 0.01, 0.2, 0.25, 0.26, 1.0, 17.3, 100.0, 255.4}) {
    SCOPED_TRACE(back_m);
    expect_all_are(read(tape, back_m), way_m - begin_m - back_m, 0.004);
  }
}

TEST(WindTape, HoldsWhatWasWrittenOnTheWay) {
  expect_reads_the_way(7.0, 1.0 / 60.0);
  expect_reads_the_way(40.0, 1.0 / 15.0);
}

TEST(WindTape, HoldsItInACalmOfSeveralTicksASample) {
  expect_reads_the_way(0.3, 1.0 / 60.0);
}

TEST(WindTape, HoldsItAfterAMillionKilometres) {
  expect_reads_the_way(7.0, 1.0 / 60.0, 1e9);
}

TEST(WindTape, AtThePenIsThisTicksValueToTheBit) {
  WindTape tape;
  for (int tick = 0; tick < 500; ++tick) {
    WindPen pen = pen_of(std::sin(0.37 * tick));
    pen.written = pen_of(-1.0).written;
    tape.write(pen, 0.013 * tick * tick);
    const WindSample sample = read(tape, 0.0);
    ASSERT_EQ(sample.east_m_s, pen.now.east_m_s);
    ASSERT_EQ(sample.known_along, pen.now.known_along);
    ASSERT_EQ(sample.mean.u_m_s, pen.now.mean.u_m_s);
    ASSERT_EQ(sample.gain, pen.now.gain);
  }
}

TEST(WindTape, WhatTheTapeCannotHoldIsReadAtThePenAlone) {
  WindTape tape;
  for (int tick = 0; tick < 100; ++tick) {
    WindPen pen = pen_of(1.0);
    pen.written = pen_of(0.25).written;
    tape.write(pen, 0.1 * tick);
  }
  expect_all_are(read(tape, 0.0), 1.0, 0.0);
  expect_all_are(read(tape, 0.125), 0.625, 1e-6);
  expect_all_are(read(tape, 0.25), 0.25, 1e-6);
  expect_all_are(read(tape, 3.0), 0.25, 1e-6);
}

TEST(WindTape, BeginsWithTheMeanAndNoGusts) {
  WindTape tape;
  tape.write(pen_of(2.0), 1234.56);
  for (const double back_m : {0.25, 1.0, 100.0, 255.0, 1000.0}) {
    const WindSample sample = read(tape, back_m);
    EXPECT_EQ(sample.mean.u_m_s, 2.0);
    EXPECT_EQ(sample.way.v_m_s, 8.0);
    EXPECT_EQ(sample.gain, 2.0);
    for (const float gust_m_s : sample.east_m_s) EXPECT_EQ(gust_m_s, 0.0F);
    for (const float gust_m_s : sample.north_m_s) EXPECT_EQ(gust_m_s, 0.0F);
    for (const float known : sample.known_along) EXPECT_EQ(known, 0.0F);
    for (const float known : sample.known_across) EXPECT_EQ(known, 0.0F);
  }
  EXPECT_EQ(read(tape, 0.0).east_m_s[3], 2.0F);
}

TEST(WindTape, AWayThatGoesBackBeginsAnew) {
  WindTape tape;
  for (int tick = 0; tick <= 1000; ++tick) tape.write(pen_of(1.0), 100.0 + tick);
  tape.write(pen_of(5.0), 40.0);
  for (const double back_m : {0.25, 1.0, 200.0}) {
    EXPECT_EQ(read(tape, back_m).mean.u_m_s, 5.0);
    EXPECT_EQ(read(tape, back_m).known_along[0], 0.0F);
  }
  for (int tick = 1; tick <= 10; ++tick) tape.write(pen_of(5.0), 40.0 + tick);
  EXPECT_EQ(read(tape, 3.0).known_along[0], 5.0F);
}

TEST(WindTape, StandingStillKeepsWhatIsWritten) {
  WindTape tape;
  for (int tick = 0; tick <= 100; ++tick) tape.write(pen_of(0.1 * tick), 0.1 * tick);
  const WindSample before = read(tape, 2.0);
  for (int tick = 0; tick < 100; ++tick) tape.write(pen_of(99.0), 10.0);
  expect_all_are(read(tape, 2.0), before.gain, 1e-6);
  expect_all_are(read(tape, 0.0), 99.0, 0.0);
}

TEST(WindTape, BeyondItsEndTheLastSampleStands) {
  WindTape tape;
  for (int tick = 0; tick <= 4000; ++tick) tape.write(pen_of(0.1 * tick), 0.1 * tick);
  const double last = read(tape, 256.0).gain;
  EXPECT_NEAR(last, 400.0 - 255.75, 0.26);
  for (const double back_m : {257.0, 300.0, 1e6}) EXPECT_EQ(read(tape, back_m).gain, last);
  EXPECT_GT(tape.back(255.0).left_m, 0.0);
  EXPECT_NEAR(tape.back(255.5).left_m, 0.0, 1e-9);
  EXPECT_LT(tape.back(300.0).left_m, 0.0);
}

TEST(WindTape, ALeapOfTheWayIsAStraightLine) {
  for (const double leap_m : {3.0, 200.0, 5000.0, 1e7}) {
    WindTape tape;
    for (int tick = 0; tick <= 400; ++tick) tape.write(pen_of(1.0), tick);
    tape.write(pen_of(1.0 + leap_m), 400.0 + leap_m);
    for (const double back_m : {0.0, 0.5, 2.5, 150.0, 250.0}) {
      const double expected = std::max(1.0 + leap_m - back_m, 1.0);
      SCOPED_TRACE(back_m);
      expect_all_are(read(tape, back_m), expected, 1e-6 * (expected + 1.0) + 1e-3);
    }
  }
}

/// The largest step at any of some places, from tick to tick, of a wave of this length in ticks that is written while
/// the wind's speed is what `speed_m_s` says.
void expect_no_jumps(const std::function<double(int tick)>& speed_m_s) {
  constexpr double kTapeTick_s = 1.0 / 60.0;
  WindTape tape;
  double way_m = 0.0;
  const std::vector<double> places_m = {0.0, 0.05, 0.13, 0.249, 0.25, 0.251, 0.4, 1.0, 7.7, 60.0};
  std::vector<double> before(places_m.size());
  double largest_written = 0.0;
  double largest_read = 0.0;
  double written_before = 0.0;
  const auto slowest_m_s = [&](int tick) {
    double slowest = speed_m_s(tick);
    for (int i = std::max(0, tick - 100); i <= tick; ++i) slowest = std::min(slowest, speed_m_s(i));
    return slowest;
  };
  double steepest_per_m = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    const double step_m = speed_m_s(tick) * kTapeTick_s;
    way_m += step_m;
    const double value = std::sin(2.0 * std::numbers::pi * tick / 120.0);
    if (tick > 0) {
      largest_written = std::max(largest_written, std::abs(value - written_before));
      steepest_per_m = std::max(steepest_per_m, std::abs(value - written_before) / (slowest_m_s(tick) * kTapeTick_s));
    }
    written_before = value;
    tape.write(pen_of(value), way_m);
    // What is read goes along the tape by the tick's way, no steeper than it was written; nearer than a sample it is a
    // mixture with what is written now.
    for (std::size_t i = 0; i < places_m.size(); ++i) {
      const double now = read(tape, places_m[i]).gain;
      if (tick > 0) {
        const double most = steepest_per_m * step_m + largest_written;
        ASSERT_LE(std::abs(now - before[i]), 1.001 * most) << "tick " << tick << ", " << places_m[i] << " m";
        largest_read = std::max(largest_read, std::abs(now - before[i]));
      }
      before[i] = now;
    }
  }
  EXPECT_GT(largest_read, 0.5 * largest_written) << "the wave is there";
}

TEST(WindTape, NothingJumpsWhenASampleIsFinishedInASteadyWind) {
  for (const double speed_m_s : {0.3, 1.0, 7.0, 14.99, 40.0}) {
    expect_no_jumps([speed_m_s](int) { return speed_m_s; });
  }
}

TEST(WindTape, NothingJumpsWhenASampleIsFinishedWhileTheSpeedChanges) {
  expect_no_jumps([](int tick) { return 3.0 + 2.5 * std::sin(0.004 * tick); });
}

/// Steady, sampled densely: places a little apart read almost the same, across every seam.
TEST(WindTape, IsContinuousAlongTheTape) {
  WindTape tape;
  for (int tick = 0; tick < 5000; ++tick) tape.write(pen_of(std::sin(0.1 * tick)), 0.0937 * tick);
  double before = read(tape, 0.0).gain;
  for (double back_m = 0.0; back_m < 260.0; back_m += 0.001) {
    const double now = read(tape, back_m).gain;
    ASSERT_LE(std::abs(now - before), 0.001 * (0.1 / 0.0937) * 1.001 + 1e-9) << back_m;
    before = now;
  }
}

}  // namespace
}  // namespace yuragi::wind::ground
