#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/pictures/picture_file.hpp"
#include "daemon/pictures/scaled_picture.hpp"
#include "tests/support/small_png.hpp"

namespace yuragi::daemon::pictures {
namespace {

using testing::HasSubstr;

constexpr look::Color kBlack{0, 0, 0};

std::vector<std::uint8_t> jpeg_file(std::uint32_t width_px, std::uint32_t height_px, std::uint8_t grey,
                                    bool is_progressive = false) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &bytes, &size);
  encoder.image_width = width_px;
  encoder.image_height = height_px;
  encoder.input_components = 1;
  encoder.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&encoder);
  if (is_progressive) jpeg_simple_progression(&encoder);
  jpeg_start_compress(&encoder, TRUE);
  std::vector<std::uint8_t> row(width_px, grey);
  while (encoder.next_scanline < height_px) {
    JSAMPROW at = row.data();
    jpeg_write_scanlines(&encoder, &at, 1);
  }
  jpeg_finish_compress(&encoder);
  std::vector<std::uint8_t> file(bytes, bytes + size);
  jpeg_destroy_compress(&encoder);
  std::free(bytes);
  return file;
}

/// A valid grey file of so many scans: those of an encoder's file again and again.
std::vector<std::uint8_t> progressive_jpeg(std::size_t scans) {
  const std::vector<std::uint8_t> once = jpeg_file(16, 16, 77, true);
  std::vector<std::size_t> begins;  // of each scan, and the end of the last
  std::size_t tables = 0;           // before the first scan
  for (std::size_t at = 0; at + 1 < once.size(); ++at) {
    if (once[at] != 0xFF) continue;
    if (once[at + 1] == 0xC4 && tables == 0) tables = at;
    if (once[at + 1] == 0xDA || once[at + 1] == 0xD9) begins.push_back(at);
  }
  begins.at(0) = tables;
  std::vector<std::uint8_t> file(once.begin(), once.begin() + static_cast<std::ptrdiff_t>(tables));
  for (std::size_t scan = 0; scan < scans; ++scan) {
    const std::size_t i = scan % (begins.size() - 1);
    file.insert(file.end(), once.begin() + static_cast<std::ptrdiff_t>(begins[i]),
                once.begin() + static_cast<std::ptrdiff_t>(begins[i + 1]));
  }
  file.insert(file.end(), {0xFF, 0xD9});
  return file;
}

std::string refused(std::span<const std::uint8_t> bytes) {
  const auto picture = decoded_picture(bytes, kBlack);
  return picture ? "is read" : picture.error().message;
}

TEST(Pictures, APngIsReadPixelByPixel) {
  const look::Image picture = decoded_picture(test::small_png(), kBlack).value();
  EXPECT_EQ(picture.width_px, 2U);
  EXPECT_EQ(picture.height_px, 2U);
  EXPECT_THAT(picture.rgb, testing::ElementsAre(255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255));
}

TEST(Pictures, ThroughClearPartsTheBackgroundIsSeen) {
  const std::array<std::uint8_t, 9> row{0, 200, 100, 50, 255, 200, 100, 50, 0};
  const look::Image picture = decoded_picture(test::png_file(2, 1, row, true), {1, 2, 3}).value();
  EXPECT_THAT(picture.rgb, testing::ElementsAre(200, 100, 50, 1, 2, 3));
}

TEST(Pictures, AJpegIsReadAlsoAGreyOne) {
  const look::Image picture = decoded_picture(jpeg_file(20, 10, 77), kBlack).value();
  EXPECT_EQ(picture.width_px, 20U);
  EXPECT_EQ(picture.height_px, 10U);
  ASSERT_EQ(picture.rgb.size(), 600U);
  for (const std::uint8_t value : picture.rgb) EXPECT_NEAR(value, 77, 2);
}

