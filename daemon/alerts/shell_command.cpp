#include "daemon/alerts/shell_command.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "engine/platform/child_process.hpp"
#include "engine/platform/descriptor.hpp"

namespace yuragi::daemon::alerts {
namespace {

using platform::Descriptor;

/// Returns this program's environment and the command's own variables. A name can hold any byte except zero.
std::vector<std::string> environment_for(const News& news) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!std::string_view(*entry).starts_with("YURAGI_ALERT")) all.emplace_back(*entry);
  }
  all.push_back("YURAGI_ALERT=" + news.alert);
  all.push_back(std::string("YURAGI_ALERT_STATE=") + (news.has_begun ? "began" : "ended"));
  all.push_back("YURAGI_ALERT_MESSAGE=" + news.message);
  return all;
}

/// Reads once from a pipe, and appends as much as fits. Returns false if there is nothing to read now, or the pipe is
/// closed.
bool read_some(int pipe, std::string& output) {
  std::array<char, 4096> block{};
  const ssize_t count = ::read(pipe, block.data(), block.size());
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) return false;
  output.append(block.data(), std::min(static_cast<std::size_t>(count), kMaxCommandOutput_bytes - output.size()));
  return true;
}

/// Waits until a process has ended and reads its output meanwhile. Returns false if it has not ended after `most`, or a
/// stop was requested.
bool has_ended(const platform::ChildProcess& process, int pipe, Nanoseconds most, const std::stop_token& stop,
               std::string& output) {
  const Descriptor wake(::eventfd(0, EFD_CLOEXEC));
  if (wake.get() < 0) return false;
  const std::stop_callback wakes(stop, [&wake] { ::eventfd_write(wake.get(), 1); });
  const auto end = std::chrono::steady_clock::now() + most;
  std::array<pollfd, 3> waits = {{{process.descriptor(), POLLIN, 0}, {wake.get(), POLLIN, 0}, {pipe, POLLIN, 0}}};
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    const int count = ::poll(waits.data(), waits.size(), static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (count < 0 && errno == EINTR) continue;
    if (count > 0 && waits[0].revents != 0) return true;
    // A command that prints continuously has the same time limit.
    if (count <= 0 || waits[1].revents != 0 || left.count() <= 0) return false;
    if (!read_some(pipe, output)) waits[2].fd = -1;
  }
}

Failure cannot_start(int error) {
  return {fmt::format("cannot be started ({})", std::generic_category().message(error))};
}

}  // namespace

Result<void, Failure> run_command(const News& news, Nanoseconds most, const std::stop_token& stop,
                                  std::string& output) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return cannot_start(errno);
  const Descriptor pipe(ends[0]);
  Descriptor print_end(ends[1]);
  ::fcntl(pipe.get(), F_SETFL, O_NONBLOCK);  // only here: its other end may wait

  std::optional<platform::ChildProcess> process;
  try {
    process.emplace(platform::ChildProcess::Setup{.command = {"/bin/sh", "-c", news.command},
                                                  .output = print_end.get(),
                                                  .error = print_end.get(),
                                                  .environment = environment_for(news),
                                                  .has_own_group = true});
  } catch (const std::system_error& error) {
    return cannot_start(error.code().value());
  }
  print_end.reset();
  const bool ended = has_ended(*process, pipe.get(), most, stop, output);
  // Before waiting for it: until then no other process group can have its number.
  process->signal(SIGKILL);
  const platform::ChildEnd end = process->wait();
  while (output.size() < kMaxCommandOutput_bytes && read_some(pipe.get(), output)) {
  }
  if (!ended) return Failure{fmt::format("was killed because it had not ended after {:.0f} s", seconds(most))};
  if (!end.is_good()) return Failure{text_of(end)};
  return {};
}

}  // namespace yuragi::daemon::alerts
