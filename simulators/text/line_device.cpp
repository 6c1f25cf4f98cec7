#include "simulators/text/line_device.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

namespace yuragi::simulators::text {
namespace {

struct LineFormat {
  std::string_view name;
  std::string (*line_of)(const core::PlayedMoment& moment);
};

constexpr std::array<LineFormat, 4> kLineFormats = {
    {{"csv",
      [](const core::PlayedMoment& now) { return fmt::format("{:.2f},{:.1f}", now.speed_m_s, now.direction_deg); }},
     {"key-value",
      [](const core::PlayedMoment& now) {
        return fmt::format("speed={:.2f} direction={:.1f}", now.speed_m_s, now.direction_deg);
      }},
     {"units",
      [](const core::PlayedMoment& now) {
        return fmt::format("speed: {:.2f} km/h, direction: {:.1f} deg", 3.6 * now.speed_m_s, now.direction_deg);
      }},
     {"json", [](const core::PlayedMoment& now) {
        return fmt::format("{{\"speed\":{:.2f},\"direction\":{:.1f}}}", now.speed_m_s, now.direction_deg);
      }}}};

class LineDevice final : public Device {
 public:
  explicit LineDevice(const LineFormat& format) : format_(format) {}

  std::span<const core::FaultKind> known_faults() const override { return {}; }

  /// As Serial.println() of an Arduino ends a line.
  std::vector<std::string> send_messages(const core::PlayedMoment& moment,
                                         std::optional<core::FaultKind> /*fault*/) override {
    return {format_.line_of(moment) + "\r\n"};
  }

  bool is_request(std::string_view line) const override { return line == "?"; }

 private:
  LineFormat format_;
};

}  // namespace

std::vector<std::string> line_format_names() {
  std::vector<std::string> names;
  names.reserve(kLineFormats.size());
  for (const LineFormat& format : kLineFormats) names.emplace_back(format.name);
  return names;
}

std::unique_ptr<Device> make_line_device(const std::string& format) {
  const auto* const found = std::ranges::find(kLineFormats, format, &LineFormat::name);
  if (found == kLineFormats.end()) {
    throw std::runtime_error(
        fmt::format("no simulated format \"{}\"; known: {}", format, fmt::join(line_format_names(), ", ")));
  }
  return std::make_unique<LineDevice>(*found);
}

}  // namespace yuragi::simulators::text
