#pragma once

#include <array>
#include <cerrno>
#include <span>
#include <string>

#include <unistd.h>

namespace yuragi::simulators::core {

/// The lines that can be read from a descriptor, until its end. It does not own the descriptor. A line is cut after 512
/// bytes. Thread-safe: no.
class LineReader {
 public:
  explicit LineReader(int descriptor) : descriptor_(descriptor) {}

  int descriptor() const noexcept { return descriptor_; }
  bool is_open() const noexcept { return is_open_; }

  /// Reads once; calls `use` with each whole line, without its end. Waits if nothing can be read.
  template <class Use>
  void read_lines(Use&& use) {
    std::array<char, 512> block{};
    const ssize_t size = read(descriptor_, block.data(), block.size());
    if (size <= 0) {
      is_open_ = size < 0 && (errno == EINTR || errno == EAGAIN);
      return;
    }
    for (const char c : std::span(block).first(static_cast<std::size_t>(size))) {
      if (c != '\n') {
        if (line_.size() < block.size()) line_ += c;
        continue;
      }
      use(line_);
      line_.clear();
    }
  }

 private:
  int descriptor_;
  bool is_open_ = true;
  std::string line_;
};

}  // namespace yuragi::simulators::core
