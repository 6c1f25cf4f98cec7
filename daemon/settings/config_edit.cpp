#include "daemon/settings/config_edit.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "daemon/settings/toml_places.hpp"
#include "engine/tables/parse_toml.hpp"

namespace yuragi::daemon::settings {
namespace {

/// How a table is written, which decides how a key is added.
enum class TableForm : std::uint8_t {
  kHeader,  ///< [sensor.calibration] with lines below
  kInline,  ///< { gain = 1.1 }
  kDotted,  ///< calibration.gain = 1.1 among the keys of the enclosing table
};

/// Collects edits of one text. Places refer to the text as it was parsed.
class SensorEditor {
 public:
  SensorEditor(std::string_view text, const toml::table& entry) : text_(text), places_(text), entry_(entry) {}

  /// Adds an edit that sets a key to a value.
  void set(const ConfigChange& change) {
    const toml::node* inner = change.table.empty() ? nullptr : entry_.get(change.table);
    const toml::table* table = change.table.empty() ? &entry_ : inner != nullptr ? inner->as_table() : nullptr;
    const std::string line = change.key + " = " + toml_value(change.value);
    if (const toml::node* old = table != nullptr ? table->get(change.key) : nullptr; old != nullptr) {
      const std::size_t from = places_.at(old->source().begin);
      edits_.push_back({from, places_.at(old->source().end) - from, toml_value(change.value)});
    } else if (table == nullptr) {
      new_tables_.push_back({change.table, line});
    } else if (const TableForm form = form_of(*table); form == TableForm::kDotted) {
      add_key(entry_, change.table + "." + line, table);
    } else {
      add_key(*table, line, table);
    }
  }

  /// The text with all edits applied.
  std::string text() {
    add_new_tables();
    // From the back, so that places before stay valid; several at one place in the order in which they were added.
    std::ranges::stable_sort(edits_, {}, &Edit::from);
    std::string result(text_);
    for (auto edit = edits_.rbegin(); edit != edits_.rend(); ++edit) result.replace(edit->from, edit->size, edit->text);
    return result;
  }

 private:
  struct Edit {
    std::size_t from, size;
    std::string text;
  };

  TableForm form_of(const toml::table& table) const {
    const std::size_t begin = places_.at(table.source().begin);
    const char first = begin < text_.size() ? text_[begin] : '[';
    return first == '{' ? TableForm::kInline : first == '[' ? TableForm::kHeader : TableForm::kDotted;
  }

  /// The last value of a table, dotted keys included; nullptr: it has none.
  const toml::node* last_value(const toml::table& table) const {
    const toml::node* last = nullptr;
    for (const auto& [key, node] : table) {
      const toml::node* candidate = &node;
      if (const toml::table* inner = node.as_table()) {
        const TableForm form = form_of(*inner);
        if (form == TableForm::kHeader) continue;
        if (form == TableForm::kDotted) candidate = last_value(*inner);
      }
      if (candidate == nullptr) continue;
      if (last == nullptr || places_.at(candidate->source().end) > places_.at(last->source().end)) last = candidate;
    }
    return last;
  }

  /// Adds "key = value" to a table, after the last value of `beside` (the table itself, or its dotted keys).
  void add_key(const toml::table& table, const std::string& line, const toml::table* beside) {
    const toml::node* last = last_value(*beside);
    if (form_of(table) == TableForm::kInline) {
      if (last != nullptr) return insert(places_.at(last->source().end), ", " + line);
      const std::size_t brace = places_.at(table.source().begin);
      // Several keys in an empty table: a space before the first, a comma before each further one.
      const bool is_first = std::ranges::none_of(edits_, [&](const Edit& edit) { return edit.from == brace + 1; });
      return insert(brace + 1, (is_first ? " " : ", ") + line);
    }
    const toml::source_position place = last != nullptr ? last->source().end : table.source().begin;
    const std::size_t first_line = last != nullptr ? last->source().begin.line : place.line;
    insert_line(place.line, std::string(places_.indentation(first_line)) + line);
  }

  void add_new_tables() {
    std::string name;
    for (const auto& [table, line] : new_tables_) {
      if (form_of(entry_) == TableForm::kInline) {
        add_key(entry_, fmt::format("{}.{}", table, line), &entry_);
        continue;
      }
      const std::string indentation(places_.indentation(entry_.source().begin.line));
      const std::size_t after = line_behind_entry();
      if (name != table) insert_line(after, fmt::format("{}[sensor.{}]", indentation, table));
      insert_line(after, indentation + line);
      name = table;
    }
    new_tables_.clear();
  }

