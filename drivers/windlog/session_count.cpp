#include "drivers/windlog/session_count.hpp"

#include <bit>
#include <optional>

namespace yuragi::drivers::windlog {
namespace {

/// The step and the output function of SplitMix64 (Steele, Lea and Flood 2014), with a value added.
std::uint64_t mix(std::uint64_t hash, std::uint64_t value) noexcept {
  hash += value + 0x9e3779b97f4a7c15;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111eb;
  return hash ^ (hash >> 31);
}

/// SQLite stores a negative zero as zero. The bits of a missing value are those of a number that is no reading.
std::uint64_t bits_of(const std::optional<double>& value) noexcept {
  return value ? std::bit_cast<std::uint64_t>(*value + 0.0) : ~std::uint64_t{0};
}

}  // namespace

void SessionCount::add(const wind::Reading& reading) noexcept {
  std::uint64_t hash = mix(0, static_cast<std::uint64_t>(reading.time.mono.time_since_epoch().count()));
  hash = mix(hash, static_cast<std::uint64_t>(reading.time.utc.time_since_epoch().count()));
  hash = mix(hash, bits_of(reading.speed_m_s));
  hash = mix(hash, bits_of(reading.direction_deg));
  hash = mix(hash, bits_of(reading.gust_m_s));
  checksum += mix(hash, static_cast<std::uint64_t>(reading.quality));
  ++readings;
}

}  // namespace yuragi::drivers::windlog
