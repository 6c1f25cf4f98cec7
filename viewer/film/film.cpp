#include "viewer/film/film.hpp"

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/base/count_text.hpp"
#include "engine/base/time.hpp"
#include "viewer/film/film_progress.hpp"
#include "viewer/picture/gl_renderer.hpp"
#include "viewer/picture/headless.hpp"
#include "viewer/picture/null_renderer.hpp"
#include "viewer/picture/picture_director.hpp"
#include "viewer/picture/viewer_exit.hpp"
#include "viewer/stream/lockstep_timeline.hpp"

namespace yuragi::viewer::film {
namespace {

constexpr int kFilmSamples = 4;  // a pixel
constexpr double kTerminalProgress_s = 0.5;
constexpr double kLogProgress_s = 30.0;
/// The replay is longer than the film by this, because the film's last picture can lie between two ticks.
constexpr double kMoreReplay_s = 0.25;

/// Returns the number of pictures of a film: those at 0, 1 / fps ... before its end.
int picture_count(double duration_s, double fps) {
  return static_cast<int>(std::ceil(std::min(duration_s * fps, 1e9) - 1e-6));
}

/// Takes a stream's messages, up to the frame that is needed for a moment.
class Reader {
 public:
  Reader(Stream& stream, picture::Director& director, const std::string& source)
      : stream_(stream), director_(director), source_(source) {}

  /// Reads until a frame at least this long after the first one. Returns false if the stream ends first.
  bool read_until(double after_first_s) {
    while (!timeline_.has_begun() || timeline_.newest_s() - first_s_ < after_first_s) {
      auto message = stream_.next();
      if (!message) return false;
      std::visit([this](auto& body) { take(body); }, *message);
    }
    return true;
  }

  const stream::PoseMoment& moment_at(double after_first_s) { return timeline_.at(first_s_ + after_first_s); }
  double utc_s_at(double after_first_s) const { return utc_s_ + after_first_s - (timeline_.newest_s() - first_s_); }
  /// Nullopt if the stream does not report it.
  std::optional<double> length_s() const { return length_s_; }

 private:
  template <class Message>
  void take(Message& /*of no use for a film*/) {}
  void take(wire::Hello& hello) {
    if (const auto mismatch = wire::protocol_mismatch(hello)) {
      throw picture::ViewerExit(EX_SOFTWARE, fmt::format("{} ({}) {}", source_, hello.software, *mismatch));
    }
    if (hello.wind_from_deg) director_.set_wind_from(*hello.wind_from_deg);
  }
  void take(wire::Scenes& scenes) {
    timeline_.set_scenes(scenes.scenes);
    director_.set_scenes(std::move(scenes.scenes));
  }
  void take(wire::Sensors& status) { director_.take_status(status); }
  void take(wire::ControlReply& reply) {
    if (!reply.players.empty()) length_s_ = reply.players.front().length_s;
  }
  void take(wire::Frame& frame) {
    if (!timeline_.accept(frame))
      throw picture::ViewerExit(EX_SOFTWARE, source_ + " sent a frame that does not fit the scenes");
    if (!std::exchange(has_first_, true)) first_s_ = frame.info.time_s;
    utc_s_ = 1e-9 * static_cast<double>(frame.info.utc_ns);
  }

