#include "engine/base/duration.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

namespace yuragi {

Result<double, Failure> parse_duration_s(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, double>, 8> kUnits_s = {
      {{"", 1.0}, {"ms", 1e-3}, {"s", 1.0}, {"sec", 1.0}, {"m", 60.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}}};
  const Failure refusal{"\"" + std::string(text) +
                            "\" is not a duration; allowed: seconds (90), or a number with ms, s, min, h or d (5min)",
                        FailureKind::kUsage};
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || !std::isfinite(number) || number < 0.0) return refusal;
  std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  for (const auto& [name, unit_s] : kUnits_s) {
    if (unit == name && std::isfinite(number * unit_s)) return number * unit_s;
  }
  return refusal;
}

std::string duration_to_seconds(std::string& text) {
  const auto duration_s = parse_duration_s(text);
  if (!duration_s) return duration_s.error().message;
  std::array<char, 32> digits{};
  const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), *duration_s);
  text.assign(digits.data(), written.ptr);
  return {};
}

}  // namespace yuragi
