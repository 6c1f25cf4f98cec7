#include "simulators/text/line_device.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace yuragi::simulators::text {
namespace {

class LineDevice final : public TextDevice {
 public:
  explicit LineDevice(bool has_keys) : has_keys_(has_keys) {}

  std::span<const FaultKind> known_faults() const override { return {}; }

  std::vector<std::string> send_messages(const PlayedMoment& moment, std::optional<FaultKind> /*fault*/) override {
    // As Serial.println() of an Arduino ends a line.
    constexpr std::string_view kKeys = "speed={:.2f} direction={:.1f}\r\n";
    constexpr std::string_view kColumns = "{:.2f},{:.1f}\r\n";
    return {fmt::format(fmt::runtime(has_keys_ ? kKeys : kColumns), moment.speed_m_s, moment.direction_deg)};
  }

  bool is_request(std::string_view line) const override { return line == "?"; }

 private:
  bool has_keys_;
};

}  // namespace

std::vector<std::string> line_format_names() {
  return {"csv", "key-value"};
}

std::unique_ptr<TextDevice> make_line_device(const std::string& format) {
  const auto names = line_format_names();
  if (std::ranges::find(names, format) == names.end()) {
    throw std::runtime_error(fmt::format("no simulated format \"{}\"; known: {}", format, fmt::join(names, ", ")));
  }
  return std::make_unique<LineDevice>(format == "key-value");
}

}  // namespace yuragi::simulators::text
