#include "daemon/tools/decode/recognise.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/tools/decode/decode_formats.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

Recognition recognition_of(const UnitFormat& format, std::span<const std::string> lines) {
  Recognition recognition{.format = format.name};
  const auto decoder = format.make({});
  const auto count = [&recognition](const UnitDecoder::Outcome& outcome) {
    if (outcome) {
      if (outcome->wind.speed_m_s) ++recognition.winds;
      return;
    }
    using drivers::decode::Refusal;
    const Refusal why = outcome.error().why;
    if (why != Refusal::kMalformed && why != Refusal::kTooShort) ++recognition.refused[name_of(why)];
  };
  for (const std::string& line : lines) {
    if (line.size() > format.longest_line) continue;
    decoder->take({{reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, {}}, count);
  }
  decoder->finish(count);
  return recognition;
}

}  // namespace

std::vector<Recognition> recognise(std::span<const std::string> lines) {
  std::vector<Recognition> all;
  for (const UnitFormat& format : unit_formats()) {
    // `line` has no form of its own: any number is one.
    if (!format.is_text || format.name == "line") continue;
    Recognition recognition = recognition_of(format, lines);
    if (recognition.winds > 0 || !recognition.refused.empty()) all.push_back(std::move(recognition));
  }
  std::ranges::stable_sort(all, std::ranges::greater(), &Recognition::winds);
  return all;
}

std::string recognised_text(std::span<const std::string> lines) {
  const std::vector<Recognition> all = recognise(lines);
  if (all.empty() || all.front().winds == 0) return {};
  return fmt::format("{} ({} in {})", all.front().format, count_text(all.front().winds, "wind"),
                     count_text(lines.size(), "line"));
}

}  // namespace yuragi::daemon::tools::decode
