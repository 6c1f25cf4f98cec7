#include "viewer/app/keys.hpp"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::viewer::app {
namespace {

std::string whole_help() {
  std::string text;
  for (std::size_t line = 0; const auto help = key_help(line); ++line) {
    text += help->keys + ": " + std::string(help->text) + "\n";
  }
  return text;
}

TEST(Keys, NoKeyDoesTwoThings) {
  std::set<int> codes;
  std::set<std::string> names;
  for (const Key& key : all_keys()) {
    EXPECT_TRUE(codes.insert(key.code).second) << key.code;
    EXPECT_TRUE(names.insert(name_of_key(key.code)).second) << name_of_key(key.code);
    ASSERT_TRUE(key_of(key.code));
    EXPECT_EQ(key_of(key.code)->action, key.action);
  }
  EXPECT_FALSE(key_of('Z'));
}

TEST(Keys, TheHelpHasEachKeyOnceAndSaysWhatItDoes) {
  std::multiset<std::string> written;
  for (std::size_t line = 0; const auto help = key_help(line); ++line) {
    EXPECT_FALSE(help->text.empty()) << help->keys;
    std::string rest = help->keys + ", ";
    for (std::size_t end = rest.find(", "); end != std::string::npos; end = rest.find(", ")) {
      written.insert(rest.substr(0, end));
      rest.erase(0, end + 2);
    }
  }
  EXPECT_EQ(written.size(), all_keys().size());
  for (const Key& key : all_keys()) EXPECT_EQ(written.count(name_of_key(key.code)), 1U) << name_of_key(key.code);
  EXPECT_THAT(whole_help(), testing::HasSubstr("F5, F11: full screen"));
  EXPECT_THAT(whole_help(), testing::HasSubstr("Space: pause"));
  EXPECT_THAT(whole_help(), testing::HasSubstr("1, 2, 3, 4, 5, 6, 7, 8, 9: that camera"));
}

}  // namespace
}  // namespace yuragi::viewer::app
