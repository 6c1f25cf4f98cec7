#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <epoxy/gl.h>

namespace yuragi::viewer::gl {

/// How long each pass of a picture takes. For measurements: it waits.
///
/// By the GPU: by timestamps between the passes (GL_TIMESTAMP), read when the picture is done. By the processor, where
/// that draws (which otherwise draws all passes together at the end): each pass is waited for, and its time is that of
/// all threads of the process.
class PassClock {
 public:
  enum class By : std::uint8_t { kGpu, kProcessor };
  explicit PassClock(By by) : by_(by) {}
  ~PassClock();
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

  /// A picture begins.
  void begin();
  /// What has been drawn since the last mark, or since begin(), is of the pass `name`.
  void mark(std::string_view name);

  struct Pass {
    std::string name;
    double time_ms;
  };
  /// Those of the picture, in order; marks of the same name are added up. Waits until the GPU is done.
  std::vector<Pass> passes() const;

 private:
  void put_timestamp();

  By by_;
  std::vector<GLuint> queries_;   // one more than names_ while a picture is drawn; those behind are for later
  std::vector<double> times_ms_;  // likewise, of the processor
  std::vector<std::string> names_;
};

}  // namespace yuragi::viewer::gl
