#include "daemon/tools/logs/key_reader.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/csv/csv_layout.hpp"
#include "daemon/tools/csv/csv_time.hpp"
#include "daemon/tools/csv/csv_unit_choice.hpp"
#include "daemon/tools/csv/csv_value.hpp"
#include "daemon/tools/csv/csv_words.hpp"
#include "daemon/tools/logs/log_time.hpp"
#include "drivers/decode/json_value.hpp"
#include "drivers/decode/network/station_push.hpp"
#include "engine/base/compass.hpp"
#include "engine/base/json_text.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::tools::logs {
namespace {

namespace decode = drivers::decode;
using decode::Refusal;

constexpr std::size_t kMaxKeys = 200;

bool begins_key(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_in_key(char c) {
  return begins_key(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.' || c == '/';
}

void add(KeyedLine& line, std::string key, std::string value) {
  if (line.keys.size() >= kMaxKeys) return;
  line.keys.push_back(std::move(key));
  line.values.push_back(std::move(value));
}

/// The members of an object, and of those in it: "wind.speed".
void add_members(KeyedLine& line, const nlohmann::json& object, const std::string& path, int depth) {
  constexpr int kMaxDepth = 3;
  for (const auto& [name, value] : object.items()) {
    const std::string key = path.empty() ? name : fmt::format("{}.{}", path, name);
    if (value.is_object() && depth < kMaxDepth) add_members(line, value, key, depth + 1);
    if (value.is_number()) add(line, key, json_text(value));
    if (value.is_string()) add(line, key, value.get<std::string>());
    if (value.is_null()) add(line, key, {});
  }
}

std::optional<KeyedLine> split_json(std::string_view text, std::size_t begin) {
  const nlohmann::json json = decode::parse_json(text.substr(begin));
  if (!json.is_object()) return std::nullopt;
  KeyedLine line{.prefix = text.substr(0, begin)};
  add_members(line, json, {}, 1);
  if (line.keys.empty()) return std::nullopt;
  return line;
}

/// "GET /path?a=1&b=2 HTTP/1.1", or "a=1&b=2". What a logger wrote before it is no part of it.
std::optional<KeyedLine> split_form(std::string_view text) {
  const std::size_t ampersand = text.find('&');
  if (ampersand == std::string_view::npos || text.find('=') > ampersand) return std::nullopt;
  std::size_t begin = text.rfind(' ', ampersand);
  begin = begin == std::string_view::npos ? 0 : begin + 1;
  std::string_view form = text.substr(begin);
  form = form.substr(0, form.find(' '));
  if (form.starts_with('/')) form = decode::network::split_push_target(form).form;
  KeyedLine line{.prefix = text.substr(0, begin)};
  while (!form.empty()) {
    const std::string_view pair = form.substr(0, form.find('&'));
    form.remove_prefix(std::min(form.size(), pair.size() + 1));
    const auto sign = pair.find('=');
    if (sign == std::string_view::npos || sign == 0) continue;
    add(line, decode::network::percent_decoded(pair.substr(0, sign)),
        decode::network::percent_decoded(pair.substr(sign + 1)));
  }
  if (line.keys.empty()) return std::nullopt;
  return line;
}

/// A key ends at '=' or ':', with blanks before it or not; its value ends where the next one's key begins.
std::optional<KeyedLine> split_text(std::string_view text) {
  struct Key {
    std::size_t begin;
    std::size_t end;
    std::size_t value;
  };
  std::vector<Key> keys;
  for (std::size_t i = 1; i < text.size() && keys.size() < kMaxKeys; ++i) {
    if (text[i] != '=' && text[i] != ':') continue;
    std::size_t end = i;
    while (end > 0 && (text[end - 1] == ' ' || text[end - 1] == '\t')) --end;
    std::size_t begin = end;
    while (begin > 0 && is_in_key(text[begin - 1])) --begin;
    if (begin == end || !begins_key(text[begin])) continue;
    if (!keys.empty() && begin < keys.back().value) continue;
    keys.push_back({begin, end, i + 1});
  }
  if (keys.empty()) return std::nullopt;
  constexpr std::string_view kAround = " \t,;&|#]})\r\"";
  KeyedLine line{.prefix = text.substr(0, keys.front().begin)};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::size_t next = i + 1 < keys.size() ? keys[i + 1].begin : text.size();
    std::string_view value = text.substr(keys[i].value, next - keys[i].value);
    const auto first = value.find_first_not_of(kAround);
    value = first == std::string_view::npos ? std::string_view()
                                            : value.substr(first, value.find_last_not_of(kAround) - first + 1);
    add(line, std::string(text.substr(keys[i].begin, keys[i].end - keys[i].begin)), std::string(value));
  }
  return line;
}

std::optional<double> number_of(const csv::Columns& columns, csv::Role role, const KeyedLine& line) {
  const auto& column = columns.at(role);
  if (!column) return std::nullopt;
  const std::string& text = line.values[column->index];
  if (csv::is_missing_word(text)) return std::nullopt;
  const auto number = parse_number(text, csv::dimension_of(role));
  if (!number) return std::nullopt;
  const csv::Unit unit = number->unit.value_or(column->unit.value_or(csv::Unit{}));
  const double base = csv::in_base(unit, number->value);
  if (csv::is_missing_number(role, number->value, base)) return std::nullopt;
  return base;
}

/// A direction that is none leaves the speed.
std::optional<double> direction_of(const csv::Columns& columns, const KeyedLine& line, bool is_toward) {
  const auto& column = columns.at(csv::Role::kDirection);
  if (!column) return std::nullopt;
  auto direction_deg = compass_point_deg(line.values[column->index]);
  if (!direction_deg) direction_deg = number_of(columns, csv::Role::kDirection, line);
  if (!direction_deg || *direction_deg < -180.0 || *direction_deg > 360.0) return std::nullopt;
  constexpr double kTurn_deg = 360.0;
  return decode::wrapped_direction_deg(*direction_deg + (is_toward ? kTurn_deg / 2.0 : 0.0) +
                                       (*direction_deg < 0.0 ? kTurn_deg : 0.0));
}

Result<decode::DecodedWind, Refusal> wind_of(const csv::Columns& columns, const KeyedLine& line,
                                             const csv::ImportOptions& options) {
  decode::DecodedWind wind;
  if (columns.at(csv::Role::kSpeed)) {
    wind.speed_m_s = number_of(columns, csv::Role::kSpeed, line);
    wind.direction_deg = direction_of(columns, line, options.direction_is_toward);
  } else {
    const auto u_m_s = number_of(columns, csv::Role::kU, line);
    const auto v_m_s = number_of(columns, csv::Role::kV, line);
    if (!u_m_s || !v_m_s) return Refusal::kInvalid;
    const wind::Vector blowing = (options.components_are_from ? -1.0 : 1.0) * wind::Vector{*u_m_s, *v_m_s};
    wind.speed_m_s = speed_of(blowing);
    if (*wind.speed_m_s > 0.0) wind.direction_deg = wind::direction_from_deg(blowing);
  }
  if (!wind.speed_m_s) return Refusal::kInvalid;
  wind.gust_m_s = number_of(columns, csv::Role::kGust, line);
  return decode::checked(wind);
}

std::optional<wind::StationQuantities> quantities_of(const csv::Columns& columns, const KeyedLine& line) {
  wind::StationQuantities quantities;
  bool has_any = false;
  for (std::size_t i = 0; i < csv::kQuantityRoles.size(); ++i) {
    const auto value = number_of(columns, csv::kQuantityRoles[i], line);
    quantities.*wind::kStationQuantities[i].value = value;
    has_any = has_any || value;
  }
  if (!has_any) return std::nullopt;
  return quantities;
}

/// The time that the message has itself, with its date.
std::optional<csv::Time> time_of(const csv::Columns& columns, const KeyedLine& line, csv::TimeFormat format) {
  std::string text;
  for (const csv::TimePart& part : columns.time_parts) text += (text.empty() ? "" : " ") + line.values[part.column];
  auto time = leading_time(text, format);
  if (time && !time->utc_offset && columns.zone) {
    if (const auto zone = csv::Zone::parse(*columns.zone)) {
      if (const auto utc = zone->to_utc(time->clock, std::nullopt)) time = csv::Time{*utc, Nanoseconds{0}};
    }
  }
  return time;
}

/// Which of several stations sent it, as rtl_433 names them.
std::string station_of(const KeyedLine& line) {
  std::string station;
  for (const std::string_view name : {"model", "id", "channel"}) {
    const auto found = std::ranges::find(line.keys, name);
    if (found == line.keys.end()) continue;
    station += " " + line.values[static_cast<std::size_t>(found - line.keys.begin())];
  }
  return station;
}

}  // namespace

std::optional<KeyedLine> split_keyed_line(std::string_view line) {
  if (const auto brace = line.find('{'); brace != std::string_view::npos) {
    if (auto split = split_json(line, brace)) return split;
  }
  if (auto split = split_form(line)) return split;
  return split_text(line);
}

const KeyReader::Form& KeyReader::form_of(const KeyedLine& line) {
  const auto known = std::ranges::find(forms_, line.keys, &Form::keys);
  if (known != forms_.end()) return *known;
  Form form{.keys = line.keys};
  auto columns = csv::choose_keys(line.keys, options_.columns, line.values);
  if (columns) {
    csv::Layout layout;
    layout.header = line.keys;
    layout.row = line.values;
    layout.columns = std::move(*columns);
    const auto units = csv::choose_units(layout, options_);
    if (!units) form.failure = units.error().message;
    form.columns = std::move(layout.columns);
    const auto& speed = form.columns->at(csv::Role::kSpeed);
    form.source = "key " + (speed ? speed->name : form.columns->at(csv::Role::kU)->name);
  }
  constexpr std::size_t kMaxForms = 64;
  if (forms_.size() >= kMaxForms) forms_.erase(forms_.begin());
  forms_.push_back(std::move(form));
  return forms_.back();
}

std::optional<Message> KeyReader::message_of(const KeyedLine& line) {
  const Form& form = form_of(line);
  if (!form.columns) return std::nullopt;
  Message message;
  message.prefix = line.prefix;
  message.source = form.source + station_of(line);
  if (!form.failure.empty()) return message;
  message.wind = wind_of(*form.columns, line, options_);
  message.quantities = quantities_of(*form.columns, line);
  message.time = time_of(*form.columns, line, options_.time_format);
  return message;
}

std::optional<Message> KeyReader::take(std::string_view text) {
  has_absorbed_ = false;
  auto line = split_keyed_line(text);
  has_keys_ = line && line->keys.size() > 1;
  if (!line) return std::nullopt;
  if (has_keys_) return message_of(*line);
  std::optional<Message> ended;
  if (std::ranges::find(block_.keys, line->keys[0]) != block_.keys.end()) ended = finish();
  if (block_.keys.empty()) block_prefix_ = line->prefix;
  has_absorbed_ = true;
  add(block_, std::move(line->keys[0]), std::move(line->values[0]));
  return ended;
}

std::optional<Message> KeyReader::finish() {
  if (block_.keys.empty()) return std::nullopt;
  block_.prefix = block_prefix_;
  auto message = message_of(block_);
  block_ = {};
  return message;
}

std::vector<std::string> KeyReader::describe(std::string_view source) const {
  std::vector<std::string> lines;
  for (const Form& form : forms_) {
    if (!form.columns || !source.starts_with(form.source)) continue;
    if (!form.failure.empty()) return {form.failure};
    for (const csv::Role role :
         {csv::Role::kSpeed, csv::Role::kU, csv::Role::kV, csv::Role::kDirection, csv::Role::kGust}) {
      const auto& column = form.columns->at(role);
      if (!column) continue;
      lines.push_back(fmt::format("{} from \"{}\" ({}, {})", name_of(role), column->name,
                                  column->unit ? column->unit->name : std::string_view("?"), column->unit_source));
    }
    return lines;
  }
  return lines;
}

}  // namespace yuragi::daemon::tools::logs
