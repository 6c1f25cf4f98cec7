#include "viewer/child_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace yuragi::viewer {
namespace {

/// What the child is to find: its end of the pipe, nothing on the other, no signal that we have blocked or ignore.
class SpawnPlan {
 public:
  SpawnPlan(int child_end, ChildProcess::Pipe pipe) {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    const bool is_input = pipe == ChildProcess::Pipe::kStandardInput;
    posix_spawn_file_actions_adddup2(&actions, child_end, is_input ? STDIN_FILENO : STDOUT_FILENO);
    if (is_input) {
      posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    } else {
      posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    }
    posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
};

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, Pipe pipe) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const bool is_input = pipe == Pipe::kStandardInput;
  const int child_end = is_input ? ends[0] : ends[1];
  fd_ = is_input ? ends[1] : ends[0];

  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const SpawnPlan plan(child_end, pipe);
  const int error = ::posix_spawnp(&pid_, words[0], &plan.actions, &plan.attributes, words.data(), environ);
  ::close(child_end);
  if (error == 0) return;
  pid_ = 0;
  close_pipe();
  throw std::system_error(error, std::generic_category(), command.front());
}

ChildProcess::~ChildProcess() {
  close_pipe();
  if (pid_ == 0) return;
  ::kill(pid_, SIGKILL);
  wait();
}

void ChildProcess::close_pipe() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

ChildProcess::End ChildProcess::wait() {
  close_pipe();
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = 0;
  if (WIFSIGNALED(status)) return {.exit_code = 0, .signal = WTERMSIG(status)};
  return {.exit_code = WEXITSTATUS(status), .signal = 0};
}

std::string ChildProcess::text_of(const End& end) {
  if (end.signal != 0) {
    const char* const name = ::sigdescr_np(end.signal);
    return fmt::format("was killed by a signal ({}, {})", end.signal, name != nullptr ? name : "unknown");
  }
  return fmt::format("has failed (exit code {})", end.exit_code);
}

}  // namespace yuragi::viewer
