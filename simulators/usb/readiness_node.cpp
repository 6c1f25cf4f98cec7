// A pipe of one page holds one write: empty, it can be written; with one byte in it, it can be read, and not be
// written.
#include "simulators/usb/readiness_node.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace yuragi::simulators::usb {
namespace {

constexpr int kOnePage = 4096;

}  // namespace

ReadinessNode::ReadinessNode(const std::string& path, Direction direction) : direction_(direction) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  unlink(path.c_str());
  if (mkfifo(path.c_str(), 0600) == 0) descriptor_ = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0 || fcntl(descriptor_, F_SETPIPE_SZ, kOnePage) < 0) {
    const int error = errno;
    if (descriptor_ >= 0) close(descriptor_);
    throw std::system_error(error, std::generic_category(), "cannot make the device node " + path);
  }
  set_ready(false);
}

ReadinessNode::~ReadinessNode() {
  close(descriptor_);
}

void ReadinessNode::set_ready(bool is_ready) noexcept {
  const bool is_to_be_filled = is_ready == (direction_ == Direction::kReadable);
  if (is_to_be_filled == is_filled_) return;
  std::uint8_t byte = 0;
  is_filled_ = is_to_be_filled ? write(descriptor_, &byte, 1) == 1 : read(descriptor_, &byte, 1) != 1;
}

}  // namespace yuragi::simulators::usb