TEST(Pictures, AProgressiveJpegOfTooManyScansIsRefusedBeforeTheyAreDecoded) {
  EXPECT_EQ(refused(progressive_jpeg(500)), "is read");
  EXPECT_EQ(refused(progressive_jpeg(501)), "has more than 500 scans; save it anew, not progressive");
  EXPECT_THAT(refused(progressive_jpeg(200'000)), HasSubstr("500 scans"));
}

TEST(Pictures, NoPartOfAFileIsTakenForAPicture) {
  for (const std::vector<std::uint8_t>& file : {test::small_png(), jpeg_file(40, 40, 120)}) {
    // Without the last 12 bytes (IEND) all pixels of a PNG are there.
    const std::size_t whole = file[0] == 0x89 ? file.size() - 12 : file.size() - 2;
    for (std::size_t length = 0; length < whole; ++length) {
      EXPECT_FALSE(decoded_picture(std::span(file).first(length), kBlack)) << length << " of " << file.size();
    }
  }
}

TEST(Pictures, DamagedBytesAreReadOrRefusedAndNothingElse) {
  for (const std::vector<std::uint8_t>& file : {test::small_png(), jpeg_file(40, 40, 120)}) {
    for (std::size_t at = 0; at < file.size(); ++at) {
      for (const std::uint8_t value : std::array<std::uint8_t, 3>{0x00, 0x7F, 0xFF}) {
        std::vector<std::uint8_t> hurt = file;
        hurt[at] = value;
        const auto picture = decoded_picture(hurt, kBlack);
        if (!picture) continue;
        EXPECT_EQ(picture->rgb.size(), std::size_t{3} * picture->width_px * picture->height_px);
      }
    }
  }
}

TEST(Pictures, HugeSizesInASmallFileAreRefused) {
  const std::array<std::uint8_t, 4> row{0, 1, 2, 3};
  EXPECT_THAT(refused(test::png_file(16384, 16384, row)), HasSubstr("16384 x 16384 pixels; allowed: up to 16 million"));
  EXPECT_THAT(refused(test::png_file(100000, 1, row)), HasSubstr("100000 x 1 pixels"));
  EXPECT_THAT(refused(test::png_file(0x7FFFFFFF, 0x7FFFFFFF, row)), testing::Not("is read"));
  EXPECT_THAT(refused(test::png_file(0, 0, row)), testing::Not("is read"));
  std::vector<std::uint8_t> jpeg = jpeg_file(16, 16, 0);
  for (std::size_t i = 0; i + 9 < jpeg.size(); ++i) {
    if (jpeg[i] != 0xFF || jpeg[i + 1] != 0xC0) continue;
    for (std::size_t side = 5; side < 9; ++side) jpeg[i + side] = 0x7F;
  }
  EXPECT_THAT(refused(jpeg), HasSubstr("32639 x 32639 pixels"));
}

TEST(Pictures, WhatIsNoPictureIsRefused) {
  const std::string text = "kind = \"flag\"";
  EXPECT_EQ(refused(std::vector<std::uint8_t>(text.begin(), text.end())),
            "is neither a PNG nor a JPEG file; save it as one of them");
  EXPECT_EQ(refused({}), "is neither a PNG nor a JPEG file; save it as one of them");
}

TEST(Pictures, LargeOnesAreScaledDownToTheMeanLight) {
  look::Image checks{.width_px = 2048, .height_px = 2048, .rgb = std::vector<std::uint8_t>(3U << 22)};
  for (std::size_t i = 0; i < checks.rgb.size(); i += 3) {
    if ((i / 3 + i / 3 / 2048) % 2 == 0) std::fill_n(checks.rgb.begin() + static_cast<std::ptrdiff_t>(i), 3, 255);
  }
  const look::Image small = scaled_down(std::move(checks));
  EXPECT_EQ(small.width_px, 1024U);
  EXPECT_EQ(small.height_px, 1024U);
  ASSERT_EQ(small.rgb.size(), 3U << 20);
  // Half of the light: 188 of 255 on a screen.
  EXPECT_THAT(small.rgb, testing::Each(188));

  const look::Image strip = scaled_down({.width_px = 16000, .height_px = 2, .rgb = std::vector<std::uint8_t>(96000)});
  EXPECT_LE(strip.width_px, look::Image::kMaxSide_px);
  EXPECT_EQ(strip.height_px, 1U);
}

TEST(Pictures, FilesThatAreNoneAreRefusedWithoutWaiting) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("pictures" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto why = [](const std::filesystem::path& file) {
    const auto picture = read_picture(file, kBlack);
    return picture ? "is read" : picture.error().message;
  };
  EXPECT_THAT(why(folder / "none.png"), HasSubstr("cannot be read: No such file"));
  EXPECT_THAT(why(folder), HasSubstr("not a regular file"));
  ASSERT_EQ(::mkfifo((folder / "pipe.png").c_str(), 0600), 0);
  EXPECT_THAT(why(folder / "pipe.png"), HasSubstr("not a regular file"));
  std::ofstream(folder / "large.png").close();
  std::filesystem::resize_file(folder / "large.png", 40U << 20);
  EXPECT_THAT(why(folder / "large.png"), HasSubstr("is a file of 40 MB; allowed: up to 16 MB"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace yuragi::daemon::pictures
