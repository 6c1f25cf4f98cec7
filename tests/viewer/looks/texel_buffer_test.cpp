#include "viewer/gl/texel_buffer.hpp"

#include <array>
#include <numeric>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "viewer/gl/headless_context.hpp"

namespace yuragi::viewer::gl {
namespace {

constexpr std::size_t kWide = TexelBuffer::kWide;

std::vector<float> count_from(std::size_t first, std::size_t count) {
  std::vector<float> numbers(count);
  std::iota(numbers.begin(), numbers.end(), static_cast<float>(first));
  return numbers;
}

std::span<const float> all_of(const std::vector<float>& numbers) {
  return numbers;
}

class TexelBufferTest : public testing::Test {
 protected:
  ~TexelBufferTest() override { EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR)); }

  /// All texels of the bound texture, whose rows are those expected.
  static std::vector<float> texels(std::size_t rows) {
    GLint wide = 0;
    GLint high = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &wide);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &high);
    EXPECT_EQ(wide, static_cast<GLint>(kWide));
    EXPECT_EQ(high, static_cast<GLint>(rows));
    std::vector<float> read(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED, GL_FLOAT, read.data());
    return read;
  }

  static void expect_count(const std::vector<float>& read, std::size_t first, std::size_t end) {
    ASSERT_LE(end, read.size());
    for (std::size_t i = first; i < end; ++i) ASSERT_EQ(read[i], static_cast<float>(i));
  }

 private:
  HeadlessContext context_{{.is_software = true}};
};

TEST_F(TexelBufferTest, LaysContentRowBehindRow) {
  for (const std::size_t count : {std::size_t{1}, kWide - 1, kWide, kWide + 1, 2 * kWide, 2 * kWide + 500}) {
    TexelBuffer one(GL_R32F);
    one.fill(all_of(count_from(0, count)));
    one.bind(0);
    expect_count(texels((count + kWide - 1) / kWide), 0, count);
  }
}

TEST_F(TexelBufferTest, WritesPiecesThatBeginAndEndWithinRows) {
  TexelBuffer buffer(GL_R32F);
  constexpr std::size_t kCount = 4 * kWide + 100;
  buffer.begin(kCount);
  constexpr std::array<std::size_t, 6> kEnds{10, 20, kWide, kWide + 3, 3 * kWide + 7, kCount};
  std::size_t first = 0;
  for (const std::size_t end : kEnds) {
    buffer.write(first, all_of(count_from(first, end - first)));
    first = end;
  }
  buffer.bind(0);
  expect_count(texels(5), 0, kCount);
}

TEST_F(TexelBufferTest, LeavesOutWhatIsBeyondItsContent) {
  TexelBuffer buffer(GL_R32F);
  buffer.begin(kWide);
  buffer.write(kWide - 24, all_of(count_from(kWide - 24, 3 * kWide)));
  buffer.write(kWide, all_of(count_from(kWide, 1)));
  buffer.write(0, std::span<const float>());
  buffer.bind(0);
  expect_count(texels(1), kWide - 24, kWide);
}

TEST_F(TexelBufferTest, LeavesOutWhatTheDriverHasNoRoomFor) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  TexelBuffer buffer(GL_R32F);
  buffer.begin(kWide * static_cast<std::size_t>(most) + 1);
  const std::size_t last = kWide * static_cast<std::size_t>(most) - 1;
  buffer.write(last, all_of(count_from(0, 2)));
  buffer.bind(0);
  EXPECT_EQ(texels(static_cast<std::size_t>(most))[last], 0.0F);
}

TEST_F(TexelBufferTest, KeepsThePreviousContentWhileItMayBeRead) {
  TexelBuffer buffer(GL_R32F);
  buffer.fill(all_of(count_from(0, 7)));
  buffer.bind(0);
  GLint before = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &before);
  buffer.fill(all_of(count_from(100, 7)));
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(before));
  expect_count(texels(1), 0, 7);
  buffer.bind(0);
  EXPECT_EQ(texels(1)[6], 106.0F);
}

TEST_F(TexelBufferTest, GrowsAndTakesTexelsOfSeveralNumbers) {
  TexelBuffer buffer(GL_RG32F);
  for (const std::size_t count : {std::size_t{4}, 8 * kWide, std::size_t{6}, 8 * kWide}) {
    buffer.fill(all_of(count_from(0, count)));
    buffer.bind(0);
    std::vector<float> read(16 * kWide);
    GLint high = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &high);
    ASSERT_LE(high, 4);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RG, GL_FLOAT, read.data());
    expect_count(read, 0, count);
  }
}

}  // namespace
}  // namespace yuragi::viewer::gl
