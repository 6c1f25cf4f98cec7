#include "daemon/commands/command.hpp"
namespace yuragi {
extern const Command kImportCommand;
const Command kImportCommand{[](CLI::App&) {}};
}  // namespace yuragi
