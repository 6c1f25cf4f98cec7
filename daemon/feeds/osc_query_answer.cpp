#include "daemon/feeds/osc_query_answer.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"

namespace yuragi::daemon::feeds {
namespace {

using nlohmann::json;

constexpr int kNoValue = 0, kReadOnly = 1;  // of ACCESS
constexpr std::array<std::string_view, 9> kAttributes = {"FULL_PATH", "CONTENTS", "TYPE",     "ACCESS",     "VALUE",
                                                         "RANGE",     "UNIT",     "CLIPMODE", "DESCRIPTION"};

/// The unit's name in the proposal's list.
std::string_view unit_name_of(std::string_view unit) {
  if (unit == "m/s") return "speed.m/s";
  if (unit == "deg") return "angle.degree";
  if (unit == "s") return "time.second";
  return "";
}

json host_info(const std::string& name) {
  json extensions;
  for (const std::string_view extension :
       {"ACCESS", "VALUE", "RANGE", "DESCRIPTION", "CLIPMODE", "UNIT", "LISTEN", "PATH_CHANGED"})
    extensions[std::string(extension)] = true;
  return {{"NAME", name}, {"EXTENSIONS", extensions}};
}

json value_of(const OscArguments& arguments) {
  if (const auto* const text = std::get_if<std::string>(&arguments)) return json::array({*text});
  return json(std::get<std::vector<float>>(arguments));
}

/// What an address adds to its node.
void describe(json& node, const OscAddress& address, const values::Moment& moment, values::Wind wind) {
  node["DESCRIPTION"] = address.help;
  node["ACCESS"] = kReadOnly;
  node["TYPE"] = address.numbers.empty() ? "s" : std::string(address.numbers.size(), 'f');
  if (const auto arguments = address.read(moment, wind)) node["VALUE"] = value_of(*arguments);
  json ranges = json::array(), units = json::array(), clips = json::array();
  if (!address.texts.empty()) ranges.push_back({{"VALS", address.texts}});
  bool has_units = false;
  for (const OscNumber& number : address.numbers) {
    ranges.push_back({{"MIN", number.min}, {"MAX", number.max}});
    units.push_back(unit_name_of(number.unit));
    clips.push_back("none");  // a strong wind exceeds the range
    has_units = has_units || !number.unit.empty();
  }
  node["RANGE"] = ranges;
  if (has_units) node["UNIT"] = units;
  if (!clips.empty()) node["CLIPMODE"] = clips;
}

json empty_node(const std::string& path) {
  return {{"FULL_PATH", path.empty() ? "/" : path}, {"ACCESS", kNoValue}};
}

/// The node at `path` ("/wind", or "" for the root) with all below it; null: there is none.
json node_at(const std::string& path, std::span<const OscAddress> addresses, const values::Moment& moment,
             values::Wind wind) {
  json root;
  for (const OscAddress& address : addresses) {
    if (!address.path.starts_with(path)) continue;
    const std::string_view below = std::string_view(address.path).substr(path.size());
    if (!below.empty() && below.front() != '/') continue;
    if (root.is_null()) root = empty_node(path);
    json* node = &root;
    for (std::size_t end = 0; end < below.size();) {
      const std::size_t begin = end + 1;
      end = std::min(below.find('/', begin), below.size());
      json& child = (*node)["CONTENTS"][std::string(below.substr(begin, end - begin))];
      if (child.is_null()) child = empty_node(path + std::string(below.substr(0, end)));
      node = &child;
    }
    describe(*node, address, moment, wind);
  }
  return root;
}

}  // namespace

http::Response osc_query_answer(std::string_view path, std::string_view query, const std::string& name,
                                std::span<const OscAddress> addresses, const values::Moment& moment,
                                values::Wind wind) {
  if (query == "HOST_INFO") return {.body = json_text(host_info(name))};
  const bool is_root = path.empty() || path == "/";
  json node = node_at(is_root ? std::string() : std::string(path), addresses, moment, wind);
  if (node.is_null()) return {.status = 404};
  if (query.empty()) return {.body = json_text(node)};
  if (std::ranges::count(kAttributes, query) == 0) return {.status = 400};
  const auto attribute = node.find(query);
  if (attribute == node.end()) return {.status = 204};
  return {.body = json_text(json{{std::string(query), *attribute}})};
}

}  // namespace yuragi::daemon::feeds
