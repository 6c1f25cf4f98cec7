#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace yuragi {

/// A text that must not be shown, such as a password. It has no conversion to a text, no formatter and no output
/// operator: prints, recordings and messages contain printable(). Thread-safe: as a std::string is.
class Secret {
 public:
  /// Replaces the secret in printed or recorded configurations.
  static constexpr std::string_view kWithheld = "(secret)";

  Secret() = default;
  explicit Secret(std::string text) : text_(std::move(text)) {}

  bool is_empty() const noexcept { return text_.empty(); }

  /// Returns true if it is only kWithheld, read back from such a configuration: then the secret is unknown.
  bool is_withheld() const noexcept { return text_ == kWithheld; }

  /// Empty if the secret is empty, otherwise kWithheld.
  std::string_view printable() const noexcept { return is_empty() ? std::string_view() : kWithheld; }

  /// The text itself, only for the library that uses it to authenticate.
  const std::string& reveal() const noexcept { return text_; }

  friend bool operator==(const Secret&, const Secret&) = default;

 private:
  std::string text_;
};

/// Returns true if a text contains a user's name and password, as in mqtt://user:password@host or user:password@host.
/// Pure.
bool holds_credentials(std::string_view text) noexcept;

}  // namespace yuragi
