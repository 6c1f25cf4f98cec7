#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace yuragi::viewer {

/// A large picture that small ones and texts are put on; black at first. Pixels have 3 bytes, rows go from the top
/// down.
class Canvas {
 public:
  Canvas(int width_px, int height_px);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

  /// `rgb`: a picture that wide. What does not fit is cut off.
  void put(int left_px, int top_px, int picture_width_px, std::span<const std::uint8_t> rgb);
  /// White letters, kTextHeight_px high.
  void write_text(int left_px, int top_px, std::string text);
  void save(const std::filesystem::path& file) const;

  static constexpr int kTextHeight_px = 24;

 private:
  int width_px_, height_px_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace yuragi::viewer
