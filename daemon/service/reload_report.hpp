#pragma once

#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::service {

/// Returns one line for clients that show only the message of a reply.
std::string summary_of(const wire::ReloadReport& report);

/// Returns a text without the folders of the absolute paths in it.
std::string without_path_folders(const std::string& text);

/// The same report without the folders of the absolute paths in its texts: for clients of other machines.
wire::ReloadReport without_folders(wire::ReloadReport report);

}  // namespace yuragi::daemon::service
