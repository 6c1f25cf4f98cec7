#pragma once

#include <stdexcept>
#include <string>

#include <sysexits.h>

#include "engine/base/result.hpp"

namespace yuragi::viewer::picture {

/// A failure that ends the program, with a text for a person and an exit code of sysexits.h. Caught once, in main.
class ViewerExit : public std::runtime_error {
 public:
  ViewerExit(int code, const std::string& message) : std::runtime_error(message), code_(code) {}
  int code() const noexcept { return code_; }

 private:
  int code_;
};

/// The exit code for a failure that a part of the viewer threw as a FailureError; bad data is that of a configuration.
constexpr int exit_code_of(FailureKind kind) noexcept {
  switch (kind) {
    case FailureKind::kUsage:
      return EX_USAGE;
    case FailureKind::kBadData:
      return EX_CONFIG;
    case FailureKind::kNoInput:
      return EX_NOINPUT;
    case FailureKind::kUnavailable:
      return EX_UNAVAILABLE;
    case FailureKind::kCannotCreate:
      return EX_CANTCREAT;
    case FailureKind::kOther:
      break;
  }
  return EX_SOFTWARE;
}

}  // namespace yuragi::viewer::picture
