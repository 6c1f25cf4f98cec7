#pragma once

#include <stdexcept>
#include <string>

#include "engine/base/result.hpp"

namespace yuragi::daemon::commands {

// How commands end: 0, or one of sysexits.h, so that a service manager can see what went wrong; or, if a command
// judges something, one of the first two.
inline constexpr int kExitAttention = 1;      ///< `status`, `doctor`, `accept`, `verify`: something needs attention
inline constexpr int kExitNoDaemon = 2;       ///< `status`: no daemon replies
inline constexpr int kExitUsage = 64;         ///< the command line
inline constexpr int kExitDataError = 65;     ///< an input file with invalid content
inline constexpr int kExitNoInput = 66;       ///< a missing input file
inline constexpr int kExitUnavailable = 69;   ///< no daemon replies, or an address is in use
inline constexpr int kExitSoftware = 70;      ///< an unexpected error
inline constexpr int kExitCannotCreate = 73;  ///< an output file
inline constexpr int kExitNoPermission = 77;  ///< refused by the daemon
inline constexpr int kExitConfig = 78;        ///< the configuration

/// The exit code for a failure that ends a command.
constexpr int exit_code_of(FailureKind kind) {
  switch (kind) {
    case FailureKind::kUsage:
      return kExitUsage;
    case FailureKind::kBadData:
      return kExitDataError;
    case FailureKind::kNoInput:
      return kExitNoInput;
    case FailureKind::kUnavailable:
      return kExitUnavailable;
    case FailureKind::kCannotCreate:
      return kExitCannotCreate;
    case FailureKind::kOther:
      break;
  }
  return kExitSoftware;
}

/// A failure of a command, with a text for a person and an exit code for the shell. Thrown by commands alone, and
/// caught once, in main. An empty text: the command has printed everything already. Rooms below return a Failure, or
/// throw it as a FailureError.
class ExitError : public std::runtime_error {
 public:
  ExitError(int code, const std::string& message) : std::runtime_error(message), code_(code) {}
  int code() const noexcept { return code_; }

 private:
  int code_;
};

}  // namespace yuragi::daemon::commands
