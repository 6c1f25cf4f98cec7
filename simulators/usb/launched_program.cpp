#include "simulators/usb/launched_program.hpp"

#include <cerrno>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace yuragi::simulators::usb {
namespace {

constexpr int kNotThere = 127;
constexpr int kBySignal = 128;
constexpr int kPatience_ms = 2000;

}  // namespace

LaunchedProgram::LaunchedProgram(const std::vector<std::string>& command, Simulator& simulator)
    : simulator_(simulator) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) {
    // It must not outlive the simulator, whose devices it uses.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(kNotThere);
    if (const int nothing = open("/dev/null", O_RDONLY); nothing >= 0) dup2(nothing, STDIN_FILENO);
    execvp(words[0], words.data());
    _exit(kNotThere);
  }
  if (process_ > 0) descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, process_, 0));
  if (process_ < 0 || descriptor_ < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot start " + command.front());
  }
}

LaunchedProgram::~LaunchedProgram() {
  if (!reap()) {
    kill(process_, SIGTERM);
    pollfd wait{descriptor_, POLLIN, 0};
    poll(&wait, 1, kPatience_ms);
    if (!reap()) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  close(descriptor_);
}

bool LaunchedProgram::reap() {
  int status = 0;
  if (!exit_code_ && waitpid(process_, &status, WNOHANG) == process_) {
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : kBySignal + WTERMSIG(status);
  }
  return exit_code_.has_value();
}

std::vector<int> LaunchedProgram::descriptors() const {
  std::vector<int> all = simulator_.descriptors();
  all.push_back(descriptor_);
  return all;
}

void LaunchedProgram::serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) {
  if (reap()) return;
  simulator_.serve(ready, time_s, fault);
}

}  // namespace yuragi::simulators::usb
