#include "simulators/core/pty.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

namespace yuragi::simulators::core {

Pty::Pty(std::string link) : link_(std::move(link)) {
  plug_in();
}

Pty::~Pty() {
  unplug();
}

void Pty::plug_in() {
  if (is_plugged_in()) return;
  const auto fail = [this](const char* what) {
    const int error = errno;
    unplug();
    throw std::system_error(error, std::generic_category(), what);
  };
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master_ < 0) fail("cannot make a pseudo terminal");
  std::array<char, 128> name{};
  if (grantpt(master_) != 0 || unlockpt(master_) != 0 || ptsname_r(master_, name.data(), name.size()) != 0) {
    fail("cannot name a pseudo terminal");
  }
  port_ = name.data();

  // Bytes pass unchanged and are not echoed.
  kept_slave_ = open(port_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (kept_slave_ < 0 || tcgetattr(kept_slave_, &settings) != 0) fail("cannot open a pseudo terminal");
  cfmakeraw(&settings);
  if (tcsetattr(kept_slave_, TCSANOW, &settings) != 0) fail("cannot set up a pseudo terminal");

  if (!link_.empty()) {
    unlink(link_.c_str());
    if (symlink(port_.c_str(), link_.c_str()) != 0) fail(("cannot make the link " + link_).c_str());
  }
}

void Pty::unplug() noexcept {
  if (!link_.empty()) unlink(link_.c_str());
  if (kept_slave_ >= 0) close(std::exchange(kept_slave_, -1));
  if (master_ >= 0) close(std::exchange(master_, -1));
}

std::vector<std::uint8_t> Pty::read() {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 512> block{};
  ssize_t size = 0;
  while ((size = ::read(master_, block.data(), block.size())) > 0) {
    bytes.insert(bytes.end(), block.begin(), block.begin() + size);
  }
  return bytes;
}

void Pty::write(std::span<const std::uint8_t> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t size = ::write(master_, bytes.data(), bytes.size());
    if (size <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

}  // namespace yuragi::simulators::core
