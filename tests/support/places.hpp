#pragma once

#include <string>
#include <string_view>

namespace yuragi::test {

/// A file of the project, as an absolute path: source_path("drivers/modbus/profiles").
std::string source_path(std::string_view relative);

/// A file that was built, as an absolute path: built_path("bin/yuragi-sim").
std::string built_path(std::string_view relative);

}  // namespace yuragi::test
