#include "daemon/commands/command.hpp"
namespace yuragi {
extern const Command kNoiseCommand;
const Command kNoiseCommand{[](CLI::App&) {}};
}  // namespace yuragi
