#include "daemon/alerts/shell_command.hpp"

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

#include "engine/base/version.hpp"

namespace yuragi::daemon::alerts {
namespace {

/// A process group of its own, no signal that this program blocks or ignores, nothing to read, and its standard output
/// where errors go: that of this program may be data.
class SpawnPlan {
 public:
  SpawnPlan() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
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

/// Waits until a process has ended; false: it has not after `most`, or a stop was requested.
bool has_ended(pid_t process, Nanoseconds most, const std::stop_token& stop) {
  const int ended = static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
  const int wake = ::eventfd(0, EFD_CLOEXEC);
  bool has = false;
  if (ended >= 0 && wake >= 0) {
    const std::stop_callback wakes(stop, [wake] { ::eventfd_write(wake, 1); });
    const auto end = std::chrono::steady_clock::now() + most;
    std::array<pollfd, 2> waits = {{{ended, POLLIN, 0}, {wake, POLLIN, 0}}};
    int count = -1;
    do {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
      count = ::poll(waits.data(), waits.size(), static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    } while (count < 0 && errno == EINTR);
    has = waits[0].revents != 0;
  }
  if (ended >= 0) ::close(ended);
  if (wake >= 0) ::close(wake);
  return has;
}

}  // namespace

Result<void, Failure> run_command(const AlertNews& news, Nanoseconds most, const std::stop_token& stop) {
  std::array<std::string, 3> words = {"/bin/sh", "-c", news.command};
  std::array<char*, 4> arguments = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  std::vector<std::string> environment = environment_for(news);
  std::vector<char*> entries;
  entries.reserve(environment.size() + 1);
  for (std::string& entry : environment) entries.push_back(entry.data());
  entries.push_back(nullptr);

  const SpawnPlan plan;
  pid_t process = 0;
  if (const int error =
          ::posix_spawn(&process, arguments[0], &plan.actions, &plan.attributes, arguments.data(), entries.data());
      error != 0)
    return Failure{fmt::format("cannot be started ({})", std::generic_category().message(error))};
  const bool ended = has_ended(process, most, stop);
  if (!ended) ::kill(-process, SIGKILL);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!ended) return Failure{fmt::format("was killed, as it had not ended after {:.0f} s", seconds(most))};
  if (WIFSIGNALED(status)) return Failure{fmt::format("was killed by signal {}", WTERMSIG(status))};
  if (WEXITSTATUS(status) != 0) return Failure{fmt::format("has failed with exit code {}", WEXITSTATUS(status))};
  return {};
}

}  // namespace yuragi::daemon::alerts
