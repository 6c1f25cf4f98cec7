#include "daemon/commands/command.hpp"
namespace yuragi {
extern const Command kExportCommand;
const Command kExportCommand{[](CLI::App&) {}};
}  // namespace yuragi
