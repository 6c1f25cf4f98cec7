// Oregon Scientific WMR300 (0fde:ca08). Source: weewx wmr300.py (its comment).
//
// Interrupt end points of 64 bytes both ways. Each heartbeat (a6 91 ca 45 52) is answered with the console's
// identification (57 4d 52 33 30 30 ...). Sends no data before 73 e5 0a 26 and two bytes of that answer, which it
// acknowledges, and none 100 s after the last heartbeat or acknowledgement (41 43 4b kind channel). A packet: its kind,
// length, five bytes of date and time, channel, ..., the sum of all before, high byte first.
//
//   every     packet
//   2.75 s    d4 wind, 54 bytes, big-endian from 8 on: gust 0.1 m/s, its direction, average 0.1 m/s, its direction
//   11 s      d3 temperature, 61 bytes: 8 0.1 degrees Celsius, 10 %: -3.6 degrees (two's complement) and 58 %
//   22 s      d5 rain, 40 bytes: 15 all, 17 rate, 0.01 inch (an hour): 2.50 and 0.10 inch
//   900 s     d6 pressure, 46 bytes: 8 at the station, 10 at sea level, 0.1 hPa: 981.7 and 1015.3 hPa
#include "simulators/usb/wmr300.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace yuragi::simulators::usb {
namespace {

constexpr std::array kWmr300Faults = {core::FaultKind::kSilence, core::FaultKind::kFreeze,
                                      core::FaultKind::kSpike,   core::FaultKind::kGarbage,
                                      core::FaultKind::kPartial, core::FaultKind::kBadChecksum};
constexpr std::array<std::uint8_t, 5> kHeartbeat = {0xA6, 0x91, 0xCA, 0x45, 0x52};
constexpr std::array<std::uint8_t, 6> kBegin = {0x73, 0xE5, 0x0A, 0x26, 0x0E, 0xC1};
constexpr std::array<std::uint8_t, 3> kAcknowledgement = {0x41, 0x43, 0x4B};
constexpr Bytes::size_type kWmr300Report = 64;
constexpr double kRunsOnFor_s = 100.0;

struct PacketKind {
  std::uint8_t kind;
  std::uint8_t size;
  double every_s;
};
constexpr std::array<PacketKind, 4> kPacketKinds = {
    {{0xD4, 54, 2.75}, {0xD3, 61, 11.0}, {0xD5, 40, 22.0}, {0xD6, 46, 900.0}}};

class Wmr300 final : public HidModel {
 public:
  explicit Wmr300(const HidModelOptions& options)
      : HidModel({.vendor = 0x0FDE,
                  .product = 0xCA08,
                  .manufacturer = "Oregon Scientific",
                  .product_name = "WMR300",
                  .report_descriptor = plain_report_descriptor(kWmr300Report),
                  .report_size = kWmr300Report,
                  .interval_ms = 1,
                  .has_out_endpoint = true,
                  .is_full_speed = true},
                 kWmr300Faults, options) {
    for (std::size_t i = 0; i < kPacketKinds.size(); ++i) next_s_[i] = paced(1.0 + static_cast<double>(i));
  }

 protected:
  void play() override {
    gust_m_s_ = std::max(gust_m_s_, wind().speed_m_s);
    const bool sends = has_begun_ && now_s() < received_s_ + paced(kRunsOnFor_s) && !suffers(core::FaultKind::kSilence);
    for (std::size_t i = 0; i < kPacketKinds.size(); ++i) {
      if (now_s() < next_s_[i]) continue;
      next_s_[i] = std::max(next_s_[i] + paced(kPacketKinds[i].every_s), now_s());
      if (sends) queue_packet(packet(kPacketKinds[i]));
    }
  }

  bool take_output(std::span<const std::uint8_t> report) override {
    const auto begins_with = [report](std::span<const std::uint8_t> head) {
      return report.size() >= head.size() && std::equal(head.begin(), head.end(), report.begin());
    };
    if (begins_with(kHeartbeat)) {
      received_s_ = now_s();
      if (!suffers(core::FaultKind::kSilence)) queue_packet(who_it_is());
    } else if (begins_with(kBegin)) {
      has_begun_ = true;
      if (!suffers(core::FaultKind::kSilence)) queue_packet({0x41, 0x43, 0x4B, 0x73, 0xE5, 0x0A, 0x26, 0x0E, 0xC1});
    } else if (begins_with(kAcknowledgement)) {
      received_s_ = now_s();
    }
    return true;
  }

 private:
  static Bytes who_it_is() {
    return {0x57, 0x4D, 0x52, 0x33, 0x30, 0x30, 0x2C, 0x41, 0x30, 0x30, 0x32, 0x2C,
            0x0E, 0xC1, 0x00, 0x00, 0x2C, 0x67, 0x17, 0x2C, 0x4B, 0x2C, 0x52, 0x2C};
  }

  Bytes packet(const PacketKind& kind) {
    Bytes bytes(kind.size, 0x00);
    const auto put = [&bytes](std::size_t at, double number) {
      const auto value = static_cast<unsigned>(std::lround(number));
      bytes[at] = static_cast<std::uint8_t>(value >> 8U);
      bytes[at + 1] = static_cast<std::uint8_t>(value & 0xFFU);
    };
    constexpr std::array<std::uint8_t, 6> kDateAndChannel = {14, 5, 9, 18, 20, 1};
    bytes[0] = kind.kind;
    bytes[1] = kind.size;
    std::ranges::copy(kDateAndChannel, bytes.begin() + 2);
    if (kind.kind == 0xD4) {
      put(8, 10.0 * gust_m_s_);
      put(10, std::fmod(std::round(wind().direction_deg), 360.0));
      put(12, 10.0 * wind().speed_m_s);
      put(14, std::fmod(std::round(wind().direction_deg), 360.0));
      put(18, 0x7FFD);  // no wind chill
      gust_m_s_ = 0.0;
    } else if (kind.kind == 0xD3) {
      put(8, 0x10000 - 36);
      bytes[10] = 58;
    } else if (kind.kind == 0xD5) {
      put(15, 250);
      put(17, 10);
    } else {
      put(8, 9817);
      put(10, 10153);
    }
    unsigned sum = 0;
    for (const std::uint8_t byte : bytes) sum += byte;
    if (suffers(core::FaultKind::kBadChecksum)) sum ^= 0x0005U;
    put(bytes.size() - 2, static_cast<double>(sum & 0xFFFFU));
    return bytes;
  }

  void queue_packet(Bytes bytes) {
    if (suffers(core::FaultKind::kPartial)) {
      bytes.resize(bytes.size() / 2);  // a short packet ends the report
    } else {
      bytes.resize(kWmr300Report, 0x00);
    }
    if (suffers(core::FaultKind::kGarbage)) bytes = random_bytes(kWmr300Report);
    queue_report(std::move(bytes));
  }

  bool has_begun_ = false;
  double received_s_ = 0.0;  ///< time of the host's last message
  std::array<double, kPacketKinds.size()> next_s_{};
  double gust_m_s_ = 0.0;  ///< since the last wind packet
};

}  // namespace

std::unique_ptr<Device> make_wmr300(const HidModelOptions& options) {
  return std::make_unique<Wmr300>(options);
}

}  // namespace yuragi::simulators::usb
