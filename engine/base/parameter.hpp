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

/// The types of a parameter. Text that must be one of a few words has `choices`.
using ParameterValue = std::variant<bool, std::int64_t, double, std::string, Secret>;

/// The printable form of a value, for prints, recordings and messages: the value itself, or Secret::printable().
using PrintableValue = std::variant<bool, std::int64_t, double, std::string>;
PrintableValue printable(const ParameterValue& value);

/// The effect of a new value of a key in a running daemon.
enum class KeyChange : std::uint8_t {
  kAtOnce,        ///< it takes effect
  kCrossFade,     ///< the object is made again, and the old one fades out
  kTakesRestart,  ///< takes effect at the next start of the daemon
  kTakesReload,   ///< it names a file, which is read only together with the configuration
};

/// A parameter that describes itself: config checking, --help, the viewer's sliders and the reference page all read
/// this one description. Constants of this type are next to the members that they set.
struct Parameter {
  std::string_view name;
  std::string_view unit = {};  ///< "m/s", "Hz"; empty for a pure number or a text
  ParameterValue default_value;
  double min = -std::numeric_limits<double>::infinity();  ///< numbers only, inclusive
  double max = std::numeric_limits<double>::infinity();
  std::string_view help;
  std::span<const std::string_view> choices = {};  ///< texts only; empty: any text
  /// Meaning of a missing value that no value can express ("at the windward edge"). Then the parameter has no default,
  /// and is present only if given. Empty: default_value is used; otherwise only its type counts.
  std::string_view left_out = {};
  /// Effect of a new value; nullopt: the table's.
  std::optional<KeyChange> change = {};
  /// texts only: the path of a file with a secret, which other users of the machine must not read
  bool is_secret_file = false;
  /// texts only: a script or the bytes for a device, in which control characters and line breaks are allowed
  bool takes_control_characters = false;
};

/// The error in a given value; the caller adds file and line.
struct ParameterError {
  std::string name;
  std::string message;  ///< what is wrong, and what is allowed
};

[[noreturn]] inline void throw_exception_from_error(const ParameterError& error, const boost::source_location&) {
  throw std::runtime_error(error.name + ": " + error.message);
}

/// The values of a table of parameters, of their declared types and within their ranges. Each declared one is present,
/// except those with Parameter::left_out, which are present only if given.
class ParameterValues {
 public:
  using Map = std::map<std::string, ParameterValue, std::less<>>;

  /// Adds the defaults of values that are missing in `given`. Refuses unknown names, wrong types (an integer passes for
  /// a number, a text for a secret), numbers out of range or not finite, texts that are not among the choices, texts
  /// with a user's name and password in them, and texts with control characters. No error shows a secret.
  static Result<ParameterValues, ParameterError> resolve(std::span<const Parameter> table, const Map& given);

  /// Returns true if there is a value of this name. Always true for parameters with a default.
  bool has(std::string_view name) const { return values_.contains(name); }

  bool flag(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  double number(std::string_view name) const;
  const std::string& text(std::string_view name) const;
  /// Throws std::runtime_error if it is withheld (Secret::is_withheld): the values come from a recording or a printed
  /// configuration, and the secret must be given again.
  const Secret& secret(std::string_view name) const;

  const Map& all() const { return values_; }

  /// Replaces a value with one of the same type, which the caller has checked (a command-line option, for example).
  void set(std::string_view name, const ParameterValue& value);

  /// Copies the value of this name from `other`, of the same table; removes it if `other` has none.
  void take_over(const std::string& name, const ParameterValues& other);

 private:
  Map values_;
};

/// One sentence on the allowed values of a parameter: "number from 0 to 40 m/s, default 4", or "number; left out: at
/// the edge".
std::string describe_allowed(const Parameter& parameter);

/// Parses a value as typed after "KEY=": a number, true or false, or a text without quotes. A text that is not of the
/// parameter's type is returned as text, so that ParameterValues::resolve() refuses it with the reason.
ParameterValue typed_value(const Parameter& parameter, std::string_view text);

/// The reverse: numbers with the fewest digits that read back as the same number; for a secret, Secret::printable().
std::string value_text(const ParameterValue& value);

}  // namespace yuragi
