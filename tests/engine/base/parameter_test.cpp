#include "engine/base/parameter.hpp"

#include <array>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi {
namespace {

using namespace std::string_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::array<std::string_view, 2> kModels{"fixed", "turbulent"};

const std::array<Parameter, 6>& table() {
  static const std::array<Parameter, 6> parameters{{
      {.name = "speed", .unit = "m/s", .default_value = 4.0, .min = 0.0, .max = 40.0, .help = "Mean speed"},
      {.name = "count", .default_value = std::int64_t{10}, .min = 1.0, .max = 1000.0, .help = "How many"},
      {.name = "gusts", .default_value = true, .help = "Are there gusts?"},
      {.name = "model", .default_value = "turbulent"s, .help = "Which model", .choices = kModels},
      {.name = "label", .default_value = ""s, .help = "Any text"},
      {.name = "gain", .default_value = 1.0, .help = "Any number"},
  }};
  return parameters;
}

ParameterValues accepted(const ParameterValues::Map& given) {
  return ParameterValues::resolve(table(), given).value();
}

ParameterError refusal_of(std::string_view name, const ParameterValue& value) {
  const auto resolved = ParameterValues::resolve(table(), {{std::string(name), value}});
  EXPECT_TRUE(resolved.has_error()) << name;
  return resolved.has_error() ? resolved.error() : ParameterError{};
}

TEST(ParameterValues, FillsWhatIsLeftOutWithDefaults) {
  const auto values = accepted({});
  EXPECT_EQ(values.number("speed"), 4.0);
  EXPECT_EQ(values.integer("count"), 10);
  EXPECT_TRUE(values.flag("gusts"));
  EXPECT_EQ(values.text("model"), "turbulent");
  EXPECT_EQ(values.text("label"), "");
  EXPECT_EQ(values.all().size(), table().size());
}

TEST(ParameterValues, WhatHasAMeaningWhereItIsLeftOutIsThereOnlyIfItWasGiven) {
  const std::array parameters{Parameter{
      .name = "x", .unit = "m", .default_value = 0.0, .max = 10.0, .help = "Where", .left_out = "at the edge"}};
  const auto left_out = ParameterValues::resolve(parameters, {}).value();
  EXPECT_FALSE(left_out.has("x"));
  EXPECT_TRUE(left_out.all().empty());
  EXPECT_THROW(static_cast<void>(left_out.number("x")), std::logic_error);
  const auto given = ParameterValues::resolve(parameters, {{"x", std::int64_t{0}}}).value();
  EXPECT_TRUE(given.has("x"));
  EXPECT_EQ(given.number("x"), 0.0);
  EXPECT_TRUE(ParameterValues::resolve(parameters, {{"x", 11.0}}).has_error());
  EXPECT_EQ(describe_allowed(parameters[0]), "number of at most 10 m; left out: at the edge");
  EXPECT_TRUE(accepted({}).has("speed"));
  EXPECT_FALSE(accepted({}).has("nothing"));
}

TEST(ParameterValues, TakesWhatIsGiven) {
  const auto values = accepted(
      {{"speed", 7.5}, {"count", std::int64_t{20}}, {"gusts", false}, {"model", "fixed"s}, {"label", "roof, north"s}});
  EXPECT_EQ(values.number("speed"), 7.5);
  EXPECT_EQ(values.integer("count"), 20);
  EXPECT_FALSE(values.flag("gusts"));
  EXPECT_EQ(values.text("model"), "fixed");
  EXPECT_EQ(values.text("label"), "roof, north");
}

TEST(ParameterValues, AWholeNumberPassesForANumber) {
  EXPECT_EQ(accepted({{"speed", std::int64_t{8}}}).number("speed"), 8.0);
}

TEST(ParameterValues, ItsRangeIncludesBothEnds) {
  for (const double end : {0.0, 40.0}) {
    EXPECT_EQ(accepted({{"speed", end}}).number("speed"), end);
  }
  for (const std::int64_t end : {1, 1000}) {
    EXPECT_EQ(accepted({{"count", end}}).integer("count"), end);
  }
}

TEST(ParameterValues, RefusesANameThatIsNotInTheTableAndListsThoseThatAre) {
  const ParameterError error = refusal_of("sped", 4.0);
  EXPECT_EQ(error.name, "sped");
  EXPECT_THAT(error.message, HasSubstr("speed, count, gusts, model, label, gain"));
}

TEST(ParameterValues, RefusesAValueOfAnotherType) {
  for (const ParameterValue& value : {ParameterValue(true), ParameterValue("4"s)}) {
    EXPECT_EQ(refusal_of("speed", value).name, "speed");
    EXPECT_EQ(refusal_of("count", value).name, "count");
  }
  EXPECT_THAT(refusal_of("count", 3.0).message, HasSubstr("whole number from 1 to 1000"));
  for (const ParameterValue& value : {ParameterValue(1.0), ParameterValue(std::int64_t{1}), ParameterValue("true"s)}) {
    EXPECT_THAT(refusal_of("gusts", value).message, HasSubstr("true or false"));
  }
  for (const ParameterValue& value : {ParameterValue(1.0), ParameterValue(std::int64_t{1}), ParameterValue(true)}) {
    EXPECT_EQ(refusal_of("label", value).name, "label");
  }
}

TEST(ParameterValues, RefusesANumberOutOfRangeAndSaysWhatIsAllowed) {
  for (const double value : {-0.001, 40.001, 1e300}) {
    EXPECT_THAT(refusal_of("speed", value).message, HasSubstr("number from 0 to 40 m/s, default 4"));
  }
  for (const std::int64_t value : {std::int64_t{0}, std::int64_t{1001}, std::numeric_limits<std::int64_t>::min(),
                                   std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(refusal_of("count", value).name, "count");
  }
  EXPECT_EQ(refusal_of("speed", std::int64_t{41}).name, "speed");
}

TEST(ParameterValues, RefusesANumberThatIsNotFiniteEvenWithoutARange) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    EXPECT_EQ(refusal_of("speed", value).name, "speed");
    EXPECT_EQ(refusal_of("gain", value).name, "gain");
  }
}

