#include "engine/base/parameter.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "engine/base/printable_text.hpp"

namespace yuragi {
namespace {

std::string_view type_name(const ParameterValue& value) {
  static constexpr std::string_view kNames[] = {"true or false", "whole number", "number", "text",
                                                "text that is never printed or recorded"};
  return kNames[value.index()];
}

std::string to_text(const ParameterValue& value) {
  std::ostringstream out;
  std::visit(
      [&out](const auto& held) {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, bool>) {
          out << (held ? "true" : "false");
        } else if constexpr (std::is_same_v<Held, std::string>) {
          out << '"' << held << '"';
        } else {
          out << held;
        }
      },
      printable(value));
  return out.str();
}

/// The value in the type that the parameter declares, or an error without a name.
Result<ParameterValue, ParameterError> convert(const Parameter& parameter, const ParameterValue& given) {
  const auto refuse = [&](const std::string& what) {
    return ParameterError{std::string(parameter.name), what + "; allowed: " + describe_allowed(parameter)};
  };

  ParameterValue value = given;
  if (std::holds_alternative<double>(parameter.default_value) && std::holds_alternative<std::int64_t>(given)) {
    value = static_cast<double>(std::get<std::int64_t>(given));
  }
  const auto* given_text = std::get_if<std::string>(&given);
  if (std::holds_alternative<Secret>(parameter.default_value) && !std::holds_alternative<Secret>(given)) {
    if (given_text == nullptr) return refuse("is a " + std::string(type_name(given)));
    return ParameterValue(Secret(*given_text));
  }
  if (value.index() != parameter.default_value.index()) {
    return refuse("is a " + std::string(type_name(given)) + " (" + to_text(given) + ")");
  }

  if (given_text != nullptr && holds_credentials(*given_text)) {
    return refuse(
        "has a user's name and password in it, which would be printed and recorded; give them by keys of their own");
  }

  if (given_text != nullptr && !parameter.takes_control_characters && !is_printable(*given_text)) {
    return refuse("has a control character in it");
  }

  const auto check_range = [&](double number) { return number >= parameter.min && number <= parameter.max; };
  if (const auto* number = std::get_if<double>(&value); number && (!std::isfinite(*number) || !check_range(*number))) {
    return refuse("is " + to_text(value));
  }
  if (const auto* whole = std::get_if<std::int64_t>(&value); whole && !check_range(static_cast<double>(*whole))) {
    return refuse("is " + to_text(value));
  }
  if (const auto* text = std::get_if<std::string>(&value); text && !parameter.choices.empty()) {
    bool known = false;
    for (const std::string_view choice : parameter.choices) known = known || choice == *text;
    if (!known) return refuse("is " + to_text(value));
  }
  return value;
}

template <class T>
const T& held(const ParameterValues::Map& values, std::string_view name) {
  const auto found = values.find(name);
  if (found == values.end()) throw std::logic_error("no parameter named " + std::string(name));
  return std::get<T>(found->second);
}

}  // namespace

PrintableValue printable(const ParameterValue& value) {
  return std::visit(
      [](const auto& held) -> PrintableValue {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, Secret>) {
          return std::string(held.printable());
        } else {
          return held;
        }
      },
      value);
}

std::string describe_allowed(const Parameter& parameter) {
  std::ostringstream out;
  if (!parameter.choices.empty()) {
    const char* separator = "one of ";
    for (const std::string_view choice : parameter.choices) {
      out << separator << '"' << choice << '"';
      separator = ", ";
    }
  } else {
    out << type_name(parameter.default_value);
    if (std::isfinite(parameter.min) && std::isfinite(parameter.max)) {
      out << " from " << parameter.min << " to " << parameter.max;
    } else if (std::isfinite(parameter.min)) {
      out << " of at least " << parameter.min;
    } else if (std::isfinite(parameter.max)) {
      out << " of at most " << parameter.max;
    }
    if (!parameter.unit.empty()) out << ' ' << parameter.unit;
  }
  if (parameter.left_out.empty()) {
    out << ", default " << to_text(parameter.default_value);
  } else {
    out << "; left out: " << parameter.left_out;
  }
  return out.str();
}

ParameterValue typed_value(const Parameter& parameter, std::string_view text) {
  const auto read = [text](auto number) -> ParameterValue {
    const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool is_read = end.ec == std::errc{} && end.ptr == text.data() + text.size();
    return is_read ? ParameterValue(number) : ParameterValue(std::string(text));
  };
  if (std::holds_alternative<double>(parameter.default_value)) return read(0.0);
  if (std::holds_alternative<std::int64_t>(parameter.default_value)) return read(std::int64_t{0});
  if (std::holds_alternative<bool>(parameter.default_value) && (text == "true" || text == "false")) {
    return text == "true";
  }
  return std::string(text);
}

std::string value_text(const ParameterValue& value) {
  const auto written = [](auto number) {
    std::array<char, 32> digits{};
    return std::string(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
  };
  const PrintableValue shown = printable(value);
  if (const auto* flag = std::get_if<bool>(&shown)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&shown)) return written(*whole);
  if (const auto* number = std::get_if<double>(&shown)) return written(*number);
  return std::get<std::string>(shown);
}

Result<ParameterValues, ParameterError> ParameterValues::resolve(std::span<const Parameter> table, const Map& given) {
  ParameterValues resolved;
  for (const Parameter& parameter : table) {
    if (parameter.left_out.empty()) resolved.values_.emplace(parameter.name, parameter.default_value);
  }

  for (const auto& [name, value] : given) {
    const Parameter* parameter = nullptr;
    for (const Parameter& candidate : table) {
      if (candidate.name == name) parameter = &candidate;
    }
    if (parameter == nullptr) {
      std::string known;
      for (const Parameter& candidate : table) known.append(known.empty() ? "" : ", ").append(candidate.name);
      return ParameterError{name, "is not a known key here; known: " + known};
    }
    auto converted = convert(*parameter, value);
    if (!converted) return converted.error();
    resolved.values_.insert_or_assign(name, *converted);
  }
  return resolved;
}

bool ParameterValues::flag(std::string_view name) const {
  return held<bool>(values_, name);
}
std::int64_t ParameterValues::integer(std::string_view name) const {
  return held<std::int64_t>(values_, name);
}
double ParameterValues::number(std::string_view name) const {
  return held<double>(values_, name);
}
const std::string& ParameterValues::text(std::string_view name) const {
  return held<std::string>(values_, name);
}

const Secret& ParameterValues::secret(std::string_view name) const {
  const auto& secret = held<Secret>(values_, name);
  if (secret.is_withheld()) {
    throw std::runtime_error(std::string(name) + ": is \"" + std::string(Secret::kWithheld) +
                             "\", which stands for it in what was printed or recorded; give the secret itself");
  }
  return secret;
}

void ParameterValues::set(std::string_view name, const ParameterValue& value) {
  const auto found = values_.find(name);
  if (found == values_.end() || found->second.index() != value.index()) {
    throw std::logic_error("no parameter of that type named " + std::string(name));
  }
  found->second = value;
}

void ParameterValues::take_over(const std::string& name, const ParameterValues& other) {
  values_.erase(name);
  if (const auto found = other.values_.find(name); found != other.values_.end()) values_.insert(*found);
}

}  // namespace yuragi
