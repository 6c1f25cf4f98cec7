#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace yuragi::viewer::app {

/// One picture that was handed to the display.
struct Swap {
  std::int64_t utc_ns = 0;         ///< when the display had taken it
  std::uint64_t tick = 0;          ///< of the frame that it shows, or of the earlier of two that it is between
  std::int64_t chosen_utc_ns = 0;  ///< the UTC for which its moment was chosen
  bool is_in_step = false;         ///< chosen by the fixed delay of the output, from a live stream
  std::uint64_t late_frames = 0;   ///< until then
};

/// Writes a line of CSV for each picture, to compare the screens of a wall. Thread-safe: no.
class SwapLog {
 public:
  /// Throws ViewerExit (EX_CANTCREAT) if the file cannot be written.
  explicit SwapLog(const std::string& file);

  /// A line that cannot be written is left out, which is reported once on standard error.
  void add(const Swap& swap);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  bool has_failed_ = false;
};

}  // namespace yuragi::viewer::app
