#pragma once

#include "engine/base/secret.hpp"

namespace yuragi::viewer::app {

/// Returns the token that the viewer sends to the daemon, from the file named by the environment variable
/// YURAGI_TOKEN_FILE; empty if it is not set. If the file cannot be read, this prints an error and returns an empty
/// token: the wall still shows its picture.
Secret own_token();

}  // namespace yuragi::viewer::app
