#include "daemon/settings/withhold_secrets.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::settings {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(WithholdSecrets, ReplacesThePasswordOfASensorAndNothingElse) {
  const std::string before =
      "\xEF\xBB\xBF# a wall \xE2\x80\x94 hunter2 is no secret here\r\nseed = 1\r\n[[sensor]]\r\n"
      "name = 'hunter2'\r\n  password\t= 'hunter2'   # in the garden\r\ndriver = 'mqtt'\r\nuser = 'garden'\r\n"
      "[sensor.calibration]\r\ngain = 1.04\r\n[[sensor]]\r\npassword = '''\r\nhunter\r\n2'''\r\ndriver = \"mqtt\"\r\n";
  const std::string after =
      "\xEF\xBB\xBF# a wall \xE2\x80\x94 hunter2 is no secret here\r\nseed = 1\r\n[[sensor]]\r\n"
      "name = 'hunter2'\r\n  password\t= \"(secret)\"   # in the garden\r\ndriver = 'mqtt'\r\nuser = 'garden'\r\n"
      "[sensor.calibration]\r\ngain = 1.04\r\n[[sensor]]\r\npassword = \"(secret)\"\r\ndriver = \"mqtt\"\r\n";
  const auto withheld = withhold_in_configuration(before);
  ASSERT_TRUE(withheld);
  EXPECT_EQ(withheld->text, after);
  EXPECT_EQ(withheld->secrets, 2U);
  const auto again = withhold_in_configuration(withheld->text);
  EXPECT_EQ(again->text, after);
  EXPECT_EQ(again->secrets, 0U);
}

TEST(WithholdSecrets, FindsThemHoweverTheTableIsWritten) {
  const auto inline_tables =
      withhold_in_configuration("sensor = [{ driver = 'mqtt', password = \"hu\\u006eter2\", tls = true }]\n");
  EXPECT_EQ(inline_tables->text, "sensor = [{ driver = 'mqtt', password = \"(secret)\", tls = true }]\n");
  const auto quoted = withhold_in_configuration("[[sensor]]\ndriver = 'mqtt'\n\"pass\\u0077ord\" = 'hunter2'");
  EXPECT_EQ(quoted->text, "[[sensor]]\ndriver = 'mqtt'\n\"pass\\u0077ord\" = \"(secret)\"");
  for (const char* odd : {"password = 271828", "password = [ 'hunter2' ]", "password = { a = 'hunter2' }",
                          "password.a = 'hunter2'", "[sensor.password]\na = 'hunter2'", "password = 1e300"}) {
    const auto withheld =
        withhold_in_configuration(std::string("[[sensor]]\ndriver = 'mqtt'\nuser = 'a'\n") + odd + "\n");
    ASSERT_TRUE(withheld) << odd;
    EXPECT_EQ(withheld->secrets, 1U) << odd;
    EXPECT_THAT(withheld->text, Not(testing::ContainsRegex("hunter2|271828|1e"))) << odd;
    EXPECT_THAT(withheld->text, HasSubstr("(secret)")) << odd;
    EXPECT_EQ(withhold_in_configuration(withheld->text)->secrets, 0U) << odd;
  }
}

TEST(WithholdSecrets, AnAlertsCommandAndWebhookAreSecrets) {
  const auto withheld = withhold_in_configuration(
      "[[alert]]\nname = 'storm'\ncommand = 'curl -u anna:hunter2 https://example.org'\nafter = 1\n"
      "[[alert]]\nname = 'b'\nwebhook = 'https://example.org/hunter2'\n");
  EXPECT_EQ(withheld->text,
            "[[alert]]\nname = 'storm'\ncommand = \"(secret)\"\nafter = 1\n"
            "[[alert]]\nname = 'b'\nwebhook = \"(secret)\"\n");
  EXPECT_EQ(withheld->secrets, 2U);
}

TEST(WithholdSecrets, KnowsWhichDriversHaveThem) {
  EXPECT_EQ(withhold_in_options("password = 'hunter2'\nuser = 'garden'", "mqtt")->text,
            "password = \"(secret)\"\nuser = 'garden'");
  EXPECT_EQ(withhold_in_options("station_key = 'hunter2'", "ecowitt-push")->text, "station_key = \"(secret)\"");
  EXPECT_EQ(withhold_in_options("password = 'hunter2'", "synthetic")->secrets, 0U) << "it has no such key";
  EXPECT_EQ(withhold_in_options("password = 'hunter2'", "of a later version")->secrets, 1U);
  EXPECT_EQ(withhold_in_options("password = ''", "mqtt")->secrets, 0U) << "there is none";
  EXPECT_EQ(withhold_in_options("", "mqtt")->text, "");
  for (const char* text :
       {"", "sensor = 3", "sensor = [1, 2]", "[[sensor]]\ndriver = 3\n", "[sensor]\npassword = 'x'\n"}) {
    EXPECT_EQ(withhold_in_configuration(text)->text, text);
  }
}

TEST(WithholdSecrets, SaysThatATextIsNoToml) {
  const auto withheld = withhold_in_options("password = hunter2", "mqtt");
  ASSERT_TRUE(withheld.has_error());
  EXPECT_THAT(withheld.error().message, Not(HasSubstr("hunter2")));
  EXPECT_TRUE(withhold_in_configuration("= hunter2").has_error());
}

}  // namespace
}  // namespace yuragi::daemon::settings
