#include <random>
#include <string>

#include <gtest/gtest.h>

#include "drivers/decode/text/gill.hpp"
#include "tests/support/decoded_text.hpp"

namespace yuragi::drivers::decode {
namespace {

const text::GillOptions kGill;

/// STX body ETX and the right checksum.
std::string gill_frame(std::string_view body) {
  const std::string sum = sentence(body).substr(body.size() + 2);
  return '\x02' + std::string(body) + '\x03' + sum + "\r\n";
}

Result<DecodedWind, Refusal> decode_gill_body(std::string_view body, const text::GillOptions& options = kGill) {
  return text::decode_gill(options, gill_frame(body));
}

TEST(GillLine, WithADirectionThatCannotBeReadKeepsItsSpeed) {
  const auto wind = decode_gill_body("Q,2x9,002.74,M,00,");
  EXPECT_TRUE(reads(wind, 2.74, {}));
  EXPECT_EQ(wind->status, DecodedStatus::kUncertain);
  EXPECT_TRUE(is_refused(decode_gill_body("Q,2x9,,M,00,"), Refusal::kMalformed));
}

TEST(GillPolar, GivesSpeedInEachUnit) {
  EXPECT_TRUE(reads(decode_gill_body("Q,229,002.74,M,00,"), 2.74, 229.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,229,002.74,N,00,"), 1.4096, 229.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,229,002.74,P,00,"), 1.2249, 229.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,229,002.74,K,00,"), 0.7611, 229.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,229,0539.4,F,00,"), 2.7402, 229.0));
  EXPECT_EQ(decode_gill_body("Q,229,002.74,M,00,")->reference, WindReference::kRelative);
}

TEST(GillPolar, HasNoDirectionInCalm) {
  EXPECT_TRUE(reads(decode_gill_body("Q,,000.04,M,00,"), 0.04, {}));
  EXPECT_TRUE(reads(decode_gill_body("Q,160,000.04,M,00,"), 0.04, {}));  // fixed field: the last one, frozen
  EXPECT_TRUE(reads(decode_gill_body("Q,160,000.05,M,00,"), 0.05, 160.0));
}

