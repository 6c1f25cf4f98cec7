#include "daemon/alerts/shell_command.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace yuragi::daemon::alerts {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return value_; }
  void reset() {
    if (value_ >= 0) ::close(value_);
    value_ = -1;
  }

 private:
  int value_;
};

/// A process group of its own, no signal that this program blocks or ignores, nothing to read, `output` for both of its
/// outputs, and no other open file.
class SpawnPlan {
 public:
  explicit SpawnPlan(int output) {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
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

/// This program's environment and what the command is told. A name may hold anything but a zero byte.
std::vector<std::string> environment_for(const AlertNews& news) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!std::string_view(*entry).starts_with("YURAGI_ALERT")) all.emplace_back(*entry);
  }
  all.push_back("YURAGI_ALERT=" + news.alert);
  all.push_back(std::string("YURAGI_ALERT_STATE=") + (news.has_begun ? "began" : "ended"));
  all.push_back("YURAGI_ALERT_MESSAGE=" + news.message);
  return all;
}

/// Reads once from a pipe, and appends what has room. False: there is nothing to read now, or never again.
bool read_some(int pipe, std::string& output) {
  std::array<char, 4096> block{};
  const ssize_t count = ::read(pipe, block.data(), block.size());
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) return false;
  output.append(block.data(), std::min(static_cast<std::size_t>(count), kMaxCommandOutput_bytes - output.size()));
  return true;
}

/// Waits until a process has ended and reads what it prints meanwhile; false: it has not ended after `most`, or a stop
/// was requested.
bool has_ended(pid_t process, int pipe, Nanoseconds most, const std::stop_token& stop, std::string& output) {
  const Descriptor ended(static_cast<int>(::syscall(SYS_pidfd_open, process, 0)));
  const Descriptor wake(::eventfd(0, EFD_CLOEXEC));
  if (ended.get() < 0 || wake.get() < 0) return false;
  const std::stop_callback wakes(stop, [&wake] { ::eventfd_write(wake.get(), 1); });
  const auto end = std::chrono::steady_clock::now() + most;
  std::array<pollfd, 3> waits = {{{ended.get(), POLLIN, 0}, {wake.get(), POLLIN, 0}, {pipe, POLLIN, 0}}};
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    const int count = ::poll(waits.data(), waits.size(), static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (count < 0 && errno == EINTR) continue;
    if (count > 0 && waits[0].revents != 0) return true;
    // A command that always prints has no more time than others.
    if (count <= 0 || waits[1].revents != 0 || left.count() <= 0) return false;
    if (!read_some(pipe, output)) waits[2].fd = -1;
  }
}

Failure cannot_start(int error) {
  return {fmt::format("cannot be started ({})", std::generic_category().message(error))};
}

}  // namespace

Result<void, Failure> run_command(const AlertNews& news, Nanoseconds most, const std::stop_token& stop,
                                  std::string& output) {
  std::array<std::string, 3> words = {"/bin/sh", "-c", news.command};
  std::array<char*, 4> arguments = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  std::vector<std::string> environment = environment_for(news);
  std::vector<char*> entries;
  entries.reserve(environment.size() + 1);
  for (std::string& entry : environment) entries.push_back(entry.data());
  entries.push_back(nullptr);

  std::array<int, 2> ends{};
  int error = ::pipe2(ends.data(), O_CLOEXEC) == 0 ? 0 : errno;
  if (error != 0) return cannot_start(error);
  const Descriptor pipe(ends[0]);
  Descriptor print_end(ends[1]);
  ::fcntl(pipe.get(), F_SETFL, O_NONBLOCK);  // only here: its other end may wait

  pid_t process = 0;
  {
    const SpawnPlan plan(print_end.get());
    error = ::posix_spawn(&process, arguments[0], &plan.actions, &plan.attributes, arguments.data(), entries.data());
  }
  print_end.reset();
  if (error != 0) return cannot_start(error);
  const bool ended = has_ended(process, pipe.get(), most, stop, output);
  // Before it is waited for: until then no other process group has its number.
  ::kill(-process, SIGKILL);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  while (output.size() < kMaxCommandOutput_bytes && read_some(pipe.get(), output)) {
  }
  if (!ended) return Failure{fmt::format("was killed, as it had not ended after {:.0f} s", seconds(most))};
  if (WIFSIGNALED(status)) return Failure{fmt::format("was killed by signal {}", WTERMSIG(status))};
  if (WEXITSTATUS(status) != 0) return Failure{fmt::format("has failed with exit code {}", WEXITSTATUS(status))};
  return {};
}

}  // namespace yuragi::daemon::alerts
