#include "daemon/pictures/picture_file.hpp"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/pictures/jpeg_picture.hpp"
#include "daemon/pictures/png_picture.hpp"
#include "daemon/pictures/scaled_picture.hpp"
#include "engine/platform/descriptor.hpp"

namespace yuragi::daemon::pictures {
namespace {

Failure refusal(std::string message) {
  return {.message = std::move(message), .kind = FailureKind::kBadData};
}

Result<std::vector<std::uint8_t>, Failure> bytes_of(const std::filesystem::path& file) {
  // Without waiting for somebody who writes into a pipe.
  const platform::Descriptor opened(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (opened.get() < 0) {
    return Failure{.message = "cannot be read: " + std::generic_category().message(errno) +
                              "; give the path of a PNG or JPEG file, from the configuration's folder on",
                   .kind = FailureKind::kNoInput};
  }
  struct stat status {};
  if (fstat(opened.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return refusal("is not a regular file, but a folder, a pipe or a device");
  }
  if (static_cast<std::uintmax_t>(status.st_size) > kMaxFile_bytes) {
    return refusal("is a file of " + std::to_string(status.st_size >> 20) + " MB; allowed: up to " +
                   std::to_string(kMaxFile_bytes >> 20) + " MB");
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(status.st_size));
  std::size_t length = 0;
  while (length < bytes.size()) {
    const ssize_t count = read(opened.get(), bytes.data() + length, bytes.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return refusal("cannot be read: " + std::generic_category().message(errno));
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  bytes.resize(length);
  return bytes;
}

}  // namespace

Result<look::Image, Failure> decoded_picture(std::span<const std::uint8_t> bytes, look::Color background) {
  if (!is_png(bytes) && !is_jpeg(bytes)) return refusal("is neither a PNG nor a JPEG file; save it as one of them");
  auto picture = is_png(bytes) ? decoded_png(bytes, background) : decoded_jpeg(bytes);
  if (!picture) return picture.error();
  return scaled_down(std::move(*picture));
}

Result<std::shared_ptr<const look::Image>, Failure> read_picture(const std::filesystem::path& file,
                                                                 look::Color background) {
  const auto bytes = bytes_of(file);
  if (!bytes) return bytes.error();
  auto picture = decoded_picture(*bytes, background);
  if (!picture) return picture.error();
  return std::make_shared<const look::Image>(std::move(*picture));
}

}  // namespace yuragi::daemon::pictures
