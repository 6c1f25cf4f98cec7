// Protocols whose messages are bytes. The values of a message are those of its protocol's smallest steps.
#include <algorithm>
#include <array>
#include <bit>
#include <initializer_list>
#include <utility>

#include "drivers/bus/osc_message.hpp"
#include "drivers/decode/davis/vantage.hpp"
#include "drivers/decode/davis/vantage_assembler.hpp"
#include "drivers/decode/hid/acurite.hpp"
#include "drivers/decode/hid/fineoffset.hpp"
#include "drivers/decode/hid/te923.hpp"
#include "drivers/decode/hid/wmr100.hpp"
#include "drivers/decode/hid/wmr300.hpp"
#include "drivers/decode/lufft/umb.hpp"
#include "drivers/decode/lufft/umb_assembler.hpp"
#include "drivers/decode/modbus/modbus.hpp"
#include "drivers/decode/modbus/modbus_quantity.hpp"
#include "drivers/decode/network/ecowitt.hpp"
#include "drivers/decode/usb/cup_counter.hpp"
#include "drivers/decode/usb/labjack.hpp"
#include "drivers/decode/usb/mcc1208.hpp"
#include "drivers/decode/usb/potentiometer_vane.hpp"
#include "engine/base/units.hpp"
#include "tests/hurt/protocol.hpp"

