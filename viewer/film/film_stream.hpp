#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/wire/message_reader.hpp"
#include "viewer/film/piped_child.hpp"

namespace yuragi::viewer::film {

/// The source of a film: a stream that waits for its reader.
class Stream {
 public:
  virtual ~Stream() = default;

  /// Returns the next message; nullopt at the stream's end. Throws ViewerExit if it is invalid, or its sender has
  /// failed.
  virtual std::optional<wire::Message> next() = 0;
};

/// A recording that `yuragi replay` plays, as a child process: each tick is computed on demand. `yuragi` is searched
/// for beside this program, then in PATH.
class ReplayFilmStream final : public Stream {
 public:
  /// `arguments`: those of `yuragi replay`, the recording first. `is_stopping` ends next() like the stream's end; must
  /// outlive this. Throws ViewerExit.
  ReplayFilmStream(const std::vector<std::string>& arguments, const std::atomic<bool>& is_stopping);

  std::optional<wire::Message> next() override;

 private:
  bool receive();

  const std::atomic<bool>& is_stopping_;
  PipedChild replay_;
  wire::MessageReader reader_;
  std::array<std::uint8_t, 1u << 16> received_{};
};

}  // namespace yuragi::viewer::film
