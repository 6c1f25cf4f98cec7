#include "engine/base/version.hpp"

namespace yuragi {

const char* const kVersion = YURAGI_VERSION;

}  // namespace yuragi
