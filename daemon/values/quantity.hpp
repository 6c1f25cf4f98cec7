#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace yuragi::daemon::values {

/// What other programs can be sent of a wind. Every feed has the same names, units and ranges.
enum class Quantity : std::uint8_t {
  kSpeed,
  kDirection,
  kU,
  kV,
  kMean,
  kGust,
  kPeak,
  kNorm,
  kGustNorm,
  kLive,
  kAge,
};
inline constexpr std::size_t kQuantityCount = 11;

struct QuantityDescription {
  std::string_view name;
  std::string_view unit;        ///< empty: a number from 0 to 1
  double min = 0.0, max = 1.0;  ///< the range for programs that draw a slider; a strong wind may exceed it
  std::string_view help;
};

const QuantityDescription& description_of(Quantity quantity) noexcept;
std::optional<Quantity> quantity_named(std::string_view name) noexcept;

/// All of them, in the order of Quantity.
const std::array<QuantityDescription, kQuantityCount>& quantities() noexcept;

/// The values of one wind at one moment, all finite.
class Readout {
 public:
  double operator[](Quantity quantity) const noexcept { return values_[static_cast<std::size_t>(quantity)]; }
  double& operator[](Quantity quantity) noexcept { return values_[static_cast<std::size_t>(quantity)]; }
  friend bool operator==(const Readout&, const Readout&) = default;

 private:
  std::array<double, kQuantityCount> values_{};
};

}  // namespace yuragi::daemon::values
