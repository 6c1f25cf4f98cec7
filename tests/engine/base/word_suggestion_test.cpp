#include "engine/base/word_suggestion.hpp"

#include <gtest/gtest.h>

namespace yuragi {
namespace {

const std::vector<std::string> kKnown = {"run", "replay", "record", "sensors", "--duration", "--listen"};

TEST(WordSuggestion, IsTheKnownWordWithTheFewestSlips) {
  EXPECT_EQ(suggest_word("runn", kKnown), "run");
  EXPECT_EQ(suggest_word("rnu", kKnown), "run") << "exchanged letters are one slip";
  EXPECT_EQ(suggest_word("recrod", kKnown), "record");
  EXPECT_EQ(suggest_word("sensor", kKnown), "sensors");
  EXPECT_EQ(suggest_word("--durtion", kKnown), "--duration");
}

TEST(WordSuggestion, OfSomethingElseIsNone) {
  EXPECT_EQ(suggest_word("garden", kKnown), "");
  EXPECT_EQ(suggest_word("x", kKnown), "");
  EXPECT_EQ(suggest_word("", kKnown), "");
  EXPECT_EQ(suggest_word("run", {}), "");
}

TEST(UnexpectedArguments, AreToldInTheOrderInWhichTheyStand) {
  const std::vector<std::string> three = {"one", "garden", "three"};
  EXPECT_EQ(unexpected_arguments_text(three, kKnown), R"(unexpected arguments: "one", "garden", "three")");
  const std::vector<std::string> one = {"runn"};
  EXPECT_EQ(unexpected_arguments_text(one, kKnown), R"(unexpected argument: "runn"; did you mean "run"?)");
  const std::vector<std::string> with_value = {"--durtion=5"};
  EXPECT_EQ(unexpected_arguments_text(with_value, kKnown),
            R"(unexpected argument: "--durtion=5"; did you mean "--duration"?)");
  EXPECT_EQ(unexpected_arguments_text({}, kKnown), "");
}

}  // namespace
}  // namespace yuragi
