// A line of each text format is recognised wherever lines come in: by `yuragi decode`'s hint, by `yuragi import`, and,
// where a driver receives lines, by what names the driver that reads them. Each tries decoders of its own; this keeps
// them together.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/decode/decode_formats.hpp"
#include "daemon/tools/decode/recognise.hpp"
#include "daemon/tools/logs/message_finder.hpp"
#include "drivers/text/driver_of_line.hpp"

namespace yuragi::daemon::tools::logs {
namespace {

struct Sample {
  std::string line;
  double speed_m_s;
  std::string_view driver;  ///< of lines; empty: no driver of lines reads it
};

/// By the name of the format.
const std::map<std::string_view, Sample>& samples() {
  static const std::map<std::string_view, Sample> kSamples = {
      {"nmea", {"$WIMWV,214.8,R,4.0,M,A*2B", 4.0, "nmea"}},
      {"gill",
       {"\x02Q,229,002.74,M,00,\x03"
        "16",
        2.74, "nmea"}},
      {"umb", {"$ 28673 M 00400 06552", 7.5, "nmea"}},
      {"ft", {"$WI,WVP=020.0,045,0*73", 20.0, "nmea"}},
      {"wxt", {"0R1,Dn=236D,Dm=283D,Dx=031D,Sn=0.0M,Sm=1.0M,Sx=2.2M", 1.0, "nmea"}},
      {"line", {"speed=4.2 direction=270", 4.2, "line"}},
      {"nmea2000", {"2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,f4,01,9a,91,fa,ff,ff", 5.0, "nmea2000"}},
      {"signalk",
       {R"({"context":"vessels.self","updates":[{"$source":"a.1","timestamp":"2026-06-21T10:00:00Z","values":[)"
        R"({"path":"environment.wind.speedApparent","value":4.0},)"
        R"({"path":"environment.wind.angleApparent","value":1.0}]}]})",
        4.0, "signalk"}},
      {"weatherlink",
       {R"({"did":"001D0A700002","ts":1646168724,"conditions":[{"data_structure_type":1,"txid":1,)"
        R"("wind_speed_last":10.0,"wind_dir_last":90,"wind_speed_hi_last_10_min":12.0}]})",
        4.4704,
        {}}},
      {"tempest",
       {R"({"serial_number":"ST-00000001","type":"rapid_wind","hub_sn":"HB-00000001","ob":[1646168724,2.3,128]})",
        2.3,
        {}}},
      {"ecowitt-push",
       {"PASSKEY=A&dateutc=2026-06-21+10:00:00&winddir=270&windspeedmph=10.0&windgustmph=12.0", 4.4704, {}}},
  };
  return kSamples;
}

TEST(TextFormats, ALineOfEachIsRecognisedByImportAndDecodeAndNamesItsDriver) {
  for (const decode::UnitFormat& format : decode::unit_formats()) {
    if (!format.is_text) continue;
    const auto found = samples().find(format.name);
    ASSERT_NE(found, samples().end()) << "a text format without a sample here: " << format.name;
    const Sample& sample = found->second;
    SCOPED_TRACE(sample.line);

    MessageFinder finder({});
    auto message = finder.find(sample.line);
    if (!message) message = finder.finish();
    ASSERT_TRUE(message && message->wind);
    EXPECT_NEAR(message->wind->speed_m_s.value_or(0.0), sample.speed_m_s, 1e-3);

    if (format.name != "line") {  // which any number is
      const auto recognised = decode::recognise(std::vector<std::string>{sample.line});
      ASSERT_FALSE(recognised.empty());
      EXPECT_EQ(recognised.front().format, format.name);
      EXPECT_EQ(recognised.front().winds, 1U);
    }
    EXPECT_EQ(drivers::text::driver_of_line(sample.line).value_or(""), sample.driver);
  }
}

}  // namespace
}  // namespace yuragi::daemon::tools::logs
