#include "drivers/bus/process_port.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <optional>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "engine/platform/child_process.hpp"
#include "engine/platform/descriptor.hpp"

namespace yuragi::drivers::bus {
namespace {

using platform::close_if_open;

constexpr int kKillTakes_ms = 400;

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
    if (wake_ < 0 || pipe2(output.data(), O_CLOEXEC) != 0) {
      return Failure{fmt::format("cannot open a pipe to {} ({}): check the limit of open files (ulimit -n)",
                                 command_[0], std::generic_category().message(errno))};
    }
    output_ = output[0];
    try {
      process_.emplace(platform::ChildProcess::Setup{.command = command_, .output = output[1]});
      close_if_open(output[1]);
      return {};
    } catch (const std::system_error& error) {
      close_if_open(output[1]);
      close();
      return Failure{fmt::format("cannot start {} ({}): check that it is installed and executable", command_[0],
                                 error.code().message())};
    }
  }

  void close() noexcept override {
    close_if_open(output_);
    std::erase_if(killed_, [](platform::ChildProcess& process) { return process.end().has_value(); });
    if (!process_) return;
    process_->signal(SIGKILL);
    // A killed process ends within a moment, unless a system driver holds it: then it is checked again later.
    if (!process_->end(kKillTakes_ms)) killed_.push_back(std::move(*process_));
    process_.reset();
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
  std::optional<platform::ChildProcess> process_;
  std::vector<platform::ChildProcess> killed_;  ///< that have not been seen to end
};

}  // namespace

std::unique_ptr<BytePort> make_process_port(std::vector<std::string> command) {
  return std::make_unique<ProcessPort>(std::move(command));
}

}  // namespace yuragi::drivers::bus
