// HTTPS by real connections to the loopback, with Asio's client. The servers work on threads of their own.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/http/certificate_files.hpp"
#include "daemon/http/server.hpp"
#include "daemon/web/web_server.hpp"
#include "engine/base/address.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/tls_server.hpp"

namespace yuragi::daemon::web {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using http::CertificateFiles;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using namespace std::chrono_literals;

constexpr long kDay_s = 24L * 3600;

tcp::endpoint endpoint_of(const std::string& text) {
  const Address address = parse_address(text).value();
  return {asio::ip::make_address(address.host), address.port};
}

/// A client that has shaken hands; throws if it cannot.
class TlsClient {
 public:
  explicit TlsClient(const std::string& endpoint) {
    stream_.lowest_layer().connect(endpoint_of(endpoint));
    stream_.handshake(asio::ssl::stream_base::client);
  }

  /// The whole answer to a request, after which the server closes.
  std::string get(const std::string& path) {
    asio::write(stream_, asio::buffer("GET " + path + " HTTP/1.0\r\nHost: 127.0.0.1\r\n\r\n"));
    std::string answer;
    boost::system::error_code error;
    asio::read(stream_, asio::dynamic_buffer(answer), error);
    EXPECT_EQ(error, asio::error::eof) << "it ends as TLS has it: " << error.message();
    return answer;
  }
  bool has(const SelfSignedCertificate& certificate) {
    const std::unique_ptr<X509, decltype(&X509_free)> shown(SSL_get1_peer_certificate(stream_.native_handle()),
                                                            &X509_free);
    return X509_cmp(shown.get(), certificate.certificate()) == 0;
  }

 private:
  asio::io_context io_;
  asio::ssl::context context_{asio::ssl::context::tls_client};
  asio::ssl::stream<tcp::socket> stream_{io_, context_};
};

class CertificateFilesTest : public testing::Test {
 protected:
  void save(const SelfSignedCertificate& certificate) const {
    certificate.save(certificate_file_);
    certificate.save_key(key_file_);
  }
  std::string why_not() const {
    try {
      CertificateFiles(certificate_file_, key_file_);
    } catch (const FailureError& error) {
      return error.what();
    }
    return "it can be used";
  }

  test::TemporaryFolder folder_;
  std::filesystem::path certificate_file_ = folder_ / "wall.pem", key_file_ = folder_ / "wall.key";
};

TEST_F(CertificateFilesTest, WhatCannotBeUsedIsNamed) {
  EXPECT_THAT(why_not(), AllOf(HasSubstr("certificate: "), HasSubstr("wall.pem\" does not exist")));
  const SelfSignedCertificate certificate("IP:127.0.0.1");
  certificate.save(certificate_file_);
  EXPECT_THAT(why_not(), AllOf(HasSubstr("key: "), HasSubstr("wall.key\" does not exist")));
  SelfSignedCertificate("IP:127.0.0.1").save_key(key_file_);
  EXPECT_THAT(why_not(), HasSubstr("wall.key\" is not the key of "));
  std::ofstream(key_file_) << "no key";
  EXPECT_THAT(why_not(), HasSubstr("wall.key\" is not a private key"));
  certificate.save_key(certificate_file_);
  EXPECT_THAT(why_not(), HasSubstr("wall.pem\" is not a certificate"));
  save(SelfSignedCertificate("IP:127.0.0.1", -3600));
  EXPECT_THAT(why_not(), HasSubstr("wall.pem\" expired on "));
  save(certificate);
  EXPECT_EQ(why_not(), "it can be used");
}
TEST_F(CertificateFilesTest, TheLastTwoWeeksNeedAttention) {
  save(SelfSignedCertificate("IP:127.0.0.1", 30 * kDay_s));
  const CertificateFiles files(certificate_file_, key_file_);
  const auto now = std::chrono::system_clock::now();
  EXPECT_EQ(files.trouble(now), std::nullopt);
  EXPECT_EQ(files.trouble(now + 15 * 24h), std::nullopt);
  EXPECT_THAT(files.trouble(now + 17 * 24h).value_or(""), HasSubstr("wall.pem\" expires on "));
  EXPECT_THAT(files.trouble(now + 31 * 24h).value_or(""), HasSubstr("wall.pem\" expired on "));
}
TEST_F(CertificateFilesTest, OldVersionsOfTlsAreOff) {
  save(SelfSignedCertificate("IP:127.0.0.1"));
  const auto options = SSL_CTX_get_options(CertificateFiles(certificate_file_, key_file_).context()->native_handle());
  for (const auto off : {SSL_OP_NO_SSLv3, SSL_OP_NO_TLSv1, SSL_OP_NO_TLSv1_1}) EXPECT_NE(options & off, 0U);
  EXPECT_EQ(options & (SSL_OP_NO_TLSv1_2 | SSL_OP_NO_TLSv1_3), 0U);
}

/// The page by TLS.
class TlsTest : public CertificateFilesTest {
 protected:
  TlsTest() {
    save(certificate_);
    server_ = std::make_unique<Server>(Settings{.listen = "127.0.0.1:0",
                                                .certificate = certificate_file_,
                                                .key = key_file_,
                                                .hello = {.software = "yuragi 0.0.0", .tick_rate_hz = 60.0}});
  }

