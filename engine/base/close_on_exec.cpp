#include "engine/base/close_on_exec.hpp"

#include <fcntl.h>

namespace yuragi {

void close_on_exec(int descriptor) noexcept {
  fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

}  // namespace yuragi
