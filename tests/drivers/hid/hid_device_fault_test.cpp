// The faults of the HID stations through the real hidapi: all stations on one bus in umockdev's testbed, each read by a
// driver of its own on a thread of its own, as in a daemon.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/usb/hid_stations.hpp"
#include "simulators/usb/umockdev_simulator.hpp"
#include "tests/simulators/usb/steady_wind.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/running_sensor.hpp"
#include "tests/support/simulator_thread.hpp"

namespace yuragi::drivers::hid {
namespace {

using simulators::core::FaultKind;

constexpr double kFaultPace = 20.0;
constexpr double kSplitPace = 6.0;  // a block that comes in pieces takes a second, and must hold still for so long
constexpr std::chrono::seconds kAtMost{60};

/// One station in its socket, and its driver.
struct Read {
  std::string model;
  std::vector<FaultKind> known_faults;
  std::unique_ptr<RunningSensor> sensor = nullptr;

  bool suffers(FaultKind kind) const {
    return kind == FaultKind::kUnplug || std::ranges::count(known_faults, kind) > 0;
  }
  bool waits_for(wind::LinkState state) {
    return sensor->wait_until([state](const RecordingSink& sink) { return sink.last_state() == state; }, kAtMost);
  }
  bool waits_for_readings(std::size_t count, std::chrono::seconds at_most = kAtMost) {
    return sensor->wait_until([count](const RecordingSink& sink) { return sink.readings.size() >= count; }, at_most);
  }
  std::size_t readings() {
    return sensor->look([](const RecordingSink& sink) { return sink.readings.size(); });
  }
  std::string detail() {
    return sensor->look([](const RecordingSink& sink) { return sink.last_detail(); });
  }
};

/// The parameter is the names of the stations.
class HidFault : public testing::TestWithParam<std::vector<std::string_view>> {
 protected:
  /// All are in the wind, and read.
  void plug_in(double pace) {
    std::vector<std::unique_ptr<simulators::usb::Port>> ports;
    for (const std::string_view model : GetParam()) {
      auto device = simulators::usb::make_hid_station(model, pace);
      const auto known = device->known_faults();
      reads_.push_back({.model = std::string(model), .known_faults = {known.begin(), known.end()}});
      ports.push_back(
          std::make_unique<simulators::usb::Port>(std::move(device), simulators::usb::steady_wind(8.6, 225.0)));
    }
    bus_ = std::make_unique<SimulatorThread>(std::make_unique<simulators::usb::UmockdevSimulator>(std::move(ports)));
    for (std::size_t i = 0; i < reads_.size(); ++i) {
      const std::string port = "1-" + std::to_string(i + 1);
      reads_[i].sensor = std::make_unique<RunningSensor>(
          driver_named("hid").open(values_for("hid", {{"path", port}, {"pace", pace}})));
    }
    for (Read& read : reads_) {
      EXPECT_TRUE(read.waits_for_readings(1)) << read.model << ": " << read.detail();
    }
  }

  /// Only the true wind was ever published, or this speed.
  void expect_true_winds(double or_speed_m_s) {
    for (Read& read : reads_) {
      read.sensor->look([&](const RecordingSink& sink) {
        for (const wind::Reading& reading : sink.readings) {
          const double error_m_s =
              std::min(std::abs(reading.speed_m_s - 8.6), std::abs(reading.speed_m_s - or_speed_m_s));
          EXPECT_LT(error_m_s, 0.13) << read.model;
          EXPECT_EQ(reading.direction_deg.value_or(225.0), 225.0) << read.model;
        }
        return 0;
      });
    }
  }

  /// Each that suffers it says that something is wrong, publishes nothing, and is back when it is over.
  void expect_trouble_and_return(FaultKind kind) {
    plug_in(kFaultPace);
    bus_->set_fault(kind);
    for (Read& read : reads_) {
      EXPECT_TRUE(!read.suffers(kind) || read.waits_for(wind::LinkState::kConnecting)) << read.model;
    }
    std::vector<std::size_t> before;
    for (Read& read : reads_) before.push_back(read.readings());
    // A second in which nobody who suffers may say a wind.
    const auto one = static_cast<std::size_t>(
        std::ranges::find_if(reads_, [kind](const Read& read) { return read.suffers(kind); }) - reads_.begin());
    EXPECT_FALSE(reads_.at(one).waits_for_readings(before[one] + 1, std::chrono::seconds(1))) << reads_[one].model;
    for (std::size_t i = 0; i < reads_.size(); ++i) {
      if (!reads_[i].suffers(kind)) continue;
      EXPECT_EQ(reads_[i].readings(), before[i]) << reads_[i].model;
      EXPECT_FALSE(reads_[i].detail().empty());
    }
    bus_->set_fault(std::nullopt);
    for (std::size_t i = 0; i < reads_.size(); ++i) {
      EXPECT_TRUE(reads_[i].waits_for_readings(before[i] + 1)) << reads_[i].model << ": " << reads_[i].detail();
      EXPECT_TRUE(reads_[i].waits_for(wind::LinkState::kConnected)) << reads_[i].model;
    }
    expect_true_winds(8.6);
  }

  std::unique_ptr<SimulatorThread> bus_;
  std::vector<Read> reads_;
};

TEST_P(HidFault, Silence) {
  expect_trouble_and_return(FaultKind::kSilence);
}
TEST_P(HidFault, Garbage) {
  expect_trouble_and_return(FaultKind::kGarbage);
}
TEST_P(HidFault, Partial) {
  expect_trouble_and_return(FaultKind::kPartial);
}
TEST_P(HidFault, BadChecksum) {
  expect_trouble_and_return(FaultKind::kBadChecksum);
}
TEST_P(HidFault, Late) {
  expect_trouble_and_return(FaultKind::kLate);
}
TEST_P(HidFault, Unplug) {
  expect_trouble_and_return(FaultKind::kUnplug);
}

TEST_P(HidFault, Split) {
  plug_in(kSplitPace);
  bus_->set_fault(FaultKind::kSplit);
  for (Read& read : reads_) {
    EXPECT_TRUE(read.waits_for_readings(read.readings() + 1)) << read.model << ": " << read.detail();
  }
  expect_true_winds(8.6);
}

TEST_P(HidFault, Spike) {
  plug_in(kFaultPace);
  bus_->set_fault(FaultKind::kSpike);
  const auto is_spike = [](const wind::Reading& reading) { return std::abs(reading.speed_m_s - 55.0) < 0.13; };
  for (Read& read : reads_) {
    EXPECT_TRUE(read.sensor->wait_until(
        [&](const RecordingSink& sink) {
          return std::ranges::any_of(sink.readings, is_spike) && sink.last_state() == wind::LinkState::kConnected;
        },
        kAtMost))
        << read.model;
  }
  expect_true_winds(55.0);
}

INSTANTIATE_TEST_SUITE_P(Hidapi, HidFault, testing::Values(simulators::usb::hid_station_names()),
                         [](const auto&) { return std::string("AllAtOnce"); });

}  // namespace
}  // namespace yuragi::drivers::hid
