#pragma once

#include <string>

namespace yuragi::daemon::tools::doctor {

/// Why a program cannot take datagrams at HOST:PORT of this machine (an empty host: all addresses); empty: it can. The
/// socket is closed again at once. `is_shared`: other programs that ask for the same (SO_REUSEADDR) may be there, too.
std::string udp_trouble(const std::string& address, bool is_shared = false);

/// The same of connections. Sets `is_in_use` if another program listens there.
std::string listen_trouble(const std::string& address, bool& is_in_use);

}  // namespace yuragi::daemon::tools::doctor
