#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <epoxy/gl.h>

#include "viewer/gl/pass_marks.hpp"

namespace yuragi::viewer::gl {

/// Measures the cost of each pass of a picture. It waits, so it slows the picture.
///
/// On a GPU: by timestamps between the passes (GL_TIMESTAMP), read when the picture is done; before OpenGL 3.3, where
/// they may be missing, it waits for each pass and uses the clock. If the processor draws (which otherwise draws all
/// passes together at the end): it waits for each pass, whose time is that of all threads of the process.
class PassClock final : public PassMarks {
 public:
  enum class By : std::uint8_t { kGpu, kProcessor };
  /// Needs a current context.
  explicit PassClock(By by);
  ~PassClock() override;
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

  void begin() override;
  void mark(std::string_view name) override;

  struct Pass {
    std::string name;
    double time_ms = 0.0;
    double thread_ms = 0.0;  ///< processor time of the drawing thread
    std::size_t uploaded_bytes = 0;
    std::size_t triangles = 0;  ///< given to the pass, seen or not
  };
  /// Ends the picture. Returns its passes in order; marks of the same name are added up. Waits until the GPU is done.
  std::vector<Pass> end();

 private:
  /// The time spent since the program started, at a mark; the clock counts from an unknown moment.
  struct Spent {
    double all_threads_ms = 0.0;
    double thread_ms = 0.0;
    double clock_ms = 0.0;
    std::size_t uploaded_bytes = 0;
  };

  void put_mark();
  static void grow(std::vector<GLuint>& queries, std::size_t count);

  By by_;
  bool has_timestamps_;
  std::vector<GLuint> timestamps_;       // one more than names_ while a picture is drawn; the rest are spare
  std::vector<GLuint> triangle_counts_;  // in the same order; the last is being counted
  std::vector<Spent> spent_;             // likewise
  std::vector<std::string> names_;
};

}  // namespace yuragi::viewer::gl
