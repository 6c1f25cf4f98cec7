#include "engine/base/duration.hpp"

#include <gtest/gtest.h>

namespace yuragi {
namespace {

TEST(Duration, IsANumberOfSecondsOrANumberWithAUnit) {
  EXPECT_EQ(parse_duration_s("90").value(), 90.0);
  EXPECT_EQ(parse_duration_s("0.5").value(), 0.5);
  EXPECT_EQ(parse_duration_s("90s").value(), 90.0);
  EXPECT_EQ(parse_duration_s("500ms").value(), 0.5);
  EXPECT_EQ(parse_duration_s("5min").value(), 300.0);
  EXPECT_EQ(parse_duration_s("5 min").value(), 300.0);
  EXPECT_EQ(parse_duration_s("1.5h").value(), 5400.0);
  EXPECT_EQ(parse_duration_s("2d").value(), 172'800.0);
}

TEST(Duration, OfAnyOtherFormIsRefusedWithWhatIsAllowed) {
  for (const char* text :
       {"", "soon", "min", "-5", "-5min", "5 moons", "5min3", "nan", "inf", "1e400", "1e308d", "+5"}) {
    const auto duration = parse_duration_s(text);
    ASSERT_FALSE(duration) << text;
    EXPECT_EQ(duration.error().kind, FailureKind::kUsage);
    EXPECT_NE(duration.error().message.find("5min"), std::string::npos) << duration.error().message;
  }
}

TEST(Duration, BecomesANumberForAParserOfOptions) {
  std::string text = "2h";
  EXPECT_EQ(duration_to_seconds(text), "");
  EXPECT_EQ(text, "7200");
  text = "tomorrow";
  EXPECT_NE(duration_to_seconds(text), "");
  EXPECT_EQ(text, "tomorrow");
}

}  // namespace
}  // namespace yuragi
