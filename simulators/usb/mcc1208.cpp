// MCC USB-1208FS-Plus, as wjasper/Linux_Drivers uses it (USB/mcc-libusb/usb-1208FS-Plus.{h,c} and
// USB/python/usb_1208FS_Plus.py; W. J. Jasper, 2014 and 2020). Vendor requests to the device, numbers low byte first:
//
//   C0 10  wValue mode << 8 | channel    analogue input, 2 bytes, 12 bits; against ground (mode 0) -10 to 10 V only
//          wIndex range
//   C0 20                                event counter, 4 bytes
//   40 20                                sets it to 0
//   C0 30  wValue address                calibration memory, 768 bytes: from 0x100 on, for each of the inputs against
//                                        ground, two 32-bit floats: code * slope + intercept
//   C0 44                                status, 2 bytes
//   C0 48                                serial number, 8 characters
#include "simulators/usb/mcc1208.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "simulators/usb/cup_and_vane.hpp"

namespace yuragi::simulators::usb {
namespace {

constexpr unsigned kMccInputs = 8;
constexpr std::size_t kCalibrationSize = 768;
constexpr std::size_t kGroundedCalibration = 0x100;
constexpr std::string_view kMccSerial = "01C5A7E2";

void append_low_first(Bytes& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// The ADC of each input has an error, which its calibration corrects.
float slope_of(unsigned channel) {
  return 1.01F + 0.002F * static_cast<float>(channel);
}
float intercept_of(unsigned channel) {
  return -20.0F + 3.0F * static_cast<float>(channel);
}

Bytes calibration_memory() {
  Bytes memory;
  const auto add = [&memory](float slope, float intercept) {
    append_low_first(memory, std::bit_cast<std::uint32_t>(slope), 4);
    append_low_first(memory, std::bit_cast<std::uint32_t>(intercept), 4);
  };
  while (memory.size() < kGroundedCalibration) add(1.0F, 0.0F);
  for (unsigned channel = 0; channel < kMccInputs; ++channel) add(slope_of(channel), intercept_of(channel));
  memory.resize(kCalibrationSize);
  return memory;
}

Descriptors mcc1208_descriptors() {
  return {.device = {18, 1, 0x00, 0x02, 0xFF, 0xFF, 0xFF, 64, 0xDB, 0x09, 0xE8, 0x00, 0x00, 0x01, 1, 2, 3, 1},
          .configuration = {9, 2, 32,   0, 1,  1,    0,    0x80, 250,  // bus powered, 500 mA
                            9, 4, 0,    0, 2,  0xFF, 0xFF, 0xFF, 0,    // one vendor's interface
                            7, 5, 0x81, 2, 64, 0,    0,                // bulk in: scans of the analogue inputs
                            7, 5, 0x02, 2, 64, 0,    0},               // bulk out: scans of the analogue outputs
          .hid_report = {},
          .strings = {"Measurement Computing Corp.", "USB-1208FS-Plus", std::string(kMccSerial)}};
}

class Mcc1208 final : public Device {
 public:
  const Descriptors& descriptors() const override { return descriptors_; }

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {
        core::FaultKind::kSilence, core::FaultKind::kFreeze,    core::FaultKind::kSpike, core::FaultKind::kGarbage,
        core::FaultKind::kPartial, core::FaultKind::kException, core::FaultKind::kUnplug};
    return kKnown;
  }

  void advance(double time_s, const core::PlayedMoment& wind, std::optional<core::FaultKind> fault) override {
    fault_ = fault;
    cup_and_vane_.advance(time_s, wind, fault == core::FaultKind::kFreeze);
    if (fault == core::FaultKind::kUnplug) counted_from_ = cup_and_vane_.pulses();  // without power the count is lost
  }

  std::optional<Bytes> control(const SetupPacket& setup, std::span<const std::uint8_t> /*data*/) override {
    if (fault_ == core::FaultKind::kException) return std::nullopt;
    std::optional<Bytes> reply = setup.request_type == 0xC0 ? reply_to(setup) : obey(setup);
    if (!reply) return std::nullopt;
    if (reply->size() > setup.length) reply->resize(setup.length);
    if (fault_ == core::FaultKind::kGarbage) {
      std::ranges::generate(*reply, [this] { return static_cast<std::uint8_t>(random_()); });
    }
    if (fault_ == core::FaultKind::kPartial && !reply->empty()) reply->pop_back();
    return reply;
  }

  std::optional<Bytes> in(std::uint8_t /*endpoint*/, std::size_t /*max_size*/) override { return std::nullopt; }
  bool out(std::uint8_t /*endpoint*/, std::span<const std::uint8_t> /*data*/) override { return false; }

 private:
  std::optional<Bytes> reply_to(const SetupPacket& setup) const {
    Bytes reply;
    switch (setup.request) {
      case 0x10: {
        const unsigned channel = setup.value & 0xFFU;
        const bool is_against_ground = setup.value >> 8U == 0;
        if (!is_against_ground || channel >= kMccInputs) return std::nullopt;
        append_low_first(reply, convert(channel), 2);
        return reply;
      }
      case 0x20:
        append_low_first(reply, static_cast<std::uint32_t>(cup_and_vane_.pulses() - counted_from_), 4);
        return reply;
      case 0x30:
        if (setup.value >= memory_.size()) return std::nullopt;
        return Bytes(memory_.begin() + setup.value, memory_.end());
      case 0x44:
        return Bytes{0, 0};
      case 0x48:
        return Bytes(kMccSerial.begin(), kMccSerial.end());
      default:
        return std::nullopt;
    }
  }

  std::optional<Bytes> obey(const SetupPacket& setup) {
    if (setup.request_type != 0x40 || setup.request != 0x20) return std::nullopt;
    counted_from_ = cup_and_vane_.pulses();
    return Bytes{};
  }

  /// The ADC's code for the voltage at an input.
  std::uint16_t convert(unsigned channel) const {
    double volts = 0.0;
    if (channel == 0) volts = cup_and_vane_.wiper_v();
    if (channel == 1) volts = CupAndVane::kReference_v;
    const double right_code = volts / 10.0 * 2048.0 + 2048.0;
    const double code =
        (right_code - static_cast<double>(intercept_of(channel))) / static_cast<double>(slope_of(channel));
    return static_cast<std::uint16_t>(std::clamp(std::round(code), 0.0, 4095.0));
  }

  Descriptors descriptors_ = mcc1208_descriptors();
  Bytes memory_ = calibration_memory();
  CupAndVane cup_and_vane_;
  std::uint64_t counted_from_ = 0;
  std::optional<core::FaultKind> fault_;
  std::mt19937_64 random_{1208};
};

}  // namespace

std::unique_ptr<Device> make_mcc1208() {
  return std::make_unique<Mcc1208>();
}

}  // namespace yuragi::simulators::usb
