#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/bus/byte_port.hpp"

namespace yuragi::drivers::bus {

/// A program of ours whose standard output is the port: a library that can hang must run in a process, because a thread
/// that spins cannot be ended. `command`: the program's path and its arguments.
///
/// open() starts it. close() kills it in any state, and leaves no zombie. It dies with the thread that opened it,
/// should that end without close(). Standard input is empty; standard error is the daemon's own. read() returns kLost
/// when the program has ended, after the last of its bytes. write() is refused.
std::unique_ptr<BytePort> make_process_port(std::vector<std::string> command);

}  // namespace yuragi::drivers::bus
