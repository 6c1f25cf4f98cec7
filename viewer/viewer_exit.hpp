#pragma once

#include <stdexcept>
#include <string>

#include <sysexits.h>

namespace yuragi::viewer {

/// A failure that ends the program, with a text for a person and an exit code of sysexits.h. Caught once, in main.
class ViewerExit : public std::runtime_error {
 public:
  ViewerExit(int code, const std::string& message) : std::runtime_error(message), code_(code) {}
  int code() const noexcept { return code_; }

 private:
  int code_;
};

}  // namespace yuragi::viewer
