// Oregon Scientific WMR100 (0fde:ca01). Sources: ejeklint/WLoggerDaemon's description of the protocol (reports, frames,
// sums); weewx wmr100.py (start report, wind frame).
//
// Sends nothing before the start report, 20 00 08 01 00 00 00 00. Then a stream of bytes in reports of 8: the number of
// valid ones, 1 to 7, and those. Frames stand between ff ff and end with the sum of their bytes, low byte first.
//
//   every     frame (first byte: flags; second: kind)
//   14 s      48 wind, 11 bytes: point of the compass; 0c; gust, 12 bits, and average, 12 bits, 0.1 m/s; chill 2 bytes
//   47 s      42 temperature, 12 bytes: channel (1, outdoors), 0.1 degrees Celsius, %: 19.6 degrees and 58 %
//   60 s      60 clock, 12 bytes
//   73 s      46 pressure, 8 bytes: 1005 hPa at the station, and at sea level
//   49 s      41 rain, 17 bytes: rate, last hour, day, all, 0.01 inch; since when: 2.50 inch in all
#include "simulators/usb/wmr100.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace yuragi::simulators::usb {
namespace {

constexpr std::array kWmr100Faults = {core::FaultKind::kSilence,    core::FaultKind::kFreeze, core::FaultKind::kSpike,
                                      core::FaultKind::kGarbage,    core::FaultKind::kSplit,  core::FaultKind::kPartial,
                                      core::FaultKind::kBadChecksum};
constexpr std::array<std::uint8_t, 4> kWmr100StartsWith = {0x20, 0x00, 0x08, 0x01};

constexpr double kWmr100Report_s = 0.01;       // from one report to the next
constexpr double kWmr100SplitReport_s = 0.25;  // with the fault

struct FrameKind {
  std::uint8_t kind;
  double every_s;
};
constexpr std::array<FrameKind, 5> kFrameKinds = {
    {{0x48, 14.0}, {0x42, 47.0}, {0x60, 60.0}, {0x46, 73.0}, {0x41, 49.0}}};

class Wmr100 final : public HidModel {
 public:
  explicit Wmr100(const HidModelOptions& options)
      : HidModel({.vendor = 0x0FDE,
                  .product = 0xCA01,
                  .manufacturer = "",
                  .product_name = "Oregon Scientific Weather Station",
                  .report_descriptor = plain_report_descriptor(8)},
                 kWmr100Faults, options) {
    for (std::size_t i = 0; i < kFrameKinds.size(); ++i) next_s_[i] = paced(1.0 + static_cast<double>(i));
  }

 protected:
  void play() override {
    gust_m_s_ = std::max(gust_m_s_, wind().speed_m_s);
    for (std::size_t i = 0; i < kFrameKinds.size(); ++i) {
      if (now_s() < next_s_[i]) continue;
      next_s_[i] = std::max(next_s_[i] + paced(kFrameKinds[i].every_s), now_s());
      if (is_started_ && !suffers(core::FaultKind::kSilence)) queue_frame(frame(kFrameKinds[i].kind));
    }
  }

  bool take_output(std::span<const std::uint8_t> report) override {
    if (report.size() != 8) return false;
    if (std::equal(kWmr100StartsWith.begin(), kWmr100StartsWith.end(), report.begin())) is_started_ = true;
    return true;
  }

 private:
  /// A frame with its sum, without ff ff.
  Bytes frame(std::uint8_t kind) {
    Bytes bytes;
    switch (kind) {
      case 0x48: {
        const auto average = static_cast<unsigned>(std::lround(10.0 * wind().speed_m_s)) & 0xFFFU;
        const auto gust = static_cast<unsigned>(std::lround(10.0 * gust_m_s_)) & 0xFFFU;
        bytes = {0x00,
                 0x48,
                 static_cast<std::uint8_t>(compass_point(wind().direction_deg)),
                 0x0C,
                 static_cast<std::uint8_t>(gust & 0xFFU),
                 static_cast<std::uint8_t>(((average & 0x0FU) << 4U) | (gust >> 8U)),
                 static_cast<std::uint8_t>(average >> 4U),
                 0x00,
                 0x20};
        gust_m_s_ = 0.0;
        break;
      }
      case 0x42:
        bytes = {0x00, 0x42, 0xD1, 0xC4, 0x00, 0x3A, 0x65, 0x00, 0x00, 0x20};
        break;
      case 0x41:
        bytes = {0x00, 0x41, 0x00, 0x00, 0x00, 0x00, 0x0C, 0x00, 0xFA, 0x00, 0x00, 0x0C, 0x01, 0x01, 0x09};
        break;
      case 0x60:
        bytes = {0x00, 0x60, 0x00, 0x00, 0x14, 0x09, 0x1C, 0x04, 0x09, 0x01};
        break;
      default:
        bytes = {0x00, 0x46, 0xED, 0x03, 0xED, 0x33};
        break;
    }
    unsigned sum = 0;
    for (const std::uint8_t byte : bytes) sum += byte;
    if (suffers(core::FaultKind::kBadChecksum)) sum ^= 0x0005U;
    bytes.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(sum >> 8U));
    return bytes;
  }

  void queue_frame(Bytes bytes) {
    if (suffers(core::FaultKind::kGarbage)) bytes = random_bytes(bytes.size());
    if (suffers(core::FaultKind::kPartial)) bytes.resize(bytes.size() / 2);
    bytes.insert(bytes.begin(), {0xFF, 0xFF});

    // One or two bytes a report most often, as the real console does; the length of garbage is random.
    const double gap_s = suffers(core::FaultKind::kSplit) ? kWmr100SplitReport_s : kWmr100Report_s;
    report_from_s_ = std::max(report_from_s_, now_s());
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t wanted = suffers(core::FaultKind::kSplit) ? 1 : 1 + random_below(3);
      const std::size_t count = std::min(wanted, bytes.size() - at);
      Bytes report(8);
      report[0] = static_cast<std::uint8_t>(suffers(core::FaultKind::kGarbage) ? random_below(256) : count);
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), count, report.begin() + 1);
      queue_report(std::move(report), report_from_s_ - now_s());
      report_from_s_ += gap_s;
      at += count;
    }
  }

  bool is_started_ = false;
  std::array<double, kFrameKinds.size()> next_s_{};
  double report_from_s_ = 0.0;  ///< when the next report can go
  double gust_m_s_ = 0.0;       ///< since the last wind frame
};

}  // namespace

std::unique_ptr<Device> make_wmr100(const HidModelOptions& options) {
  return std::make_unique<Wmr100>(options);
}

}  // namespace yuragi::simulators::usb
