#pragma once

#include "engine/base/secret.hpp"

namespace yuragi::viewer::app {

/// Returns the token that the viewer shows to the daemon: that of the file which the environment variable
/// YURAGI_TOKEN_FILE names; empty if it names none. A file that cannot be read is reported on standard error, and the
/// token is empty: the wall shows its picture all the same.
Secret own_token();

}  // namespace yuragi::viewer::app
