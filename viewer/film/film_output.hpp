#pragma once

#include <atomic>
#include <csignal>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace yuragi::viewer::film {

/// The shell's exit code for a program that Ctrl-C has ended.
inline constexpr int kExitInterrupted = 128 + SIGINT;

/// The destination of a film's pictures. Errors throw ViewerExit. Without finish() the destructor removes every file
/// and folder that this has made, and no others.
class Output {
 public:
  virtual ~Output() = default;

  /// The next picture: 3 bytes a pixel, rows from the top down.
  virtual void write(std::span<const std::uint8_t> rgb) = 0;
  /// After the last one.
  virtual void finish() = 0;
  /// For a person: "take.mp4".
  virtual std::string text() const = 0;
};

struct Format {
  int width_px = 0;
  int height_px = 0;
  double pictures_per_s = 30.0;
};

/// Returns the error in the name of a film, or an empty text.
std::string check_film_name(const std::string& name);

/// `name`: "-", the bytes of one picture after the other on standard output; FILE.mp4, which ffmpeg makes as a child
/// process and which appears when it is complete; or a folder, which is made, for 000001.png and so on. Once
/// `is_stopping` is set a waiting write() throws; it must outlive the output.
std::unique_ptr<Output> make_film_output(const std::string& name, const Format& format,
                                         const std::atomic<bool>& is_stopping);

}  // namespace yuragi::viewer::film
