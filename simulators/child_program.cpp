#include "simulators/child_program.hpp"

#include <cerrno>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace yuragi::simulators {
namespace {

constexpr int kNotThere = 127;
constexpr int kBySignal = 128;
constexpr int kPatience_ms = 2000;

/// In the child: what it gets as `wanted`, if anything.
void give(int descriptor, int wanted) {
  if (descriptor >= 0) dup2(descriptor, wanted);
}

}  // namespace

ChildProgram::ChildProgram(const std::vector<std::string>& command, const Streams& streams) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(kNotThere);
    give(streams.input >= 0 ? streams.input : open("/dev/null", O_RDONLY), STDIN_FILENO);
    give(streams.output, STDOUT_FILENO);
    give(streams.error, STDERR_FILENO);
    close_range(STDERR_FILENO + 1, ~0U, 0);
    execvp(words[0], words.data());
    _exit(kNotThere);
  }
  if (process_ > 0) descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, process_, 0));
  if (process_ < 0 || descriptor_ < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot start " + command.front());
  }
}

ChildProgram::~ChildProgram() {
  if (!exit_code()) {
    terminate();
    pollfd wait{descriptor_, POLLIN, 0};
    poll(&wait, 1, kPatience_ms);
    if (!exit_code()) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  close(descriptor_);
}

std::optional<int> ChildProgram::exit_code() {
  int status = 0;
  if (!exit_code_ && waitpid(process_, &status, WNOHANG) == process_) {
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : kBySignal + WTERMSIG(status);
  }
  return exit_code_;
}

void ChildProgram::terminate() {
  if (!exit_code()) kill(process_, SIGTERM);
}

}  // namespace yuragi::simulators
