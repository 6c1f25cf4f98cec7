#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace yuragi::viewer {

/// Pixels of 3 bytes, rows from the top down.
struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb = {};
};

/// Nothing where the file is not there or no picture.
std::optional<Picture> read_picture(const std::filesystem::path& file);

/// How much two pictures differ, from means over squares of pixels: where an edge falls within a square, which samples,
/// processors and versions of a driver decide differently, hardly counts; what is there and which color it has does.
struct PictureDifference {
  double mean = 0.0;          ///< of all squares and channels, 0 to 255
  double changed_part = 0.0;  ///< of the squares, 0 to 1: those of which a channel differs by more than 6
};
/// Pictures of different sizes differ by 255 everywhere.
PictureDifference difference(const Picture& a, const Picture& b);

/// The peak signal-to-noise ratio of two pictures of the same size, in decibels; infinite where they are the same.
double signal_to_noise_db(const Picture& a, const Picture& b);

/// Black where the two are the same, 4 times as bright as they differ elsewhere. Of the same size.
Picture difference_picture(const Picture& a, const Picture& b);

}  // namespace yuragi::viewer