TEST(GillPolar, WithABadStatusIsInvalid) {
  EXPECT_TRUE(is_refused(decode_gill_body("Q,,,M,04,"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(decode_gill_body("Q,999,999.99,M,04,"), Refusal::kInvalid));
  for (const std::string status : {"01", "02", "08", "09", "V"}) {
    EXPECT_TRUE(is_refused(decode_gill_body("Q,229,002.74,M," + status + ","), Refusal::kInvalid)) << status;
  }
  EXPECT_TRUE(reads(decode_gill_body("Q,229,002.74,M,60,"), 2.74, 229.0));
  EXPECT_TRUE(is_refused(decode_gill_body("Q,229,002.74,M,"), Refusal::kMalformed));
  EXPECT_TRUE(reads(decode_gill_body("Q,229,002.74,M,", {.status = WhenMissing::kAccept, .node = {}}), 2.74, 229.0));
}

TEST(GillPolar, OfAWindObserverHasItsStatusBehindTheTemperature) {
  EXPECT_TRUE(reads(decode_gill_body("A,121,000.08,M,+344.66,+021.76,00,"), 0.08, 121.0));
  EXPECT_TRUE(is_refused(decode_gill_body("A,121,000.08,M,+344.66,+021.76,04,"), Refusal::kInvalid));
}

TEST(GillUv, BlowsTowardNorthAndWest) {
  EXPECT_TRUE(reads(decode_gill_body("Q,+003.00,+000.00,M,00,"), 3.0, 180.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,-003.00,+000.00,M,00,"), 3.0, 0.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,+000.00,+003.00,M,00,"), 3.0, 90.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,+000.00,-003.00,M,00,"), 3.0, 270.0));
  EXPECT_TRUE(reads(decode_gill_body("Q,-003.00,-004.00,N,00,"), 5.0 * 0.51444, 306.87));
  EXPECT_TRUE(reads(decode_gill_body("Q,+000.00,-000.00,M,00,"), 0.0, {}));
  EXPECT_TRUE(is_refused(decode_gill_body("Q,+000.00,,M,00,"), Refusal::kInvalid));
}

// The bodies of lines on page 56 of the WindMaster's manual.
constexpr std::string_view kWindMaster =
    "Q,335.3,001.261,-001.282,M,+345.41,+023.05,00,+2.4181,+2.4181,+2.4162,+2.4175,-50.00C,";
constexpr std::string_view kWindMasterError = "Q,,,,M,,,07,+2.4181,+2.4187,+2.4162,+2.4175,-50.00C,";
constexpr std::string_view kWindMasterFixedError =
    "Q,999.9,999.999,+999.999,M,+999.99,+999.99,07,+2.4181,+2.4187,+2.4169,+2.4181,-50.00C,";

std::optional<wind::StationQuantities> gill_quantities_of(std::string_view body,
                                                          const text::GillOptions& options = kGill) {
  return text::decode_gill_quantities(options, gill_frame(body));
}

TEST(GillWindMaster, GivesTheHorizontalWindAndTheVerticalBesides) {
  EXPECT_TRUE(reads(decode_gill_body(kWindMaster), 1.261, 335.3));
  EXPECT_EQ(decode_gill_body(kWindMaster)->status, DecodedStatus::kGood);
  const auto said = gill_quantities_of(kWindMaster);
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->vertical_speed_m_s, -1.282);
  EXPECT_FALSE(said->air_temperature_c.has_value()) << "the sonic temperature is another";

  EXPECT_TRUE(reads(decode_gill_body("Q,+003.00,+000.00,+000.50,M,00,"), 3.0, 180.0));
  EXPECT_EQ(gill_quantities_of("Q,+003.00,+000.00,+000.50,M,00,")->vertical_speed_m_s, 0.5);
}

TEST(GillWindMaster, HasItsUnitAndItsStatusBehindTheVerticalWind) {
  EXPECT_TRUE(
      reads(decode_gill_body("Q,335.3,001.261,-001.282,N,+345.41,+023.05,00,"), 1.261 * 1852.0 / 3600.0, 335.3));
  EXPECT_NEAR(*gill_quantities_of("Q,335.3,001.261,-001.282,N,00,")->vertical_speed_m_s, -1.282 * 1852.0 / 3600.0,
              1e-9);
  for (const std::string_view body : {kWindMasterError, kWindMasterFixedError}) {
    EXPECT_TRUE(is_refused(decode_gill_body(body), Refusal::kInvalid)) << body;
    EXPECT_FALSE(gill_quantities_of(body).has_value()) << body;
  }
  // A pair of transducers has failed; the numbers look well.
  EXPECT_TRUE(is_refused(decode_gill_body("Q,335.3,001.261,-001.282,M,01,"), Refusal::kInvalid));
  EXPECT_FALSE(gill_quantities_of("Q,335.3,001.261,-001.282,M,01,").has_value());
  EXPECT_TRUE(is_refused(decode_gill_body("Q,335.3,001.261,-001.282,M,"), Refusal::kMalformed));
  EXPECT_FALSE(gill_quantities_of("Q,335.3,001.261,-001.282,M,").has_value());
  const text::GillOptions accept = {.status = WhenMissing::kAccept, .node = {}};
  EXPECT_EQ(decode_gill_body("Q,335.3,001.261,-001.282,M,", accept)->status, DecodedStatus::kUncertain);
  EXPECT_TRUE(gill_quantities_of("Q,335.3,001.261,-001.282,M,", accept).has_value());
}

TEST(GillWindMaster, IsWhatOtherLinesAreNot) {
  for (const char* body : {"Q,229,002.74,M,00,", "A,121,000.08,M,+344.66,+021.76,00,", "Q,+003.00,+000.00,M,00,",
                           "Q,168,000.02,213,000.00,1013.3,+021.0,0000,"}) {
    EXPECT_FALSE(gill_quantities_of(body).has_value()) << body;
  }
  EXPECT_FALSE(gill_quantities_of(kWindMaster, {.node = 'A'}).has_value());
  auto damaged = gill_frame(kWindMaster);
  damaged[10] ^= 1;
  EXPECT_FALSE(text::decode_gill_quantities(kGill, damaged).has_value());
  EXPECT_FALSE(text::decode_gill_quantities(kGill, "$WIMWV,214.8,R,10.0,N,A*1D").has_value());
}

TEST(GillMaxiMet, HasSpeedAndDirectionInFront) {
  EXPECT_TRUE(reads(decode_gill_body("Q,180,000.06,133,000.21,1013.2,021,0000,"), 0.06, 180.0));
  EXPECT_EQ(decode_gill_body("Q,180,001.06,133,000.21,0100,")->status, DecodedStatus::kUncertain);
}

TEST(GillFrame, NeedsItsChecksumUnlessThePolicySaysOtherwise) {
  EXPECT_TRUE(reads(text::decode_gill(kGill,
                                      "Q,229,002.74,M,00,\x03"
                                      "16"),
                    2.74, 229.0));
  EXPECT_TRUE(is_refused(text::decode_gill(kGill,
                                           "\x02Q,229,002.74,M,00,\x03"
                                           "17"),
                         Refusal::kBadChecksum));
  EXPECT_TRUE(is_refused(text::decode_gill(kGill,
                                           "\x02Q,229,002.74,M,00,\x03"
                                           "1"),
                         Refusal::kTooShort));
  EXPECT_TRUE(is_refused(text::decode_gill(kGill, "\x02Q,229,002.74,M,00,"), Refusal::kTooShort));
  EXPECT_TRUE(
      reads(text::decode_gill({.checksum = WhenMissing::kAccept, .node = {}}, "Q,229,002.74,M,00,"), 2.74, 229.0));
  EXPECT_TRUE(is_refused(text::decode_gill(kGill, ""), Refusal::kTooShort));
}

TEST(GillFrame, OfAnotherNodeOrFormatIsNotMine) {
  text::GillOptions options;
  options.node = 'Q';
  EXPECT_TRUE(reads(decode_gill_body("Q,229,002.74,M,00,", options), 2.74, 229.0));
  EXPECT_TRUE(is_refused(decode_gill_body("A,229,002.74,M,00,", options), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(decode_gill_body("WINDSONIC (Gill Instruments Ltd)"), Refusal::kNotMine));
  EXPECT_TRUE(reads(text::decode_gill(kGill, "$IIMWV,120,R,002.10,M,00*51"), 2.1, 120.0));
}

TEST(GillVectors, OfTheManualReadWithTheRightChecksumOnly) {
  const auto vectors = shared_json("vectors/gill_vectors.json");
  if (vectors.is_null()) GTEST_SKIP() << "../shared/data/vectors/gill_vectors.json is not here";
  for (const auto& vector : vectors) {
    const std::string body = vector["body"];
    SCOPED_TRACE(body);
    const bool is_error = body.find(",04,") != std::string::npos;
    const auto decoded = text::decode_gill(kGill, '\x02' + body + '\x03' + vector["computed"].get<std::string>());
    EXPECT_EQ(decoded.has_value(), !is_error);
    EXPECT_EQ(gill_frame(body).substr(body.size() + 2, 2), vector["computed"].get<std::string>());
    if (!vector["printed_is_right"]) {
      EXPECT_TRUE(is_refused(text::decode_gill(kGill, '\x02' + body + '\x03' + vector["printed"].get<std::string>()),
                             Refusal::kBadChecksum));
    }
  }
}

TEST(GillDecoder, GivesNothingUnphysicalWhateverComes) {
  constexpr std::string_view kAlphabet = "0123456789.,-+MNPKFQ\x02\x03";
  std::mt19937_64 random(8);
  for (int round = 0; round < 30'000; ++round) {
    std::string body = round % 2 == 0 ? "Q,229,002.74,M,00," : "Q,+001.59,-002.74,M,00,";
    for (auto changes = random() % 6; changes > 0; --changes) {
      body[random() % body.size()] = kAlphabet[random() % kAlphabet.size()];
    }
    const auto decoded = decode_gill_body(body, {.status = WhenMissing::kAccept, .node = {}});
    if (decoded) {
      ASSERT_TRUE(is_physical(*decoded)) << body;
    }
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