TEST(ParameterValues, RefusesATextThatIsNotAmongTheChoices) {
  EXPECT_THAT(refusal_of("model", "calm"s).message, HasSubstr("one of \"fixed\", \"turbulent\""));
  EXPECT_EQ(refusal_of("model", ""s).name, "model");
}

TEST(ParameterValues, AskingForANameOrTypeThatIsNotThereIsAProgrammingError) {
  const auto values = accepted({});
  EXPECT_THROW(static_cast<void>(values.number("nothing")), std::logic_error);
  EXPECT_THROW(static_cast<void>(values.number("count")), std::bad_variant_access);
}

TEST(ParameterValues, SetReplacesAValueByOneOfTheSameTypeOnly) {
  ParameterValues values = accepted({});
  values.set("speed", 9.0);
  EXPECT_EQ(values.number("speed"), 9.0);
  EXPECT_THROW(values.set("speed", "9"s), std::logic_error);
  EXPECT_THROW(values.set("nothing", 9.0), std::logic_error);
  EXPECT_EQ(values.number("speed"), 9.0);
}

TEST(ParameterValues, AnUncheckedRefusalThrowsWithItsNameAndReason) {
  try {
    accepted({{"speed", -1.0}});
    FAIL() << "should have thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("speed: is -1; allowed: number from 0 to 40 m/s"));
  }
}

template <class T>
concept IsPrintable = requires(std::ostream& out, const T& value) {
  out << value;
};

const std::array kAccount{
    Parameter{.name = "user", .default_value = ""s, .help = "Who"},
    Parameter{.name = "password", .default_value = Secret(), .help = "Said by whom"},
    Parameter{.name = "host", .default_value = ""s, .help = "Where"},
};

Result<ParameterValues, ParameterError> account(const ParameterValues::Map& given) {
  return ParameterValues::resolve(kAccount, given);
}

TEST(ASecret, IsTakenFromATextAndShownToNobody) {
  const ParameterValues values = account({{"password", "hunter2"s}}).value();
  EXPECT_EQ(values.secret("password").reveal(), "hunter2");
  EXPECT_EQ(printable(values.all().at("password")), PrintableValue("(secret)"s));
  EXPECT_EQ(printable(account({})->all().at("password")), PrintableValue(""s)) << "there is none";
  EXPECT_EQ(printable(ParameterValue(2.5)), PrintableValue(2.5));
  EXPECT_THROW(static_cast<void>(values.text("password")), std::bad_variant_access);
  EXPECT_EQ(describe_allowed(kAccount[1]), "text that is never printed or recorded, default \"\"");

  static_assert(!std::is_convertible_v<Secret, std::string> && !std::is_convertible_v<Secret, std::string_view>);
  static_assert(!std::is_convertible_v<std::string, Secret>);
  static_assert(IsPrintable<std::string> && !IsPrintable<Secret>);
}

