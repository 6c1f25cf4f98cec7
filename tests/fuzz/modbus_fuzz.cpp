// Any bytes as an answer to any request, on both framings, read through any quantity; and any text as a profile.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "drivers/decode/modbus/modbus.hpp"
#include "drivers/modbus/modbus_plan.hpp"
#include "drivers/modbus/modbus_profile.hpp"
#include "engine/wind/wind_reading.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

/// What the first bytes of an input choose; the rest is the message.
constexpr std::size_t kChoices = 8;

void decode_reply(std::span<const std::uint8_t> input) {
  const decode::modbus::Request request = {.transaction = static_cast<std::uint16_t>((input[0] << 8U) | input[1]),
                                           .unit = input[2],
                                           .function = static_cast<std::uint8_t>(3U + (input[3] & 1U)),
                                           .address = 0,
                                           .count = input[4]};
  decode::modbus::Quantity quantity;
  quantity.type = static_cast<decode::modbus::RegisterType>(input[5] % 5);
  quantity.order = static_cast<decode::modbus::ByteOrder>(input[6] % 4);
  quantity.unit = static_cast<decode::modbus::QuantityUnit>(input[7] % 4);
  quantity.map = static_cast<decode::modbus::DirectionMap>((input[7] / 4) % 3);
  quantity.scale = (input[3] & 2U) != 0 ? 0.1 : 1.0;

  for (const auto framing : {decode::modbus::Framing::kTcp, decode::modbus::Framing::kRtu}) {
    const auto registers = decode::modbus::decode_modbus(framing, request, input.subspan(kChoices));
    if (!registers) continue;
    require(registers->count == request.count);
    if (const auto speed_m_s = decode::modbus::decode_speed_m_s(quantity, registers->span())) {
      require(*speed_m_s >= 0.0 && *speed_m_s <= wind::kMaxPlausibleSpeed_m_s);
    }
    if (const auto number = decode::modbus::decode_number(quantity, registers->span())) require(std::isfinite(*number));
    if (const auto direction_deg = decode::modbus::decode_direction_deg(quantity, registers->span())) {
      require(*direction_deg >= 0.0 && *direction_deg < 360.0);
    }
  }
}

/// Whatever a profile says, each of its quantities stands in the answer to the request that is to bring it.
void check_plan(const modbus::Profile& profile) {
  for (const bool is_direction_apart : {false, true}) {
    const auto reads = modbus::plan_modbus_reads(profile, is_direction_apart);
    require(!reads.empty() && reads.front().contains(modbus::Measure::kSpeed));
    for (const modbus::RegisterRead& read : reads) {
      require(read.request.count >= 1 && read.request.count <= decode::modbus::kModbusMaxRegisters);
      decode::modbus::Registers registers;
      registers.count = read.request.count;
      const auto require_in_reply = [&](const decode::modbus::Quantity& quantity) {
        require(quantity.address >= read.request.address);
        require(quantity.address + decode::modbus::register_count(quantity.type) <=
                read.request.address + std::size_t{read.request.count});
        require(modbus::registers_of(quantity, read.request, registers).size() ==
                decode::modbus::register_count(quantity.type));
      };
      require(read.has_wind() || !read.stations.empty());
      for (const modbus::Measure measure : read.measures) require_in_reply(modbus::quantity_of(profile, measure));
      for (const std::size_t station : read.stations) require_in_reply(profile.quantities.at(station).quantity);
    }
  }
}

void read_profile(std::string_view text) {
  try {
    const modbus::Profile profile = modbus::parse_modbus_profile(text, "fuzz.toml");
    require(profile.speed.slave >= 1 && profile.speed.slave <= 247);
    require(profile.response_timeout > Nanoseconds::zero());
    check_plan(profile);
  } catch (const std::runtime_error& error) {
    require(std::string_view(error.what()).starts_with("fuzz.toml:"));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  const std::span input(data, size);
  if (size > kChoices) decode_reply(input);
  read_profile({reinterpret_cast<const char*>(data), size});
  return 0;
}
