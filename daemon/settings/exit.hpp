#pragma once

#include <stdexcept>
#include <string>

namespace yuragi {

// How the programs end: 0, or one of sysexits.h, so that a service manager can tell what went wrong.
inline constexpr int kExitUsage = 64;         ///< the command line
inline constexpr int kExitDataError = 65;     ///< an input file that holds what it should not
inline constexpr int kExitNoInput = 66;       ///< an input file that is not there
inline constexpr int kExitUnavailable = 69;   ///< nobody answers, or an address is taken
inline constexpr int kExitSoftware = 70;      ///< anything not foreseen
inline constexpr int kExitCannotCreate = 73;  ///< an output file
inline constexpr int kExitNoPermission = 77;  ///< asked of somebody who does not take it from here
inline constexpr int kExitConfig = 78;        ///< the configuration

/// A failure during set-up: its text tells a person what to do, its code tells the shell. Caught once, in main.
class ExitError : public std::runtime_error {
 public:
  ExitError(int code, const std::string& message) : std::runtime_error(message), code_(code) {}
  int code() const noexcept { return code_; }

 private:
  int code_;
};

}  // namespace yuragi
