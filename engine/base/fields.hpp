#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/base/parameter.hpp"

namespace yuragi {

namespace fields {

template <class Type>
inline constexpr bool kIsOptional = false;
template <class Type>
inline constexpr bool kIsOptional<std::optional<Type>> = true;

/// A value, converted to the member's type.
template <class Member>
void take(Member& member, const Parameter& parameter, const ParameterValue& value) {
  if constexpr (kIsOptional<Member>) {
    take(member.emplace(), parameter, value);
  } else if constexpr (std::is_enum_v<Member>) {
    member = static_cast<Member>(std::ranges::find(parameter.choices, std::get<std::string>(value)) -
                                 parameter.choices.begin());
  } else if constexpr (std::is_same_v<Member, bool> || std::is_same_v<Member, Secret>) {
    member = std::get<Member>(value);
  } else if constexpr (std::is_floating_point_v<Member>) {
    member = static_cast<Member>(std::get<double>(value));
  } else if constexpr (std::is_integral_v<Member>) {
    member = static_cast<Member>(std::get<std::int64_t>(value));
  } else {
    member = std::get<std::string>(value);
  }
}

/// The member, limited to the parameter's range; `otherwise` if it is not a number, or not an enumerator.
template <class Member>
void limit(Member& member, const Parameter& parameter, const Member& otherwise) {
  if constexpr (std::is_enum_v<Member>) {
    if (static_cast<std::size_t>(member) >= parameter.choices.size()) member = otherwise;
  } else if constexpr (std::is_floating_point_v<Member>) {
    member = std::isfinite(member) ? std::clamp(member, parameter.min, parameter.max) : otherwise;
  } else if constexpr (std::is_same_v<Member, std::optional<double>>) {
    if (member && !std::isfinite(*member)) member.reset();
    if (member) member = std::clamp(*member, parameter.min, parameter.max);
  }
}

/// The member reached from `settings` through the pointers in order.
template <class Settings>
Settings& follow(Settings& settings) noexcept {
  return settings;
}
template <class Settings, class First, class... Rest>
auto& follow(Settings& settings, First first, Rest... rest) noexcept {
  return follow(std::invoke(first, settings), rest...);
}

/// A function's argument type, as a ParameterValue holds it.
template <class Returned, class Argument>
std::conditional_t<std::is_same_v<Argument, std::string_view>, std::string, std::remove_cvref_t<Argument>> argument_of(
    const std::function<Returned(Argument)>&);

}  // namespace fields

/// A member of a member, and so on, for a Field: member_of(&WindTable::wind, &WindConfig::gustiness).
template <class... Members>
constexpr auto member_of(Members... members) {
  return [members...](auto& settings) -> auto& {
    return fields::follow(settings, members...);
  };
}

/// A key of a table of settings, defined once: its description, and the member of S that its value fills. Only members
/// with a key change.
template <class S>
class Field {
 public:
  /// `member`: of S, or a function that returns a reference into an S. Its type decides: numbers are converted, a word
  /// becomes the enumerator at its place among the choices, texts and secrets are copied, and an optional stays empty
  /// if the key is missing.
  template <class Member>
  Field(Parameter parameter, Member member)
      : parameter_(std::move(parameter)),
        fill_([member](S& settings, const Parameter& description, const ParameterValue& value) {
          fields::take(std::invoke(member, settings), description, value);
          return std::optional<std::string>();
        }),
        limit_([member](S& settings, const Parameter& description, S& otherwise) {
          fields::limit(std::invoke(member, settings), description, std::invoke(member, otherwise));
        }) {}

  /// `convert` makes the member from the value, which it takes in one of ParameterValue's types. It returns the
  /// member's value, or a Result whose error has a message: what is wrong, and what is allowed.
  template <class Member, class Convert>
  Field(Parameter parameter, Member member, Convert convert)
      : parameter_(std::move(parameter)),
        fill_([member, convert](S& settings, const Parameter&, const ParameterValue& value) {
          using Value = decltype(fields::argument_of(std::function{convert}));
          auto converted = convert(std::get<Value>(value));
          if constexpr (requires { converted.error(); }) {
            if (!converted) return std::optional<std::string>(converted.error().message);
            std::invoke(member, settings) = std::move(*converted);
          } else {
            std::invoke(member, settings) = std::move(converted);
          }
          return std::optional<std::string>();
        }) {}

  /// A key that fills no member: its value is read from the ParameterValues.
  Field(Parameter parameter) : parameter_(std::move(parameter)) {}

  const Parameter& parameter() const noexcept { return parameter_; }

 private:
  template <class>
  friend class Fields;

  Parameter parameter_;
  std::function<std::optional<std::string>(S&, const Parameter&, const ParameterValue&)> fill_;
  std::function<void(S&, const Parameter&, S&)> limit_;
};

/// The keys of a table of settings, in the order in which they are shown. Pure; thread-safe once constructed.
template <class S>
class Fields {
 public:
  Fields(std::initializer_list<Field<S>> fields) : fields_(fields) {
    parameters_.reserve(fields_.size());
    for (const Field<S>& field : fields_) parameters_.push_back(field.parameter());
  }

  std::span<const Parameter> parameters() const noexcept { return parameters_; }

  /// Fills the members from the present values, which ParameterValues::resolve() has checked. Returns the errors of
  /// conversions, with their keys; the members of these keys keep their values.
  std::vector<ParameterError> fill(S& settings, const ParameterValues::Map& values) const {
    std::vector<ParameterError> errors;
    for (const Field<S>& field : fields_) {
      const auto found = values.find(field.parameter_.name);
      if (found == values.end() || !field.fill_) continue;
      if (auto message = field.fill_(settings, field.parameter_, found->second)) {
        errors.push_back({std::string(field.parameter_.name), std::move(*message)});
      }
    }
    return errors;
  }

  /// Settings of values that no conversion refuses.
  S of(const ParameterValues& values) const {
    S settings{};
    for (const ParameterError& error : fill(settings, values.all())) throw_exception_from_error(error, {});
    return settings;
  }

  /// Returns `settings` with each number within the limits of its key: for untrusted input. `otherwise` replaces
  /// numbers that are not finite, and invalid enumerators. Members of conversions are unchanged.
  S within_limits(S settings, S otherwise) const {
    for (const Field<S>& field : fields_) {
      if (field.limit_) field.limit_(settings, field.parameter_, otherwise);
    }
    return settings;
  }

 private:
  std::vector<Field<S>> fields_;
  std::vector<Parameter> parameters_;
};

/// The keys of two tables that fill different structs of the same values.
inline std::vector<Parameter> together(std::span<const Parameter> first, std::span<const Parameter> second) {
  std::vector<Parameter> all(first.begin(), first.end());
  all.insert(all.end(), second.begin(), second.end());
  return all;
}

}  // namespace yuragi
