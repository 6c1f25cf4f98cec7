#include "daemon/tools/support/redaction.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::support {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Redaction, TakesKnownSecretsOutWhereverTheyStand) {
  const Redaction redaction({"hunter2", "hunter2-long", "a\"b\\c", "xy"});
  EXPECT_EQ(redaction.apply("hunter2-long, hunter2 and xhunter2x"), "(secret), (secret) and x(secret)x");
  EXPECT_EQ(redaction.apply(R"(as it is a"b\c, and escaped a\"b\\c)"), "as it is (secret), and escaped (secret)");
  EXPECT_EQ(redaction.apply("galaxy, xy, oxygen xy"), "galaxy, (secret), oxygen (secret)") << "a short one alone only";
  EXPECT_EQ(Redaction({"", "(secret)"}).apply("nothing is (secret)"), "nothing is (secret)");
}

TEST(Redaction, TakesOutWhatLooksLikeOne) {
  const Redaction redaction({});
  for (const std::string text : {
           "password = \"swordfish\"",
           "password='swordfish'",
           "# old_password = \"swordfish\"",
           "PASSWORD: swordfish",
           "mqtt: passwd=swordfish, next",
           R"({"password": "swordfish"})",
           R"({\"token\": \"swordfish\"})",
           "api_key=swordfish;",
           "wifi psk = swordfish",
           "password = \"\"\"\nswordfish\n\"\"\"\n",
           "secret = '''\nswordfish'''",
           "password = \"a\\\"swordfish\"",
           "mqtt://user:swordfish@broker.lan:1883",
           "http://swordfish@host/path?a=b",
           "password = \"never closed swordfish",
       }) {
    EXPECT_THAT(redaction.apply(text), Not(HasSubstr("swordfish"))) << text;
    EXPECT_THAT(redaction.apply(text), HasSubstr("(secret)")) << text;
    EXPECT_EQ(redaction.apply(redaction.apply(text)), redaction.apply(text)) << text;
  }
}

TEST(Redaction, LeavesEverythingElse) {
  const Redaction redaction({"hunter2"});
  for (const std::string text : {
           "password_file = \"/etc/yuragi/mqtt-password\"",
           "password_env = \"MQTT_PASSWORD\"",
           "password = \"\"",
           "the password was refused",
           "passed: 3",
           "http://host/user@example.org",
           "user = \"garden\"",
           "",
       }) {
    EXPECT_EQ(redaction.apply(text), text);
  }
  EXPECT_EQ(redaction.apply("password = \"a\"\nuser = \"b\"\n"), "password = \"(secret)\"\nuser = \"b\"\n");
}

TEST(KnownSecrets, AreThoseOfTheConfigurationItsFilesAndItsEnvironment) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "password") << "from-the-file\n";
  std::ofstream(folder / "token") << "of-the-browsers\n";
  ASSERT_EQ(setenv("YURAGI_TEST_PASSWORD", "from-the-environment", 1), 0);  // NOLINT(concurrency-mt-unsafe)
  const std::string sensor = "[[sensor]]\ndriver = \"mqtt\"\ntopic = \"a\"\nuser = \"u\"\nname = ";
  const settings::Config config = settings::parse_config(
      sensor + "\"a\"\npassword = \"from-the-text\"\n" + sensor + "\"b\"\npassword_file = \"" +
          (folder / "password").string() + "\"\n" + sensor + "\"c\"\npassword_env = \"YURAGI_TEST_PASSWORD\"\n" +
          sensor + "\"d\"\npassword_file = \"/nonexistent\"\n[http]\ntoken_file = \"" + (folder / "token").string() +
          "\"\n",
      "test.toml");
  EXPECT_THAT(known_secrets(config), testing::UnorderedElementsAre("from-the-text", "from-the-file",
                                                                   "from-the-environment", "of-the-browsers"));
}

}  // namespace
}  // namespace yuragi::daemon::tools::support
