#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "simulators/usb/usb_device.hpp"

namespace yuragi::simulators::usb {

/// A device for tests of what carries devices, with one of everything: interface 0 is HID and says an 8-byte report
/// every 10 ms, `W`, its number (u32) and the wind (u16 cm/s, u8 deg/2), and keeps a feature report; interface 1 sends
/// back in bulk what it got in bulk, each bit turned over, and answers the vendor request 0x42.
class EchoDevice final : public Device {
 public:
  static constexpr std::uint16_t kVendor = 0x1209;
  static constexpr std::uint16_t kProduct = 0x57D1;
  static constexpr double kReportEvery_s = 0.010;
  static constexpr std::size_t kReportSize = 8;

  EchoDevice() {
    descriptors_.hid_report = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08,
                               0x95, 0x08, 0x09, 0x02, 0x81, 0x02, 0x95, 0x08, 0x09, 0x03, 0xB1, 0x02, 0xC0};
    descriptors_.device = {18, 1, 0x00, 0x02, 0, 0, 0, 64, 0x09, 0x12, 0xD1, 0x57, 0x00, 0x01, 1, 2, 3, 1};
    descriptors_.configuration = {9,    2,    64,   0,    2,  1,    0,    0x80, 50,  // configuration 1
                                  9,    4,    0,    0,    1,  3,    0,    0,    0,   // interface 0: HID
                                  9,    0x21, 0x11, 0x01, 0,  1,    0x22, 27,   0,   // its report descriptor
                                  7,    5,    0x81, 3,    8,  0,    10,              // interrupt IN
                                  9,    4,    1,    0,    2,  0xFF, 0,    0,    0,   // interface 1: the vendor's
                                  7,    5,    0x82, 2,    64, 0,    0,    7,    5,
                                  0x02, 2,    64,   0,    0};  // bulk IN, bulk OUT
    descriptors_.strings = {"Yuragi", "Echo", "E0001"};
  }

  const Descriptors& descriptors() const override { return descriptors_; }
  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kGarbage};
    return kKnown;
  }

  void advance(double time_s, const core::PlayedMoment& wind, std::optional<core::FaultKind> fault) override {
    time_s_ = time_s;
    wind_ = wind;
    fault_ = fault;
  }

  std::optional<Bytes> control(const SetupPacket& setup, std::span<const std::uint8_t> data) override {
    if (setup.request_type == 0xA1 && setup.request == 1) return feature_;
    if (setup.request_type == 0x21 && setup.request == 9) {
      feature_.assign(data.begin(), data.end());
      return Bytes{};
    }
    if (setup.request_type == 0xC0 && setup.request == 0x42) return Bytes{'V', 'E', 'N', 'D', 'O', 'R'};
    return std::nullopt;
  }

  std::optional<Bytes> in(std::uint8_t endpoint, std::size_t /*max_size*/) override {
    if (endpoint == 2) {
      if (bulk_.empty()) return std::nullopt;
      return std::exchange(bulk_, {});
    }
    if (time_s_ < next_report_s_) return std::nullopt;
    next_report_s_ = time_s_ + kReportEvery_s;
    if (fault_ == core::FaultKind::kGarbage) return Bytes(kReportSize, 0xA5);
    ++reports_;
    const auto speed_cm_s = static_cast<std::uint16_t>(100.0 * wind_.speed_m_s);
    const auto byte = [](std::uint32_t value) { return static_cast<std::uint8_t>(value); };
    return Bytes{'W',
                 byte(reports_),
                 byte(reports_ >> 8U),
                 byte(reports_ >> 16U),
                 byte(reports_ >> 24U),
                 byte(speed_cm_s),
                 byte(speed_cm_s >> 8U),
                 static_cast<std::uint8_t>(wind_.direction_deg / 2.0)};
  }

  bool out(std::uint8_t /*endpoint*/, std::span<const std::uint8_t> data) override {
    if (!data.empty() && data.front() == 0xFF) return false;  // what it refuses
    for (const std::uint8_t byte : data) bulk_.push_back(static_cast<std::uint8_t>(~byte));
    return true;
  }

 private:
  Descriptors descriptors_;
  Bytes feature_ = {'F', 'E', 'A', 'T', 'U', 'R', 'E', '!'};
  Bytes bulk_;
  double time_s_ = 0.0;
  double next_report_s_ = 0.0;
  core::PlayedMoment wind_;
  std::optional<core::FaultKind> fault_;
  std::uint32_t reports_ = 0;
};

}  // namespace yuragi::simulators::usb
