// `yuragi mic-worker`: the child process in which the driver `microphone` runs PortAudio. People use its --list.
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <memory>

#include <fcntl.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/sensing/system_clock.hpp"
#include "drivers/microphone/microphone_worker.hpp"

namespace yuragi::daemon::commands {
namespace {

struct WorkerOptions {
  drivers::microphone::MicWorkerOptions worker;
  bool list = false;
  bool verbose = false;
};

/// Set by SIGTERM and SIGINT. The work also ends when nobody reads the output any more.
std::atomic<bool> is_worker_over = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

void end_worker(int /*signal*/) {
  is_worker_over = true;
}

/// Keeps the output of libraries out of the frames: redirects standard output to standard error, and that to /dev/null
/// unless it is wanted (ALSA prints much about each device that it tries). Returns the original standard output.
int take_output(bool verbose) {
  const int output = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (output < 0) throw ExitError(kExitUnavailable, "mic-worker has no standard output");
  if (!verbose) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  }
  dup2(STDERR_FILENO, STDOUT_FILENO);
  return output;
}

void list_devices(drivers::bus::AudioInput& input, int output) {
  const auto devices = input.list();
  const std::string text = devices ? drivers::microphone::list_of_microphones(*devices) : "";
  if (write(output, text.data(), text.size()) < 0 || !devices) _exit(kExitUnavailable);
}

void work(const WorkerOptions& options) {
  if (!options.list && isatty(STDOUT_FILENO) != 0) {
    throw ExitError(kExitUsage,
                    "mic-worker is started by the daemon, and its output is binary; --list shows the inputs");
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGTERM, end_worker);
  std::signal(SIGINT, end_worker);
  // Searching for inputs must not start a JACK server. setenv() is safe: there is only one thread yet.
  setenv("JACK_NO_START_SERVER", "1", 0);  // NOLINT(concurrency-mt-unsafe)

  const int output = take_output(options.verbose);
  auto input = drivers::bus::make_portaudio_input();
  if (options.list) {
    list_devices(*input, output);
  } else {
    static const sensing::SystemClock clock;  // outlives the sound system's thread
    const bool was_stopped =
        drivers::microphone::run_microphone_worker(options.worker, *input, clock, output, is_worker_over);
    // Closing a device that is gone can hang the library: exit without closing it.
    if (!was_stopped) _exit(kExitUnavailable);
  }
}

void add_mic_worker(CLI::App& app) {
  CLI::App* command = app.add_subcommand("mic-worker", "the process of the microphone driver; --list shows the inputs");
  command->group("");  // not in the main help
  auto options = std::make_shared<WorkerOptions>();
  drivers::microphone::MicWorkerOptions& worker = options->worker;
  command->add_flag("--list", options->list,
                    "print the inputs: sound system, channels, preferred rate in Hz, \"default\" or \"-\", name");
  command->add_option("--device", worker.choice.device, "a part of the input's name; empty: the default");
  command->add_option("--host-api", worker.choice.host_api, "a part of the sound system's name");
  command->add_option("--channels", worker.choice.channels, "channels")
      ->check(CLI::Range(1, static_cast<int>(drivers::bus::kAudioMaxChannels)));
  command->add_option("--rate", worker.choice.rate_hz, "sample rate, Hz; 0: what the device prefers")
      ->check(CLI::Range(0.0, 1e6));
  command->add_option("--band-low", worker.low_hz, "lower edge of the wind band, Hz")->check(CLI::Range(2.0, 1000.0));
  command->add_option("--band-high", worker.high_hz, "upper edge of the wind band, Hz")
      ->check(CLI::Range(10.0, 2000.0));
  command->add_flag("--verbose", options->verbose, "show the messages of the sound system on standard error");
  command->callback([options] { work(*options); });
}

}  // namespace

extern const Command kMicWorkerCommand;
const Command kMicWorkerCommand{add_mic_worker};

}  // namespace yuragi::daemon::commands
