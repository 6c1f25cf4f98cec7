#include <string>

#include <gtest/gtest.h>

#include "drivers/decode/text/wxt.hpp"
#include "engine/base/units.hpp"
#include "tests/support/decoded_text.hpp"

namespace yuragi::drivers::decode {
namespace {

const text::WxtOptions kChecked;
const text::WxtOptions kUnchecked = {.checksum = WhenMissing::kAccept};

/// The wind message of the user's guide.
constexpr std::string_view kWindMessage = "0R1,Dn=236D,Dm=283D,Dx=031D,Sn=0.0M,Sm=1.0M,Sx=2.2M\r\n";

Result<DecodedWind, Refusal> decode_wind(const std::string& fields) {
  return text::decode_wxt(kUnchecked, "0R1," + fields);
}

TEST(Wxt, GivesTheMeanWindAndTheGreatestSpeedAsTheGust) {
  const auto wind = text::decode_wxt(kUnchecked, kWindMessage);
  EXPECT_TRUE(reads(wind, 1.0, 283.0));
  EXPECT_EQ(wind->gust_m_s, 2.2);
  EXPECT_EQ(wind->reference, WindReference::kRelative);
  // The composite message, of another address.
  EXPECT_TRUE(
      reads(text::decode_wxt(kUnchecked, "aR0,Dm=051D,Sm=0.1M,Ta=27.9C,Ua=39.4P,Pa=1003.2H,Rc=0.00M"), 0.1, 51.0));
}

TEST(Wxt, GivesSpeedInEachUnit) {
  EXPECT_TRUE(reads(decode_wind("Sm=36.0K"), 10.0, {}));
  EXPECT_TRUE(reads(decode_wind("Sm=10.0S"), 10.0 * kMetresPerSecondPerMph, {}));
  EXPECT_TRUE(reads(decode_wind("Sm=10.0N"), 10.0 * kMetresPerSecondPerKnot, {}));
  EXPECT_TRUE(is_refused(decode_wind("Sm=10.0X"), Refusal::kMalformed));
}

TEST(Wxt, ProvesTheChecksumOfASmallR) {
  // The commands of the user's guide and the prompt that answers a wrong one carry checksums of this kind.
  EXPECT_EQ(text::wxt_wind_request('0'), "0r1Goe\r\n");
  EXPECT_TRUE(
      reads(text::decode_wxt(kChecked, "0r1,Dn=236D,Dm=283D,Dx=031D,Sn=0.0M,Sm=1.0M,Sx=2.2MJ\\Y\r\n"), 1.0, 283.0));
  EXPECT_TRUE(is_refused(text::decode_wxt(kChecked, "0r1,Dn=236D,Dm=283D,Dx=031D,Sn=0.0M,Sm=1.1M,Sx=2.2MJ\\Y"),
                         Refusal::kBadChecksum));
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, "0r1,Sm=1.0M"), Refusal::kBadChecksum));
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, "0r1,S"), Refusal::kTooShort));
}

TEST(Wxt, WithoutAChecksumIsTakenOnlyWhereThatIsAllowed) {
  EXPECT_TRUE(is_refused(text::decode_wxt(kChecked, kWindMessage), Refusal::kBadChecksum));
}

TEST(Wxt, MarkedAsInvalidHasNoValue) {
  EXPECT_TRUE(is_refused(decode_wind("Dn=000#,Dm=000#,Dx=000#,Sn=0.0#,Sm=99.9#,Sx=0.0#"), Refusal::kInvalid));
  EXPECT_TRUE(reads(decode_wind("Dm=000#,Sm=0.3M,Sx=0.0#"), 0.3, {}));
  EXPECT_EQ(decode_wind("Dm=000#,Sm=0.3M,Sx=0.0#")->gust_m_s, std::nullopt);
  EXPECT_TRUE(is_refused(decode_wind("Dx=005D,Sx=2.8M"), Refusal::kInvalid));  // set to send no mean
}

TEST(Wxt, OfAnotherKindIsNotMine) {
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, "0R2,Ta=23.6C,Ua=14.2P,Pa=1026.6H"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, "0R5,Th=25.9C,Vh=12.0N,Vs=15.2V,Vr=3.475V,Id=HEL___"),
                         Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, "0TX,Start-up"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, "$WIMWV,230.6,R,3.42,M,A*12"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, ""), Refusal::kTooShort));
  EXPECT_TRUE(is_refused(text::decode_wxt(kUnchecked, "0R1"), Refusal::kTooShort));
}

