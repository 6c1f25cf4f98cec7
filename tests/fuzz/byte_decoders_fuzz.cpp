// Any bytes for every decoder of USB stations and DAQs; sums and heads are mended on request, so that values are
// reached.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "drivers/decode/hid/acurite.hpp"
#include "drivers/decode/hid/fineoffset.hpp"
#include "drivers/decode/hid/te923.hpp"
#include "drivers/decode/hid/wmr100.hpp"
#include "drivers/decode/hid/wmr300.hpp"
#include "drivers/decode/usb/cup_counter.hpp"
#include "drivers/decode/usb/labjack.hpp"
#include "drivers/decode/usb/mcc1208.hpp"
#include "drivers/decode/usb/potentiometer_vane.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

void require_physical(const Result<decode::DecodedWind, decode::Refusal>& decoded) {
  require(!decoded || decode::checked(*decoded).has_value());
}

/// Whatever is said can be recorded, or dropped.
void require_recordable(const std::optional<wind::StationQuantities>& said) {
  if (!said) return;
  const auto part = wind::plausible_part(*said);
  for (const wind::StationQuantity& each : wind::kStationQuantities) {
    const auto& value = (*said).*each.value;
    const bool is_kept = part && ((*part).*each.value).has_value();
    require(!is_kept || (*((*part).*each.value) >= each.least && *((*part).*each.value) <= each.greatest));
    require(!value || std::isfinite(*value));
  }
}

void read_stream(decode::ByteSpan bytes) {
  decode::hid::Wmr100Stream stream;
  for (const std::uint8_t byte : bytes) {
    const auto result = decode::hid::take_wmr100_byte(stream, byte);
    if (result) require_physical(*result);
    require_recordable(decode::hid::decode_wmr100_quantities(decode::hid::ended_wmr100_frame(stream)));
    require(stream.size <= decode::hid::kWmr100LongestFrame + 1);
  }
  if (const auto result = decode::hid::finish_wmr100(stream)) require_physical(*result);
  require(stream.size == 0);
  const decode::ByteSpan data = decode::hid::wmr100_report_bytes(bytes);
  require(data.size() <= 7 && (data.empty() || data.data() + data.size() <= bytes.data() + bytes.size()));
}

