#include "drivers/bus/process_port.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace yuragi::drivers::bus {
namespace {

constexpr int kReapTurns = 200;
constexpr auto kReapTurn = std::chrono::milliseconds(2);

void close_if_open(int& descriptor) noexcept {
  if (descriptor >= 0) ::close(std::exchange(descriptor, -1));
}

/// What happens between fork and exec: only calls that are safe there (signal-safety(7)). `failure` receives errno.
[[noreturn]] void become(char* const* words, int output, int failure, pid_t parent) noexcept {
  // Dies with its parent, even one that died before this call.
  if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) _exit(127);

  // Signals are as a shell leaves them, whatever the parent blocked.
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);

  const int empty = open("/dev/null", O_RDONLY | O_CLOEXEC);
  // What a library opened without O_CLOEXEC. exec closes it; until then `failure` is needed.
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  if (empty >= 0 && dup2(empty, STDIN_FILENO) >= 0 && dup2(output, STDOUT_FILENO) >= 0) execv(words[0], words);
  const int error = errno;
  [[maybe_unused]] const ssize_t written = write(failure, &error, sizeof error);
  _exit(127);
}

class ProcessPort final : public BytePort {
 public:
  explicit ProcessPort(std::vector<std::string> command)
      : command_(std::move(command)), wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    killed_.reserve(16);
  }
  ~ProcessPort() override {
    close();
    close_if_open(wake_);
  }
  ProcessPort(const ProcessPort&) = delete;
  ProcessPort& operator=(const ProcessPort&) = delete;

  Result<void, Failure> open() override {
    close();
    if (is_interrupted()) return Failure{"interrupted"};
    std::array<int, 2> output = {-1, -1};
    std::array<int, 2> failure = {-1, -1};
    if (wake_ < 0 || pipe2(output.data(), O_CLOEXEC) != 0 || pipe2(failure.data(), O_CLOEXEC) != 0) {
      const int error = errno;
      close_if_open(output[0]);
      close_if_open(output[1]);
      return Failure{fmt::format("no pipe to {} ({}): check the limit of open files", command_[0],
                                 std::generic_category().message(error))};
    }

    std::vector<char*> words;
    for (std::string& word : command_) words.push_back(word.data());
    words.push_back(nullptr);
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ == 0) become(words.data(), output[1], failure[1], parent);
    const int fork_error = errno;
    close_if_open(output[1]);
    close_if_open(failure[1]);
    output_ = output[0];

    // A successful exec closes the other end of this pipe; otherwise errno comes through it.
    int error = process_ < 0 ? fork_error : 0;
    if (process_ > 0 && ::read(failure[0], &error, sizeof error) != static_cast<ssize_t>(sizeof error)) error = 0;
    close_if_open(failure[0]);
    if (error == 0) return {};
    close();
    return Failure{fmt::format("cannot start {} ({}): check that it is installed and executable", command_[0],
                               std::generic_category().message(error))};
  }

  void close() noexcept override {
    close_if_open(output_);
    if (process_ > 0) {
      kill(process_, SIGKILL);
      killed_.push_back(std::exchange(process_, -1));
    }
    // A killed process is gone within a moment, unless a driver of the system holds it: that one is checked again
    // later.
    for (int turn = 0; turn < kReapTurns && !killed_.empty(); ++turn) {
      std::erase_if(killed_, [](pid_t process) { return waitpid(process, nullptr, WNOHANG) != 0; });
      if (!killed_.empty()) std::this_thread::sleep_for(kReapTurn);
    }
  }

  ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (output_ < 0) return {.status = ByteStatus::kLost};
    std::array<pollfd, 2> waits = {{{wake_, POLLIN, 0}, {output_, POLLIN, 0}}};
    const auto wait_ms = std::chrono::ceil<std::chrono::milliseconds>(
        std::clamp<Nanoseconds>(timeout, Nanoseconds::zero(), std::chrono::hours(1)));
    const int count = poll(waits.data(), waits.size(), static_cast<int>(wait_ms.count()));
    if (waits[0].revents != 0) return {.status = ByteStatus::kInterrupted};
    if (count <= 0) return {.status = ByteStatus::kSilence};

    const ssize_t size = ::read(output_, buffer.data(), buffer.size());
    if (size > 0) return {.status = ByteStatus::kBytes, .size = static_cast<std::size_t>(size)};
    return {.status = size < 0 && errno == EINTR ? ByteStatus::kSilence : ByteStatus::kLost};
  }

  bool write(std::span<const std::uint8_t> /*bytes*/) override { return false; }

  void interrupt() noexcept override { eventfd_write(wake_, 1); }

 private:
  bool is_interrupted() const noexcept {
    pollfd wait = {wake_, POLLIN, 0};
    return poll(&wait, 1, 0) > 0;
  }

  std::vector<std::string> command_;
  int wake_;
  int output_ = -1;
  pid_t process_ = -1;
  std::vector<pid_t> killed_;  ///< that have not been seen to end
};

}  // namespace

std::unique_ptr<BytePort> make_process_port(std::vector<std::string> command) {
  return std::make_unique<ProcessPort>(std::move(command));
}

}  // namespace yuragi::drivers::bus
