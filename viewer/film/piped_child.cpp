#include "viewer/film/piped_child.hpp"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace yuragi::viewer::film {

PipedChild::PipedChild(const std::vector<std::string>& command, Pipe pipe) : child_(start(command, pipe)) {}

PipedChild::~PipedChild() {
  close_pipe();
}

platform::ChildProcess PipedChild::start(const std::vector<std::string>& command, Pipe pipe) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const bool is_input = pipe == Pipe::kStandardInput;
  const int theirs = is_input ? ends[0] : ends[1];
  ours_ = is_input ? ends[1] : ends[0];
  try {
    platform::ChildProcess child({.command = command,
                                  .input = is_input ? theirs : -1,
                                  .output = is_input ? STDERR_FILENO : theirs,
                                  .has_own_group = true});
    ::close(theirs);
    return child;
  } catch (...) {
    ::close(theirs);
    close_pipe();
    throw;
  }
}

void PipedChild::close_pipe() {
  if (ours_ >= 0) ::close(ours_);
  ours_ = -1;
}

platform::ChildEnd PipedChild::wait() {
  close_pipe();
  return child_.wait();
}

}  // namespace yuragi::viewer::film