namespace yuragi::hurt {
namespace {

namespace hid = drivers::decode::hid;
namespace modbus = drivers::decode::modbus;
namespace usb = drivers::decode::usb;
using drivers::decode::ByteSpan;
using drivers::decode::Refusal;
using Winds = std::vector<DecodedWind>;

ByteSpan span_of(std::string_view bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

Winds winds_of(const Result<DecodedWind, Refusal>& decoded) {
  return decoded ? Winds{*decoded} : Winds();
}

/// A message as it is made: zeros, into which bytes and words are put.
class Bytes {
 public:
  explicit Bytes(std::size_t size) : bytes_(size, '\0') {}

  void put(std::size_t at, int byte) { bytes_[at] = static_cast<char>(byte); }
  void put(std::size_t at, std::initializer_list<int> bytes) {
    for (const int byte : bytes) put(at++, byte);
  }
  void put_big(std::size_t at, int word) { put(at, {word >> 8, word & 0xFF}); }
  void put_little(std::size_t at, int word) { put(at, {word & 0xFF, word >> 8}); }

  ByteSpan span() const { return span_of(bytes_); }
  const std::string& text() const { return bytes_; }

 private:
  std::string bytes_;
};

// --- Modbus: a device with its speed in 0.01 m/s at register 0, its direction in degrees behind it

constexpr modbus::Request kModbusRequest = {.transaction = 0x2A17, .unit = 1, .function = 3, .address = 0, .count = 2};

Winds winds_of_registers(const Result<modbus::Registers, modbus::RefusedReply>& registers) {
  if (!registers) return {};
  modbus::Quantity speed;
  speed.scale = 0.01;
  modbus::Quantity direction;
  direction.unit = modbus::QuantityUnit::kDegrees;
  const auto speed_m_s = decode_speed_m_s(speed, registers->span().first(1));
  const auto direction_deg = decode_direction_deg(direction, registers->span().subspan(1, 1));
  if (!speed_m_s) return {};
  DecodedWind wind = wind_of(*speed_m_s);
  if (direction_deg) wind.direction_deg = *direction_deg;
  return {wind};
}

/// Unit, function, size and two registers, in a message that has `before` bytes in front of it and `behind` at its end.
Bytes modbus_reply(int speed_cm_s, int direction_deg, std::size_t before, std::size_t behind) {
  Bytes reply(before + 7 + behind);
  reply.put(before, {1, 3, 4});
  reply.put_big(before + 3, speed_cm_s);
  reply.put_big(before + 5, direction_deg);
  return reply;
}

Message make_modbus_rtu(Chance& chance) {
  const int speed_cm_s = chance.between(0, 6000);
  const int direction_deg = chance.between(0, 359);
  Bytes reply = modbus_reply(speed_cm_s, direction_deg, 0, 2);
  reply.put_little(7, modbus::modbus_crc(reply.span().first(7)));
  return {reply.text(), wind_of(speed_cm_s * 0.01, direction_deg)};
}
Winds modbus_rtu_winds(std::string_view bytes) {
  return winds_of_registers(decode_rtu(kModbusRequest, span_of(bytes)));
}

Message make_modbus_tcp(Chance& chance) {
  const int speed_cm_s = chance.between(0, 6000);
  const int direction_deg = chance.between(0, 359);
  Bytes reply = modbus_reply(speed_cm_s, direction_deg, 6, 0);
  reply.put_big(0, kModbusRequest.transaction);
  reply.put_big(4, 7);
  return {reply.text(), wind_of(speed_cm_s * 0.01, direction_deg)};
}
Winds modbus_tcp_winds(std::string_view bytes) {
  return winds_of_registers(decode_tcp(kModbusRequest, span_of(bytes)));
}

// --- USB weather stations

Message make_wmr100(Chance& chance) {
  const int average = chance.between(0, 500);
  const int gust = chance.between(average, 600);
  const int point = chance.between(0, 15);
  Bytes frame(13);
  frame.put(0, {0x00, 0x48, point, 0x00, gust & 0xFF, (gust >> 8) | ((average & 0x0F) << 4), average >> 4, 0x00, 0x20});
  frame.put_little(9, drivers::decode::sum_16(frame.span().first(9)));
  frame.put(11, {0xFF, 0xFF});
  return {frame.text(), wind_of(average / 10.0, point * 22.5, gust / 10.0)};
}
Winds wmr100_winds(std::string_view bytes) {
  hid::Wmr100Stream stream;
  Winds winds;
  const auto take = [&](const std::optional<Result<DecodedWind, Refusal>>& decoded) {
    if (decoded && *decoded) winds.push_back(**decoded);
  };
  // What came before ended with its ff ff.
  for (int i = 0; i < 2; ++i) take(hid::take_wmr100_byte(stream, 0xFF));
  for (const std::uint8_t byte : span_of(bytes)) take(hid::take_wmr100_byte(stream, byte));
  take(hid::finish_wmr100(stream));
  return winds;
}

Message make_wmr300(Chance& chance) {
  const int average = chance.between(0, 500);
  const int gust = chance.between(average, 600);
  const int direction_deg = chance.between(0, 359);
  Bytes packet(hid::kWmr300WindPacket);
  packet.put(0, {0xD4, 54, 18, 6, 1, 12, 30, 1});
  packet.put_big(8, gust);
  packet.put_big(10, chance.between(0, 359));
  packet.put_big(12, average);
  packet.put_big(14, direction_deg);
  packet.put_big(52, drivers::decode::sum_16(packet.span().first(52)));
  return {packet.text(), wind_of(average / 10.0, direction_deg, gust / 10.0)};
}
Winds wmr300_winds(std::string_view bytes) {
  return winds_of(hid::decode_wmr300(span_of(bytes)));
}

/// Tenths of a mile an hour as two decimal digits, and the tens.
void put_te923_speed(Bytes& block, std::size_t at, int tenths_mph) {
  block.put(at, {((tenths_mph / 10 % 10) << 4) | (tenths_mph % 10), tenths_mph / 100});
}

Message make_te923(Chance& chance) {
  const int average = chance.between(0, 800);
  const int gust = chance.between(average, 999);
  const int point = chance.between(0, 15);
  Bytes block(hid::kTe923Block);
  block.put(0, 0x5A);
  for (std::size_t at = 1; at < 26; ++at) block.put(at, chance.byte());
  put_te923_speed(block, 26, gust);
  put_te923_speed(block, 28, average);
  block.put(30, {point, chance.byte(), chance.byte()});
  block.put(33, drivers::decode::xor_8(block.span()));
  return {block.text(),
          wind_of(average / 10.0 * kMetresPerSecondPerMph, point * 22.5, gust / 10.0 * kMetresPerSecondPerMph)};
}
Winds te923_winds(std::string_view bytes) {
  return winds_of(hid::decode_te923(span_of(bytes)));
}

Message make_acurite(Chance& chance) {
  // The codes of north, east, south and west.
  constexpr std::array<int, 4> kCodes = {6, 10, 15, 3};
  const int n = chance.between(0, 150);
  const int quarter = chance.between(0, 3);
  Bytes report(hid::kAcuriteReport1);
  report.put(
      0, {1, 0xC7, 0x1A, 0x71, n >> 3, ((n & 7) << 4) | kCodes[static_cast<std::size_t>(quarter)], 0, 0x1F, 3, 0xFF});
  const double speed_km_h = n == 0 ? 0.0 : 0.8278 * n + 1.0;
  return {report.text(), wind_of(speed_km_h / 3.6, quarter * 90.0)};
}
Winds acurite_winds(std::string_view bytes) {
  return winds_of(hid::decode_acurite(span_of(bytes)));
}

Message make_fineoffset(Chance& chance) {
  const int average = chance.between(0, 400);
  const int gust = chance.between(average, 500);
  const int point = chance.between(0, 15);
  Bytes record(16);
  record.put(0, {5, 40, 210, 0, 63, 120, 0, 0x8F, 0x27, average & 0xFF, gust & 0xFF,
                 (average >> 8) | ((gust >> 8) << 4), point, 20, 0, 0});
  return {record.text(), wind_of(average / 10.0, point * 22.5, gust / 10.0)};
}
Winds fineoffset_winds(std::string_view bytes) {
  return winds_of(hid::decode_fineoffset_record(span_of(bytes)));
}

// --- Counters and analogue inputs, and the cup and the vane on them: a second after a count of 1000

constexpr std::uint32_t kCountBefore = 1000;
constexpr double kMetresPerPulse = 0.1;
constexpr double kVane_v = 2.4;

Winds winds_of_count(std::uint32_t count, std::optional<double> direction_deg) {
  usb::CupState state = {.last_count = kCountBefore};
  const auto speed_m_s = advance_cup(state, {.metres_per_pulse = kMetresPerPulse}, count, 1.0);
  if (!speed_m_s || !*speed_m_s) return {};
  return {wind_of(**speed_m_s, direction_deg)};
}

Message make_labjack(Chance& chance) {
  const int pulses = chance.between(0, 500);
  const int analog = chance.between(100, 60'000);
  Bytes reply(16);
  reply.put(0, {0, 0xF8, 5, 0});
  reply.put_little(9, analog);
  reply.put_little(11, static_cast<int>(kCountBefore) + pulses);
  reply.put_little(4, drivers::decode::sum_16(reply.span().subspan(6)));
  int head = drivers::decode::sum_16(reply.span().subspan(1, 5));
  head = (head >> 8) + (head & 0xFF);
  reply.put(0, (head >> 8) + (head & 0xFF));
  return {reply.text(), wind_of(pulses * kMetresPerPulse, analog * 0.000037231 / kVane_v * 356.0)};
}
Winds labjack_winds(std::string_view bytes) {
  const auto reply = usb::decode_labjack({}, span_of(bytes));
  if (!reply) return {};
  const double wiper_v = usb::nominal_labjack_calibration(usb::LabjackInput::kLowVoltage).volts(*reply->analog);
  return winds_of_count(*reply->count, usb::vane_direction_deg({}, wiper_v, kVane_v));
}

Message make_mcc1208(Chance& chance) {
  const int pulses = chance.between(0, 500);
  Bytes reply(4);
  reply.put_little(0, static_cast<int>(kCountBefore) + pulses);
  return {reply.text(), wind_of(pulses * kMetresPerPulse)};
}
Winds mcc1208_winds(std::string_view bytes) {
  const auto count = usb::decode_mcc1208_count(span_of(bytes));
  return count ? winds_of_count(*count, {}) : Winds();
}

// --- Davis consoles

Message make_vantage(Chance& chance, bool is_loop2) {
  const int speed_mph = chance.between(0, 120);
  const int direction_deg = chance.between(1, 359);
  const int average_tenths_mph = chance.between(0, 800);
  const int gust_mph = chance.between(std::max(speed_mph, average_tenths_mph / 10 + 1), 130);
  Bytes packet(drivers::decode::davis::kVantagePacket);
  packet.put(0, {'L', 'O', 'O', 0xEC, is_loop2 ? 1 : 0});
  for (std::size_t at = 5; at < 95; ++at) packet.put(at, chance.byte());
  packet.put(14, speed_mph);
  packet.put_little(16, direction_deg);
  if (is_loop2) {
    packet.put_little(18, average_tenths_mph);
    packet.put_little(22, gust_mph);
  }
  packet.put(95, {0x0A, 0x0D});
  packet.put_big(97, drivers::decode::davis::vantage_checksum(packet.span().first(97)));
  Message message = {packet.text(), wind_of(speed_mph * kMetresPerSecondPerMph, direction_deg)};
  if (is_loop2) message.wind.gust_m_s = gust_mph * kMetresPerSecondPerMph;
  return message;
}
Message make_vantage_loop(Chance& chance) {
  return make_vantage(chance, false);
}
Message make_vantage_loop2(Chance& chance) {
  return make_vantage(chance, true);
}
Winds vantage_winds(std::string_view bytes) {
  drivers::decode::davis::VantageAssembler assembler;
  Winds winds;
  ByteSpan rest = span_of(bytes);
  while (const auto packet = assembler.next(rest)) {
    if (!*packet) continue;
    if (const auto wind = drivers::decode::davis::decode_vantage_packet(**packet)) winds.push_back(*wind);
  }
  return winds;
}

// --- Lufft

/// A weather station's reply to a query of speed, direction and greatest speed, each a float.
Message make_umb_binary(Chance& chance) {
  const float speed_m_s = static_cast<float>(chance.between(0, 6000)) / 128.0F;
  const float gust_m_s = speed_m_s + static_cast<float>(chance.between(0, 1000)) / 128.0F;
  const float direction_deg = static_cast<float>(chance.between(0, 35900)) / 128.0F;
  Bytes frame(43);
  frame.put(0, {0x01, 0x10, 0x01, 0xF0, 0x01, 0x70, 31, 0x02, 0x2F, 0x10, 0x00, 3});
  std::size_t at = 12;
  for (const auto& [channel, value] : {std::pair(401, speed_m_s), {501, direction_deg}, {440, gust_m_s}}) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    frame.put(at, {8, 0});
    frame.put_little(at + 2, channel);
    frame.put(at + 4, 0x16);
    frame.put_little(at + 5, static_cast<int>(bits & 0xFFFFU));
    frame.put_little(at + 7, static_cast<int>(bits >> 16U));
    at += 9;
  }
  frame.put(39, 0x03);
  frame.put_little(40, drivers::decode::lufft::umb_checksum(frame.span().first(40)));
  frame.put(42, 0x04);
  return {frame.text(), wind_of(speed_m_s, direction_deg, gust_m_s)};
}
Winds umb_binary_winds(std::string_view bytes) {
  drivers::decode::lufft::UmbAssembler assembler;
  Winds winds;
  ByteSpan rest = span_of(bytes);
  while (const auto frame = assembler.next(rest)) {
    if (!*frame) continue;
    const auto reply = drivers::decode::lufft::decode_umb_reply(drivers::decode::lufft::umb_address(7, 1), **frame);
    if (!reply) continue;
    if (const auto wind = drivers::decode::lufft::wind_of(*reply)) winds.push_back(*wind);
  }
  return winds;
}

// --- Network

Message make_ecowitt(Chance& chance) {
  const int average = chance.between(0, 500);
  const int gust = chance.between(average, 600);
  const int direction_deg = chance.between(0, 359);
  Bytes reply(22);
  reply.put(0, {0xFF, 0xFF, 0x27, 0x00, 20, 0x02, 0x00, 0xD2, 0x07, 0x5D, 0x0A});
  reply.put_big(11, direction_deg);
  reply.put(13, 0x0B);
  reply.put_big(14, average);
  reply.put(16, 0x0C);
  reply.put_big(17, gust);
  reply.put(19, {0x17, 3});
  reply.put(21, drivers::decode::sum_16(reply.span().subspan(2, 19)) & 0xFF);
  return {reply.text(), wind_of(average / 10.0, direction_deg, gust / 10.0)};
}
Winds ecowitt_winds(std::string_view bytes) {
  const auto values = drivers::decode::network::decode_ecowitt(span_of(bytes));
  return values ? winds_of(values->wind) : Winds();
}

Message make_osc(Chance& chance) {
  const float speed_m_s = static_cast<float>(chance.between(0, 6000)) / 128.0F;
  const float direction_deg = static_cast<float>(chance.between(0, 35900)) / 128.0F;
  Bytes message(20);
  message.put(0, {'/', 'w', 'i', 'n', 'd', 0, 0, 0, ',', 'f', 'f', 0});
  std::size_t at = 12;
  for (const float value : {speed_m_s, direction_deg}) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    message.put_big(at, static_cast<int>(bits >> 16U));
    message.put_big(at + 2, static_cast<int>(bits & 0xFFFFU));
    at += 4;
  }
  return {message.text(), wind_of(speed_m_s, direction_deg)};
}
/// As the driver takes messages of "/wind".
Winds osc_winds(std::string_view bytes) {
  const auto messages = drivers::bus::decode_osc(span_of(bytes));
  if (!messages) return {};
  Winds winds;
  for (const drivers::bus::OscMessage& message : *messages) {
    if (message.address != "/wind" || message.numbers.empty() || !message.numbers[0]) continue;
    DecodedWind wind = wind_of(message.numbers[0]);
    if (message.numbers.size() > 1 && message.numbers[1]) {
      wind.direction_deg = drivers::decode::wrapped_direction_deg(*message.numbers[1]);
      if (!wind.direction_deg) continue;
    }
    if (const auto sound = checked(wind)) winds.push_back(*sound);
  }
  return winds;
}

constexpr std::array kByteProtocols = {
    Protocol{.name = "Modbus RTU",
             .checksum = Checksum::kCrc16,
             .most_false_of_a_million = 15,
             .make = make_modbus_rtu,
             .winds_in = modbus_rtu_winds},
    Protocol{
        .name = "Modbus TCP", .most_false_of_a_million = 66'000, .make = make_modbus_tcp, .winds_in = modbus_tcp_winds},
    Protocol{.name = "WMR100",
             .checksum = Checksum::kSum16,
             .is_stream = true,
             .most_false_of_a_million = 890,
             .make = make_wmr100,
             .winds_in = wmr100_winds},
    Protocol{.name = "WMR300",
             .checksum = Checksum::kSum16,
             .most_false_of_a_million = 290,
             .make = make_wmr300,
             .winds_in = wmr300_winds},
    Protocol{.name = "TE923",
             .checksum = Checksum::kXor8,
             .most_false_of_a_million = 1'100,
             .make = make_te923,
             .winds_in = te923_winds},
    Protocol{.name = "AcuRite", .most_false_of_a_million = 87'000, .make = make_acurite, .winds_in = acurite_winds},
    Protocol{.name = "Fine Offset",
             .most_false_of_a_million = 150'000,
             .make = make_fineoffset,
             .winds_in = fineoffset_winds},
    Protocol{.name = "LabJack",
             .checksum = Checksum::kSum16,
             .most_false_of_a_million = 220,
             .make = make_labjack,
             .winds_in = labjack_winds},
    Protocol{.name = "MCC 1208", .most_false_of_a_million = 40'000, .make = make_mcc1208, .winds_in = mcc1208_winds},
    Protocol{.name = "Davis LOOP",
             .checksum = Checksum::kCrc16,
             .is_stream = true,
             .most_false_of_a_million = 15,
             .make = make_vantage_loop,
             .winds_in = vantage_winds},
    Protocol{.name = "Davis LOOP2",
             .checksum = Checksum::kCrc16,
             .is_stream = true,
             .most_false_of_a_million = 15,
             .make = make_vantage_loop2,
             .winds_in = vantage_winds},
    Protocol{.name = "UMB, binary",
             .checksum = Checksum::kCrc16,
             .is_stream = true,
             .most_false_of_a_million = 15,
             .make = make_umb_binary,
             .winds_in = umb_binary_winds},
    Protocol{.name = "Ecowitt",
             .checksum = Checksum::kSum8,
             .most_false_of_a_million = 430,
             .make = make_ecowitt,
             .winds_in = ecowitt_winds},
    Protocol{.name = "OSC", .most_false_of_a_million = 110'000, .make = make_osc, .winds_in = osc_winds},
};

}  // namespace

std::span<const Protocol> byte_protocols() {
  return kByteProtocols;
}

}  // namespace yuragi::hurt
