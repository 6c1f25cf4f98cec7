#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/decode/text/nmea.hpp"
#include "tests/support/decoded_text.hpp"

namespace yuragi::drivers::decode {
namespace {

const text::NmeaOptions kStrict;
const text::NmeaOptions kLenient = {
    .checksum = WhenMissing::kAccept, .status = WhenMissing::kAccept, .xdr_first_id = 0};

Result<DecodedWind, Refusal> decode_body(std::string_view body, const text::NmeaOptions& options = kStrict) {
  return text::decode_nmea(options, sentence(body));
}

TEST(NmeaMwv, GivesSpeedInEachUnitAndItsReference) {
  EXPECT_TRUE(reads(decode_body("WIMWV,214.8,R,10.0,M,A"), 10.0, 214.8));
  EXPECT_TRUE(reads(decode_body("WIMWV,214.8,R,10.0,N,A"), 5.1444, 214.8));
  EXPECT_TRUE(reads(decode_body("WIMWV,214.8,R,10.0,K,A"), 2.7778, 214.8));
  EXPECT_TRUE(reads(decode_body("WIMWV,214.8,R,10.0,S,A"), 4.4704, 214.8));
  EXPECT_EQ(decode_body("WIMWV,214.8,R,10.0,M,A")->reference, WindReference::kRelative);
  EXPECT_EQ(decode_body("WIMWV,214.8,T,10.0,M,A")->reference, WindReference::kTrue);
}

TEST(NmeaMwv, WithAHalfEmptyHasTheOtherAndNeverAZero) {
  EXPECT_TRUE(reads(decode_body("WIMWV,,R,3.0,M,A"), 3.0, {}));
  EXPECT_TRUE(reads(decode_body("WIMWV,90,R,,M,A"), {}, 90.0));
  EXPECT_TRUE(is_refused(decode_body("WIMWV,,R,,M,A"), Refusal::kInvalid));
}

TEST(NmeaMwv, TakesAnglesOfAWholeTurnAndBeyond) {
  EXPECT_TRUE(reads(decode_body("WIMWV,360,R,3.0,M,A"), 3.0, 0.0));
  EXPECT_TRUE(reads(decode_body("WIMWV,360.0,R,3.0,M,A"), 3.0, 0.0));
  EXPECT_TRUE(reads(decode_body("WIMWV,530,R,3.0,M,A"), 3.0, 170.0));
}

TEST(NmeaLine, WithAnImpossibleDirectionHasTheSpeedBesideIt) {
  EXPECT_TRUE(reads(decode_body("WIMWV,720,R,3.0,M,A"), 3.0, {}));
  EXPECT_TRUE(reads(decode_body("WIMWV,-10,R,3.0,M,A"), 3.0, {}));
  EXPECT_TRUE(reads(decode_body("WIMWV,999.9,R,3.0,M,A"), 3.0, {}));
  EXPECT_TRUE(reads(decode_body("WIMWD,999.9,T,,M,11.2,N,5.8,M"), 5.8, {}));
  EXPECT_TRUE(reads(decode_body("WIMDA,,,,,,,,,,,,,-1,T,,M,1.2,N,0.6,M"), 0.6, {}));
  EXPECT_TRUE(reads(decode_body("IIVWR,999,R,,,0.51,M,,"), 0.51, {}));
  EXPECT_TRUE(reads(decode_body("WIXDR,A,999,D,0,S,0.2,M,0"), 0.2, {}));
  for (const std::string_view body :
       {"WIMWV,720,R,,M,A", "WIMWD,999.9,T,,M,,N,,M", "IIVWR,999,R,,,,M,,", "WIXDR,A,999,D,0"}) {
    EXPECT_TRUE(is_refused(decode_body(body), Refusal::kImplausible)) << body;
  }
}

/// As SignalK's nmea0183-signalk takes the letters (hooks MWV, VWR), and pynmea2 the name.
TEST(NmeaLine, MayBeInLowerCase) {
  EXPECT_TRUE(reads(decode_body("WIMWV,214.8,r,10.0,n,a"), 5.1444, 214.8));
  EXPECT_EQ(decode_body("WIMWV,214.8,t,10.0,m,A")->reference, WindReference::kTrue);
  EXPECT_TRUE(is_refused(decode_body("WIMWV,214.8,r,10.0,n,v"), Refusal::kInvalid));
  EXPECT_TRUE(reads(decode_body("IIVWR,75,l,,,,,36.0,k"), 10.0, 285.0));
  EXPECT_TRUE(reads(decode_body("wimwd,328.2,t,326.8,m,11.2,n,5.8,m"), 5.8, 328.2));
  EXPECT_TRUE(is_refused(decode_body("wihdg,229.8,,,1.3,e"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(decode_body("WIMWV,214.8,rr,10.0,n,a"), Refusal::kMalformed));
}

TEST(NmeaMwv, WithoutAGoodStatusIsInvalid) {
  EXPECT_TRUE(is_refused(decode_body("WIMWV,,R,,M,V"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(decode_body("WIMWV,120,R,2.10,M,V"), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(decode_body("WIMWV,120,R,2.10,M,04", kLenient), Refusal::kInvalid));
  EXPECT_TRUE(reads(decode_body("IIMWV,120,R,002.10,M,00"), 2.10, 120.0));
  EXPECT_TRUE(reads(decode_body("IIMWV,120,R,002.10,M,60"), 2.10, 120.0));
}

TEST(NmeaPolicy, DecidesAboutAMissingStatus) {
  for (const std::string_view body : {"02MWV,327.6,R,1.89,N", "02MWV,327.6,R,1.89,N,"}) {
    EXPECT_TRUE(is_refused(decode_body(body), Refusal::kMalformed));
    const auto decoded = decode_body(body, kLenient);
    EXPECT_TRUE(reads(decoded, 0.9723, 327.6));
    EXPECT_EQ(decoded->status, DecodedStatus::kUncertain);
  }
}

TEST(NmeaPolicy, DecidesAboutAMissingChecksum) {
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, "$WIMWV,214.8,R,0.1,K,A"), Refusal::kBadChecksum));
  EXPECT_TRUE(reads(text::decode_nmea(kLenient, "$WIMWV,214.8,R,0.1,K"), 0.1 / 3.6, 214.8));
  EXPECT_TRUE(is_refused(text::decode_nmea(kLenient, "$WIMWV,214.8,R,0.1,K,A*00"), Refusal::kBadChecksum));
}

TEST(NmeaLine, MayHaveALowerCaseChecksumAndOnlyARightOne) {
  EXPECT_TRUE(reads(text::decode_nmea(kStrict, "$IIMWV,074,T,05.85,N,A*2e"), 3.0095, 74.0));
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, "$IIMWV,074,T,05.85,N,A*2F"), Refusal::kBadChecksum));
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, "$IIMWV,074,T,05.85,N,A*2"), Refusal::kTooShort));
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, "$IIMWV,074,T,05.85,N,A*2E0"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, "$IIMWV,074,T,05.85,N,A*xy"), Refusal::kBadChecksum));
}

