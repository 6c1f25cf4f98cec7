#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::daemon::web {

/// A browser that was paired, and its session.
struct PairedBrowser {
  std::string id = {};           ///< of its session (Access::new_session_id())
  std::int64_t since_utc_s = 0;  ///< seconds since 1970, as the other times
  std::int64_t last_use_utc_s = 0;
  std::string address = {};  ///< of its last use

  bool operator==(const PairedBrowser&) const = default;
};

/// What pairing leaves behind: the browsers that were paired, and the codes that were used. All of it belongs to one
/// token. Nothing in it is secret, and nothing in it lets anybody in without the token's signature. Memory is bounded.
/// Pure: time is a parameter. Thread-safe: no.
class Pairings {
 public:
  /// A further browser replaces the one whose last use was longest ago.
  static constexpr std::size_t kMaxBrowsers = 64;
  /// How long a browser may change something after it was paired.
  static constexpr std::int64_t kSession_s = 365 * std::int64_t{86400};
  /// The time of the last use is kept to this accuracy, so that it is not written to the disk with each request.
  static constexpr std::int64_t kUseAccuracy_s = 3600;
  /// Many times the size of valid pairings: a larger text is rejected.
  static constexpr std::size_t kMaxText_bytes = 256U << 10U;

  Pairings() = default;
  /// `token_mark`: of the token that they belong to (Access::mark()).
  explicit Pairings(std::string token_mark) : token_mark_(std::move(token_mark)) {}

  const std::string& token_mark() const { return token_mark_; }

  /// Marks the code of this step (Access::pairing_step_of()) as used. Returns false if it was used before.
  bool use_code(std::int64_t step);

  /// Adds a browser that was paired now.
  void add(std::string id, std::string address, double utc_s);

  /// Returns true if the session of this id is neither unknown, revoked nor too old.
  bool is_valid(std::string_view id, double utc_s) const;

  /// A browser sends a request from `address`. Returns true if this changed something that is to be saved.
  bool note_use(std::string_view id, std::string_view address, double utc_s);

  /// Ends the session of this id. Returns false if it is unknown.
  bool revoke(std::string_view id);

  /// Returns the browsers whose sessions are valid, the one that was paired first at the front.
  std::vector<PairedBrowser> browsers(double utc_s) const;

  /// Returns them as JSON.
  std::string text() const;
  /// Reads what text() returned; the text is not trusted. Fails if anything in it is invalid.
  static Result<Pairings, Failure> parse(std::string_view text);

  bool operator==(const Pairings&) const = default;

 private:
  std::string token_mark_;
  std::set<std::int64_t> used_codes_;  ///< steps
  std::vector<PairedBrowser> browsers_;
};

}  // namespace yuragi::daemon::web
