#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "simulators/text/text_simulator.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text_bench.hpp"

namespace yuragi {

/// The set-up of a test of what a device that says lines can do wrong: its driver, a simulator in a wind that stands
/// still, and a real wire of the test's choice between them.
class TextFaultBench : public testing::Test {
 public:
  enum class Wire { kPty, kTcp, kUdp };

 protected:
  /// Makes the driver of its values, to speak through the bench's port.
  using MakeSensor =
      std::function<std::unique_ptr<drivers::sensor::Sensor>(const ParameterValues& values, TextBench& bench)>;

  TextFaultBench(std::string driver, simulators::core::PlayedMoment wind)
      : driver_name_(std::move(driver)), wind_(wind) {}

  /// `rate_hz`: how often the device speaks; 0: when it is asked. `given`: what is not the driver's default.
  void connect(Wire wire, std::unique_ptr<simulators::text::Device> device, double rate_hz, ParameterValues::Map given,
               const MakeSensor& make_sensor) {
    bench_.put(nullptr, nullptr);  // the name of the port is free again
    auto carried = wire == Wire::kPty   ? simulators::text::make_pty_wire((folder_ / "device").string())
                   : wire == Wire::kTcp ? simulators::text::make_tcp_wire("127.0.0.1", free_port(SOCK_STREAM))
                                        : simulators::text::make_udp_wire("127.0.0.1", udp_port_);
    const std::string place = carried->place();
    if (wire == Wire::kPty) {
      given["device"] = (folder_ / "device").string();
    } else {
      given["transport"] = std::string(wire == Wire::kTcp ? "tcp" : "udp");
      given["host"] = std::string("127.0.0.1");
      given["port"] = std::int64_t{std::stoi(place.substr(place.rfind(':') + 1))};
    }
    bench_.put(std::make_unique<simulators::text::Simulator>(
                   std::move(device), bench_.observed(std::move(carried)), rate_hz,
                   simulators::core::MeasuredWind(std::make_unique<StillWind>(wind_)), 1),
               make_sensor(values_for(driver_name_, given), bench_));
  }

  /// Every reading that came is the wind.
  virtual void expect_only_the_wind() = 0;

  bool is_live(double limit_s = 20.0) {
    bench_.sink.readings.clear();
    return bench_.run_until(limit_s, {}, [this] {
      return !bench_.sink.readings.empty() && bench_.sink.last_state() == wind::LinkState::kConnected;
    });
  }
  void expect_return() {
    ASSERT_TRUE(is_live()) << bench_.sink.last_detail();
    bench_.run(2.0);
    EXPECT_GE(bench_.sink.readings.size(), 5U);
    EXPECT_TRUE(bench_.sink.refusals.empty());
    expect_only_the_wind();
  }
  /// What was live says nothing: nothing is published, and the link says so.
  void expect_silence(simulators::core::FaultKind fault, double duration_s) {
    bench_.run(duration_s, fault);
    EXPECT_TRUE(bench_.sink.readings.empty());
    EXPECT_EQ(bench_.sink.last_state(), wind::LinkState::kConnecting) << bench_.sink.last_detail();
  }

  TextBench bench_;

 private:
  std::string driver_name_;
  simulators::core::PlayedMoment wind_;
  const std::uint16_t udp_port_ = free_port(SOCK_DGRAM);
  test::TemporaryFolder folder_;
};

}  // namespace yuragi
