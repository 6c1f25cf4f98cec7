#include "viewer/picture/picture_file.hpp"

#include <fstream>
#include <iterator>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::viewer::picture {
namespace {

TEST(PictureFile, HasTheFormatThatItsNameAsksFor) {
  EXPECT_EQ(picture_format("a.png"), Format::kPng);
  EXPECT_EQ(picture_format("a.PNG"), Format::kPng);
  EXPECT_EQ(picture_format("a.jpg"), Format::kJpeg);
  EXPECT_EQ(picture_format("a.b.JPEG"), Format::kJpeg);
  for (const char* name : {"a.gif", "a", "png", "a.png.txt", ".png"})
    EXPECT_EQ(picture_format(name), std::nullopt) << name;
}

TEST(PictureFile, IsWrittenWholeInItsFormatAndNothingStaysBesideIt) {
  const test::TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb(std::size_t{3} * 16 * 8, 120);
  const auto begin_of = [&](const char* name) {
    write_picture(folder / name, 16, 8, rgb);
    std::ifstream in(folder / name, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return bytes.substr(0, 3);
  };
  EXPECT_EQ(begin_of("a.png"), "\x89PN");
  EXPECT_EQ(begin_of("a.jpg"), "\xff\xd8\xff");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

}  // namespace
}  // namespace yuragi::viewer::picture
