#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace yuragi::sim {

/// A serial port without a wire: what is written here is read by whoever opens path(), and the other way round. It has
/// no baud rate: bytes arrive at once. Can be unplugged and plugged in again under the same link.
class Pty {
 public:
  /// Makes the port. `link`, if not empty, is a symbolic link to it, made here and removed at the end: a name that
  /// stays, such as a real adapter has in /dev/serial/by-id. Throws std::system_error.
  explicit Pty(std::string link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  bool is_plugged_in() const noexcept { return master_ >= 0; }
  /// Takes the port away: whoever has it open sees it hang up, and its name is gone.
  void unplug() noexcept;
  /// Makes a new port, and the link to it. Throws std::system_error.
  void plug_in();

  /// What others open: the link, or else the port itself.
  const std::string& path() const noexcept { return link_.empty() ? port_ : link_; }
  /// To wait for bytes; -1 while unplugged.
  int descriptor() const noexcept { return master_; }

  /// What has come, never waiting; nothing if nobody has the port open.
  std::vector<std::uint8_t> read();
  /// Writes all of it, or drops what nobody takes: a wire does not wait.
  void write(std::span<const std::uint8_t> bytes) noexcept;

 private:
  std::string link_;
  std::string port_;
  int master_ = -1;
  int kept_slave_ = -1;  // or reading would fail whenever nobody has the port open
};

}  // namespace yuragi::sim
