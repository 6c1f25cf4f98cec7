#include "daemon/tools/decode/unit_reader.hpp"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/decode/hex_text.hpp"
#include "tests/support/decoded_units.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

drivers::decode::ByteSpan bytes_of_text(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The messages of an input that comes in pieces, as text: "request|bytes", or "!" and what is wrong.
std::vector<std::string> units_of(UnitReader::Form form, std::string_view input, std::size_t piece) {
  std::vector<std::string> units;
  UnitReader reader(form, drivers::decode::text::LineEnding::kNewline);
  const auto keep = [&](const ReadUnit& unit) {
    units.push_back(unit.why ? "!" + std::string(unit.detail) : to_hex(unit.request) + "|" + to_hex(unit.bytes));
  };
  for (; !input.empty(); input.remove_prefix(std::min(piece, input.size()))) {
    reader.feed(bytes_of_text(input.substr(0, piece)), keep);
  }
  reader.finish(keep);
  return units;
}

TEST(UnitReader, CutsHexadecimalInputAlikeHoweverItComes) {
  const std::string input = "# a comment\n\n01 02 | 03\r\n0405\nno digits\n| 06\n07 |\n08";
  const std::vector<std::string> expected = {"01 02|03", "|04 05", "!not hexadecimal digits, two per byte",
                                             "|06",      "07|",    "|08"};
  for (const std::size_t piece : {1U, 2U, 7U, 1000U}) {
    EXPECT_EQ(units_of(UnitReader::Form::kHexFrames, input, piece), expected) << piece;
  }
}

TEST(UnitReader, MakesLinesOfHexadecimalDigits) {
  // "ab" CR LF "c", and "d" on a line of its own.
  const std::vector<std::string> expected = {"|61 62", "|63", "|64"};
  EXPECT_EQ(units_of(UnitReader::Form::kHexLines, "61 62 0d 0a 63\n64\n", 3), expected);
}

TEST(UnitReader, PassesOverALineWithoutEndInBoundedMemory) {
  std::string input(1'000'000, '0');
  input += "\n01\n";
  const std::vector<std::string> expected = {"!line too long", "|01"};
  EXPECT_EQ(units_of(UnitReader::Form::kHexFrames, input, 4096), expected);
}

TEST(UnitDecoders, GiveNothingUnsoundWhateverComes) {
  constexpr std::string_view kAlphabet = "0123456789abcdef ,|$*\n\r\x02\x03#QWIMVR.-+";
  std::mt19937_64 random(11);
  for (const UnitFormat& format : unit_formats()) {
    UnitDecoderOptions options;
    options.profile = "renke-rs-fsjt-rs-fxjt-n01";
    options.checksum = options.makers_checksum = drivers::decode::WhenMissing::kAccept;
    options.status = drivers::decode::WhenMissing::kAccept;
    options.interval_s = 0.5;
    options.vane_reference_v = 5.0;
    for (int round = 0; round < 100; ++round) {
      options.are_reports = round % 2 == 0;
      std::string input(random() % 400, '\0');
      for (char& c : input) c = round % 3 == 0 ? static_cast<char>(random()) : kAlphabet[random() % kAlphabet.size()];
      const bool is_hex = !format.is_text || round % 4 == 0;
      test::decode_units(format, options, is_hex, bytes_of_text(input), 1 + random() % 64,
                         [&](const UnitDecoder::Outcome& outcome) {
                           EXPECT_TRUE(!outcome || test::is_sound(*outcome)) << format.name;
                         });
    }
  }
}

}  // namespace
}  // namespace yuragi::daemon::tools::decode
