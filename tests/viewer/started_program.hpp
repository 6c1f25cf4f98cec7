#pragma once

#include <string>
#include <vector>

#include <spawn.h>
#include <sys/types.h>

namespace yuragi::viewer {

/// Starts a program; 0 if that was not possible. `environment` is all that it gets.
pid_t start_program(std::vector<std::string> words, std::vector<std::string> environment,
                    posix_spawn_file_actions_t* actions);

/// Our own environment, but for the screens.
std::vector<std::string> environment_without_screen();

}  // namespace yuragi::viewer
