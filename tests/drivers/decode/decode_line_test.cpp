// The small text protocols: FT7xx, UMB, numbers of a microcontroller; and the bytes that become lines.
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/speed_units.hpp"
#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/decode/text/line_assembler.hpp"
#include "drivers/decode/text/umb.hpp"
#include "tests/support/decoded_text.hpp"

namespace yuragi::drivers::decode {
namespace {

using testing::ElementsAre;

TEST(FtAnswer, IsSpeedAngleAndStatus) {
  const text::FtOptions options;
  EXPECT_TRUE(reads(text::decode_ft(options, "$WI,WVP=020.0,045,0*73\r\n"), 20.0, 45.0));
  EXPECT_TRUE(reads(text::decode_ft(options, sentence("WI,WVP=020.0,4x5,0")), 20.0, {}));
  EXPECT_TRUE(is_refused(text::decode_ft(options, "$WI,WVP=020.0,045,0*74"), Refusal::kBadChecksum));
  EXPECT_TRUE(is_refused(text::decode_ft(options, sentence("WI,WVP=020.0,045,1")), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(text::decode_ft(options, sentence("WI,WVP=020.0,045")), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_ft(options, sentence("WI,WVP=020.0,045,0,0")), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_ft(options, sentence("WI,DF=P")), Refusal::kNotMine));
  EXPECT_TRUE(reads(text::decode_ft(options, sentence("WIMWV,045,R,020.0,M,A")), 20.0, 45.0));
}

TEST(FtAnswer, WithItsChecksumSwitchedOffIsReadByPolicy) {
  EXPECT_TRUE(is_refused(text::decode_ft({}, "$WI,WVP=020.0,045,0*//"), Refusal::kBadChecksum));
  EXPECT_TRUE(reads(text::decode_ft({.checksum = WhenMissing::kAccept}, "$WI,WVP=020.0,045,0*//"), 20.0, 45.0));
}

TEST(UmbAnswer, InNmeaModeIsMwv) {
  EXPECT_TRUE(reads(text::decode_umb({}, "$WIMWV,230.6,R,003.4,N,A*23"), 1.7491, 230.6));
  EXPECT_TRUE(is_refused(text::decode_umb({}, sentence("WIMWV,,R,,M,V")), Refusal::kInvalid));
}

TEST(UmbAnswer, InAsciiModeIsAShareOfTheRange) {
  const text::UmbOptions options;
  EXPECT_TRUE(reads(text::decode_umb(options, "$ 28673 M 00400 06552\r"), 7.5, {}));
  EXPECT_TRUE(reads(text::decode_umb(options, "$ 28673 M 00405 06552"), 7.5, {}));
  EXPECT_TRUE(reads(text::decode_umb(options, "$ 28673 M 00500 32760"), {}, 179.95));
  EXPECT_NEAR(text::decode_umb(options, "$ 28673 M 00440 65520")->gust_m_s.value_or(0.0), 75.0, 1e-9);
  EXPECT_TRUE(is_refused(text::decode_umb(options, "$ 28673 M 00400 65521"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(text::decode_umb(options, "$ 28673 M 00100 34785"), Refusal::kNotMine));  // a temperature
  EXPECT_TRUE(is_refused(text::decode_umb(options, "$ 28673 M 00400 6552"), Refusal::kTooShort));
  EXPECT_TRUE(is_refused(text::decode_umb(options, "$ 28673 M 00400 99999"), Refusal::kMalformed));
  text::UmbOptions other;
  other.device = 28674;
  EXPECT_TRUE(is_refused(text::decode_umb(other, "$ 28673 M 00400 06552"), Refusal::kNotMine));
}

TEST(NumberLine, IsColumnsOrKeys) {
  const text::LineOptions options;
  EXPECT_TRUE(reads(text::decode_line(options, "4.2,270,6.1\r\n"), 4.2, 270.0));
  EXPECT_EQ(text::decode_line(options, "4.2,270,6.1")->gust_m_s, 6.1);
  EXPECT_TRUE(reads(text::decode_line(options, "4.2"), 4.2, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "4.2,,"), 4.2, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "speed=4.2 direction=270; gust=6.1"), 4.2, 270.0));
  EXPECT_TRUE(reads(text::decode_line(options, "speed: 4.2, direction: 360"), 4.2, 0.0));
  EXPECT_TRUE(reads(text::decode_line(options, "temperature:21.5\tspeed:0"), 0.0, {}));
}

TEST(NumberLine, IsReadAsTheOptionsSay) {
  text::LineOptions options;
  options.separator = ' ';
  options.speed = {.column = 2, .key = "w", .scale = 1.0 / 3.6};
  options.direction = {.column = 0, .key = "", .offset = 10.0};
  options.gust = {};
  options.invalid = -999.0;
  EXPECT_TRUE(reads(text::decode_line(options, "  80   x\t36 "), 10.0, 90.0));
  EXPECT_TRUE(reads(text::decode_line(options, "-999 x 36"), 10.0, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "w=18 direction=7"), 5.0, {}));
}

TEST(NumberLine, TakesTheUnitThatItSays) {
  text::LineOptions options;
  options.speed.unit = 1852.0 / 3600.0;  // configured: knots
  EXPECT_TRUE(reads(text::decode_line(options, "speed: 18 km/h, direction: 270 deg"), 5.0, 270.0));
  EXPECT_TRUE(reads(text::decode_line(options, "direction: 270 speed: 18 km/h"), 5.0, 270.0));
  EXPECT_TRUE(reads(text::decode_line(options, "speed=5m/s;direction=270\xC2\xB0"), 5.0, 270.0));
  EXPECT_TRUE(reads(text::decode_line(options, "5 m/s,270 degrees"), 5.0, 270.0));
  EXPECT_TRUE(reads(text::decode_line(options, "speed=10 mph"), 4.4704, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "speed=10"), 5.1444, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "speed=10 direction=20 ok"), 5.1444, 20.0));
  EXPECT_TRUE(is_refused(text::decode_line(options, "speed=10parsecs"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_line(options, "speed: 10 deg"), Refusal::kMalformed));
}

TEST(NumberLine, MayHaveBlanksAroundTheSign) {
  text::LineOptions options;
  options.speed.key = "WindSpeed";
  options.direction.key = "WindDir";
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed    = 1.0"), 1.0, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed =1.0"), 1.0, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed\t:\t18 km/h"), 5.0, {}));
  EXPECT_TRUE(reads(text::decode_line(options, "WindDir      = 79"), {}, 79.0));
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed = 1.0 WindDir = 79"), 1.0, 79.0));
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed : 1.0, WindDir : 79"), 1.0, 79.0));
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed: 1.0,WindDir: 79"), 1.0, 79.0));
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed = WindDir = 79"), {}, 79.0)) << "a key is no value";
  EXPECT_TRUE(reads(text::decode_line(options, "WindSpeed: , WindDir: 79"), {}, 79.0));
  EXPECT_TRUE(is_refused(text::decode_line(options, "WindSpeed ="), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(text::decode_line(options, "Humidity   = 41.9"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_line(options, "= 41.9"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_line(options, "WindSpeed => 4"), Refusal::kMalformed));
}

TEST(NumberLine, MayHaveACompassPointAsItsDirection) {
  text::LineOptions options;
  EXPECT_TRUE(reads(text::decode_line(options, "4.2,NW"), 4.2, 315.0));
  EXPECT_TRUE(reads(text::decode_line(options, "speed=4.2 direction=nne"), 4.2, 22.5));
  EXPECT_TRUE(reads(text::decode_line(options, "direction: S speed: 4.2"), 4.2, 180.0));
  EXPECT_TRUE(reads(text::decode_line(options, R"({"speed": 4.2, "direction": "WSW"})"), 4.2, 247.5));
  EXPECT_EQ(text::decode_line(options, "4.2,NW")->status, DecodedStatus::kGood);
  EXPECT_TRUE(reads(text::decode_line(options, "4.2,VRB"), 4.2, {}));
  EXPECT_EQ(text::decode_line(options, "4.2,VRB")->status, DecodedStatus::kGood);
  EXPECT_TRUE(is_refused(text::decode_line(options, "NW,270"), Refusal::kMalformed)) << "a speed is none";
  options.direction.scale = 22.5;
  EXPECT_TRUE(reads(text::decode_line(options, "4.2,NW"), 4.2, 315.0));
  EXPECT_TRUE(reads(text::decode_line(options, "4.2,14"), 4.2, 315.0));
}

TEST(NumberLine, WithADirectionThatCannotBeReadKeepsItsSpeed) {
  const text::LineOptions options;
  for (const char* line :
       {"4,-1", "4,720", "4,north by west", "4,2x0", "4,270 km/h", "speed: 4, direction: 20 km/h",
        "speed=4 direction=??", R"({"speed": 4, "direction": "up"})", R"({"speed": 4, "direction": [1]})"}) {
    const auto decoded = text::decode_line(options, line);
    EXPECT_TRUE(reads(decoded, 4.0, {})) << line;
    EXPECT_EQ(decoded->status, DecodedStatus::kUncertain) << line;
  }
  EXPECT_TRUE(is_refused(text::decode_line(options,
                                           "4.2,2\x17"
                                           "0"),
                         Refusal::kMalformed))
      << "the line is damaged";
  EXPECT_TRUE(is_refused(text::decode_line(options, "direction=??"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_line(options, "direction=720"), Refusal::kImplausible));
}

TEST(NumberLine, TellsWhatItNamesFromWhatHasAValue) {
  const text::LineOptions options;
  const auto unknown = text::read_line(options, "direction=nan");
  ASSERT_TRUE(unknown);
  EXPECT_TRUE(unknown->names_direction);
  EXPECT_FALSE(unknown->names_speed || unknown->names_gust);
  EXPECT_EQ(unknown->wind, DecodedWind());
  const auto columns = text::read_line(options, "4.2");
  ASSERT_TRUE(columns);
  EXPECT_TRUE(columns->names_speed && columns->names_direction && columns->names_gust);
  const auto json = text::read_line(options, R"({"gust": 4.2})");
  ASSERT_TRUE(json);
  EXPECT_TRUE(json->names_gust);
  EXPECT_FALSE(json->names_speed || json->names_direction);
  EXPECT_EQ(text::read_line(options, "direction=up")->direction_refusal, Refusal::kMalformed);
}

TEST(NumberLine, ThatEndsBeforeAllOfItsColumnsHasAnotherFormat) {
  text::LineOptions options;
  options.speed.column = 2;
  options.direction.column = 1;
  options.gust.column = {};
  EXPECT_TRUE(is_refused(text::decode_line(options, "ready"), Refusal::kMalformed));
  EXPECT_TRUE(reads(text::decode_line(options, "x,270"), {}, 270.0));
}

TEST(NumberLine, KnowsEveryWordOfAUnitOfSpeed) {
  const text::LineOptions options;
  for (const SpeedWord& each : kSpeedWords) {
    const std::string line = R"({"speed": "10 )" + std::string(each.word) + R"("})";
    EXPECT_TRUE(reads(text::decode_line(options, line), 10.0 * each.unit.metres_per_second, {})) << line;
    EXPECT_EQ(speed_unit_of_word(each.unit.name)->metres_per_second, each.unit.metres_per_second);
  }
  EXPECT_FALSE(speed_unit_of_word("ms").has_value()) << "milliseconds";
  EXPECT_FALSE(speed_unit_of_word("").has_value());
}

TEST(NumberLine, IsAnObjectInJson) {
  text::LineOptions options;
  EXPECT_TRUE(reads(text::decode_line(options, R"({"speed": 4.2, "direction": "270", "other": [1]})"), 4.2, 270.0));
  EXPECT_TRUE(reads(text::decode_line(options, R"({"speed": "15.12 km/h", "direction": null})"), 4.2, {}));
  options.speed.key = "/wind/0/speed";
  options.speed.scale = 0.1;
  EXPECT_TRUE(reads(text::decode_line(options, R"({"wind": [{"speed": 42}]})"), 4.2, {}));
  options.speed.key = "/~";  // no pointer
  EXPECT_TRUE(is_refused(text::decode_line(options, R"({"speed": 4.2})"), Refusal::kMalformed));
  options = {};
  EXPECT_TRUE(is_refused(text::decode_line(options, R"({"volts": 4.2})"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_line(options, R"({"speed": null})"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(text::decode_line(options, R"({"speed": [4.2]})"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_line(options, R"({"speed": 1e300})"), Refusal::kImplausible));
  EXPECT_TRUE(is_refused(text::decode_line(options, R"({"speed": 4.2)"), Refusal::kMalformed));
  options.format = text::LineFormat::kJson;
  EXPECT_TRUE(is_refused(text::decode_line(options, "4.2,270"), Refusal::kMalformed));
}

TEST(NumberLine, WithoutAValueIsNeverZero) {
  const text::LineOptions options;
  EXPECT_TRUE(reads(text::decode_line(options, "nan,270"), {}, 270.0));
  EXPECT_TRUE(is_refused(text::decode_line(options, "nan,nan,nan"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(text::decode_line(options, ",,"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(text::decode_line(options, "speed="), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(text::decode_line(options, ""), Refusal::kTooShort));
  EXPECT_TRUE(is_refused(text::decode_line(options, "# speed,direction"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_line(options, "volts=3.3"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_line(options, "ready"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_line(options, "4.2.1,270"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_line(options, "speed=4 speed=5"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_line(options, "-4,270"), Refusal::kImplausible));
  EXPECT_TRUE(is_refused(text::decode_line(options, "1" + std::string(400, '0')), Refusal::kMalformed));
}

/// All lines, and "!" and the reason for each refusal, of bytes that come in pieces of `size`.
std::vector<std::string> assembled(std::string_view text, std::size_t size,
                                   text::LineEnding ending = text::LineEnding::kNewline) {
  text::LineAssembler assembler(ending);
  std::vector<std::string> lines;
  const auto keep = [&](const std::optional<text::LineAssembler::Line>& line) {
    if (line) lines.push_back(*line ? std::string(**line) : "!" + std::string(name_of(line->error())));
  };
  while (!text.empty()) {
    const std::string_view piece = text.substr(0, size);
    text.remove_prefix(piece.size());
    std::span bytes(reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size());
    while (!bytes.empty()) keep(assembler.next(bytes));
  }
  keep(assembler.finish());
  return lines;
}

TEST(Line, LeavesOutAGustBelowTheSpeed) {
  const auto decoded = text::decode_line({}, "4.2,270,4.1");
  EXPECT_TRUE(reads(decoded, 4.2, 270.0));
  EXPECT_FALSE(decoded->gust_m_s);
  EXPECT_EQ(text::decode_line({}, "4.2,270,4.2")->gust_m_s, 4.2);
}

TEST(LineAssembler, EndsLinesAtEveryKindOfEndWhereverTheBytesAreSplit) {
  for (std::size_t size = 1; size < 20; ++size) {
    EXPECT_THAT(assembled("a\nbc\r\nd\r\r\n\ne\n\rf", size), ElementsAre("a", "bc", "d", "e", "f")) << size;
    EXPECT_THAT(assembled("\x02Q,1,\x03"
                          "1A\r\n\x02Q",
                          size),
                ElementsAre("Q,1,\x03"
                            "1A",
                            "Q"))
        << size;
    EXPECT_THAT(assembled("\x02"
                          "A\x03\x02"
                          "B\r\x03",
                          size, text::LineEnding::kEtx),
                ElementsAre("A", "B"))
        << size;
    EXPECT_THAT(assembled("cut\x02whole\r\x03next\n", size), ElementsAre("!too short", "whole", "next")) << size;
  }
}

TEST(LineAssembler, RefusesAnOverlongLineOnceAndGoesOnBehindIt) {
  const std::string longest(text::LineAssembler::kMaxLine, 'x');
  EXPECT_THAT(assembled(longest + "\nb\n", 7), ElementsAre(longest, "b"));
  EXPECT_THAT(assembled(longest + "x" + longest + longest + "\nb\n", 7), ElementsAre("!malformed", "b"));
  EXPECT_THAT(assembled(longest + longest +
                            "\x02"
                            "b\n",
                        7),
              ElementsAre("!malformed", "b"));
}

TEST(LineAssembler, TakesLinesAsLongAsItIsTold) {
  text::LineAssembler assembler(text::LineEnding::kNewline, 2000);
  for (const auto& [length, is_taken] : {std::pair(2000U, true), std::pair(2001U, false)}) {
    const std::string sent = std::string(length, 'x') + "\n";
    std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(sent.data()), sent.size());
    const auto line = assembler.next(bytes);
    ASSERT_TRUE(line);
    EXPECT_EQ(line->has_value(), is_taken);
    EXPECT_FALSE(assembler.next(bytes));
  }
}

TEST(LineAssembler, ForgetsWhenItIsCleared) {
  text::LineAssembler assembler;
  const std::vector<std::uint8_t> half = {'$', 'W'};
  std::span<const std::uint8_t> bytes(half);
  EXPECT_FALSE(assembler.next(bytes));
  assembler.clear();
  EXPECT_FALSE(assembler.finish());
}

TEST(SmallTextDecoders, GiveNothingUnphysicalWhateverComes) {
  const std::vector<std::string> texts = {"WI,WVP=020.0,045,0", "$ 28673 M 00400 06552", "4.2,270,6.1",
                                          "speed=4.2 direction=270", "speed = 4.2, direction : NW"};
  constexpr std::string_view kAlphabet = "0123456789.,-+=: $M\t\x7f";
  std::mt19937_64 random(9);
  for (int round = 0; round < 30'000; ++round) {
    std::string text = texts[random() % texts.size()];
    for (auto changes = random() % 6; changes > 0; --changes) {
      text[random() % text.size()] = kAlphabet[random() % kAlphabet.size()];
    }
    for (const auto& decoded :
         {text::decode_ft({}, sentence(text)), text::decode_umb({}, text), text::decode_line({}, text)}) {
      if (decoded) {
        ASSERT_TRUE(is_physical(*decoded)) << text;
      }
    }
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
