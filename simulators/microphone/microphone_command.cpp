#include <cstdio>
#include <memory>
#include <string>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/microphone/microphone_file.hpp"
#include "simulators/microphone/microphone_simulator.hpp"

namespace yuragi::simulators::microphone {
namespace {

constexpr const char* kMicrophoneFooter =
    "Ways to connect it:\n"
    "  --listen /tmp/mic.sock    the ALSA plugin that the project's tests build (tests/support/alsa_windsim)\n"
    "  --pipe FILE               pactl load-module module-pipe-source file=FILE format=float32le rate=48000 "
    "channels=1\n"
    "  --out - --format s16 | aplay -D hw:0,0 -t raw -f S16_LE -r 48000 -c 1    a kernel's loop-back (snd-aloop)\n"
    "  --out wind.wav --duration 60                                            a sound file";

struct CommandOptions {
  Options microphone;
  Outputs outputs;
  std::string file;
  std::string format = "float32";
  core::CommonOptions common;
};

void simulate_microphone(CommandOptions options) {
  options.microphone.seed = options.common.synthetic.seed;
  if (!options.file.empty()) {
    const double endless_s = 1e9;
    write_microphone_file(options.file, options.format == "s16" ? SampleFormat::kSigned16 : SampleFormat::kFloat32,
                          options.microphone, options.common.make_wind(),
                          options.common.make_faults(microphone_faults()),
                          options.common.run.duration_s.value_or(options.file == "-" ? endless_s : 60.0));
    return;
  }
  Simulator simulator(options.microphone, options.outputs, options.common.make_wind());

  // Scripts wait for this line.
  std::printf("sounding\n");
  std::fflush(stdout);
  options.common.run_simulator(simulator);
}

}  // namespace

extern const core::Command kMicrophoneCommand;
const core::Command kMicrophoneCommand{[](CLI::App& app) {
  auto options = std::make_shared<CommandOptions>();
  Options& microphone = options->microphone;
  CLI::App* command = app.add_subcommand("microphone", "sound of wind in bare microphones, with voices and music");
  command->footer(kMicrophoneFooter);
  auto* socket = command->add_option("--listen", options->outputs.socket,
                                     "Unix socket that sends every client raw float32 frames in real time");
  auto* pipe = command->add_option("--pipe", options->outputs.pipe, "named pipe to write to, in the same format");
  auto* file = command->add_option("--out", options->file,
                                   "FILE.wav, any other name for raw samples, or - for standard output: as fast as it "
                                   "is read; 60 s unless --duration is given, endless to -");
  file->excludes(socket)->excludes(pipe);
  command->add_option("--format", options->format, "sample format of --out")
      ->check(CLI::IsMember({"float32", "s16"}))
      ->capture_default_str();
  command->add_option("--channels", microphone.channels, "microphones")
      ->check(CLI::Range(1, static_cast<int>(kMicrophoneMaxChannels)))
      ->capture_default_str();
  command->add_option("--rate", microphone.rate_hz, "samples per second")
      ->check(CLI::Range(100.0, 192000.0))
      ->capture_default_str();
  command->add_option("--exponent", microphone.exponent, "the root mean square grows with the wind to this power")
      ->check(CLI::Range(0.5, 5.0))
      ->capture_default_str();
  command->add_option("--level", microphone.level_at_10_m_s_db, "root mean square at 10 m/s, dB re full scale")
      ->check(CLI::Range(-100.0, 20.0))
      ->capture_default_str();
  command->add_option("--noise", microphone.noise_db, "noise of each microphone, in the same unit")
      ->check(CLI::Range(-150.0, 0.0))
      ->capture_default_str();
  command->add_option("--voice", microphone.voice_db, "level of a voice, in the same unit")
      ->check(CLI::Range(-150.0, 0.0));
  command->add_option("--music", microphone.music_db, "level of music, in the same unit")
      ->check(CLI::Range(-150.0, 0.0));
  command->add_flag("--faces", microphone.has_faces,
                    "the microphones face 0, 360 / channels, ... degrees, and the one in the wind is the loudest");
  options->common.add_to(*command);
  command->callback([options] {
    if (options->file.empty() && options->outputs.socket.empty() && options->outputs.pipe.empty()) {
      throw CLI::RequiredError("give one of --listen, --pipe and --out");
    }
    simulate_microphone(*options);
  });
}};

}  // namespace yuragi::simulators::microphone
