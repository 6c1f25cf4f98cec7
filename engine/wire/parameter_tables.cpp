#include <algorithm>
#include <cmath>
#include <span>

#include "engine/wire/decode_models.hpp"

namespace yuragi::wire {
namespace {

using Builder = flatbuffers::FlatBufferBuilder;
using Text = flatbuffers::Offset<flatbuffers::String>;
using TextList = flatbuffers::Vector<Text>;

// ---- to the schema ----

Text add_optional_text(Builder& builder, const std::optional<std::string>& text) {
  return text ? add_text(builder, *text) : Text();
}

/// A vector of the first `most` of `items`, each added by `add`.
template <class Item, class Add>
auto add_list(Builder& builder, const std::vector<Item>& items, std::size_t most, const Add& add) {
  std::vector<decltype(add(items.front()))> added;
  added.reserve(std::min(items.size(), most));
  for (const Item& item : std::span(items).first(std::min(items.size(), most))) added.push_back(add(item));
  return builder.CreateVector(added);
}

flatbuffers::Offset<fb::Parameter> add_parameter(Builder& builder, const ParameterState& parameter) {
  const auto choices = add_list(builder, parameter.choices, kMaxParameterChoices,
                                [&](const std::string& choice) { return add_text(builder, choice); });
  const auto name = add_text(builder, parameter.name);
  const auto unit = add_text(builder, parameter.unit);
  const auto help = add_text(builder, parameter.help);
  const auto left_out = add_text(builder, parameter.left_out);
  const auto default_value = add_optional_text(builder, parameter.default_value);
  const auto value = add_optional_text(builder, parameter.value);
  const auto configured = add_optional_text(builder, parameter.configured);
  fb::ParameterBuilder table(builder);
  table.add_name(name);
  table.add_unit(unit);
  table.add_kind(static_cast<fb::ParameterKind>(parameter.kind));
  if (parameter.min) table.add_min(*parameter.min);
  if (parameter.max) table.add_max(*parameter.max);
  table.add_choices(choices);
  table.add_help(help);
  table.add_left_out(left_out);
  if (parameter.default_value) table.add_default_value(default_value);
  if (parameter.value) table.add_value(value);
  if (parameter.configured) table.add_configured(configured);
  table.add_change(static_cast<fb::ParameterChange>(parameter.change));
  return table.Finish();
}

// ---- from the schema ----

bool read_optional_text(const flatbuffers::String* from, std::optional<std::string>& to) {
  return from == nullptr || read_text(from, to.emplace());
}

/// Reads each of at most `most` items by `read_item(from, to)`.
template <class From, class Item, class ReadItem>
bool read_list(const flatbuffers::Vector<From>* from, std::size_t most, std::vector<Item>& to,
               const ReadItem& read_item) {
  if (from == nullptr) return true;
  if (from->size() > most) return false;
  for (flatbuffers::uoffset_t i = 0; i < from->size(); ++i) {
    if (!read_item(from->Get(i), to.emplace_back())) return false;
  }
  return true;
}

/// Nullopt if there is none; returns false if it is not a number.
bool read_limit(const flatbuffers::Optional<double>& from, std::optional<double>& to) {
  if (from.has_value()) to = *from;
  return !to || std::isfinite(*to);
}

bool read_parameter(const fb::Parameter& from, ParameterState& to) {
  // An unknown kind of a newer server is shown, and cannot be set.
  const bool is_known = from.kind() <= fb::ParameterKind_MAX && from.change() <= fb::ParameterChange_MAX;
  to.kind = is_known ? static_cast<ParameterKind>(from.kind()) : ParameterKind::kText;
  to.change = is_known ? static_cast<KeyChange>(from.change()) : KeyChange::kTakesRestart;
  if (!read_limit(from.min(), to.min) || !read_limit(from.max(), to.max)) return false;
  if (to.min && to.max && *to.min > *to.max) return false;
  return read_list(from.choices(), kMaxParameterChoices, to.choices, read_text) && read_text(from.name(), to.name) &&
         read_text(from.unit(), to.unit) && read_text(from.help(), to.help) &&
         read_text(from.left_out(), to.left_out) && read_optional_text(from.default_value(), to.default_value) &&
         read_optional_text(from.value(), to.value) && read_optional_text(from.configured(), to.configured);
}

bool read_group(const fb::ParameterGroup& from, ParameterGroup& to) {
  return read_text(from.scene(), to.scene) && read_text(from.kind(), to.kind) &&
         read_list(from.parameters(), kMaxParameters, to.parameters,
                   [](const fb::Parameter* one, ParameterState& into) { return read_parameter(*one, into); });
}

}  // namespace

flatbuffers::Offset<fb::ParameterCommand> add_parameters(Builder& builder, const ParameterCommand& command) {
  const auto edits = add_list(builder, command.edits, kMaxParameterEdits, [&](const ParameterEdit& edit) {
    const auto key = add_text(builder, edit.key);
    return fb::CreateParameterEdit(builder, key, add_optional_text(builder, edit.value));
  });
  return fb::CreateParameterCommand(builder, add_text(builder, command.scene), edits, command.describe, command.number);
}

flatbuffers::Offset<fb::ParameterReport> add_parameters(Builder& builder, const ParameterReport& report) {
  const auto groups = add_list(builder, report.groups, kMaxScenes + 1, [&](const ParameterGroup& group) {
    const auto parameters = add_list(builder, group.parameters, kMaxParameters,
                                     [&](const ParameterState& one) { return add_parameter(builder, one); });
    const auto scene = add_text(builder, group.scene);
    return fb::CreateParameterGroup(builder, scene, add_text(builder, group.kind), parameters);
  });
  return fb::CreateParameterReport(builder, report.number, add_text(builder, report.refusal), groups);
}

bool read_parameters(const fb::ParameterCommand& from, ParameterCommand& to) {
  to.describe = from.describe();
  to.number = from.number();
  return read_text(from.scene(), to.scene) &&
         read_list(from.edits(), kMaxParameterEdits, to.edits, [](const fb::ParameterEdit* one, ParameterEdit& into) {
           return read_text(one->key(), into.key) && read_optional_text(one->value(), into.value);
         });
}

bool read_parameters(const fb::ParameterReport& from, ParameterReport& to) {
  to.number = from.number();
  return read_text(from.refusal(), to.refusal) &&
         read_list(from.groups(), kMaxScenes + 1, to.groups,
                   [](const fb::ParameterGroup* one, ParameterGroup& into) { return read_group(*one, into); });
}

}  // namespace yuragi::wire
