#pragma once

namespace yuragi {

/// Keeps a descriptor from being inherited by programs that this one starts: for descriptors that a library has opened
/// without O_CLOEXEC, as Asio does. Ignores one that is not open. Thread-safe: yes, but a program that another thread
/// starts before this call inherits it, so whoever starts a program closes all descriptors that it should not have.
void close_on_exec(int descriptor) noexcept;

}  // namespace yuragi
