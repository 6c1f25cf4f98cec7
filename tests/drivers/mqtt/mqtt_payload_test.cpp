#include "drivers/mqtt/mqtt_payload.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "drivers/decode/json_pointer.hpp"

namespace yuragi::drivers::mqtt {
namespace {

/// Passes if a number was found there.
testing::AssertionResult finds(std::string_view payload, const std::string& pointer, double expected) {
  const auto number = Payload(payload).number_at(pointer);
  if (number && *number && **number == expected) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (number ? "another one, or none" : name_of(number.error()));
}
testing::AssertionResult finds_none(std::string_view payload, const std::string& pointer) {
  const auto number = Payload(payload).number_at(pointer);
  if (number && !*number) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (number ? "a number" : name_of(number.error()));
}
testing::AssertionResult refuses(std::string_view payload, const std::string& pointer, decode::Refusal why) {
  const auto number = Payload(payload).number_at(pointer);
  if (!number && number.error() == why) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (number ? "accepted" : name_of(number.error()));
}

TEST(MqttPayload, ThatIsANumber) {
  EXPECT_TRUE(finds("4.2", "", 4.2));
  EXPECT_TRUE(finds(" 0\r\n", "", 0.0));
  EXPECT_TRUE(finds("-1e1", "", -10.0));
}

TEST(MqttPayload, ThatStandsForNoValue) {
  for (const std::string_view payload : {"", " ", "unavailable", "unknown", "None", "null", "nan"}) {
    EXPECT_TRUE(refuses(payload, "", decode::Refusal::kInvalid)) << payload;
  }
}

TEST(MqttPayload, ThatIsSomethingElse) {
  for (const std::string_view payload : {"4.2 m/s", "NNE", "0x10", "4,2", "1e999", "inf", "{\"a\":1}", "\xff\xfe"}) {
    EXPECT_TRUE(refuses(payload, "", decode::Refusal::kMalformed)) << payload;
  }
}

TEST(MqttPayload, CanBeADirection) {
  const auto direction_of = [](std::string_view payload, const std::string& pointer) {
    const auto direction_deg = Payload(payload).direction_at(pointer);
    return direction_deg ? *direction_deg : std::nullopt;
  };
  EXPECT_EQ(direction_of("NW", ""), 315.0);
  EXPECT_EQ(direction_of(" sse\n", ""), 157.5);
  EXPECT_EQ(direction_of("270.5", ""), 270.5);
  EXPECT_EQ(direction_of(R"({"d":"E"})", "/d"), 90.0);
  EXPECT_EQ(direction_of(R"({"d":12})", "/d"), 12.0);
  EXPECT_EQ(direction_of(R"({"d":null})", "/d"), std::nullopt);
  for (const std::string_view payload : {"VRB", "unavailable", ""})
    EXPECT_EQ(Payload(payload).direction_at("").error(), decode::Refusal::kInvalid) << payload;
  for (const std::string_view payload : {"north", "NNN", "4,2"})
    EXPECT_EQ(Payload(payload).direction_at("").error(), decode::Refusal::kMalformed) << payload;
  EXPECT_EQ(Payload("{").direction_at("/d").error(), decode::Refusal::kMalformed);
  EXPECT_EQ(Payload(R"({"d":true})").direction_at("/d").error(), decode::Refusal::kMalformed);
}

TEST(MqttPayload, InJsonStandsWhereThePointerSays) {
  const std::string_view tasmota =
      R"({"Time":"2024-06-01T12:00:00","TX23":{"Speed":{"Act":14.8,"Avg":8.5},"Dir":{"Card":"WSW","Deg":247.5}}})";
  EXPECT_TRUE(finds(tasmota, "/TX23/Speed/Act", 14.8));
  EXPECT_TRUE(finds(tasmota, "/TX23/Dir/Deg", 247.5));
  EXPECT_TRUE(finds(R"([{"v":"3.5"}])", "/0/v", 3.5)) << "as a text";
  EXPECT_TRUE(finds_none("7", "/"));
}

TEST(MqttPayload, InJsonMayBeAbsent) {
  EXPECT_TRUE(finds_none(R"({"a":null})", "/a"));
  EXPECT_TRUE(finds_none(R"({"a":1})", "/b"));
  EXPECT_TRUE(finds_none(R"({"a":1})", "/a/b/c"));
  EXPECT_TRUE(finds_none("[1,2]", "/7"));
  EXPECT_TRUE(finds_none("[1,2]", "/-"));
}

TEST(MqttPayload, InJsonIsRefusedWhereItIsNoNumber) {
  EXPECT_TRUE(refuses(R"({"a":{}})", "/a", decode::Refusal::kMalformed));
  EXPECT_TRUE(refuses(R"({"a":true})", "/a", decode::Refusal::kMalformed));
  EXPECT_TRUE(refuses(R"({"a":"NNE"})", "/a", decode::Refusal::kMalformed));
  EXPECT_TRUE(refuses(R"({"a":"unavailable"})", "/a", decode::Refusal::kInvalid));
  EXPECT_TRUE(refuses(R"({"a":1)", "/a", decode::Refusal::kMalformed));
  EXPECT_TRUE(refuses(R"({"a":1e999})", "/a", decode::Refusal::kMalformed));
  EXPECT_TRUE(refuses("", "/a", decode::Refusal::kMalformed));
}

TEST(MqttPayload, StandsAnyBytes) {
  std::mt19937_64 random(20260608);
  const std::string alphabet = "{}[]\":,0123456789.eE+-tfn \\u/a\xff";
  for (int round = 0; round < 100'000; ++round) {
    std::string payload(random() % 40, ' ');
    for (char& letter : payload) letter = alphabet[random() % alphabet.size()];
    for (const char* const pointer : {"", "/a", "/0", "/0/a", "/99999999999999999999"}) {
      const auto number = Payload(payload).number_at(pointer);
      if (number && *number) {
        EXPECT_TRUE(std::isfinite(**number)) << payload;
      }
    }
  }
}

TEST(MqttPayload, OfANumberAloneIsNotReadAsJson) {
  const Payload payload("[1]", PayloadForm::kText);
  EXPECT_TRUE(payload.json().is_discarded());
  const auto number = Payload("7.5", PayloadForm::kText).number_at("");
  EXPECT_TRUE(number && *number == 7.5);
  EXPECT_FALSE(payload.lacks(""));
  EXPECT_FALSE(payload.text_at("/0"));
}

TEST(MqttPayload, LacksAPlaceThatIsNotThere) {
  const Payload payload(R"({"a":null,"b":{"c":1},"name":"x","id":7,"part":1.5})");
  EXPECT_FALSE(payload.lacks("/a")) << "it is there, and says that there is no value";
  EXPECT_FALSE(payload.lacks("/b/c"));
  EXPECT_TRUE(payload.lacks("/b/d"));
  EXPECT_TRUE(payload.lacks("/c"));
  EXPECT_FALSE(Payload("{").lacks("/a")) << "what cannot be read is malformed, not without it";
  EXPECT_EQ(payload.text_at("/name"), "x");
  EXPECT_EQ(payload.text_at("/id"), "7");
  EXPECT_FALSE(payload.text_at("/part"));
  EXPECT_FALSE(payload.text_at("/none"));
}

TEST(MqttPayload, StandsALotOfBrackets) {
  EXPECT_TRUE(refuses(std::string(60'000, '['), "/a", decode::Refusal::kMalformed));
  EXPECT_TRUE(finds_none(std::string(30'000, '[') + std::string(30'000, ']'), "/1"));
}

TEST(JsonPointer, BeginsWithASlash) {
  EXPECT_TRUE(decode::is_json_pointer(""));
  EXPECT_TRUE(decode::is_json_pointer("/a/b~1c"));
  EXPECT_FALSE(decode::is_json_pointer("a/b"));
  EXPECT_FALSE(decode::is_json_pointer("/a~"));
  EXPECT_FALSE(decode::is_json_pointer("/a~2"));
}

}  // namespace
}  // namespace yuragi::drivers::mqtt
