#include "tests/viewer/running_viewer.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/places.hpp"
#include "tests/viewer/started_program.hpp"

namespace yuragi::viewer {

RunningViewer::RunningViewer(std::vector<std::string> options, const std::vector<std::string>& environment,
                             std::filesystem::path says)
    : says_(std::move(says)) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, says_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  options.insert(options.begin(), test::built_path("bin/yuragi-viewer"));
  child_ = start_program(std::move(options), environment, &actions);
  posix_spawn_file_actions_destroy(&actions);
}

RunningViewer::~RunningViewer() {
  if (child_ != 0) end();
}

int RunningViewer::wait() {
  if (child_ == 0) return -1;
  int status = -1;
  waitpid(std::exchange(child_, 0), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int RunningViewer::end() {
  if (child_ != 0) ::kill(child_, SIGTERM);
  return wait();
}

std::string RunningViewer::said() const {
  std::ostringstream text;
  text << std::ifstream(says_).rdbuf();
  return text.str();
}

bool comes_true(const std::function<bool()>& condition) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (std::chrono::steady_clock::now() < limit) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

}  // namespace yuragi::viewer
