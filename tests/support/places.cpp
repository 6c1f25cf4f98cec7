// The one test source that is compiled with absolute paths.
#include "tests/support/places.hpp"

namespace yuragi::test {

std::string source_path(std::string_view relative) {
  return YURAGI_SOURCE_DIR "/" + std::string(relative);
}
std::string built_path(std::string_view relative) {
  return YURAGI_BINARY_DIR "/" + std::string(relative);
}

}  // namespace yuragi::test
