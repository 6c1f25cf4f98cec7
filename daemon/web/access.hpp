#pragma once

#include <string>
#include <string_view>

#include "engine/base/secret.hpp"

namespace yuragi::daemon::web {

/// Who knows the token of an installation: those who send it, and browsers that were paired with it and send a session
/// made of it. Nothing but the token is kept: another token ends all sessions, and they outlive a restart.
///
/// A pairing code is a one-time password of the time (D. M'Raihi and others, RFC 6238, 2011) with SHA-256, 40 bits and
/// steps of kCodeStep_s. What is compared is compared in constant time. Pure but for construction; thread-safe.
/// Times are seconds since 1970.
class Access {
 public:
  /// So long a code is shown; it is taken for as long again.
  static constexpr double kCodeStep_s = 600.0;
  static constexpr double kSession_s = 365.0 * 86400.0;
  /// Fewer characters can be guessed.
  static constexpr std::size_t kShortestToken = 16;

  /// A token that nobody can guess, of 43 characters, by the system's source of randomness.
  static Secret new_token();

  explicit Access(Secret token) : token_(std::move(token)) {}

  bool is_token(std::string_view given) const;

  /// For a person to type: "K7QM-2XPD".
  std::string pairing_code(double utc_s) const;
  /// Small letters, and O, I and L for 0 and 1, count as well.
  bool is_pairing_code(std::string_view given, double utc_s) const;

  /// For a paired browser to keep: when it was made, and proof of that.
  std::string new_session(double utc_s) const;
  bool is_session(std::string_view given, double utc_s) const;

 private:
  Secret token_;
};

/// At most so many tries to pair: kBurst at once, then one a second. Time is a parameter. Thread-safe: no.
class PairingTries {
 public:
  static constexpr double kBurst = 10.0;

  /// Is there one at `now_s`, of a clock that is never set? Then it is used up.
  bool take(double now_s);

 private:
  double left_ = kBurst;
  double at_s_ = 0.0;
};

}  // namespace yuragi::daemon::web
