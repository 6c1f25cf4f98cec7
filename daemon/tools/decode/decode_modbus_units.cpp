// `yuragi decode modbus:PROFILE`: a request and its response.
#include <cmath>

#include <fmt/format.h>

#include "daemon/tools/decode/decode_formats.hpp"
#include "drivers/decode/modbus/modbus.hpp"
#include "drivers/modbus/modbus_profile.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

struct RequestedRegisters {
  drivers::decode::modbus::Framing framing = drivers::decode::modbus::Framing::kRtu;
  drivers::decode::modbus::Request request;
};

/// Parses a request to read registers, of RTU or TCP by its format. Nullopt for anything else.
std::optional<RequestedRegisters> requested_registers_of(drivers::decode::ByteSpan bytes) {
  constexpr std::size_t kRtuRequest = 8;
  constexpr std::size_t kTcpRequest = 12;
  constexpr std::size_t kTcpHeader = 6;  // in front of the unit id
  RequestedRegisters requested;
  if (bytes.size() == kRtuRequest &&
      drivers::decode::modbus::modbus_crc(bytes.first(6)) == drivers::decode::little_endian_16(bytes, 6)) {
    requested.framing = drivers::decode::modbus::Framing::kRtu;
  } else if (bytes.size() == kTcpRequest && drivers::decode::big_endian_16(bytes, 2) == 0 &&
             drivers::decode::big_endian_16(bytes, 4) == 6) {
    requested.framing = drivers::decode::modbus::Framing::kTcp;
    requested.request.transaction = drivers::decode::big_endian_16(bytes, 0);
    bytes = bytes.subspan(kTcpHeader);
  } else {
    return std::nullopt;
  }
  requested.request.unit = bytes[0];
  requested.request.function = bytes[1];
  requested.request.address = drivers::decode::big_endian_16(bytes, 2);
  requested.request.count = drivers::decode::big_endian_16(bytes, 4);
  const bool reads = requested.request.function == 3 || requested.request.function == 4;
  const bool is_possible =
      requested.request.count >= 1 && requested.request.count <= drivers::decode::modbus::kModbusMaxRegisters;
  return reads && is_possible ? std::optional(requested) : std::nullopt;
}

/// The part of a reply that belongs to `quantity`; empty if it was not requested.
std::span<const std::uint16_t> registers_of(const drivers::decode::modbus::Quantity& quantity,
                                            const drivers::decode::modbus::Request& request,
                                            const drivers::decode::modbus::Registers& registers) {
  const std::size_t count = drivers::decode::modbus::register_count(quantity.type);
  const bool is_polled = request.unit == quantity.slave && request.function == quantity.function &&
                         request.address <= quantity.address &&
                         quantity.address + count <= std::size_t{request.address} + request.count;
  if (!is_polled) return {};
  return registers.span().subspan(static_cast<std::size_t>(quantity.address - request.address), count);
}

class ModbusUnitDecoder final : public UnitDecoder {
 public:
  explicit ModbusUnitDecoder(drivers::modbus::Profile profile) : profile_(std::move(profile)) {}

  void take(const RawUnit& unit, const Sink& sink) override {
    if (unit.request.empty()) {
      return sink(
          UnitRefusal{drivers::decode::Refusal::kMalformed, "no request: write request | response on one line"});
    }
    const auto requested = requested_registers_of(unit.request);
    if (!requested) {
      return sink(UnitRefusal{drivers::decode::Refusal::kMalformed,
                              "the request does not read registers, or its checksum is wrong"});
    }
    const auto registers = drivers::decode::modbus::decode_modbus(requested->framing, requested->request, unit.bytes);
    if (!registers) {
      const drivers::decode::modbus::RefusedReply& refusal = registers.error();
      const bool is_exception = refusal.why == drivers::decode::Refusal::kException;
      return sink(UnitRefusal{
          refusal.why, is_exception ? fmt::format("{}, {}", refusal.exception,
                                                  drivers::decode::modbus::modbus_exception_name(refusal.exception))
                                    : ""});
    }
    describe_reply(requested->request, *registers, sink);
  }

 private:
  /// One reading of all quantities in the reply; refusals of single ones are reported, too.
  void describe_reply(const drivers::decode::modbus::Request& request,
                      const drivers::decode::modbus::Registers& registers, const Sink& sink) const {
    UnitReading reading;
    bool holds_any = false;
    const auto take_value = [&](const drivers::decode::modbus::Quantity& quantity, const char* what, const auto& decode,
                                std::optional<double>& value) {
      const auto own = registers_of(quantity, request, registers);
      if (own.empty()) return;
      holds_any = true;
      const auto decoded = decode(quantity, own);
      if (decoded) {
        value = *decoded;
      } else {
        sink(UnitRefusal{decoded.error(), what});
      }
    };
    take_value(profile_.speed, "speed", drivers::decode::modbus::decode_speed_m_s, reading.wind.speed_m_s);
    if (profile_.direction)
      take_value(*profile_.direction, "direction", drivers::decode::modbus::decode_direction_deg,
                 reading.wind.direction_deg);
    if (profile_.gust)
      take_value(*profile_.gust, "gust", drivers::decode::modbus::decode_speed_m_s, reading.wind.gust_m_s);
    if (auto& direction_deg = reading.wind.direction_deg; direction_deg) {
      direction_deg = std::fmod(*direction_deg + profile_.north_offset_deg + 360.0, 360.0);
    }

    if (!holds_any) {
      sink(UnitRefusal{
          drivers::decode::Refusal::kNotMine,
          fmt::format("slave {}, function {}, registers {:#06x} to {:#06x}: not in the profile", request.unit,
                      request.function, request.address, request.address + request.count - 1)});
    } else if (reading.wind != drivers::decode::DecodedWind{}) {
      sink(reading);
    }
  }

  drivers::modbus::Profile profile_;
};

}  // namespace

std::unique_ptr<UnitDecoder> make_modbus_unit_decoder(const UnitDecoderOptions& options) {
  drivers::modbus::Profile profile = drivers::modbus::load_modbus_profile(options.profile, "");
  if (options.speed_slave != 0) drivers::modbus::set_slave(profile, static_cast<std::uint8_t>(options.speed_slave));
  if (options.direction_slave != 0) {
    if (!profile.direction) throw std::runtime_error("profile \"" + profile.name + "\" has no direction");
    profile.direction->slave = static_cast<std::uint8_t>(options.direction_slave);
  }
  return std::make_unique<ModbusUnitDecoder>(std::move(profile));
}

}  // namespace yuragi::daemon::tools::decode
