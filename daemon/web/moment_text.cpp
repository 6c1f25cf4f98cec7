#include "daemon/web/moment_text.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"

namespace yuragi::daemon::web {
namespace {

std::string quoted(const std::string& text) {
  return json_text(nlohmann::json(text));
}

/// The values of a wind, without the braces around them.
std::string values_of(const values::Readout& readout) {
  std::string text;
  for (std::size_t i = 0; i < values::kQuantityCount; ++i) {
    const auto quantity = static_cast<values::Quantity>(i);
    fmt::format_to(std::back_inserter(text), "{}\"{}\":{:.4f}", i == 0 ? "" : ",",
                   values::description_of(quantity).name, readout[quantity]);
  }
  return text;
}

}  // namespace

std::string moment_text(const values::Moment& moment, std::span<const std::string> places) {
  std::string text =
      fmt::format("{{\"t\":{:.6f},\"utc\":\"{}\",\"wind\":{{{},\"source\":\"{}\"}},\"places\":{{", moment.time_s,
                  values::utc_text(moment.utc), values_of(moment.shaped), values::name_of(moment.source));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto index = values::index_of(moment.names->places, places[i]);
    const bool is_known = index && *index < moment.shaped_places.size();
    text += (i == 0 ? "" : ",") + quoted(places[i]) + ":";
    text += is_known ? "{" + values_of(moment.shaped_places[*index]) + "}" : std::string("null");
  }
  return text + "}}";
}

SharedText MomentTexts::of(const std::vector<std::string>& places) {
  const auto found = std::ranges::find(made_, places, &std::pair<std::vector<std::string>, SharedText>::first);
  if (found != made_.end()) return found->second;
  auto text = std::make_shared<const std::string>(moment_text(*moment_, places));
  made_.emplace_back(places, text);
  return text;
}

}  // namespace yuragi::daemon::web