  Stream& stream_;
  picture::Director& director_;
  const std::string& source_;
  stream::LockstepTimeline timeline_;
  bool has_first_ = false;
  double first_s_ = 0.0;  // of the first frame, on the sender's time line
  double utc_s_ = 0.0;    // of the newest frame
  std::optional<double> length_s_;
};

std::vector<std::string> replay_arguments(const picture::ViewerOptions& options) {
  std::vector<std::string> arguments = {options.render};
  const auto add = [&arguments](const std::string& name, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {name, value});
  };
  add("--config", options.config);
  add("--start", options.from);
  add("--states", options.states);
  if (options.duration_s) add("--duration", fmt::format("{}", *options.duration_s + kMoreReplay_s));
  if (options.is_as_recorded) arguments.emplace_back("--as-recorded");
  return arguments;
}

/// On a terminal a line that is updated, otherwise a new line from time to time.
class ProgressLine {
 public:
  void show(int made, std::optional<int> total) {
    const double now_s = passed_s();
    if (now_s - shown_s_ < (is_terminal_ ? kTerminalProgress_s : kLogProgress_s)) return;
    shown_s_ = now_s;
    const std::string text = film_progress_text(made, total, now_s);
    is_terminal_ ? fmt::print(stderr, "\r\x1b[K{}", text) : fmt::print(stderr, "yuragi-viewer: {}\n", text);
    std::fflush(stderr);
  }
  void end() const {
    if (is_terminal_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  double passed_s() const { return seconds(std::chrono::steady_clock::now() - began_); }

  const bool is_terminal_ = ::isatty(STDERR_FILENO) != 0;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  double shown_s_ = 0.0;
};

std::unique_ptr<picture::Renderer> make_renderer(const picture::ViewerOptions& options) {
  if (options.draws_nothing) return std::make_unique<picture::NullRenderer>(options.width_px, options.height_px);
  return std::make_unique<picture::GlRenderer>(picture::make_headless_context(), options.width_px, options.height_px,
                                               options.samples.value_or(kFilmSamples));
}

}  // namespace

bool make_film(const picture::ViewerOptions& options, Stream& stream, picture::Renderer& renderer, Output& output,
               const Progress& progress, const std::atomic<bool>& is_stopping) {
  const std::string source = std::filesystem::path(options.render).filename().string();
  picture::Director director(options, renderer, source);
  Reader reader(stream, director, source);
  int made = 0;
  for (;;) {
    const double time_s = made / options.fps;
    if (options.duration_s && made >= picture_count(*options.duration_s, options.fps)) return true;
    if (!reader.read_until(time_s)) return !is_stopping && made > 0;
    if (is_stopping) return false;
    const stream::PoseMoment& moment = reader.moment_at(time_s);
    director.advance(made > 0 ? 1.0 / options.fps : 0.0, reader.utc_s_at(time_s), moment.wind.wind);
    director.draw(moment);
    output.write(renderer.read_rgb());
    ++made;

    std::optional<double> length_s = options.duration_s;
    if (const auto whole_s = reader.length_s()) length_s = std::min(length_s.value_or(*whole_s), *whole_s);
    std::optional<int> total;
    if (length_s) total = std::max(made, picture_count(*length_s, options.fps));
    progress(made, total);
  }
}

void render_recording(const picture::ViewerOptions& options, const std::atomic<bool>& is_stopping) {
  // Reports a closed pipe and a full disk as errors, instead of ending the program by a signal.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  const std::unique_ptr<Output> output = make_film_output(
      options.out, {.width_px = options.width_px, .height_px = options.height_px, .pictures_per_s = options.fps},
      is_stopping);
  ReplayFilmStream stream(replay_arguments(options), is_stopping);
  const std::unique_ptr<picture::Renderer> renderer = make_renderer(options);
  ProgressLine line;
  std::uint64_t pictures = 0;
  bool is_whole = false;
  try {
    is_whole = make_film(
        options, stream, *renderer, *output,
        [&](int made, std::optional<int> total) {
          pictures = static_cast<std::uint64_t>(made);
          line.show(made, total);
        },
        is_stopping);
  } catch (...) {
    line.end();
    throw;
  }
  line.end();
  if (!is_whole) {
    throw picture::ViewerExit(
        is_stopping ? kExitInterrupted : EX_DATAERR,
        is_stopping ? fmt::format("interrupted after {}: the film is not whole", count_text(pictures, "picture"))
                    : options.render + " has no moment to show from there on");
  }
  output->finish();
  fmt::print(stderr, "yuragi-viewer: {}: {}, {:.2f} s\n", output->text(), count_text(pictures, "picture"),
             static_cast<double>(pictures) / options.fps);
}

}  // namespace yuragi::viewer::film
