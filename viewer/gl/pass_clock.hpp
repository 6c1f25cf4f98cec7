#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <epoxy/gl.h>

namespace yuragi::viewer::gl {

/// What each pass of a picture costs. For measurements: it waits.
///
/// By the GPU: by timestamps between the passes (GL_TIMESTAMP), read when the picture is done; before OpenGL 3.3, where
/// they may be missing, each pass is waited for, and its time is the clock's. By the processor, where that draws (which
/// otherwise draws all passes together at the end): each pass is waited for, and its time is that of all threads of the
/// process.
class PassClock {
 public:
  enum class By : std::uint8_t { kGpu, kProcessor };
  /// Needs a current context.
  explicit PassClock(By by);
  ~PassClock();
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

  /// A picture begins.
  void begin();
  /// What has been drawn since the last mark, or since begin(), is of the pass `name`.
  void mark(std::string_view name);

  struct Pass {
    std::string name;
    double time_ms = 0.0;
    double thread_ms = 0.0;  ///< processor time of the drawing thread
    std::size_t uploaded_bytes = 0;
    std::size_t triangles = 0;  ///< given to the pass, seen or not
  };
  /// The picture ends. Its passes in order; marks of the same name are added up. Waits until the GPU is done.
  std::vector<Pass> end();

 private:
  /// What had been spent at a mark since the program began; the clock counts from an unknown moment.
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
  std::vector<GLuint> timestamps_;       // one more than names_ while a picture is drawn; those behind are for later
  std::vector<GLuint> triangle_counts_;  // likewise; the last is being counted
  std::vector<Spent> spent_;             // likewise
  std::vector<std::string> names_;
};

}  // namespace yuragi::viewer::gl
