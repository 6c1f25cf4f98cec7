#include "drivers/modbus/modbus_plan.hpp"

#include <algorithm>
#include <optional>

namespace yuragi::drivers::modbus {
namespace {

ModbusRead read_of(const ModbusProfile& profile, ModbusMeasure measure) {
  const decode::modbus::ModbusQuantity& quantity = quantity_of(profile, measure);
  return {.request = {.transaction = 0,
                      .unit = quantity.slave,
                      .function = quantity.function,
                      .address = quantity.address,
                      .count = static_cast<std::uint16_t>(decode::modbus::register_count(quantity.type))},
          .measures = {measure}};
}

/// One read instead of two, if possible.
std::optional<ModbusRead> merged(const ModbusProfile& profile, const ModbusRead& one, const ModbusRead& other) {
  const auto has_side_effect = [&profile](ModbusMeasure measure) {
    return quantity_of(profile, measure).read_has_side_effect;
  };
  if (one.request.unit != other.request.unit || one.request.function != other.request.function) return std::nullopt;
  if (std::ranges::any_of(one.measures, has_side_effect) || std::ranges::any_of(other.measures, has_side_effect)) {
    return std::nullopt;
  }

  // Registers from the first to the last of both, and how many of them are not needed.
  const int begin = std::min(one.request.address, other.request.address);
  const int end = std::max(one.request.address + one.request.count, other.request.address + other.request.count);
  const int count = end - begin;
  const int between = count - one.request.count - other.request.count;
  if (between > profile.block_gap || count > static_cast<int>(decode::modbus::kModbusMaxRegisters)) return std::nullopt;

  ModbusRead read = one;
  read.request.address = static_cast<std::uint16_t>(begin);
  read.request.count = static_cast<std::uint16_t>(count);
  read.measures.insert(read.measures.end(), other.measures.begin(), other.measures.end());
  return read;
}

/// Merges the first two reads that can be merged; false: none can.
bool merge_two(const ModbusProfile& profile, std::vector<ModbusRead>& reads) {
  for (auto one = reads.begin(); one != reads.end(); ++one) {
    for (auto other = std::next(one); other != reads.end(); ++other) {
      const auto both = merged(profile, *one, *other);
      if (!both) continue;
      *one = *both;
      reads.erase(other);
      return true;
    }
  }
  return false;
}

}  // namespace

bool ModbusRead::contains(ModbusMeasure measure) const {
  return std::ranges::find(measures, measure) != measures.end();
}

std::vector<ModbusRead> plan_modbus_reads(const ModbusProfile& profile, bool is_direction_apart) {
  std::vector<ModbusRead> reads = {read_of(profile, ModbusMeasure::kSpeed)};
  if (profile.direction && !is_direction_apart) reads.push_back(read_of(profile, ModbusMeasure::kDirection));
  if (profile.gust) reads.push_back(read_of(profile, ModbusMeasure::kGust));
  while (profile.block_read && merge_two(profile, reads)) {
  }
  if (profile.direction && is_direction_apart) reads.push_back(read_of(profile, ModbusMeasure::kDirection));
  return reads;
}

const decode::modbus::ModbusQuantity& quantity_of(const ModbusProfile& profile, ModbusMeasure measure) {
  switch (measure) {
    case ModbusMeasure::kDirection:
      return *profile.direction;
    case ModbusMeasure::kGust:
      return *profile.gust;
    case ModbusMeasure::kSpeed:
      break;
  }
  return profile.speed;
}

std::span<const std::uint16_t> registers_of(const decode::modbus::ModbusQuantity& quantity,
                                            const decode::modbus::ModbusRequest& request,
                                            const decode::modbus::ModbusRegisters& registers) {
  const auto from = static_cast<std::size_t>(quantity.address - request.address);
  return registers.span().subspan(from, decode::modbus::register_count(quantity.type));
}

}  // namespace yuragi::drivers::modbus
