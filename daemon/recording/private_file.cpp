#include "daemon/recording/private_file.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace yuragi::daemon::recording {

void create_private_file(std::filesystem::path file) {
  constexpr mode_t kMode = 0640;
  constexpr int kMaxLinks = 40;  // as many as Linux follows
  for (int links = 0; links <= kMaxLinks; ++links) {
    // O_EXCL: an existing file is never opened, because closing it would release SQLite's locks on it, which belong to
    // the whole process (fcntl(2), "Advisory record locking").
    const int descriptor = open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, kMode);
    if (descriptor >= 0) {
      close(descriptor);
      return;
    }
    if (errno != EEXIST) return;
    std::error_code error;
    const std::filesystem::path target = std::filesystem::read_symlink(file, error);
    if (error) return;  // no link: the file is there
    file = file.parent_path() / target;
  }
}

}  // namespace yuragi::daemon::recording
