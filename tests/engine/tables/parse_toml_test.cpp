#include "engine/tables/parse_toml.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::tables {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// "line:column: what is wrong", or "" if it is parsed.
std::string refusal(const std::string& text) {
  try {
    parse_toml(text);
    return {};
  } catch (const toml::parse_error& error) {
    std::ostringstream out;
    out << error.source().begin.line << ':' << error.source().begin.column << ": " << error.description();
    return out.str();
  }
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

/// A key of so many parts.
std::string key_of(std::size_t parts) {
  return repeated("a.", parts - 1) + "a";
}

TEST(ParseToml, RefusesAKeyOfTooManyPartsWhereverItStands) {
  const std::string why = "nested too deeply: more than 32 levels (parts of keys, and arrays); use fewer";
  EXPECT_EQ(refusal("b = 1\n" + key_of(50'000) + " = 1\n"), "2:1: " + why);
  EXPECT_EQ(refusal("# é\n  [" + key_of(50'000) + "]\n"), "2:4: " + why);
  EXPECT_EQ(refusal("[[" + key_of(50'000) + "]]\n"), "1:3: " + why);
  EXPECT_EQ(refusal("b = [ 'é', { " + key_of(50'000) + " = 1 } ]"), "1:14: " + why);
  EXPECT_EQ(refusal(repeated("'#' . ", 50'000) + "\"=\" = 1"), "1:1: " + why);
  EXPECT_EQ(refusal("b = { c = {}, " + key_of(50'000) + " = 1 }"), "1:15: " + why);
  EXPECT_EQ(refusal("b = '''\n''''' # '\n" + key_of(50'000) + " = 1"), "3:1: " + why);
}

TEST(ParseToml, CountsPartsOfHeadersKeysAndArraysTogether) {
  EXPECT_EQ(refusal(key_of(32) + " = 1"), "");
  EXPECT_THAT(refusal(key_of(33) + " = 1"), HasSubstr("nested too deeply"));
  EXPECT_EQ(refusal("[" + key_of(20) + "]\n" + repeated("b.", 11) + "b = 1"), "");
  EXPECT_THAT(refusal("[" + key_of(20) + "]\n" + repeated("b.", 12) + "b = 1"), StartsWith("2:1: nested too deeply"));
  EXPECT_EQ(refusal("a = " + repeated("[", 31) + repeated("]", 31)), "");
  EXPECT_THAT(refusal("a = " + repeated("[", 32) + repeated("]", 32)), StartsWith("1:36: nested too deeply"));
  EXPECT_THAT(refusal("a = " + repeated("[", 1'000'000)), HasSubstr("nested too deeply"));
  EXPECT_EQ(refusal(repeated("a = { ", 31) + "a = 1" + repeated(" }", 31)), "");
  EXPECT_THAT(refusal(repeated("a = { ", 32) + "a = 1" + repeated(" }", 32)), HasSubstr("nested too deeply"));
}

TEST(ParseToml, WhatWasParsedCanBeWrittenAndParsedAgain) {
  for (const std::string& text :
       {"[" + key_of(20) + "]\n" + repeated("b.", 11) + "b = 1", key_of(32) + " = 1",
        repeated("a = { ", 31) + "a = 1" + repeated(" }", 31), "a = { " + key_of(31) + " = 1 }",
        "a = [" + repeated("{ b.c = [", 10) + repeated("] }", 10) + "]"}) {
    std::ostringstream out;
    out << parse_toml(text);
    EXPECT_EQ(parse_toml(out.str()), parse_toml(text)) << text;
  }
}

TEST(ParseToml, RefusesALongKeyAndALongText) {
  EXPECT_EQ(refusal(std::string(1024, 'k') + " = 1"), "");
  EXPECT_EQ(refusal(" " + std::string(1025, 'k') + " = 1"),
            "1:2: this key is too long: more than 1024 bytes; shorten it");
  EXPECT_THAT(refusal("[b]\n\"" + std::string(1023, '.') + "\" = 1"), StartsWith("2:1: this key is too long"));
  EXPECT_EQ(refusal("k = 1" + std::string(kMaxToml_bytes - 5, ' ')), "");
  EXPECT_EQ(refusal("k = 1" + std::string(kMaxToml_bytes - 4, ' ')),
            "1:1: too large: 4194305 bytes (maximum 4194304); divide the file");
}

TEST(ParseToml, TakesDotsBracketsAndQuotesInValuesAndCommentsForWhatTheyAre) {
  const std::string many = repeated(".", 2000) + repeated("[", 100) + repeated("{", 100);
  for (const std::string& text : {
           "a = '" + many + "'\r\nb = \"" + many + "\\\"" + many + "\"\n",
           "a = '''\n" + many + "'' \n" + many + "'''''\nb = \"\"\"\\\"\"\"" + many + "\"\"\"\"\"\n",
           "# " + many + " \" ' \"\"\"\na = 1 # " + many + "\n",
           "a = [ '" + many + "', # ] " + many + "\n  \"" + many + "\",\n]\n" + repeated("b.", 31) + "b = 2",
           "[a] # " + many + "\nb = 2.5\nc = 1979-05-27T00:32:00.999999-07:00\n",
           std::string("a.\"b.c\" . 'd' = { }\n[[e]]\n[[e]]\n[e.f]\nx = [[1.5, 2.5], [{ y = '' }, {z=\"\"}]]"),
           "e = \"\"\nf = ''\ng = \"\\\\\"\nh = 'a\\'\n" + key_of(32) + " = 1",
           "[" + key_of(31) + "]\n[b]\nc.d = 1",
           "a = [" + repeated("[1.0, 2.0],\n", 10'000) + "]",
       }) {
    EXPECT_EQ(refusal(text), "") << text.substr(0, 300);
  }
}

TEST(ParseToml, ReadsNoMoreOfAStreamThanItTakes) {
  std::istringstream endless(std::string(2 * kMaxToml_bytes, '#'));
  EXPECT_EQ(toml_text(endless).size(), kMaxToml_bytes + 1);
  std::istringstream small("a = 1");
  EXPECT_EQ(toml_text(small), "a = 1");
}

}  // namespace
}  // namespace yuragi::tables
