#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi {

/// What a parameter can be. Text that must be one of a few words has `choices`.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string, Secret>;

/// What may be printed, recorded or sent of a value: the value itself, and of a secret Secret::printable().
using PrintableValue = std::variant<bool, std::int64_t, double, std::string>;
PrintableValue printable(const ParameterValue& value);

/// What a running daemon does with a new value of a key.
enum class KeyChange : std::uint8_t {
  kAtOnce,        ///< it takes effect
  kCrossFade,     ///< what it belongs to is made anew, and the old one fades out
  kTakesRestart,  ///< it takes effect when the daemon is started again
  kTakesReload,   ///< it names a file, which is read only together with the configuration
};

/// A parameter that describes itself: config checking, --help, the viewer's sliders and the reference page all read
/// this one description. Constants of this type stand beside what they set.
struct Parameter {
  std::string_view name;
  std::string_view unit = {};  ///< "m/s", "Hz"; empty for a pure number or a text
  ParameterValue default_value;
  double min = -std::numeric_limits<double>::infinity();  ///< numbers only, inclusive
  double max = std::numeric_limits<double>::infinity();
  std::string_view help;
  std::span<const std::string_view> choices = {};  ///< texts only; empty: any text
  /// What it means where it is not given, which none of its values can express ("at the windward edge"). Then it has no
  /// default, and values have it only if it was given. Empty: default_value, of which otherwise only the type counts.
  std::string_view left_out = {};
  /// What a new value does; nullopt: the table's own.
  std::optional<KeyChange> change = {};
  /// texts only: the path of a file with a secret in it, which other users of the machine are not to read
  bool is_secret_file = false;
  /// texts only: a script or the bytes for a device, in which control characters and line breaks are allowed
  bool takes_control_characters = false;
};

/// What is wrong with a given value; the file and line are the caller's to add.
struct ParameterError {
  std::string name;
  std::string message;  ///< what is wrong, and what is allowed
};

[[noreturn]] inline void throw_exception_from_error(const ParameterError& error, const boost::source_location&) {
  throw std::runtime_error(error.name + ": " + error.message);
}

/// The values of a table of parameters, of their declared types and within their ranges. Each declared one is present,
/// but for those whose being left out has a meaning (Parameter::left_out): they are present where they were given.
class ParameterValues {
 public:
  using Map = std::map<std::string, ParameterValue, std::less<>>;

  /// Fills what `given` leaves out with defaults. Refuses unknown names, wrong types (an integer passes for a number, a
  /// text for a secret), numbers out of range or not finite, texts that are not among the choices, texts with a
  /// user's name and password in them, and texts with control characters. No error shows a secret.
  static Result<ParameterValues, ParameterError> resolve(std::span<const Parameter> table, const Map& given);

  /// Is there a value of this name? What has a default always has one.
  bool has(std::string_view name) const { return values_.contains(name); }

  bool flag(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  double number(std::string_view name) const;
  const std::string& text(std::string_view name) const;
  /// Throws std::runtime_error if it is withheld (Secret::is_withheld): the values are of a recording or of a
  /// configuration that was printed, and the secret has to be given again.
  const Secret& secret(std::string_view name) const;

  const Map& all() const { return values_; }

  /// Replaces a value with one of the same type, which the caller vouches for (a command-line option, say).
  void set(std::string_view name, const ParameterValue& value);

  /// Takes over the value that `other`, of the same table, has of this name; none if it has none.
  void take_over(const std::string& name, const ParameterValues& other);

 private:
  Map values_;
};

/// One sentence on what a parameter takes: "number from 0 to 40 m/s, default 4", or "number; left out: at the edge".
std::string describe_allowed(const Parameter& parameter);

/// A value as a person types it behind "KEY=": a number, true or false, or a text without quotes. What is not of the
/// parameter's type stays the text that it is, so that ParameterValues::resolve() refuses it with the reason.
ParameterValue typed_value(const Parameter& parameter, std::string_view text);

/// The reverse: numbers with the fewest digits that read back as the same number. Of a secret, Secret::printable().
std::string value_text(const ParameterValue& value);

}  // namespace yuragi
