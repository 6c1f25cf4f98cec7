#include "daemon/tools/support/support_bundle.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::support {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kPlaced = {"inline-horse",  "file-battery",  "environment-staple", "comment-correct",
                                          "log-tangerine", "url-persimmon", "table-quince"};

/// An installation with a secret in every place.
class SupportBundle : public testing::Test {
 protected:
  SupportBundle() {
    std::ofstream(folder_ / "password") << "file-battery\n";
    setenv("YURAGI_TEST_BUNDLE", "environment-staple", 1);  // NOLINT(concurrency-mt-unsafe)
    const std::string mqtt = "[[sensor]]\ndriver = \"mqtt\"\ntopic = \"a\"\nuser = \"u\"\nname = ";
    config_text_ = "# password = \"comment-correct\"\n[recording]\nfile = \"" + (folder_ / "wall.windlog").string() +
                   "\"\n" + mqtt + "\"one\"\npassword = \"inline-horse\"\n" + mqtt + "\"two\"\npassword_file = \"" +
                   (folder_ / "password").string() + "\"\n" + mqtt +
                   "\"three\"\npassword_env = \"YURAGI_TEST_BUNDLE\"\n";
    write_config(config_text_);
    auto writer = drivers::windlog::Writer::open(folder_ / "wall.windlog");
    EXPECT_TRUE(writer->begin_session(
        {test::at_ms(0, test::kSampleUtc_ms), "yuragi test", "[[sensor]]\npassword = \"inline-horse\"\n"}));
    const auto sensor = writer->add_sensor("one", "mqtt", "password = 'inline-horse'");
    for (int i = 0; i < 10; ++i) {
      wind::Reading reading;
      reading.time = test::at_ms(1000 * i, test::kSampleUtc_ms);
      reading.speed_m_s = 4.25;
      EXPECT_TRUE(writer->append(*sensor, reading));
    }
  }

  void write_config(const std::string& text) const { std::ofstream(folder_ / "wall.toml") << text; }

  BundleRequest request() const {
    BundleRequest request;
    request.examination.config_file = folder_ / "wall.toml";
    request.examination.config = settings::parse_config(config_text_, "wall.toml");
    sensors::DaemonStatus status;
    status.software = "yuragi 9";
    status.sensors.sensors.resize(1);
    status.sensors.sensors[0].state_reason = "the broker refuses inline-horse";
    request.examination.daemon = status;
    request.findings = {{doctor::Verdict::kError, "sensor", "refused file-battery", "try environment-staple"}};
    request.with_readings = true;
    request.run = [](const std::vector<std::string>& command) -> std::optional<doctor::ProgramOutput> {
      if (command.front() == "lsusb") return std::nullopt;
      return doctor::ProgramOutput{command.front() +
                                       " says: connecting to mqtt://u:url-persimmon@lan with inline-horse, "
                                       "password=log-tangerine\n",
                                   0};
    };
    return request;
  }

  test::TemporaryFolder folder_;
  std::string config_text_;
};

void expect_no_secret(const std::map<std::string, std::string>& files) {
  for (const auto& [name, text] : files) {
    for (const std::string& secret : kPlaced) EXPECT_THAT(text, Not(HasSubstr(secret))) << name;
  }
}

TEST_F(SupportBundle, HoldsEverythingButSecrets) {
  const auto files = bundle_files(request());
  expect_no_secret(files);
  EXPECT_THAT(files.at("configuration.toml"), HasSubstr("password = \"(secret)\""));
  EXPECT_THAT(files.at("configuration.toml"), HasSubstr("password_file = "));
  EXPECT_THAT(files.at("configuration-full.toml"), HasSubstr("max_clients = 32"));
  EXPECT_THAT(files.at("doctor.txt"), HasSubstr("refused (secret)"));
  EXPECT_THAT(files.at("status.json"), HasSubstr("the broker refuses (secret)"));
  EXPECT_THAT(files.at("journal-yuragi.txt"), HasSubstr("journalctl says: connecting to mqtt://(secret)@lan"));
  EXPECT_THAT(files.at("recording.txt"), HasSubstr("sensor one (mqtt): 10 readings"));
  EXPECT_THAT(files.at("recording.txt"), HasSubstr("yuragi test"));
  EXPECT_THAT(files.at("recording-last-hour.csv"), HasSubstr("4.25"));
  EXPECT_EQ(files.count("usb.txt"), 0U) << "lsusb is not installed";
  EXPECT_EQ(files.count("host-name.txt"), 0U);
  EXPECT_THAT(files.at("os-release.txt"), HasSubstr("NAME="));
}

TEST_F(SupportBundle, OfABrokenConfigurationHasItsErrorsButNoSecrets) {
  BundleRequest broken = request();
  broken.examination.config.reset();
  broken.examination.daemon.reset();
  broken.findings.clear();
  broken.run = [](const std::vector<std::string>&) { return std::nullopt; };
  broken.examination.config_error = "wall.toml:1:1: wrong";
  write_config("[strange]\nthing = 1\npassword = '''\ntable-quince'''\n");
  auto files = bundle_files(broken);
  expect_no_secret(files);
  EXPECT_THAT(files.at("configuration.toml"), HasSubstr("thing = 1"));
  EXPECT_EQ(files.at("configuration-errors.txt"), "wall.toml:1:1: wrong\n");
  EXPECT_EQ(files.at("status.txt"), "no daemon replies\n");
  write_config("password \"\ninline-horse");
  files = bundle_files(broken);
  expect_no_secret(files);
  EXPECT_THAT(files.at("configuration.toml"), HasSubstr("Left out"));
}

TEST_F(SupportBundle, IsPackedForItsOwnerAndGroup) {
  const std::string archive = folder_ / "bundle.tar.gz";
  ASSERT_TRUE(pack({{"a.txt", "some text\n"}}, "yuragi-support", archive));
  struct stat status {};
  ASSERT_EQ(stat(archive.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
  EXPECT_EQ(doctor::program_output({"tar", "-xzOf", archive, "yuragi-support/a.txt"}, 60s)->text, "some text\n");
  EXPECT_FALSE(pack({}, "yuragi-support", archive)) << "it is there already";
  EXPECT_FALSE(pack({}, "yuragi-support", "/nonexistent/bundle.tar.gz"));
}

TEST(RecordingHead, SaysWhyItCannotBeRead) {
  BundleRequest request;
  request.examination.config = settings::parse_config("[recording]\nfile = \"/nonexistent/a.windlog\"\n", "a.toml");
  request.run = [](const std::vector<std::string>&) { return std::nullopt; };
  EXPECT_THAT(bundle_files(request).at("recording.txt"), HasSubstr("/nonexistent/a.windlog: No such file"));
}

}  // namespace
}  // namespace yuragi::daemon::tools::support
