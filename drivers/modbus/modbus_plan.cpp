#include "drivers/modbus/modbus_plan.hpp"

#include <algorithm>
#include <optional>

namespace yuragi::drivers::modbus {
namespace {

RegisterRead read_of(const Profile& profile, Measure measure) {
  return {.request = request_for(quantity_of(profile, measure)), .measures = {measure}, .stations = {}};
}

bool has_side_effect(const Profile& profile, const RegisterRead& read) {
  return std::ranges::any_of(read.measures,
                             [&](Measure measure) { return quantity_of(profile, measure).read_has_side_effect; }) ||
         std::ranges::any_of(read.stations,
                             [&](std::size_t i) { return profile.quantities[i].quantity.read_has_side_effect; });
}

/// One read instead of two, if possible.
std::optional<RegisterRead> merged(const Profile& profile, const RegisterRead& one, const RegisterRead& other) {
  if (one.request.unit != other.request.unit || one.request.function != other.request.function) return std::nullopt;
  if (has_side_effect(profile, one) || has_side_effect(profile, other)) return std::nullopt;

  // Registers from the first to the last of both, and how many of them are not needed.
  const int begin = std::min(one.request.address, other.request.address);
  const int end = std::max(one.request.address + one.request.count, other.request.address + other.request.count);
  const int count = end - begin;
  const int between = count - one.request.count - other.request.count;
  if (between > profile.block_gap || count > static_cast<int>(decode::modbus::kModbusMaxRegisters)) return std::nullopt;

  RegisterRead read = one;
  read.request.address = static_cast<std::uint16_t>(begin);
  read.request.count = static_cast<std::uint16_t>(count);
  read.measures.insert(read.measures.end(), other.measures.begin(), other.measures.end());
  read.stations.insert(read.stations.end(), other.stations.begin(), other.stations.end());
  return read;
}

/// Merges the first two reads that can be merged; false: none can.
bool merge_two(const Profile& profile, std::vector<RegisterRead>& reads) {
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

bool RegisterRead::contains(Measure measure) const {
  return std::ranges::find(measures, measure) != measures.end();
}

std::vector<RegisterRead> plan_modbus_reads(const Profile& profile, bool is_direction_apart) {
  std::vector<RegisterRead> reads = {read_of(profile, Measure::kSpeed)};
  if (profile.direction && !is_direction_apart) reads.push_back(read_of(profile, Measure::kDirection));
  if (profile.gust) reads.push_back(read_of(profile, Measure::kGust));
  for (std::size_t i = 0; i < profile.quantities.size(); ++i) {
    reads.push_back({.request = request_for(profile.quantities[i].quantity), .measures = {}, .stations = {i}});
  }
  while (profile.block_read && merge_two(profile, reads)) {
  }
  if (profile.direction && is_direction_apart) reads.push_back(read_of(profile, Measure::kDirection));
  std::stable_partition(reads.begin(), reads.end(), [](const RegisterRead& read) { return read.has_wind(); });
  return reads;
}

decode::modbus::Request request_for(const decode::modbus::Quantity& quantity) {
  return {.transaction = 0,
          .unit = quantity.slave,
          .function = quantity.function,
          .address = quantity.address,
          .count = static_cast<std::uint16_t>(decode::modbus::register_count(quantity.type))};
}

const decode::modbus::Quantity& quantity_of(const Profile& profile, Measure measure) {
  switch (measure) {
    case Measure::kDirection:
      return *profile.direction;
    case Measure::kGust:
      return *profile.gust;
    case Measure::kSpeed:
      break;
  }
  return profile.speed;
}

std::span<const std::uint16_t> registers_of(const decode::modbus::Quantity& quantity,
                                            const decode::modbus::Request& request,
                                            const decode::modbus::Registers& registers) {
  const auto from = static_cast<std::size_t>(quantity.address - request.address);
  return registers.span().subspan(from, decode::modbus::register_count(quantity.type));
}

}  // namespace yuragi::drivers::modbus
