#include "daemon/tools/report/report_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::tools::report {
namespace {

TEST(PageText, HasNoSignThatMeansSomethingInAPage) {
  EXPECT_EQ(page_text("<script>alert(\"1\")</script>&'"),
            "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;&amp;&#39;");
  EXPECT_EQ(page_text("Dach Süd 風 🌬"), "Dach Süd 風 🌬");
}

TEST(PageText, IsAlwaysText) {
  const std::string bad = "\xef\xbf\xbd";
  EXPECT_EQ(page_text(std::string("a\0b\n\x7f", 5)), "a" + bad + "b" + bad + bad);
  EXPECT_EQ(page_text("\xff"), bad);
  EXPECT_EQ(page_text("\xc3"), bad) << "cut off";
  EXPECT_EQ(page_text("\xc0\xaf"), bad + bad) << "longer than needed";
  EXPECT_EQ(page_text("\xed\xa0\x80"), bad + bad + bad) << "half of a pair";
  EXPECT_EQ(page_text("\xf4\x90\x80\x80"), bad + bad + bad + bad) << "beyond the last character";
  EXPECT_EQ(page_text("\xef\xbf\xbf"), bad + bad + bad) << "no character";
  EXPECT_EQ(page_text("\xc2\x85"), bad + bad) << "a control character";
}

TEST(PageText, IsCutWhenItIsVeryLong) {
  EXPECT_EQ(page_text(std::string(5000, 'x')), std::string(200, 'x') + "…");
  EXPECT_EQ(page_text(std::string(200, 'x')), std::string(200, 'x'));
}

TEST(ReportText, SaysTimesAndDirections) {
  EXPECT_EQ(utc_text(UtcTime(std::chrono::seconds(1'532'095'200))), "2018-07-20 14:00:00 UTC");
  EXPECT_EQ(utc_text(UtcTime(std::chrono::seconds(-1))), "1969-12-31 23:59:59 UTC");
  EXPECT_EQ(settings::duration_text(0.1), "0.1 s");
  EXPECT_EQ(settings::duration_text(59.97), "1 min");
  EXPECT_EQ(settings::duration_text(725), "12 min 5 s");
  EXPECT_EQ(settings::duration_text(12'000), "3 h 20 min");
  EXPECT_EQ(settings::duration_text(86'400 + 3'600), "1 day 1 h");
  EXPECT_EQ(settings::duration_text(41 * 86'400), "41 days");
  EXPECT_EQ(compass_text(359.0), "north");
  EXPECT_EQ(compass_text(191.0), "south");
  EXPECT_EQ(compass_text(237.0), "west-south-west");
}

}  // namespace
}  // namespace yuragi::daemon::tools::report
