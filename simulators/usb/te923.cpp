// Hideki TE923 (1130:6801). Source: weewx te923.py.
//
// On the output report 05 af, address (low, middle, high), the exclusive or of these four, 00 00, it answers with 34
// bytes in input reports of 8 (how many of the next 7 are valid, then those): 5a, 32 bytes of memory, the exclusive or
// of all 33. The host acknowledges with 24 af ... A request with a wrong check byte gets no reply.
//
// Memory from 0x020001 on (counted from the header as byte 0): 26, 27 gust; 28, 29 speed, decimal digits of 0.1 mph:
// ones and tenths, then tens (and 0x10: a hundred); 30 point of the compass. New every 33 s. And what does not change
// here: 4, 5 temperature of channel 1, digits as above with 0x80: above zero, 0x40: valid, 0x20: 0.05 more; 6 its
// humidity, two digits; 21, 22 pressure, 1/16 hPa, low byte first; 31, 32 tips of the rain gauge, low byte first.
#include "simulators/usb/te923.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace yuragi::simulators::usb {
namespace {

constexpr std::array kTe923Faults = {core::FaultKind::kSilence,     core::FaultKind::kFreeze, core::FaultKind::kSpike,
                                     core::FaultKind::kGarbage,     core::FaultKind::kSplit,  core::FaultKind::kPartial,
                                     core::FaultKind::kBadChecksum, core::FaultKind::kLate};
constexpr double kTe923Every_s = 33.0;
constexpr double kTe923Reply_s = 0.05;       // from the request to the first report
constexpr double kTe923Report_s = 0.01;      // from one report to the next
constexpr double kTe923SplitReport_s = 0.3;  // with the fault
constexpr double kTe923LateReply_s = 8.0;    // with the fault: longer than a host's timeout of 5 s
constexpr unsigned kTe923ReadingsAt = 0x020001;
constexpr double kMetrePerSecond_mph = 1.0 / 0.44704;

std::uint8_t xor_of(std::span<const std::uint8_t> bytes) {
  unsigned all = 0;
  for (const std::uint8_t byte : bytes) all ^= byte;
  return static_cast<std::uint8_t>(all);
}

class Te923 final : public HidModel {
 public:
  explicit Te923(const HidModelOptions& options)
      : HidModel({.vendor = 0x1130,
                  .product = 0x6801,
                  .manufacturer = "",
                  .product_name = "",
                  .report_descriptor = plain_report_descriptor(8)},
                 kTe923Faults, options) {
    // Before the first message of its anemometer.
    constexpr std::array<std::uint8_t, 4> kNoSensor = {0xEE, 0x8E, 0xEE, 0x8E};
    std::ranges::copy(kNoSensor, readings_.begin() + 25);
    constexpr std::array<std::uint8_t, 3> kChannel1 = {0x96, 0xE1, 0x58};  // 19.65 degrees Celsius, 58 %
    std::ranges::copy(kChannel1, readings_.begin() + 3);
    constexpr std::array<std::uint8_t, 2> kPressure = {0xD0, 0x3E};  // 1005 hPa
    std::ranges::copy(kPressure, readings_.begin() + 20);
    readings_[30] = 36;  // an inch of rain
  }

 protected:
  void play() override {
    gust_m_s_ = std::max(gust_m_s_, wind().speed_m_s);
    if (now_s() < next_s_) return;
    next_s_ = std::max(next_s_ + paced(kTe923Every_s), now_s());
    put_speed(25, gust_m_s_);
    put_speed(27, wind().speed_m_s);
    readings_[29] = static_cast<std::uint8_t>(compass_point(wind().direction_deg));
    gust_m_s_ = 0.0;
  }

  bool take_output(std::span<const std::uint8_t> report) override {
    if (report.size() != 8) return false;
    const bool is_request = report[0] == 0x05 && report[1] == 0xAF && xor_of(report.subspan(1, 5)) == 0;
    if (is_request && !suffers(core::FaultKind::kSilence)) {
      reply(report[2] + 0x100U * report[3] + 0x10000U * report[4]);
    }
    return true;
  }

 private:
  void put_speed(std::size_t at, double speed_m_s) {
    const auto tenths = static_cast<unsigned>(std::lround(10.0 * speed_m_s * kMetrePerSecond_mph));
    const auto digit = [tenths](unsigned divisor) { return tenths / divisor % 10U; };
    readings_[at] = static_cast<std::uint8_t>((digit(10) << 4U) | digit(1));
    readings_[at + 1] = static_cast<std::uint8_t>((digit(1000) << 4U) | digit(100));
  }

  void reply(unsigned address) {
    // The block: header, memory, check byte. Only the readings are written here; the rest is empty memory.
    Bytes block(33, 0x00);
    block[0] = 0x5A;
    if (address == kTe923ReadingsAt) std::copy(readings_.begin(), readings_.end(), block.begin() + 1);
    block.push_back(xor_of(block));
    if (suffers(core::FaultKind::kBadChecksum)) block.back() ^= 0x05U;
    if (suffers(core::FaultKind::kGarbage)) block = random_bytes(block.size());
    if (suffers(core::FaultKind::kPartial)) block.resize(block.size() / 2);

    drop_reports();
    double delay_s = suffers(core::FaultKind::kLate) ? kTe923LateReply_s : kTe923Reply_s;
    for (std::size_t at = 0; at < block.size();) {
      const std::size_t count = std::min<std::size_t>(7, block.size() - at);
      Bytes report(8);
      report[0] = static_cast<std::uint8_t>(count);
      std::copy_n(block.begin() + static_cast<std::ptrdiff_t>(at), count, report.begin() + 1);
      queue_report(std::move(report), delay_s);
      delay_s += suffers(core::FaultKind::kSplit) ? kTe923SplitReport_s : kTe923Report_s;
      at += count;
    }
  }

  std::array<std::uint8_t, 32> readings_{};  ///< the memory from 0x020001 on
  double next_s_ = 0.0;
  double gust_m_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Device> make_te923(const HidModelOptions& options) {
  return std::make_unique<Te923>(options);
}

}  // namespace yuragi::simulators::usb
