#include "drivers/bus/descriptor_port.hpp"

#include <cerrno>

#include <unistd.h>

namespace yuragi::drivers::bus {
namespace {

/// A device that accepts no bytes for this time will not accept them later.
constexpr Nanoseconds kWritePatience = std::chrono::seconds(1);

}  // namespace

ByteArrival DescriptorPort::read(std::span<std::uint8_t> buffer, Nanoseconds timeout) {
  if (descriptor() < 0) return {ByteStatus::kLost};
  switch (interruption_.wait(descriptor(), WaitFor::kReadable, timeout)) {
    case WaitEnd::kInterrupted:
      return {ByteStatus::kInterrupted};
    case WaitEnd::kTimeout:
      return {ByteStatus::kSilence};
    case WaitEnd::kReady:
      break;
  }
  const ssize_t size = ::read(descriptor(), buffer.data(), buffer.size());
  if (size > 0) return {ByteStatus::kBytes, static_cast<std::size_t>(size)};
  const bool is_nothing = size < 0 && (errno == EAGAIN || errno == EINTR);
  return {is_nothing ? ByteStatus::kSilence : ByteStatus::kLost};
}

bool DescriptorPort::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    if (descriptor() < 0) return false;
    const ssize_t size = ::write(descriptor(), bytes.data(), bytes.size());
    if (size > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(size));
      continue;
    }
    if (errno != EAGAIN && errno != EINTR) return false;
    if (interruption_.wait(descriptor(), WaitFor::kWritable, kWritePatience) != WaitEnd::kReady) return false;
  }
  return true;
}

}  // namespace yuragi::drivers::bus