TEST(NmeaLine, MayHaveSomethingInFront) {
  const std::string good = sentence("WIMWV,074,R,05.85,M,A");
  for (const std::string& front : {std::string(3, '\0'), std::string("\\s:GPS,c:1534758457*00\\"),
                                   std::string("12:00:01 "), std::string("$WIMWV,0"), std::string(" \t")}) {
    EXPECT_TRUE(reads(text::decode_nmea(kStrict, front + good + "\r\n"), 5.85, 74.0)) << front;
  }
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, "# " + good), Refusal::kNotMine));
}

TEST(NmeaLine, ThatIsNoWindSentenceIsNotMine) {
  EXPECT_TRUE(
      is_refused(text::decode_nmea(kStrict, "!AIVDM,1,1,,A,13u?etPv2;0n:dDPwUM1U1Cb069D,0*24"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, "Calypso ready"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(decode_body("SDHDG,229.8,,,1.3,E"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(decode_body("PMWV,1,R,1,M,A"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(decode_body("IIXDR,C,,C,AIRTEMP,A,-1.0,D,HEEL,A,2.9,D,TRIM"), Refusal::kNotMine));
  EXPECT_TRUE(is_refused(text::decode_nmea(kStrict, ""), Refusal::kTooShort));
}

TEST(NmeaLine, WithFieldsThatTheSentenceDoesNotHaveIsMalformed) {
  for (const std::string_view body :
       {"WIMWV,12x,R,,M,A", "WIMWV,12,R,1.0.0,M,A", "WIMWV,12,R,nan,M,A", "WIMWV,12,R,1e3,M,A", "WIMWV,12,Q,1.0,M,A",
        "WIMWV,12,R,1.0,,A", "WIMWV,12,R,1.0,X,A", "WIMWV,12,R,0x1,M,A", "WIVWR,12,,,N", "WIVWR,12,R,1.0,M",
        "WIMWD,12,T,,M,1.0,X", "WIMWD,12,X", "WIMWV,12,R,inf,M,A", "WIMWV,12,R,.,M,A", "WIMWV,12,R,+-1,M,A"}) {
    EXPECT_TRUE(is_refused(decode_body(body), Refusal::kMalformed)) << body;
  }
  EXPECT_TRUE(is_refused(decode_body("WIMWV" + std::string(200, ',')), Refusal::kMalformed));
}

TEST(NmeaLine, WithAWindThatNeverBlewIsImplausible) {
  EXPECT_TRUE(is_refused(decode_body("WIMWV,12,R,120.5,M,A"), Refusal::kImplausible));
  EXPECT_TRUE(is_refused(decode_body("WIMWV,12,R,-0.5,M,A"), Refusal::kImplausible));
}

TEST(NmeaMwd, PrefersTrueNorthAndMetresPerSecond) {
  const auto both = decode_body("WIMWD,328.2,T,326.8,M,11.2,N,5.8,M");
  EXPECT_TRUE(reads(both, 5.8, 328.2));
  EXPECT_EQ(both->reference, WindReference::kNorth);
  const auto magnetic = decode_body("IIMWD,,,046.,M,10.1,N,,");
  EXPECT_TRUE(reads(magnetic, 5.1958, 46.0));
  EXPECT_EQ(magnetic->reference, WindReference::kMagnetic);
  const auto calm = decode_body("IIMWD,,T,,M,0.0,N,0.0,M");
  EXPECT_TRUE(reads(calm, 0.0, {}));
  EXPECT_EQ(calm->reference, WindReference::kUnknown);
}

/// As a boat's network sends it (sankeysoft/nmea_dashboard issue 31): the pair of the knots is left out.
TEST(NmeaMwd, IsReadByItsLetters) {
  const auto six = decode_body("WIMWD,322.8,T,333.9,M,4.5,M");
  EXPECT_TRUE(reads(six, 4.5, 322.8));
  EXPECT_EQ(six->reference, WindReference::kNorth);
  EXPECT_TRUE(reads(decode_body("WIMWD,322.8,T,333.9,M,10.0,N"), 5.1444, 322.8));
  EXPECT_TRUE(reads(decode_body("WIMWD,322.8,T,10.0,N,5.1,M"), 5.1, 322.8));
  EXPECT_TRUE(reads(decode_body("WIMWD,322.8,T,,,4.5,M"), 4.5, 322.8));
  EXPECT_TRUE(reads(decode_body("WIMWD,,,,,,,4.5,M"), 4.5, {}));
  const auto magnetic = decode_body("WIMWD,333.9,M,4.5,M");
  EXPECT_TRUE(reads(magnetic, 4.5, 333.9));
  EXPECT_EQ(magnetic->reference, WindReference::kMagnetic);
  EXPECT_TRUE(reads(decode_body("WIMWD,322.8,T,33.9,M"), {}, 322.8)) << "33.9 is no speed";
}

TEST(NmeaLine, WithADirectionThatCannotBeReadKeepsItsSpeed) {
  EXPECT_TRUE(reads(decode_body("WIMWV,12x,R,1.0,M,A"), 1.0, {}));
  EXPECT_TRUE(reads(decode_body("WIMWD,NW,T,,M,11.2,N,5.8,M"), 5.8, {}));
  EXPECT_TRUE(reads(decode_body("WIMWD,12,X,,,1.0,M"), 1.0, {}));
  EXPECT_TRUE(reads(decode_body("IIVWR,---,R,,,0.51,M,,"), 0.51, {}));
  EXPECT_TRUE(reads(decode_body("IIVWR,12,,1.0,N"), 0.5144, {}));
  EXPECT_TRUE(reads(decode_body("WIXDR,A,--,D,0,S,0.2,M,0"), 0.2, {}));
}

TEST(NmeaVwr, IsFromPortOrStarboardOfTheBow) {
  EXPECT_TRUE(reads(decode_body("IIVWR,75,R,1.0,N,0.51,M,1.85,K"), 0.51, 75.0));
  EXPECT_TRUE(reads(decode_body("IIVWR,75,L,,,,,36.0,K"), 10.0, 285.0));
  EXPECT_TRUE(reads(decode_body("IIVWR,0,L,10,N,,,,"), 5.1444, 0.0));
  EXPECT_EQ(decode_body("IIVWT,75,L,,,,,36.0,K")->reference, WindReference::kTrue);
}

/// As SignalK's nmea0183-signalk does (hooks VWT): 200 degrees to starboard are 160 to port.
TEST(NmeaVwt, CountsOnAboveAHalfTurn) {
  EXPECT_TRUE(reads(decode_body("IIVWT,200.0,R,10.1,N,05.2,M,018.7,K"), 5.2, 200.0));
  EXPECT_TRUE(reads(decode_body("IIVWT,200.0,L,10.1,N,05.2,M,018.7,K"), 5.2, 160.0));
  EXPECT_TRUE(reads(decode_body("IIVWT,180.0,L,10.1,N,05.2,M,018.7,K"), 5.2, 180.0));
  EXPECT_TRUE(reads(decode_body("IIVWT,360.0,L,10.1,N,05.2,M,018.7,K"), 5.2, 0.0));
  EXPECT_TRUE(reads(decode_body("IIVWR,181,R,1.0,N,,,,"), 0.5144, 181.0));
}

TEST(NmeaMda, HasItsWindAtTheEnd) {
  EXPECT_TRUE(
      reads(decode_body("WIMDA,29.7544,I,1.0076,B,35.5,C,,,42.1,,20.6,C,116.4,T,107.7,M,1.2,N,0.6,M"), 0.6, 116.4));
  EXPECT_TRUE(is_refused(decode_body("WIMDA,29.7544,I,1.0076,B,35.5,C"), Refusal::kInvalid));
}

TEST(NmeaXdr, OfTheWxtHasMeanAndGust) {
  const auto decoded = decode_body("WIXDR,A,302,D,0,A,320,D,1,A,330,D,2,S,0.1,M,0,S,0.2,M,1,S,0.4,M,2");
  EXPECT_TRUE(reads(decoded, 0.2, 320.0));
  ASSERT_TRUE(decoded->gust_m_s);
  EXPECT_NEAR(*decoded->gust_m_s, 0.4, 1e-9);
  EXPECT_TRUE(reads(decode_body("WIXDR,A,302,D,0,S,0.1,M,0"), 0.1, 302.0));
  EXPECT_TRUE(is_refused(decode_body("WIXDR,A,302,D,4,S,0.1,M,4"), Refusal::kNotMine));
  EXPECT_TRUE(
      reads(decode_body("WIXDR,A,302,D,4,S,36,K,4", {.checksum = {}, .status = {}, .xdr_first_id = 4}), 10.0, 302.0));
}

TEST(NmeaXdr, TakesTheLeastOfSeveralForNoReading) {
  const auto decoded = decode_body("WIXDR,A,302,D,0,A,330,D,2,S,0.1,M,0,S,0.4,M,2");
  ASSERT_TRUE(decoded.has_value());
  EXPECT_FALSE(decoded->speed_m_s) << "the mean was switched off, and 0.1 m/s is the least";
  EXPECT_FALSE(decoded->direction_deg);
  EXPECT_NEAR(decoded->gust_m_s.value_or(0.0), 0.4, 1e-9);
}

TEST(NmeaXdr, WhoseFieldsHaveMovedIsRefused) {
  for (const char* body :
       {"WIXDR,A,302,D,0,,A,320,D,1,S,0.1,M,0,S,0.2,M,1", "WIXDR,A,302,D,0,A320,D,1,S,0.1,M,0,S,0.2,M,1",
        "WIXDR,A,302,D,0,S,0.1,M,0,S,0.2,M", "WIXDR,302,D,0,A,S,0.1,M,0"}) {
    EXPECT_TRUE(is_refused(decode_body(body), Refusal::kMalformed)) << body;
  }
  EXPECT_TRUE(reads(decode_body("WIXDR,A,302,D,0,S,0.1,M,0,"), 0.1, 302.0)) << "a comma behind the last field";
}

std::optional<wind::StationQuantities> quantities_of(std::string_view body, int xdr_first_id = 0) {
  return text::decode_nmea_quantities({.checksum = {}, .status = {}, .xdr_first_id = xdr_first_id}, sentence(body));
}

TEST(NmeaQuantities, AreInMda) {
  const auto said = quantities_of("WIMDA,29.7544,I,1.0076,B,35.5,C,,,42.1,,20.6,C,116.4,T,107.7,M,1.2,N,0.6,M");
  ASSERT_TRUE(said.has_value());
  EXPECT_NEAR(said->pressure_hpa.value_or(0.0), 1007.6, 1e-9);
  EXPECT_EQ(said->air_temperature_c, 35.5);
  EXPECT_EQ(said->relative_humidity_percent, 42.1);
  EXPECT_FALSE(said->rain_total_mm || said->rain_rate_mm_h || said->vertical_speed_m_s);

  const auto inches = quantities_of("WIMDA,29.7544,I,,,-3.5,C,,,,,,,,T,,M,,N,,M");
  ASSERT_TRUE(inches.has_value());
  EXPECT_NEAR(inches->pressure_hpa.value_or(0.0), 1007.6, 0.05);
  EXPECT_EQ(inches->air_temperature_c, -3.5);
  EXPECT_FALSE(inches->relative_humidity_percent.has_value());
}

TEST(NmeaQuantities, AreInXdrByTheDevicesOwnNumber) {
  const auto said =
      quantities_of("WIXDR,C,25.1,C,0,C,31.0,C,1,H,40.5,P,0,P,1015.2,H,0,V,0.12,M,0,Z,10,s,0,R,2.3,M,0,V,9,M,1");
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->air_temperature_c, 25.1);
  EXPECT_EQ(said->relative_humidity_percent, 40.5);
  EXPECT_EQ(said->pressure_hpa, 1015.2);
  EXPECT_EQ(said->rain_total_mm, 0.12);
  EXPECT_EQ(said->rain_rate_mm_h, 2.3);
  EXPECT_NEAR(quantities_of("WIXDR,P,1.0152,B,4", 4)->pressure_hpa.value_or(0.0), 1015.2, 1e-9);
  EXPECT_NEAR(quantities_of("WIXDR,P,101520,P,4", 4)->pressure_hpa.value_or(0.0), 1015.2, 1e-9);
}

TEST(NmeaQuantities, AreNoneInAnythingElse) {
  for (const std::string_view body :
       {"WIMWV,214.8,R,10.0,M,A", "IIXDR,C,90.0,C,ENGINE", "WIXDR,C,75.0,F,0", "WIXDR,C,nan,C,0", "WIXDR,C,,C,0",
        "WIMDA,,I,,B,,C", "WIXDR,V,0.01,I,0", "WIXDR"}) {
    EXPECT_FALSE(quantities_of(body).has_value()) << body;
  }
  EXPECT_FALSE(text::decode_nmea_quantities(kStrict, "$WIXDR,C,25.1,C,0*00").has_value());
  EXPECT_FALSE(text::decode_nmea_quantities(kStrict, "$WIXDR,C,25.1,C,0").has_value());
  EXPECT_FALSE(text::decode_nmea_quantities(kStrict, "").has_value());
}

TEST(NmeaVectors, OfTheSharedCollectionDecodeAsTheySay) {
  const auto vectors = shared_json("vectors/nmea_vectors.json");
  if (vectors.is_null()) GTEST_SKIP() << "../shared/data/vectors/nmea_vectors.json is not here";

  for (const auto& vector : vectors) {
    const std::string line = vector["sentence"];
    const auto& expect = vector["expect"];
    SCOPED_TRACE(line);
    const auto decoded = text::decode_nmea(kLenient, line);
    if (!vector["checksum_ok"]) {
      EXPECT_TRUE(is_refused(decoded, Refusal::kBadChecksum));
    } else if (expect.contains("drop")) {
      EXPECT_TRUE(is_refused(decoded, Refusal::kInvalid));
    } else if (expect.contains("speed_ms")) {
      const double direction_deg = expect.contains("angle")      ? expect["angle"]
                                   : expect.contains("dir_true") ? expect["dir_true"]
                                                                 : expect["dir_mag"];
      EXPECT_TRUE(reads(decoded, expect["speed_ms"].get<double>(), direction_deg));
    } else {
      EXPECT_TRUE(decoded.has_value());
    }
    if (decoded && expect.contains("ref")) {
      EXPECT_EQ(decoded->reference, expect["ref"] == "R" ? WindReference::kRelative : WindReference::kTrue);
    }
  }
}

std::vector<std::string> lines_of(const std::string& name) {
  std::ifstream in(test::source_path("../shared/data/nmea/" + name));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(NmeaLog, OfTheZeusReadsAllItsWindAsGpsdDoes) {
  const auto lines = lines_of("gpsd_bundg_zeus_9.log");
  if (lines.empty()) GTEST_SKIP() << "../shared/data/nmea/gpsd_bundg_zeus_9.log is not here";

  int decoded_count = 0;
  std::vector<DecodedWind> apparent;
  std::vector<DecodedWind> north;
  for (const std::string& line : lines) {
    const auto decoded = text::decode_nmea(kStrict, line);
    const bool is_wind = line.starts_with("$WIMW");
    EXPECT_EQ(decoded.has_value(), is_wind) << line;
    if (!decoded) continue;
    ++decoded_count;
    if (decoded->reference == WindReference::kRelative) apparent.push_back(*decoded);
    if (decoded->reference == WindReference::kNorth) north.push_back(*decoded);
  }
  EXPECT_EQ(decoded_count, 450);

  // gpsd reports once a second what came before; its lines are in the order of the log, and some sentences are skipped.
  std::ifstream in(test::source_path("../shared/data/nmea/gpsd_bundg_zeus_9.tpv_wind.json"));
  std::size_t at_apparent = 0;
  std::size_t at_north = 0;
  int compared = 0;
  const auto find = [](const std::vector<DecodedWind>& winds, std::size_t& at, double speed_m_s, double direction_deg) {
    while (at < winds.size() && (std::abs(*winds[at].speed_m_s - speed_m_s) > 0.06 ||
                                 std::abs(*winds[at].direction_deg - direction_deg) > 0.06)) {
      ++at;
    }
    return at < winds.size();
  };
  for (std::string line; std::getline(in, line);) {
    const auto gpsd = nlohmann::json::parse(line);
    if (gpsd.contains("wspeedr")) {
      EXPECT_TRUE(find(apparent, at_apparent, gpsd["wspeedr"], gpsd["wangler"])) << line;
      ++compared;
    }
    if (gpsd.contains("wspeedt")) {
      EXPECT_TRUE(find(north, at_north, gpsd["wspeedt"], gpsd["wanglet"])) << line;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
  RecordProperty("compared", compared);
}

TEST(NmeaLog, OfN2kdReadsByPolicy) {
  const auto lines = lines_of("signalk_n2kd-183-merrimac.log");
  if (lines.empty()) GTEST_SKIP() << "../shared/data/nmea/signalk_n2kd-183-merrimac.log is not here";

  int wind = 0;
  int strict = 0;
  int by_policy = 0;
  for (const std::string& line : lines) {
    wind += line.find("MWV,") == 3 ? 1 : 0;
    strict += text::decode_nmea(kStrict, line).has_value() ? 1 : 0;
    const auto decoded =
        text::decode_nmea({.checksum = WhenMissing::kRefuse, .status = WhenMissing::kAccept, .xdr_first_id = 0}, line);
    by_policy += decoded.has_value() ? 1 : 0;
  }
  EXPECT_EQ(wind, 147);
  EXPECT_EQ(strict, 0);
  EXPECT_EQ(by_policy, wind);
}

/// Random bytes, and sentences with some of their bytes changed and their checksum made right again.
TEST(NmeaDecoder, GivesNothingUnphysicalWhateverComes) {
  const std::vector<std::string> bodies = {"WIMWV,57.5,R,13.0,N,A", "WIMWD,328.2,T,326.8,M,11.2,N,5.8,M",
                                           "IIVWR,75,R,1.0,N,0.51,M,1.85,K", "WIXDR,A,302,D,0,S,0.1,M,0,S,0.4,M,2"};
  constexpr std::string_view kAlphabet = "0123456789.,-+MNKSRTLAVD$*#e\x00\xff";
  std::mt19937_64 random(7);
  for (int round = 0; round < 30'000; ++round) {
    std::string body = bodies[random() % bodies.size()];
    for (auto changes = random() % 6; changes > 0; --changes) {
      body[random() % body.size()] = kAlphabet[random() % kAlphabet.size()];
    }
    const auto decoded = text::decode_nmea(kLenient, round % 4 == 0 ? body : sentence(body));
    if (decoded) {
      ASSERT_TRUE(is_physical(*decoded)) << body;
    }

    std::string bytes(random() % 40, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    EXPECT_FALSE(text::decode_nmea(kStrict, bytes).has_value());
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