TEST(Wxt, ThatIsHurtIsRefused) {
  // The first was seen on a line: the device had lost characters.
  EXPECT_TRUE(is_refused(decode_wind("Dn=0m=032D,Sm=0.1M,Ta=27.9C"), Refusal::kMalformed) ||
              reads(decode_wind("Dn=0m=032D,Sm=0.1M,Ta=27.9C"), 0.1, {}));
  for (const char* fields : {"Dm=283D,Sm=1.M0M", "Dm=283D,Sm=", "Dm=283D,Sm=M", "Dm283D,Sm=1.0M", "Sm=1.0M,Sm=2.0M",
                             "Dm=283D,,Sm=1.0M", "Sm=1.0MSx=2.2M"}) {
    EXPECT_TRUE(is_refused(decode_wind(fields), Refusal::kMalformed)) << fields;
  }
  EXPECT_TRUE(is_refused(decode_wind("Sm=999.9M"), Refusal::kImplausible));
}

TEST(Wxt, WithADirectionThatCannotBeReadKeepsItsSpeed) {
  for (const char* fields : {"Dm=28x3D,Sm=1.0M", "Dm=283,Sm=1.0M", "Dm=999D,Sm=1.0M"}) {
    const auto wind = decode_wind(fields);
    EXPECT_TRUE(reads(wind, 1.0, {})) << fields;
    EXPECT_EQ(wind->status, DecodedStatus::kUncertain) << fields;
  }
}

TEST(Wxt, WithAnImpossibleDirectionKeepsTheSpeed) {
  const auto wind = decode_wind("Dm=999D,Sm=1.0M");
  EXPECT_TRUE(reads(wind, 1.0, {}));
  EXPECT_EQ(wind->status, DecodedStatus::kUncertain);
}

TEST(WxtQuantities, AreInOurUnits) {
  const auto metric = text::decode_wxt_quantities(kUnchecked, "0R0,Ta=23.6C,Ua=14.2P,Pa=1026.6H,Rc=1.50M,Ri=0.6M");
  ASSERT_TRUE(metric.has_value());
  EXPECT_EQ(metric->air_temperature_c, 23.6);
  EXPECT_EQ(metric->relative_humidity_percent, 14.2);
  EXPECT_EQ(metric->pressure_hpa, 1026.6);
  EXPECT_EQ(metric->rain_total_mm, 1.5);
  EXPECT_EQ(metric->rain_rate_mm_h, 0.6);

  const auto imperial = text::decode_wxt_quantities(kUnchecked, "0R0,Ta=50.0F,Pa=30.00I,Rc=0.100I");
  ASSERT_TRUE(imperial.has_value());
  EXPECT_NEAR(imperial->air_temperature_c.value(), 10.0, 1e-9);
  EXPECT_NEAR(imperial->pressure_hpa.value(), 1015.92, 0.01);
  EXPECT_NEAR(imperial->rain_total_mm.value(), 2.54, 1e-9);
  EXPECT_NEAR(text::decode_wxt_quantities(kUnchecked, "0R2,Pa=1.0133B")->pressure_hpa.value(), 1013.3, 1e-9);
  EXPECT_NEAR(text::decode_wxt_quantities(kUnchecked, "0R2,Pa=101330P")->pressure_hpa.value(), 1013.3, 1e-9);
  EXPECT_NEAR(text::decode_wxt_quantities(kUnchecked, "0R2,Pa=760.0M")->pressure_hpa.value(), 1013.25, 1e-3);
}

TEST(WxtQuantities, AreNothingWhereNothingIsSaid) {
  EXPECT_FALSE(text::decode_wxt_quantities(kUnchecked, kWindMessage));
  EXPECT_FALSE(text::decode_wxt_quantities(kUnchecked, "0R2,Ta=23.6#"));
  EXPECT_FALSE(text::decode_wxt_quantities(kUnchecked, "0R2,Ta=23.6"));
  EXPECT_FALSE(text::decode_wxt_quantities(kChecked, "0R2,Ta=23.6C"));
}

TEST(Wxt, IsKnownByItsLook) {
  EXPECT_TRUE(text::looks_like_wxt(kWindMessage));
  EXPECT_TRUE(text::looks_like_wxt("0r2,Ta=23.6Cxyz"));
  for (const char* line :
       {"", "0R1", "0R1,", "Q,229,002.74,M,00,", "$WI,WVP=020.0,045,0*73", "speed=4.2", "4.2,270", "0TX,Start-up"}) {
    EXPECT_FALSE(text::looks_like_wxt(line)) << line;
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
