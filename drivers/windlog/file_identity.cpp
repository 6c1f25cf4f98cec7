#include "drivers/windlog/file_identity.hpp"

#include <cerrno>

#include <sys/stat.h>

namespace yuragi::drivers::windlog {

Result<FileIdentity, std::error_code> identity_of(const std::filesystem::path& file) noexcept {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return std::error_code(errno, std::generic_category());
  return FileIdentity{status.st_dev, status.st_ino};
}

}  // namespace yuragi::drivers::windlog
