#include "engine/platform/child_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/platform/descriptor.hpp"

namespace yuragi::platform {
namespace {

constexpr int kNotStarted = 127;
constexpr int kKillTakes_ms = 400;

/// Pointers to the words, as exec takes them.
std::vector<char*> pointers_to(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

/// The parameters of exec, prepared before the fork.
struct Becoming {
  std::vector<char*> words;
  std::vector<char*> environment;  ///< empty: ours
  std::array<int, 3> files;        ///< for standard input, output and error; -1: as in ChildProcess::Setup
  int failure;                     ///< a pipe for errno
  pid_t parent;
  bool has_own_group;
};

/// The steps between fork and exec: only calls that are safe there (signal-safety(7)).
[[noreturn]] void become(const Becoming& plan) noexcept {
  // Dies with its parent, even one that died before this call.
  if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != plan.parent) _exit(kNotStarted);
  if (plan.has_own_group) setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  for (int number = 1; number < NSIG; ++number) ::signal(number, SIG_DFL);

  // Copies above the standard ones first: one of them may be a standard one itself.
  std::array<int, 3> files = plan.files;
  if (files[0] < 0) files[0] = open("/dev/null", O_RDONLY | O_CLOEXEC);
  for (int& file : files) file = file < 0 ? -1 : fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  bool is_ready = files[0] >= 0;
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    const int file = files[static_cast<std::size_t>(standard)];
    if (file >= 0) is_ready = is_ready && dup2(file, standard) >= 0;
  }
  // Descriptors that a library opened without O_CLOEXEC. exec closes them; `failure` is needed until then.
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  if (is_ready) {
    execvpe(plan.words[0], plan.words.data(), plan.environment.empty() ? environ : plan.environment.data());
  }
  const int error = errno;
  [[maybe_unused]] const ssize_t written = write(plan.failure, &error, sizeof error);
  _exit(kNotStarted);
}

}  // namespace

std::string text_of(const ChildEnd& end) {
  if (end.signal == 0) return "has failed with exit code " + std::to_string(end.exit_code);
  const char* const name = ::sigdescr_np(end.signal);
  return "was killed by signal " + std::to_string(end.signal) + " (" + (name != nullptr ? name : "unknown") + ")";
}

ChildProcess::ChildProcess(const Setup& setup) : has_own_group_(setup.has_own_group), patience_ms_(setup.patience_ms) {
  const auto fail = [&setup](int error) {
    throw std::system_error(error, std::generic_category(), "cannot start " + setup.command.front());
  };
  std::array<int, 2> failure = {-1, -1};
  if (::pipe2(failure.data(), O_CLOEXEC) != 0) fail(errno);
  Becoming plan{.words = pointers_to(setup.command),
                .environment = {},
                .files = {setup.input, setup.output, setup.error},
                .failure = failure[1],
                .parent = getpid(),
                .has_own_group = setup.has_own_group};
  if (setup.environment) plan.environment = pointers_to(*setup.environment);
  process_ = fork();
  if (process_ == 0) become(plan);
  int error = process_ < 0 ? errno : 0;
  close_if_open(failure[1]);
  // A successful exec closes the other end of this pipe; otherwise it transmits errno.
  while (process_ > 0 && ::read(failure[0], &error, sizeof error) < 0 && errno == EINTR) {
  }
  close_if_open(failure[0]);
  if (process_ > 0 && error == 0) descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, process_, 0));
  if (process_ > 0 && error == 0 && descriptor_ < 0) error = errno;
  if (error == 0) return;
  let_go();
  fail(error);
}

ChildProcess::~ChildProcess() {
  let_go();
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      has_own_group_(other.has_own_group_),
      patience_ms_(other.patience_ms_),
      end_(other.end_) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this == &other) return *this;
  let_go();
  process_ = std::exchange(other.process_, -1);
  descriptor_ = std::exchange(other.descriptor_, -1);
  has_own_group_ = other.has_own_group_;
  patience_ms_ = other.patience_ms_;
  end_ = other.end_;
  return *this;
}

void ChildProcess::let_go() noexcept {
  if (patience_ms_ > 0 && !end()) {
    signal(SIGTERM);
    end(patience_ms_);
  }
  if (!end()) {
    signal(SIGKILL);
    // A killed process ends immediately, unless a system driver holds it. A child that did not start has ended.
    if (descriptor_ >= 0) {
      end(kKillTakes_ms);
    } else {
      wait();
    }
  }
  close_if_open(descriptor_);
}

/// Reaps it if it has ended. Returns true if it does not run any more.
bool ChildProcess::reap(int options) {
  if (process_ <= 0) return true;
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(process_, &status, options)) < 0 && errno == EINTR) {
  }
  if (ended == 0) return false;
  process_ = -1;
  end_ = WIFSIGNALED(status) ? ChildEnd{.signal = WTERMSIG(status)} : ChildEnd{.exit_code = WEXITSTATUS(status)};
  return true;
}

std::optional<ChildEnd> ChildProcess::end(int most_ms) {
  if (most_ms > 0 && process_ > 0) {
    pollfd waiting{descriptor_, POLLIN, 0};
    ::poll(&waiting, 1, most_ms);
  }
  return reap(WNOHANG) ? std::optional(end_) : std::nullopt;
}

ChildEnd ChildProcess::wait() {
  reap(0);
  return end_;
}

void ChildProcess::signal(int number) noexcept {
  if (process_ > 0) ::kill(has_own_group_ ? -process_ : process_, number);
}

}  // namespace yuragi::platform
