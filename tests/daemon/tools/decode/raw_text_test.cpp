#include "daemon/tools/decode/raw_text.hpp"

#include <sstream>

#include <gtest/gtest.h>

#include "daemon/tools/decode/hex_text.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

wire::RawTrace message_of(std::string_view text, bool received = true) {
  return {.sensor = "roof",
          .utc_ns = 1'700'000'000'123'000'000,  // 2023-11-14 22:13:20.123
          .received = received,
          .bytes = {text.begin(), text.end()},
          .length = static_cast<std::uint32_t>(text.size())};
}

TEST(RawText, ShowsTimeDirectionDigitsAndText) {
  EXPECT_EQ(raw_text(message_of("$WIMWV,1\r\n")),
            "22:13:20.123 roof         <- 24 57 49 4d 57 56 2c 31 0d 0a                    $WIMWV,1..\n");
  EXPECT_EQ(raw_text(message_of("\x01\x03", false)),
            "22:13:20.123 roof         -> 01 03                                            ..\n");
}

TEST(RawText, GoesOnUnderALongMessageAndTellsWhatIsLeftOut) {
  wire::RawTrace trace = message_of("0123456789abcdef0123");
  trace.length = 700;
  trace.lost = 12;
  EXPECT_EQ(raw_text(trace),
            "... 12 messages of roof were skipped\n"
            "22:13:20.123 roof         <- 30 31 32 33 34 35 36 37 38 39 61 62 63 64 65 66  0123456789abcdef\n"
            "                             30 31 32 33                                      0123\n"
            "                             ... and 680 bytes more\n");
}

TEST(RawText, ShowsAMessageWithoutBytes) {
  EXPECT_EQ(raw_text(message_of("")).find("22:13:20.123 roof         <- "), 0U);
}

TEST(RawText, IsNeverWiderThanAHundredColumns) {
  wire::RawTrace trace = message_of(std::string(wire::kMaxRawBytes, 'x'));
  trace.sensor = std::string(64, 'n');
  trace.lost = 18'446'744'073'709'551'615U;
  trace.utc_ns = -1;
  std::istringstream lines(raw_text(trace));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST(RawHexLines, PutsARequestBeforeItsAnswer) {
  RawHexLines lines;
  EXPECT_EQ(lines.line_of(message_of("\x01\x03", false)), "");
  EXPECT_EQ(lines.line_of(message_of("\x01\x04")), "01 03 | 01 04\n");
  EXPECT_EQ(lines.line_of(message_of("\x05")), "05\n") << "nothing was asked again";
  EXPECT_EQ(lines.line_of(message_of("\x01\x03", false)), "");
  wire::RawTrace of_another = message_of("\x07");
  of_another.sensor = "mast";
  EXPECT_EQ(lines.line_of(of_another), "07\n");
}

TEST(HexText, IsReadAsItIsWritten) {
  std::vector<std::uint8_t> all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
  EXPECT_EQ(parse_hex(to_hex(all)), all);
  EXPECT_EQ(parse_hex(""), std::vector<std::uint8_t>{});
  EXPECT_EQ(parse_hex("0xD4,0x36"), (std::vector<std::uint8_t>{0xD4, 0x36}));
  for (const char* none : {"d", "d4 3", "0x", "zz", "d4;36", "-", "+1", "d4 36 |"}) {
    const bool is_empty = std::string_view(none) == "-";
    EXPECT_EQ(parse_hex(none).has_value(), is_empty) << none;
  }
}

}  // namespace
}  // namespace yuragi::daemon::tools::decode
