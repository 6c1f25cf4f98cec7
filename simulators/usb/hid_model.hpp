#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <span>
#include <string>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

/// The properties that distinguish one HID device from another on the bus. Ours have one interface, one interrupt IN
/// end point (1) and, some of them, one interrupt OUT end point (1).
struct HidIdentity {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string manufacturer;
  std::string product_name;
  Bytes report_descriptor;        ///< HID 1.11 specification, 6.2.2
  std::uint8_t report_size = 8;   ///< of the interrupt end points, bytes
  std::uint8_t interval_ms = 10;  ///< how often the host polls for a report
  bool has_out_endpoint = false;  ///< otherwise output reports come as SET_REPORT
  bool is_full_speed = false;     ///< otherwise low speed, with packets of 8 bytes
};

/// The descriptors of a device with that identity.
Descriptors hid_descriptors(const HidIdentity& identity);

/// The report descriptor of a vendor's own device without report ids: one input and one output report of `size` bytes.
Bytes plain_report_descriptor(std::uint8_t size);

/// How a simulated station runs.
struct HidModelOptions {
  double pace = 1.0;       ///< how many times as fast as the real station, for tests; USB itself keeps its speed
  std::uint64_t seed = 1;  ///< of the garbage fault
};

/// The common part of HID stations: descriptors, the requests of the HID class, and the reports that wait for the host.
/// A station adds the content of its reports, and the times at which it sends them.
///
/// kFreeze and kSpike come with the wind that it is given (MeasuredWind). Thread-safe: no.
class HidModel : public Device {
 public:
  const Descriptors& descriptors() const final { return descriptors_; }
  std::span<const core::FaultKind> known_faults() const final { return known_faults_; }
  void advance(double time_s, const core::PlayedMoment& wind, std::optional<core::FaultKind> fault) final;
  std::optional<Bytes> control(const SetupPacket& setup, std::span<const std::uint8_t> data) final;
  std::optional<Bytes> in(std::uint8_t endpoint, std::size_t max_size) final;
  bool out(std::uint8_t endpoint, std::span<const std::uint8_t> data) final;

 protected:
  /// `known_faults` must have static storage.
  HidModel(const HidIdentity& identity, std::span<const core::FaultKind> known_faults, const HidModelOptions& options);

  /// Advances to now_s().
  virtual void play() = 0;
  /// Takes an output report, received by either way (without a report id). Returns false if it refuses it.
  virtual bool take_output(std::span<const std::uint8_t> report) = 0;
  /// Returns the reply to GET_REPORT for input report `id`; nullopt: refused.
  virtual std::optional<Bytes> input_report(std::uint8_t id);

  double now_s() const noexcept { return now_s_; }
  const core::PlayedMoment& wind() const noexcept { return wind_; }
  bool suffers(core::FaultKind kind) const noexcept { return fault_ == kind; }
  /// A duration of the real station, divided by the pace.
  double paced(double duration_s) const noexcept { return duration_s / options_.pace; }

  /// Queues a report for the host, to be fetched from `delay_s` on. What is not fetched is dropped after some seconds.
  void queue_report(Bytes report, double delay_s = 0.0);
  /// Drops the reports that have not been fetched.
  void drop_reports() { waiting_.clear(); }
  Bytes random_bytes(std::size_t size);
  /// A number from 0 up to, but without, `end`.
  std::uint64_t random_below(std::uint64_t end) { return random_() % end; }

 private:
  struct Waiting {
    double from_s;
    Bytes report;
  };

  Descriptors descriptors_;
  std::span<const core::FaultKind> known_faults_;
  HidModelOptions options_;
  bool has_out_endpoint_;
  std::deque<Waiting> waiting_;
  std::mt19937_64 random_;
  double now_s_ = 0.0;
  core::PlayedMoment wind_;
  std::optional<core::FaultKind> fault_;
};

/// Returns the point of the compass, 0 to 15: 0 north, 1 north-north-east ... 15.
unsigned compass_point(double direction_deg);

}  // namespace yuragi::simulators::usb