void read_frames(std::vector<std::uint8_t> bytes, bool is_mended) {
  require_physical(decode::hid::decode_wmr100_frame(bytes));
  require_physical(decode::hid::decode_wmr300(bytes));
  require_physical(decode::hid::decode_te923(bytes));
  require_physical(decode::hid::decode_acurite(bytes));
  require_physical(decode::hid::decode_fineoffset_record(bytes));
  require_recordable(decode::hid::decode_wmr100_quantities(bytes));
  require_recordable(decode::hid::decode_wmr300_quantities(bytes));
  require_recordable(decode::hid::decode_te923_quantities(bytes));
  require_recordable(decode::hid::decode_acurite_quantities(bytes));
  require_recordable(decode::hid::decode_fineoffset_quantities(bytes));
  static_cast<void>(decode::hid::encode_wmr300_acknowledgement(bytes));
  for (const auto model : {decode::hid::FineOffsetModel::kWh1080, decode::hid::FineOffsetModel::kWh3080}) {
    if (const auto fixed = decode::hid::decode_fineoffset_fixed_block(bytes, model)) {
      require(fixed->current_position >= decode::hid::kFineOffsetFirstRecord);
    }
  }
  if (!is_mended) return;
  if (bytes.size() >= 11) {
    std::vector<std::uint8_t> frame(bytes.begin(), bytes.begin() + 11);
    frame[1] = 0x48;
    const auto sum = decode::sum_16(decode::ByteSpan(frame).first(9));
    frame[9] = static_cast<std::uint8_t>(sum & 0xFFU);
    frame[10] = static_cast<std::uint8_t>(sum >> 8U);
    require_physical(decode::hid::decode_wmr100_frame(frame));
  }
  constexpr std::array<std::array<std::size_t, 2>, 3> kWmr100Weather = {{{0x41, 17}, {0x42, 12}, {0x46, 8}}};
  for (const auto& [kind, size] : kWmr100Weather) {
    if (bytes.size() < size) continue;
    std::vector<std::uint8_t> frame(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    frame[1] = static_cast<std::uint8_t>(kind);
    const auto sum = decode::sum_16(decode::ByteSpan(frame).first(size - 2));
    frame[size - 2] = static_cast<std::uint8_t>(sum & 0xFFU);
    frame[size - 1] = static_cast<std::uint8_t>(sum >> 8U);
    require_recordable(decode::hid::decode_wmr100_quantities(frame));
  }
  constexpr std::array<std::array<std::size_t, 2>, 3> kWmr300Weather = {{{0xD3, 61}, {0xD5, 40}, {0xD6, 46}}};
  for (const auto& [kind, size] : kWmr300Weather) {
    if (bytes.size() < size) continue;
    std::vector<std::uint8_t> packet = bytes;
    packet[0] = static_cast<std::uint8_t>(kind);
    packet[1] = static_cast<std::uint8_t>(size);
    const auto sum = decode::sum_16(decode::ByteSpan(packet).first(size - 2));
    packet[size - 2] = static_cast<std::uint8_t>(sum >> 8U);
    packet[size - 1] = static_cast<std::uint8_t>(sum & 0xFFU);
    require_recordable(decode::hid::decode_wmr300_quantities(packet));
  }
  if (bytes.size() >= decode::hid::kTe923Block) {
    std::vector<std::uint8_t> block(bytes.begin(), bytes.begin() + decode::hid::kTe923Block);
    block[0] = 0x5A;
    block[33] = static_cast<std::uint8_t>(block[33] ^ decode::xor_8(block));
    const auto decoded = decode::hid::decode_te923(block);
    require(decoded || decoded.error() == decode::Refusal::kInvalid);
    require_physical(decoded);
    require_recordable(decode::hid::decode_te923_quantities(block));
  }
  if (bytes.size() >= decode::hid::kWmr300WindPacket) {
    bytes[0] = 0xD4;
    bytes[1] = 54;
    const auto sum = decode::sum_16(decode::ByteSpan(bytes).first(52));
    bytes[52] = static_cast<std::uint8_t>(sum >> 8U);
    bytes[53] = static_cast<std::uint8_t>(sum & 0xFFU);
    require_physical(decode::hid::decode_wmr300(bytes));
  }
}

void read_daq(decode::ByteSpan bytes, std::uint8_t choice) {
  decode::usb::LabjackRequest request;
  if ((choice & 1U) != 0) request.analog_channel.reset();
  if ((choice & 2U) != 0) request.counter.reset();
  if ((choice & 4U) != 0) request.reference_channel = 1;
  if (const auto reply = decode::usb::decode_labjack(request, bytes)) {
    require(reply->analog.has_value() == request.analog_channel.has_value());
    require(reply->reference.has_value() == request.reference_channel.has_value());
    require(reply->count.has_value() == request.counter.has_value());
  }
  if (const auto analog = decode::usb::decode_mcc1208_analog(bytes)) require(*analog < 4096 && bytes.size() == 2);
  if (decode::usb::decode_mcc1208_count(bytes)) require(bytes.size() == 4);
  if (const auto calibration = decode::usb::decode_mcc1208_calibration(bytes)) {
    require(std::isfinite(decode::usb::mcc1208_volts(4095, *calibration)));
  }
  if (const auto block = decode::usb::decode_labjack_memory(bytes)) require(std::isfinite((*block)[0]));
  static_cast<void>(decode::usb::decode_labjack_identity(bytes));
  static_cast<void>(decode::usb::decode_labjack_configuration(0, bytes));
}

/// Counts and any doubles, as they come.
void turn_cup_and_vane(decode::ByteSpan bytes) {
  constexpr std::size_t kStep = 4 + sizeof(double);
  decode::usb::CupState state;
  for (; bytes.size() >= kStep; bytes = bytes.subspan(kStep)) {
    double number = 0.0;
    std::memcpy(&number, bytes.data() + 4, sizeof number);
    const auto speed =
        decode::usb::advance_cup(state, {.metres_per_pulse = 0.1}, decode::little_endian_32(bytes, 0), number);
    if (speed && *speed) require(**speed >= 0.0 && **speed <= wind::kMaxPlausibleSpeed_m_s);
    const auto direction_deg = decode::usb::vane_direction_deg({.start_deg = 17.0}, number, 5.0);
    if (direction_deg) require(*direction_deg >= 0.0 && *direction_deg < 360.0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  if (size == 0) return 0;
  const decode::ByteSpan bytes(data + 1, size - 1);
  read_stream(bytes);
  read_frames({bytes.begin(), bytes.end()}, (data[0] & 4U) != 0);
  read_daq(bytes, data[0]);
  turn_cup_and_vane(bytes);
  return 0;
}
