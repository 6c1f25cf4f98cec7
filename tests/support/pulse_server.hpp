#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"

namespace yuragi::test {

/// A PulseAudio of the test's own, without hardware, D-Bus or display.
class PulseServer {
 public:
  /// Its files and its socket stand in `folder`. Throws if it does not come up.
  explicit PulseServer(const std::filesystem::path& folder)
      : socket_("unix:" + (folder / "pulse.sock").string()), process_(command(folder)) {
    process_.line_after("I: [pulseaudio] main.c: Daemon startup complete");
  }

  /// As clients name it.
  const std::string& address() const { return socket_; }

  /// Loads a module; its number. Throws if there is none.
  std::string load(const std::vector<std::string>& module) {
    std::vector<std::string> words = {"load-module"};
    words.insert(words.end(), module.begin(), module.end());
    auto [text, code] = control(words);
    if (code != 0) throw std::runtime_error("PulseAudio does not load " + module.front() + ": " + text);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }
  void unload(const std::string& number) { control({"unload-module", number}); }

 private:
  static std::vector<std::string> command(const std::filesystem::path& folder) {
    for (const char* part : {"home", "run", "state"}) std::filesystem::create_directories(folder / part);
    std::filesystem::permissions(folder / "run", std::filesystem::perms::owner_all);
    const auto in = [&](const char* name, const char* part) { return name + ("=" + (folder / part).string()); };
    const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
    return {"env",
            "-i",
            "PATH=" + std::string(path != nullptr ? path : "/usr/bin:/bin"),
            in("HOME", "home"),
            in("XDG_RUNTIME_DIR", "run"),
            in("PULSE_RUNTIME_PATH", "run"),
            in("PULSE_STATE_PATH", "state"),
            "DBUS_SESSION_BUS_ADDRESS=disabled:",
            "pulseaudio",
            "-n",
            "--daemonize=no",
            "--exit-idle-time=-1",
            "--realtime=no",
            "--high-priority=no",
            "--use-pid-file=no",
            "--disable-shm=yes",
            "--log-target=stderr",
            "--log-level=info",
            "-L",
            "module-native-protocol-unix socket=" + (folder / "pulse.sock").string() + " auth-anonymous=1"};
  }

  /// What pactl says, and how it ends.
  std::pair<std::string, int> control(const std::vector<std::string>& words) const {
    std::vector<std::string> command = {"env", "PULSE_SERVER=" + socket_, "pactl"};
    command.insert(command.end(), words.begin(), words.end());
    ChildProcess pactl(command);
    std::string text = pactl.rest();
    return {std::move(text), pactl.wait()};
  }

  std::string socket_;
  ChildProcess process_;
};

}  // namespace yuragi::test