  SelfSignedCertificate certificate_{"IP:127.0.0.1"};
  std::unique_ptr<Server> server_;
};

TEST_F(TlsTest, ThePageIsServed) {
  TlsClient client(server_->local_endpoint());
  EXPECT_TRUE(client.has(certificate_));
  EXPECT_THAT(client.get("/"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("<title>")));
  EXPECT_EQ(server_->address(), "https://" + server_->local_endpoint());
}
TEST_F(TlsTest, AWebSocketIsServed) {
  asio::io_context io;
  asio::ssl::context context(asio::ssl::context::tls_client);
  websocket::stream<asio::ssl::stream<tcp::socket>> socket(io, context);
  socket.next_layer().lowest_layer().connect(endpoint_of(server_->local_endpoint()));
  socket.next_layer().handshake(asio::ssl::stream_base::client);
  socket.handshake("127.0.0.1", "/ws");
  socket.write(asio::buffer(std::string("no wish")));
  boost::beast::flat_buffer message;
  boost::system::error_code error;
  socket.read(message, error);
  EXPECT_EQ(error, websocket::error::closed);
  EXPECT_EQ(socket.reason().code, websocket::close_code::bad_payload);
}
TEST_F(TlsTest, WhoAsksInTheClearIsAnsweredWhatToDo) {
  asio::io_context io;
  tcp::socket socket(io);
  socket.connect(endpoint_of(server_->local_endpoint()));
  asio::write(socket, asio::buffer(std::string("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")));
  std::string answer;
  boost::system::error_code end;
  asio::read(socket, asio::dynamic_buffer(answer), end);
  EXPECT_THAT(answer, AllOf(StartsWith("HTTP/1.1 400 "), HasSubstr("https://")));
}
TEST_F(TlsTest, ARenewedCertificateIsShownToTheNextClient) {
  const SelfSignedCertificate renewed("IP:127.0.0.1", kDay_s);
  std::ofstream(certificate_file_) << "half of a fi";
  server_->renew_certificate();
  const auto hangs = std::chrono::steady_clock::now() + 60s;
  std::string trouble;
  while (trouble.find("is not a certificate") == std::string::npos && std::chrono::steady_clock::now() < hangs)
    trouble = server_->certificate_trouble().value_or("");
  EXPECT_THAT(trouble, HasSubstr("is not a certificate as PEM; the one before is used until "));
  EXPECT_TRUE(TlsClient(server_->local_endpoint()).has(certificate_));
  save(renewed);
  server_->renew_certificate();
  bool is_renewed = false;
  while (!is_renewed && std::chrono::steady_clock::now() < hangs)
    is_renewed = TlsClient(server_->local_endpoint()).has(renewed);
  EXPECT_TRUE(is_renewed);
}
TEST_F(TlsTest, WithoutACertificateThatCanBeUsedNothingIsServed) {
  std::filesystem::remove(key_file_);
  EXPECT_THROW(Server({.listen = "127.0.0.1:0", .certificate = certificate_file_, .key = key_file_}), FailureError);
}

/// A server with limits of the test's choice.
class TlsLimitsTest : public CertificateFilesTest {
 protected:
  void begin(const http::Limits& limits) {
    save(SelfSignedCertificate("IP:127.0.0.1"));
    server_ = std::make_unique<http::Server>(
        io_, "127.0.0.1:0", limits,
        [](const http::Request& request, const auto& reply) {
          reply({.content_type = "text/plain", .body = request.is_https ? "by TLS" : "in the clear"});
        },
        std::make_shared<CertificateFiles>(certificate_file_, key_file_));
    thread_ = std::thread([this] { io_.run(); });
  }
  ~TlsLimitsTest() override {
    io_.stop();
    if (thread_.joinable()) thread_.join();
    server_.reset();
  }

  asio::io_context io_;
  std::unique_ptr<http::Server> server_;
  std::thread thread_;
};

TEST_F(TlsLimitsTest, WhoDoesNotShakeHandsTakesNoPlaceOfThoseWhoAsk) {
  begin({.clients = {.max_clients = 1}, .newcomers = {.max_clients = 3}});
  asio::io_context io;
  tcp::socket silent(io), half(io);
  silent.connect(endpoint_of(server_->local_endpoint()));
  half.connect(endpoint_of(server_->local_endpoint()));
  asio::write(half, asio::buffer(std::string("\x16\x03\x01\x02\x00\x01", 6)));
  EXPECT_THAT(TlsClient(server_->local_endpoint()).get("/"), HasSubstr("by TLS"));
}
TEST_F(TlsLimitsTest, WhoDoesNotShakeHandsInTimeHasToGo) {
  begin({.time = 50ms});
  asio::io_context io;
  tcp::socket silent(io);
  silent.connect(endpoint_of(server_->local_endpoint()));
  char one = 0;
  boost::system::error_code end;
  silent.read_some(asio::buffer(&one, 1), end);
  EXPECT_TRUE(end.failed());
}

}  // namespace
}  // namespace yuragi::daemon::web
