#pragma once

#include <string_view>

namespace yuragi::viewer::gl {

/// Takes the marks between the passes of a picture.
class PassMarks {
 public:
  virtual ~PassMarks() = default;

  /// A picture begins.
  virtual void begin() = 0;
  /// What was drawn since the last mark, or since begin(), is the pass `name`.
  virtual void mark(std::string_view name) = 0;
};

}  // namespace yuragi::viewer::gl