  /// The last line of an entry: that of its last value, or of the comments that follow it directly.
  std::size_t line_behind_entry() const {
    const toml::node* last = last_value(entry_);
    const std::size_t line = last != nullptr ? last->source().end.line : entry_.source().begin.line;
    std::size_t next = line + 1;
    while (next <= places_.line_count() && places_.trimmed_line(next).starts_with('#')) ++next;
    const bool stands_alone = next > places_.line_count() || places_.trimmed_line(next).empty();
    return stands_alone ? next - 1 : line;
  }

  void insert(std::size_t at, std::string text) { edits_.push_back({at, 0, std::move(text)}); }

  /// Below a line, counted from 1.
  void insert_line(std::size_t line, const std::string& content) {
    const std::size_t at = places_.line_start(line + 1);
    const std::string end(places_.line_end());
    const bool has_end = at > 0 && text_[at - 1] == '\n';
    insert(at, has_end ? content + end : end + content);
  }

  std::string_view text_;
  TextPlaces places_;
  const toml::table& entry_;
  std::vector<Edit> edits_;
  std::vector<std::pair<std::string, std::string>> new_tables_;  // name, and a line of it
};

/// The entry of a sensor; nullptr: there is none.
toml::table* find_sensor(toml::table& root, std::string_view sensor) {
  toml::array* entries = root["sensor"].as_array();
  if (entries == nullptr) return nullptr;
  for (toml::node& element : *entries) {
    toml::table* entry = element.as_table();
    if (entry == nullptr) continue;
    const toml::node* name = entry->get(entry->contains("name") ? "name" : "driver");
    if (name != nullptr && name->value<std::string>() == sensor) return entry;
  }
  return nullptr;
}

/// Applies the changes to the parsed table, for comparison.
bool apply(toml::table& entry, std::span<const ConfigChange> changes) {
  for (const ConfigChange& change : changes) {
    toml::table* table = &entry;
    if (!change.table.empty()) {
      if (!entry.contains(change.table)) entry.insert(change.table, toml::table{});
      table = entry[change.table].as_table();
    }
    if (table == nullptr) return false;
    std::visit([&](const auto& value) { table->insert_or_assign(change.key, value); }, printable(change.value));
  }
  return true;
}

Failure by_hand(std::string_view sensor, const std::string& why, std::span<const ConfigChange> changes) {
  std::string lines;
  for (const ConfigChange& change : changes) {
    lines += fmt::format("\n  {}{}{} = {}", change.table, change.table.empty() ? "" : ".", change.key,
                         toml_value(change.value));
  }
  return {fmt::format("the entry of the sensor \"{}\" cannot be edited automatically ({}); add these lines by hand:{}",
                      sensor, why, lines)};
}

}  // namespace

std::string toml_value(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    std::string text = fmt::format("{}", *number);
    if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
    return text;
  }
  // Simple text in double quotes; toml++ formats any other.
  if (const auto* text = std::get_if<std::string>(&value)) {
    const auto is_plain = [](char sign) { return sign >= ' ' && sign <= '~' && sign != '"' && sign != '\\'; };
    if (std::ranges::all_of(*text, is_plain)) return '"' + *text + '"';
  }
  std::ostringstream out;
  std::visit([&out](const auto& held) { out << toml::value(held); }, printable(value));
  return out.str();
}

Result<std::string, Failure> edit_sensor(std::string_view toml_text, std::string_view sensor,
                                         std::span<const ConfigChange> changes) {
  for (const ConfigChange& change : changes) {
    if (std::holds_alternative<Secret>(change.value))
      return Failure{change.key + ": secrets are not written by this program; write it by hand"};
  }
  try {
    toml::table root = tables::parse_toml(toml_text);
    toml::table* entry = find_sensor(root, sensor);
    if (entry == nullptr) return Failure{fmt::format("there is no [[sensor]] named \"{}\"", sensor)};

    SensorEditor editor(toml_text, *entry);
    for (const ConfigChange& change : changes) editor.set(change);
    std::string text = editor.text();

    // Verify: the new text must equal the old one except for the changes.
    if (!apply(*entry, changes)) return by_hand(sensor, "it has a value in the place of a table", changes);
    if (tables::parse_toml(text) != root) return by_hand(sensor, "its layout is unusual", changes);
    return {boost::system::in_place_value, std::move(text)};
  } catch (const toml::parse_error& error) {
    return by_hand(sensor, "TOML: " + std::string(error.description()), changes);
  }
}

}  // namespace yuragi::daemon::settings
