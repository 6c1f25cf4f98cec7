#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace yuragi {

/// A text that is to be seen by nobody, such as a password. It has no conversion to a text, no formatter and no output
/// operator: what is printed, recorded or sent of it is printable(). Thread-safe: as a std::string is.
class Secret {
 public:
  /// What stands in its place where a configuration is printed or recorded.
  static constexpr std::string_view kWithheld = "(secret)";

  Secret() = default;
  explicit Secret(std::string text) : text_(std::move(text)) {}

  bool is_empty() const noexcept { return text_.empty(); }

  /// Is it only kWithheld, read back from such a place? Then the secret is not known.
  bool is_withheld() const noexcept { return text_ == kWithheld; }

  /// Nothing if it is empty, else kWithheld.
  std::string_view printable() const noexcept { return is_empty() ? std::string_view() : kWithheld; }

  /// The text itself, for the library that proves with it who we are, and for nothing else.
  const std::string& reveal() const noexcept { return text_; }

  friend bool operator==(const Secret&, const Secret&) = default;

 private:
  std::string text_;
};

/// Does a text hold a user's name and password, as in mqtt://user:password@host or user:password@host? Pure.
bool holds_credentials(std::string_view text) noexcept;

}  // namespace yuragi
