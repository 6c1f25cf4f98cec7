#include "daemon/sensing/sensor_runner.hpp"

#include <memory>
#include <semaphore>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/sensing/system_clock.hpp"
#include "tests/support/manual_clock.hpp"

namespace yuragi::daemon::sensing {
namespace {

/// A poll of it waits for `go_on`, whatever interrupts it, as a read from a disk that hangs does.
class HangingSensor final : public drivers::sensor::Sensor {
 public:
  struct Gates {
    std::binary_semaphore has_begun{0};
    std::binary_semaphore go_on{0};
  };

  explicit HangingSensor(std::shared_ptr<Gates> gates) : gates_(std::move(gates)) {}

  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink&) override {
    gates_->has_begun.release();
    gates_->go_on.acquire();
    return clock.now().mono;
  }

 private:
  std::shared_ptr<Gates> gates_;
};

TEST(SensorRunner, IsEndedWithoutWaitingForAPollThatHangs) {
  const ManualClock clock;
  const auto gates = std::make_shared<HangingSensor::Gates>();
  SensorRunner runner(std::make_unique<HangingSensor>(gates), clock);
  gates->has_begun.acquire();
  runner.end();
  EXPECT_FALSE(runner.has_ended());
  gates->go_on.release();
  while (!runner.has_ended()) std::this_thread::yield();
}

/// Says a temperature so many times in one poll.
class TalkativeStation final : public drivers::sensor::Sensor {
 public:
  explicit TalkativeStation(int times) : times_(times) {}

  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    for (int i = 0; i < times_; ++i) {
      wind::StationQuantities quantities;
      quantities.time = clock.now();
      quantities.air_temperature_c = i == 0 ? 1000.0 : 20.0;
      sink.quantities(quantities);
    }
    return MonoTime::max();
  }

 private:
  int times_;
};

TEST(SensorRunner, PassesOnPlausibleQuantitiesAndCountsWhatHasNoRoom) {
  ManualClock clock;
  SensorRunner runner(std::make_unique<TalkativeStation>(1001), clock, SensorThread::kOfCaller);
  runner.drain([](const wind::Reading&) { FAIL() << "it has no wind"; });
  std::uint64_t passed = 0;
  runner.drain_quantities([&](const wind::StationQuantities& quantities) {
    EXPECT_EQ(quantities.air_temperature_c, 20.0);
    ++passed;
  });
  EXPECT_GT(passed, 100U);
  EXPECT_GT(runner.lost_quantities_count(), 0U);
  EXPECT_EQ(passed + runner.lost_quantities_count(), 1000U);
  EXPECT_EQ(runner.refused_count(drivers::decode::Refusal::kImplausible), 0U);
}

/// Has a reading at each poll: of 1 m/s on the thread that made it, of 2 m/s on another.
class TellsItsThread final : public drivers::sensor::Sensor {
 public:
  explicit TellsItsThread(std::thread::id caller) : caller_(caller) {}
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    wind::Reading reading;
    reading.time = clock.now();
    reading.speed_m_s = std::this_thread::get_id() == caller_ ? 1.0 : 2.0;
    sink.reading(reading);
    return clock.now().mono;
  }

 private:
  std::thread::id caller_;
};

TEST(SensorRunner, ThatTheCallerHasPolledGoesOnOnAThreadOfItsOwn) {
  const SystemClock clock;
  SensorRunner runner(std::make_unique<TellsItsThread>(std::this_thread::get_id()), clock, SensorThread::kOfCaller);
  std::vector<double> speeds_m_s;
  const auto drain = [&] {
    runner.drain([&](const wind::Reading& reading) { speeds_m_s.push_back(reading.speed_m_s); });
  };
  drain();
  EXPECT_EQ(speeds_m_s, std::vector{1.0});
  runner.begin_thread();
  runner.begin_thread();
  while (speeds_m_s.size() < 3) drain();
  EXPECT_EQ(speeds_m_s[1], 2.0);
  EXPECT_EQ(speeds_m_s[2], 2.0);
}

}  // namespace
}  // namespace yuragi::daemon::sensing
