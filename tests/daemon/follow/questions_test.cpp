#include "daemon/follow/questions.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "engine/base/snapshot.hpp"

namespace yuragi::daemon::follow {
namespace {

Bytes bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

settings::Config config_of(const std::string& text) {
  return settings::parse_config(text, "test.toml");
}

TEST(Questions, AreReadAsTheyWereWritten) {
  const Question ticks{.about = Question::About::kTicks, .epoch = 1'800'000'000'000'000'000, .from = 3, .to = 9};
  const auto read = decode_question(encode(ticks));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->about, ticks.about);
  EXPECT_EQ(read->epoch, ticks.epoch);
  EXPECT_EQ(read->from, 3U);
  EXPECT_EQ(read->to, 9U);
  EXPECT_EQ(decode_question(encode(Question{}))->about, Question::About::kLeader);
  EXPECT_EQ(decode_question(encode(Question{.about = Question::About::kState, .epoch = 4}))->epoch, 4U);
}

TEST(Questions, WhatIsNoneIsRefused) {
  for (const std::string_view text :
       {"", "{", "[]", "{}", "{\"ask\":1}", "{\"ask\":\"else\"}", "{\"ask\":\"ticks\"}", "{\"ask\":\"state\"}",
        "{\"ask\":\"ticks\",\"epoch\":1,\"from\":9,\"to\":3}", "{\"ask\":\"ticks\",\"epoch\":-1,\"from\":1,\"to\":3}",
        "{\"ask\":\"state\",\"epoch\":1.5}", "{\"ask\":\"state\",\"epoch\":\"1\"}"}) {
    EXPECT_FALSE(decode_question(bytes_of(text))) << text;
  }
  EXPECT_FALSE(decode_question(bytes_of(std::string(100'000, '['))));
}

TEST(Replies, AnIntroductionNamesWhatAPictureIsMadeOf) {
  const Introduction introduction{.epoch = 7, .delay_s = 0.3, .makeup = makeup_of(settings::default_config())};
  const auto read = decode_reply(encode(introduction));
  ASSERT_TRUE(read);
  const auto& there = std::get<Introduction>(*read);
  EXPECT_EQ(there.epoch, 7U);
  EXPECT_EQ(there.makeup.hash(), introduction.makeup.hash());
  EXPECT_EQ(there.makeup.software, introduction.makeup.software);
  EXPECT_EQ(there.makeup.scenes, introduction.makeup.scenes);
  EXPECT_TRUE(wind_differences(there.makeup, introduction.makeup).empty());
  EXPECT_TRUE(scene_differences(there.makeup, introduction.makeup).empty());
}

TEST(Replies, TicksAndPartsOfAState) {
  const auto ticks = decode_reply(encode(Ticks{.ticks = {bytes_of("one"), bytes_of("another")}}));
  ASSERT_TRUE(ticks);
  EXPECT_EQ(std::get<Ticks>(*ticks).ticks, (std::vector<Bytes>{bytes_of("one"), bytes_of("another")}));

  const StatePart part{
      .epoch = 1, .number = 2, .made_of = 3, .total_bytes = 10, .first_byte = 4, .bytes = bytes_of("abcdef")};
  const auto read = decode_reply(encode(part));
  ASSERT_TRUE(read);
  EXPECT_EQ(std::get<StatePart>(*read).first_byte, 4U);
  EXPECT_EQ(std::get<StatePart>(*read).bytes, part.bytes);
}

TEST(Replies, WhatIsNoneIsRefused) {
  EXPECT_FALSE(decode_reply({}));
  EXPECT_FALSE(decode_reply(bytes_of("X")));
  EXPECT_FALSE(decode_reply(bytes_of("I{}")));
  EXPECT_FALSE(decode_reply(bytes_of("T\x05")));
  EXPECT_FALSE(decode_reply(Bytes{'T', 9, 0, 1}));
  EXPECT_FALSE(decode_reply(Bytes{'T', 0, 0}));
  Bytes part = encode(StatePart{.total_bytes = 5, .first_byte = 0, .bytes = bytes_of("abcde")});
  EXPECT_TRUE(decode_reply(part));
  part.back() ^= 1U;
  EXPECT_FALSE(decode_reply(part));
  EXPECT_FALSE(decode_reply(encode(StatePart{.total_bytes = 5, .first_byte = 1, .bytes = bytes_of("abcde")})));
  EXPECT_FALSE(decode_reply(encode(StatePart{.total_bytes = kMaxState_bytes + 1, .bytes = bytes_of("abcde")})));
  Introduction introduction{.epoch = 7, .delay_s = -1.0, .makeup = makeup_of(settings::default_config())};
  EXPECT_FALSE(decode_reply(encode(introduction)));
  introduction.delay_s = 0.3;
  introduction.makeup.scenes.resize(1000);
  EXPECT_FALSE(decode_reply(encode(introduction)));
}

// A name comes from another machine, and is logged and shown.
TEST(Replies, NamesArePrintable) {
  Introduction introduction{.epoch = 7, .delay_s = 0.3, .makeup = makeup_of(settings::default_config())};
  introduction.makeup.software = "yuragi\x1b[2J";
  introduction.makeup.scenes[0].first = "a\nb";
  const auto read = decode_reply(encode(introduction));
  ASSERT_TRUE(read);
  EXPECT_EQ(std::get<Introduction>(*read).makeup.software, "yuragi?[2J");
  EXPECT_EQ(std::get<Introduction>(*read).makeup.scenes[0].first, "a?b");
}

const char* const kTwoScenes = R"(
[[scene]]
name = "meadow"
kind = "grass"
[[scene]]
name = "cloth"
kind = "flag"
)";

TEST(SamePicture, WhatDiffersIsNamed) {
  const PictureMakeup one = makeup_of(config_of(kTwoScenes));
  EXPECT_TRUE(wind_differences(one, one).empty());
  EXPECT_TRUE(scene_differences(one, one).empty());

  PictureMakeup other = makeup_of(config_of("seed = 5\n[animation]\nrate = 30\n" + std::string(kTwoScenes)));
  other.motion = 9;
  other.software = "yuragi 3";
  EXPECT_EQ(wind_differences(other, one),
            (std::vector<std::string>{"it has version 9 of the motion (yuragi 3), this one version " +
                                          std::to_string(kMotionVersion) + " (" + one.software + ")",
                                      "its [animation] rate is 30 Hz, this one's 60 Hz",
                                      "its seed or its [wind] evolving is another one"}));

  const PictureMakeup third = makeup_of(config_of(
      "[[scene]]\nname = \"meadow\"\nkind = \"grass\"\nlinks = 5\n[[scene]]\nname = \"elm\"\nkind = \"tree\"\n"));
  EXPECT_TRUE(wind_differences(third, one).empty());
  EXPECT_EQ(scene_differences(third, one),
            (std::vector<std::string>{"scene meadow is another one there", "scene cloth is only here",
                                      "scene elm is only there"}));
  EXPECT_NE(third.hash(), one.hash());
}

TEST(SamePicture, WhatMovesNothingMayDiffer) {
  const PictureMakeup one = makeup_of(config_of(kTwoScenes));
  const PictureMakeup other =
      makeup_of(config_of("[wind]\ndefault_speed = 9\n[animation]\nthreads = 4\n[look]\nhaze = "
                          "0.5\n" +
                          std::string(kTwoScenes)));
  EXPECT_EQ(other.hash(), one.hash());
}

TEST(SamePicture, TheOrderOfTheScenesCounts) {
  const PictureMakeup one = makeup_of(config_of(kTwoScenes));
  PictureMakeup other = one;
  std::swap(other.scenes[0], other.scenes[1]);
  EXPECT_EQ(scene_differences(other, one), std::vector<std::string>{"the scenes have another order there"});
}

}  // namespace
}  // namespace yuragi::daemon::follow