TEST(ASecret, IsNotShownWhereItIsRefused) {
  for (const ParameterValue& value : {ParameterValue(std::int64_t{271828}), ParameterValue(271828.0)}) {
    const auto refused = account({{"password", value}});
    ASSERT_TRUE(refused.has_error());
    EXPECT_EQ(refused.error().name, "password");
    EXPECT_THAT(refused.error().message, Not(HasSubstr("2718")));
  }
}

TEST(ASecret, ThatWasWithheldIsNotUsedAsOne) {
  const ParameterValues values = account({{"password", "(secret)"s}}).value();
  EXPECT_THAT([&] { static_cast<void>(values.secret("password")); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("password: is \"(secret)\", which stands for it")));
  EXPECT_EQ(printable(values.all().at("password")), PrintableValue("(secret)"s));
}

TEST(ASecret, IsRefusedInATextThatIsPrinted) {
  for (const char* host :
       {"mqtt://garden:hunter2@broker:1883/wind", "mqtt://garden:hunter2@broker", "mqtts://:hunter2@broker",
        "garden:hunter2@broker", "garden:hunt@er2@broker:1883", "http://a:hunter2@[::1]/"}) {
    const auto refused = account({{"host", std::string(host)}});
    ASSERT_TRUE(refused.has_error()) << host;
    EXPECT_EQ(refused.error().name, "host");
    EXPECT_THAT(refused.error().message, AllOf(HasSubstr("user's name and password"), Not(HasSubstr("hunt")))) << host;
  }
  for (const char* host : {"broker", "[::1]:1883", "garden@broker", "mqtt://garden@broker:1883", "http://host:80/a@b:c",
                           "tele/a:b@c/wind", "see a: b@c", "0:0 5:5.5", "@DEFAULT_SOURCE@"}) {
    EXPECT_TRUE(account({{"host", std::string(host)}})) << host;
  }
}

TEST(DescribeAllowed, SaysTypeRangeUnitAndDefaultInOneSentence) {
  EXPECT_EQ(describe_allowed(table()[0]), "number from 0 to 40 m/s, default 4");
  EXPECT_EQ(describe_allowed(table()[1]), "whole number from 1 to 1000, default 10");
  EXPECT_EQ(describe_allowed(table()[2]), "true or false, default true");
  EXPECT_EQ(describe_allowed(table()[3]), "one of \"fixed\", \"turbulent\", default \"turbulent\"");
  EXPECT_EQ(describe_allowed(table()[4]), "text, default \"\"");
  EXPECT_EQ(describe_allowed(table()[5]), "number, default 1");
  EXPECT_EQ(describe_allowed({.name = "age", .unit = "s", .default_value = 1.0, .min = 0.0, .help = ""}),
            "number of at least 0 s, default 1");
  EXPECT_EQ(describe_allowed({.name = "gain", .unit = "dB", .default_value = 0.0, .max = 6.0, .help = ""}),
            "number of at most 6 dB, default 0");
}

TEST(Parameter, ATypedValueIsReadAsItsTypeAndWrittenBackAsItWas) {
  const auto read = [](const ParameterValue& kind, std::string_view text) {
    return typed_value({.name = "key", .default_value = kind, .help = ""}, text);
  };
  for (const char* text : {"0.1", "4", "-2.5", "1e-07"}) EXPECT_EQ(value_text(read(0.0, text)), text);
  EXPECT_EQ(read(0.0, "0.1"), ParameterValue(0.1));
  EXPECT_EQ(read(std::int64_t{1}, "12"), ParameterValue(std::int64_t{12}));
  EXPECT_EQ(read(false, "true"), ParameterValue(true));
  EXPECT_EQ(value_text(false), "false");
  EXPECT_EQ(read(std::string(), "12"), ParameterValue(std::string("12")));
  EXPECT_EQ(value_text(Secret("hunter2")), Secret::kWithheld);
  // What is not of the type stays a text, for resolve() to refuse it.
  EXPECT_EQ(read(0.0, "4 m"), ParameterValue(std::string("4 m")));
  EXPECT_EQ(read(0.0, ""), ParameterValue(std::string()));
  EXPECT_EQ(read(std::int64_t{1}, "1.5"), ParameterValue(std::string("1.5")));
  EXPECT_EQ(read(false, "1"), ParameterValue(std::string("1")));
}

}  // namespace
}  // namespace yuragi
