#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <epoxy/gl.h>

namespace yuragi::viewer::gl {

/// How long the GPU works on each pass of a picture, by timestamps between them (GL_TIMESTAMP). For measurements:
/// reading waits for the GPU. Where the processor draws, passes are drawn together at the end and cannot be told apart.
class PassClock {
 public:
  PassClock() = default;
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

  std::vector<GLuint> queries_;  // one more than names_ while a picture is drawn; those behind are for later
  std::vector<std::string> names_;
};

}  // namespace yuragi::viewer::gl
