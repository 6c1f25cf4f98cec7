#include "engine/base/secret_line.hpp"

#include <utility>

namespace yuragi {

Result<Secret, Failure> secret_line(std::string text) {
  if (text.ends_with('\n')) text.pop_back();
  if (text.ends_with('\r')) text.pop_back();
  if (text.empty()) return Failure{"is empty"};
  if (text.find('\n') != std::string::npos) return Failure{"has more than one line"};
  if (text.find('\0') != std::string::npos) return Failure{"has a zero byte in it"};
  return Secret(std::move(text));
}

}  // namespace yuragi
