#include "engine/base/printable_text.hpp"

#include <gtest/gtest.h>

namespace yuragi {
namespace {

std::string printable(std::string text) {
  make_printable(text);
  return text;
}

TEST(PrintableText, WhatCanBeShownStaysAsItIs) {
  const std::string text = "roof 3.4 m/s \xC3\xA9 \xE3\x82\x86\xE3\x82\x89\xE3\x81\x8E \xF0\x9F\x8C\xAC \xC2\xA0 ~";
  EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable(""), "");
}

TEST(PrintableText, KnowsWhatIsPrintable) {
  EXPECT_TRUE(is_printable(""));
  EXPECT_TRUE(is_printable("caf\xC3\xA9?"));
  EXPECT_FALSE(is_printable("a\n"));
  EXPECT_FALSE(is_printable("a\xE2\x80\xAE"));
  EXPECT_FALSE(is_printable("\xFF"));
}

TEST(PrintableText, KnowsWhatIsUtf8) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8(std::string_view("a\0\x1b\xC3\xA9\xF0\x9F\x8C\xAC", 9)));
  EXPECT_FALSE(is_utf8("a\xFF"));
  EXPECT_FALSE(is_utf8("\xE3\x82"));
}

TEST(PrintableText, ControlCharactersBecomeQuestionMarks) {
  EXPECT_EQ(printable(std::string("a\0b\x1b[2J\n\t\x7f", 10)), "a?b?[2J???");
  EXPECT_EQ(printable("a\xC2\x80\xC2\x9F"), "a????");
}

TEST(PrintableText, CharactersThatReorderOrBreakALineDoToo) {
  EXPECT_EQ(printable("a\xE2\x80\xAE.b"), "a???.b");  // U+202E: right to left from here on
  EXPECT_EQ(printable("a\xE2\x80\xA8\xE2\x81\xA6"), "a??????");
  EXPECT_EQ(printable("a\xE2\x80\x8D-"), "a\xE2\x80\x8D-") << "a joiner is part of words and pictures";
}

TEST(PrintableText, BytesThatAreNotUtf8BecomeQuestionMarks) {
  EXPECT_EQ(printable("\xFF\xFE"), "??");
  EXPECT_EQ(printable("\x80x"), "?x") << "a continuation of nothing";
  EXPECT_EQ(printable("\xE3\x82"), "??") << "cut at the end";
  EXPECT_EQ(printable("\xE3\x82x"), "??x");
  EXPECT_EQ(printable("\xC0\xAF\xC1\xBF"), "????") << "ASCII in two bytes";
  EXPECT_EQ(printable("\xE0\x80\xAF"), "???") << "in three";
  EXPECT_EQ(printable("\xF0\x80\x80\xAF"), "????") << "in four";
  EXPECT_EQ(printable("\xED\xA0\x80"), "???") << "half of a pair of UTF-16";
  EXPECT_EQ(printable("\xF4\x90\x80\x80\xF5"), "?????") << "above U+10FFFF";
}

TEST(PrintableText, EveryPairOfBytesIsTakenAndKeepsItsSize) {
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second) {
      const std::string once = printable({static_cast<char>(first), static_cast<char>(second)});
      ASSERT_EQ(once.size(), 2U);
      ASSERT_EQ(printable(once), once);
    }
  }
}

TEST(PrintableText, ALongTextIsCutBetweenCharacters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc...");
  EXPECT_EQ(shortened("\xE3\x82\x86\xE3\x82\x89\xE3\x81\x8E", 3), "\xE3\x82\x86\xE3\x82\x89\xE3\x81\x8E");
  EXPECT_EQ(shortened("\xE3\x82\x86\xE3\x82\x89\xE3\x81\x8E", 2), "\xE3\x82\x86\xE3\x82\x89...");
  EXPECT_EQ(shortened("abc", 0), "...");
  EXPECT_EQ(shortened("", 0), "");
}

}  // namespace
}  // namespace yuragi
