// HTTPS: which certificates of a server are trusted, and what a technician reads of one that is not.
#include <csignal>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tls_server.hpp"

namespace yuragi::drivers::json {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class JsonTls : public testing::Test {
 protected:
  JsonTls() { std::signal(SIGPIPE, SIG_IGN); }

  /// Polls a server with this certificate once, and returns the status. `ca_file`: of the sensor.
  std::string poll(const SelfSignedCertificate& certificate, const std::string& ca_file, const char* host) {
    const TlsServer server(certificate,
                           "HTTP/1.1 200 OK\r\nContent-Length: 18\r\nConnection: close\r\n\r\n{\"wind\": [1, 4.5]}");
    const auto sensor = driver_named("json").open(
        values_for("json", {{"url", Secret(fmt::format("https://{}:{}/?key=hunter2", host, server.port()))},
                            {"speed", std::string("/wind/1")},
                            {"response_timeout", 60.0},
                            {"ca_file", ca_file}}));
    sink_.clear();
    sensor->poll(clock_, sink_);
    sensor->poll(clock_, sink_);
    return sink_.last_detail();
  }
  std::string saved(const SelfSignedCertificate& certificate) {
    const auto file = folder_ / "ca.pem";
    certificate.save(file);
    return file.string();
  }

  test::TemporaryFolder folder_;
  ManualClock clock_;
  RecordingSink sink_;
};

TEST_F(JsonTls, TheCertificateOfAConfiguredCaIsTrusted) {
  const SelfSignedCertificate certificate("IP:127.0.0.1");
  EXPECT_THAT(poll(certificate, saved(certificate), "127.0.0.1"), HasSubstr("server 127.0.0.1:"));
  ASSERT_EQ(sink_.readings.size(), 1U);
  EXPECT_EQ(sink_.readings[0].speed_m_s, 4.5);
}

TEST_F(JsonTls, ASelfSignedCertificateIsNot) {
  const SelfSignedCertificate certificate("IP:127.0.0.1");
  EXPECT_THAT(poll(certificate, "", "127.0.0.1"), AllOf(HasSubstr("the certificate of 127.0.0.1:"),
                                                        HasSubstr("is not trusted (SSL certificate problem: self"),
                                                        HasSubstr("ca_file names a CA of your own")));
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(JsonTls, NeitherIsThatOfAnotherCa) {
  const std::string ca_file = saved(SelfSignedCertificate("IP:127.0.0.1"));
  EXPECT_THAT(poll(SelfSignedCertificate("IP:127.0.0.1"), ca_file, "127.0.0.1"), HasSubstr("is not trusted ("));
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(JsonTls, NorOneForAnotherName) {
  const SelfSignedCertificate certificate("DNS:example.org");
  EXPECT_THAT(poll(certificate, saved(certificate), "127.0.0.1"),
              AllOf(HasSubstr("is not trusted ("), HasSubstr("127.0.0.1")));
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(JsonTls, NorOneThatHasExpired) {
  const SelfSignedCertificate certificate("IP:127.0.0.1", -3600);
  EXPECT_THAT(poll(certificate, saved(certificate), "127.0.0.1"),
              AllOf(HasSubstr("certificate has expired"), HasSubstr("this machine's date")));
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(JsonTls, AFileThatIsMissingIsNamed) {
  EXPECT_THAT(poll(SelfSignedCertificate("IP:127.0.0.1"), "/does/not/exist.pem", "127.0.0.1"),
              HasSubstr("/does/not/exist.pem"));
}

}  // namespace
}  // namespace yuragi::drivers::json
