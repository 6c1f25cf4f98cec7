// AcuRite 01035 (24c0:0003). Source: weewx acurite.py; wxforum topic 27244 (speed).
//
// It sends nothing unasked; the host requests input reports. Report 1, 10 bytes, is new every 18 s, two kinds
// alternate:
//
//   01 channel and id (2)   71   speed high 5 bits   speed low 3 bits << 4 | direction   rain (2)               link ff
//                           78                       ... | temperature, high 4 bits      temperature, humidity
//
// Report 2, 25 bytes: the console's own sensors. The speed n is 0.8278 n + 1 km/h; the direction is a code's number.
// The other values are constant here: 12 tips of 0.01 inch of rain; 8 << 7 | 0x1f, less 720, eighteenths of a degree
// Celsius; 83 %.
#include "simulators/usb/acurite.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace yuragi::simulators::usb {
namespace {

// Silence is a console in mode 1 or 2: it is on the bus and refuses every request.
constexpr std::array kAcuriteFaults = {core::FaultKind::kSilence, core::FaultKind::kFreeze, core::FaultKind::kSpike,
                                       core::FaultKind::kGarbage, core::FaultKind::kPartial};
constexpr double kReport1Every_s = 18.0;
constexpr double kMetrePerSecond_kmh = 3.6;

/// The vane's code of each point of the compass, from north on.
constexpr std::array<std::uint8_t, 16> kCodeOfPoint = {6, 14, 12, 8, 10, 11, 9, 13, 15, 7, 5, 1, 3, 2, 0, 4};

/// Report ids 1 to 3: 9, 24 and 32 bytes of input behind the id.
Bytes acurite_report_descriptor() {
  Bytes bytes = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08};
  const std::array<std::uint8_t, 3> sizes = {9, 24, 32};
  std::uint8_t id = 0;
  for (const std::uint8_t size : sizes) {
    const Bytes report = {0x85, ++id, 0x95, size, 0x09, 0x01, 0x81, 0x02};
    bytes.insert(bytes.end(), report.begin(), report.end());
  }
  bytes.push_back(0xC0);
  return bytes;
}

class Acurite final : public HidModel {
 public:
  explicit Acurite(const HidModelOptions& options)
      : HidModel({.vendor = 0x24C0,
                  .product = 0x0003,
                  .manufacturer = "Chaney Instrument",
                  .product_name = "",
                  .report_descriptor = acurite_report_descriptor()},
                 kAcuriteFaults, options) {}

 protected:
  void play() override {
    if (now_s() < next_s_) return;
    next_s_ = std::max(next_s_ + paced(kReport1Every_s), now_s());
    has_direction_ = !has_direction_;
    measure();
  }

  bool take_output(std::span<const std::uint8_t>) override { return !suffers(core::FaultKind::kSilence); }

  std::optional<Bytes> input_report(std::uint8_t id) override {
    if (suffers(core::FaultKind::kSilence)) return std::nullopt;
    Bytes report;
    if (id == 1) report = report_1_;
    if (id == 2) {
      report = {0x02, 0x00, 0x00, 0x4C, 0xBE, 0x0D, 0xEC, 0x01, 0x52, 0x03, 0x62, 0x7E, 0x38,
                0x18, 0xEE, 0x09, 0xC4, 0x08, 0x22, 0x06, 0x07, 0x7B, 0xA4, 0x8A, 0x46};
    }
    if (report.empty()) return std::nullopt;
    if (suffers(core::FaultKind::kGarbage)) {
      report = random_bytes(report.size());
      report[0] = id;
    }
    if (suffers(core::FaultKind::kPartial)) report.resize(report.size() / 2);
    return report;
  }

 private:
  void measure() {
    const double speed_kmh = wind().speed_m_s * kMetrePerSecond_kmh;
    const auto n = speed_kmh < 1.4 ? 0U : static_cast<unsigned>(std::max(1L, std::lround((speed_kmh - 1.0) / 0.8278)));
    const std::uint8_t code = kCodeOfPoint[compass_point(wind().direction_deg)];
    const auto low_bits = static_cast<std::uint8_t>((n & 7U) << 4U);
    report_1_ = {0x01,     0xC0, 0x5C, 0x71, static_cast<std::uint8_t>((n >> 3U) & 0x1FU),
                 low_bits, 0x00, 0x0C, 0x03, 0xFF};
    if (has_direction_) {
      report_1_[5] = low_bits | code;
    } else {
      report_1_[3] = 0x78;
      report_1_[5] = low_bits | 0x08U;
      report_1_[6] = 0x1F;
      report_1_[7] = 0x53;
    }
  }

  double next_s_ = 0.0;
  bool has_direction_ = false;
  Bytes report_1_;
};

}  // namespace

std::unique_ptr<Device> make_acurite(const HidModelOptions& options) {
  return std::make_unique<Acurite>(options);
}

}  // namespace yuragi::simulators::usb
