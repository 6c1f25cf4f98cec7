#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/secret.hpp"

namespace yuragi::daemon::web {

/// Who knows the token of an installation: those who send it, and browsers that were paired with it and send a session
/// signed with it. Nothing but the token is kept here: another token ends all sessions. Pairings knows which sessions
/// are valid.
///
/// A pairing code is a one-time password of the time (D. M'Raihi and others, RFC 6238, 2011) with SHA-256, 40 bits and
/// steps of kCodeStep_s. All comparisons take constant time. Pure except for construction; thread-safe. Times are
/// seconds since 1970.
class Access {
 public:
  /// There is a new code each kCodeStep_s. It is valid for kCodeSteps of them, 10 minutes.
  static constexpr double kCodeStep_s = 30.0;
  static constexpr std::int64_t kCodeSteps = 20;
  /// Fewer characters can be guessed.
  static constexpr std::size_t kMinToken = 16;

  /// A token that nobody can guess, of 43 characters, by the system's source of randomness.
  static Secret new_token();

  explicit Access(Secret token) : token_(std::move(token)) {}

  bool is_token(std::string_view given) const;

  /// For a person to type: "K7QM-2XPD".
  std::string pairing_code(double utc_s) const;
  /// Returns the step whose code this is, so that each can be used once; nullopt: it is not valid at `utc_s`. Small
  /// letters, and O, I and L for 0 and 1, are accepted.
  std::optional<std::int64_t> pairing_step_of(std::string_view given, double utc_s) const;

  /// Returns the id of a new session: kSessionIdCharacters hexadecimal digits, by the system's source of randomness. It
  /// is no secret.
  static std::string new_session_id();
  static constexpr std::size_t kSessionIdCharacters = 10;

  /// Returns what a paired browser keeps: the session's id and its signature.
  std::string session_of(std::string_view id) const;
  /// Returns the id of a session whose signature is valid, or nullopt.
  std::optional<std::string> session_id_of(std::string_view given) const;

  /// Returns a text by which this token is known again, and from which it cannot be computed.
  std::string mark() const;

 private:
  Secret token_;
};

}  // namespace yuragi::daemon::web
