#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace yuragi::simulators::core {

/// A pseudo terminal as a serial port: bytes written here are read by the program that opens path(), and the other way
/// round. It has no baud rate: bytes arrive at once. It can be unplugged and plugged in again under the same link.
/// Thread-safe: no.
class Pty {
 public:
  /// Makes the port. `link`, if not empty, is a symbolic link to it, made here and removed at the end: a name that
  /// stays, such as a real adapter has in /dev/serial/by-id. Throws std::system_error.
  explicit Pty(std::string link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  bool is_plugged_in() const noexcept { return master_ >= 0; }
  /// Closes the port: a program that has it open sees a hang-up, and its name is removed.
  void unplug() noexcept;
  /// Makes a new port, and the link to it. Throws std::system_error.
  void plug_in();

  /// The path for others to open: the link if there is one, else the terminal's own.
  const std::string& path() const noexcept { return link_.empty() ? port_ : link_; }
  /// To wait for bytes; -1 while unplugged.
  int descriptor() const noexcept { return master_; }

  /// The bytes that have arrived; empty if no program has the port open. Never waits.
  std::vector<std::uint8_t> read();
  /// Writes all of it; what no program reads is dropped, as on a real line. Never waits.
  void write(std::span<const std::uint8_t> bytes) noexcept;

 private:
  std::string link_;
  std::string port_;
  int master_ = -1;
  int kept_slave_ = -1;  // kept open, or reading would fail while no program has the port open
};

}  // namespace yuragi::simulators::core
