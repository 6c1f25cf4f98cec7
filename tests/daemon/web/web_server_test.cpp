// Real connections to the loopback. The server answers on its own thread; a read waits for what comes, or for the end.
#include "daemon/web/web_server.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/http/server.hpp"
#include "daemon/web/access.hpp"
#include "daemon/web/routes.hpp"
#include "engine/base/address.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

using boost::asio::ip::tcp;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using namespace std::chrono_literals;

/// A client that knows just enough HTTP for these tests.
class Client {
 public:
  explicit Client(const std::string& endpoint) : socket_(io_) {
    const Address address = parse_address(endpoint).value();
    socket_.connect(tcp::endpoint(boost::asio::ip::make_address(address.host), address.port));
  }

  void send(const std::string& bytes) { boost::asio::write(socket_, boost::asio::buffer(bytes)); }
  /// The next answer: its header and its body.
  std::string answer() {
    boost::system::error_code error;
    const std::size_t header = boost::asio::read_until(socket_, boost::asio::dynamic_buffer(said_), "\r\n\r\n", error);
    if (error) return std::exchange(said_, {});
    const std::size_t field = said_.find("Content-Length: ");
    const std::size_t body = field < header ? std::stoul(said_.substr(field + 16)) : 0;
    if (said_.size() < header + body)
      boost::asio::read(socket_, boost::asio::dynamic_buffer(said_),
                        boost::asio::transfer_exactly(header + body - said_.size()), error);
    std::string whole = said_.substr(0, header + body);
    said_.erase(0, header + body);
    return whole;
  }
  std::string get(const std::string& path, const std::string& fields = "") {
    send("GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + fields + "\r\n");
    return answer();
  }
  std::string post(const std::string& path, const std::string& body, const std::string& fields) {
    send("POST " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
         fields + "\r\n" + body);
    return answer();
  }
  /// The first byte behind the last answer.
  char next_byte() {
    if (said_.empty()) boost::asio::read(socket_, boost::asio::dynamic_buffer(said_), boost::asio::transfer_exactly(1));
    return said_.front();
  }
  /// Has the server closed the connection? Waits until it has.
  bool is_closed() {
    char one = 0;
    boost::system::error_code error;
    socket_.read_some(boost::asio::buffer(&one, 1), error);
    return error.failed();
  }

 private:
  boost::asio::io_context io_;
  tcp::socket socket_;
  std::string said_;
};

constexpr const char* kJson = "Content-Type: application/json\r\n";

stream::SharedBytes status_of(const char* sensor) {
  wire::Sensors sensors;
  sensors.sensors.emplace_back().name = sensor;
  sensors.sensors.back().state = wind::judging::SensorState::kLive;
  return std::make_shared<const wire::Bytes>(wire::encode(sensors));
}

class WebServerTest : public testing::Test {
 protected:
  WebServerTest() : server_(settings()) { server_.publish_sensors(status_of("roof"), status_of("roof")); }

  Settings settings() {
    return {.listen = "127.0.0.1:0",
            .hosts = {"roof"},
            .hello = {.software = "yuragi 0.0.0"},
            .ask =
                [this](const wire::Control& control, bool is_local, const auto& reply) {
                  asked_ += control.scene + (is_local ? " from here;" : " from elsewhere;");
                  if (replies_) reply({.done = true, .message = "done", .scenes = {}});
                },
            .patience = replies_ ? Nanoseconds(60s) : Nanoseconds(20ms)};
  }

  bool replies_ = true;
  std::string asked_;  // on the server's thread, before its answer
  Server server_;
};

TEST_F(WebServerTest, AnswersRequestAfterRequestOnOneConnection) {
  Client client(server_.local_endpoint());
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(client.get("/healthz"), StartsWith("HTTP/1.1 200 OK"));
    EXPECT_THAT(client.get("/metrics"), HasSubstr("sensor=\"roof\""));
  }
  EXPECT_THAT(client.get("/healthz", "Connection: close\r\n"), HasSubstr("all is well"));
  EXPECT_TRUE(client.is_closed());
}
TEST_F(WebServerTest, ThePageIsKeptByTheBrowser) {
  Client client(server_.local_endpoint());
  const std::string whole = client.get("/");
  EXPECT_THAT(whole, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(whole, HasSubstr("Cache-Control: no-cache\r\n"));
  const std::size_t tag = whole.find("ETag: ") + 6;
  const std::string again = "If-None-Match: " + whole.substr(tag, whole.find("\r\n", tag) - tag) + "\r\n";
  EXPECT_THAT(client.get("/", again), StartsWith("HTTP/1.1 304 Not Modified"));
  EXPECT_THAT(client.get("/healthz"), StartsWith("HTTP/1.1 200 OK"));
}
TEST_F(WebServerTest, AnUnknownMethodIsRefusedAsSuch) {
  for (const std::string path : {"/", "/healthz", "/api/v1/scenes", "/nowhere"}) {
    for (const std::string method : {"PUT", "BREW", "DELETE", "OPTIONS"}) {
      Client client(server_.local_endpoint());
      client.send(method + " " + path + " HTTP/1.1\r\nHost: roof\r\n\r\n");
      EXPECT_THAT(client.answer(), AllOf(StartsWith("HTTP/1.1 405"), HasSubstr("\r\nAllow: GET"))) << method << path;
    }
  }
}
TEST_F(WebServerTest, TheNewestNewsWin) {
  server_.publish_sensors(status_of("mast"), nullptr);
  EXPECT_THAT(Client(server_.local_endpoint()).get("/api/v1/status"), HasSubstr("\"mast\""));
}
/// Each part of a request with bytes that are no text: an answer, and the next request has one, too.
TEST_F(WebServerTest, BytesThatAreNoTextCostNothingButTheirAnswer) {
  const std::string name = "127.0.0.1";
  for (const std::string bytes : {"\xff", "\x80\xc3", "\xc0\xaf", "\xed\xa0\x80"}) {
    const auto request = [&](const std::string& first_line, const std::string& host, const std::string& fields,
                             const std::string& body = "") {
      return first_line + " HTTP/1.1\r\nHost: " + host + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" +
             fields + "\r\n" + body;
    };
    for (const std::string& sent :
         {request("GET /", bytes, ""), request("GET /" + bytes, name, ""), request("GET /api/v1/" + bytes, name, ""),
          request("GET /api/v1/history?hours=" + bytes, name, ""), request("GE" + bytes + " /", name, ""),
          request("GET /api/v1/status", name, "Cookie: yuragi=" + bytes + "\r\n"),
          request("GET /api/v1/log", name, "Authorization: Bearer " + bytes + "\r\n"),
          request("GET /", name, "If-None-Match: " + bytes + "\r\n"),
          request("POST /api/v1/scenes", name, std::string(kJson) + "Origin: http://" + bytes + "\r\n", "{}"),
          request("POST /api/v1/scenes", name, "Content-Type: " + bytes + "\r\n", "{}"),
          request("POST /api/v1/scenes", name, kJson, bytes),
          request("POST /api/v1/scenes", name, kJson, R"({"scene":")" + bytes + "\"}"),
          request("POST /api/v1/scenes", name, kJson, R"({")" + bytes + "\":1}"),
          request("POST /api/v1/pair", name, kJson, R"({"code":")" + bytes + "\"}")}) {
      Client client(server_.local_endpoint());
      client.send(sent);
      EXPECT_THAT(client.answer(), AllOf(StartsWith("HTTP/1.1 "), Not(StartsWith("HTTP/1.1 500")))) << sent;
    }
  }
  EXPECT_THAT(Client(server_.local_endpoint()).get("/healthz"), StartsWith("HTTP/1.1 200 OK"));
}

TEST(HttpServer, AHandlerThatThrowsCostsItsAnswerAlone) {
  boost::asio::io_context io;
  http::Server server(io, "127.0.0.1:0", {}, [](const http::Request& request, const http::Reply& reply) {
    if (request.path == "/after") reply({.body = "said"});
    if (request.path != "/well") throw std::runtime_error("a secret");
    reply({.body = "well"});
  });
  std::thread thread([&io] { io.run(); });
  Client client(server.local_endpoint());
  EXPECT_THAT(client.get("/before"), AllOf(StartsWith("HTTP/1.1 500"), Not(HasSubstr("a secret"))));
  EXPECT_THAT(client.get("/after"), HasSubstr("said"));
  EXPECT_THAT(client.get("/well"), HasSubstr("well")) << "on the same connection";
  boost::asio::post(io, [&server] { server.close(); });
  thread.join();
}

TEST_F(WebServerTest, NobodyElsesPageSeesOrChangesAnything) {
  Client client(server_.local_endpoint());
  const std::string answer = client.get("/api/v1/status");
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'"));
  EXPECT_THAT(answer, Not(HasSubstr("Access-Control-Allow")));
  client.send("GET /api/v1/status HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_THAT(client.answer(), StartsWith("HTTP/1.1 421"));
  client.send("GET /api/v1/status HTTP/1.0\r\n\r\n");
  EXPECT_THAT(client.answer(), StartsWith("HTTP/1.1 421")) << "no host at all";

  Client other(server_.local_endpoint());
  const std::string body = R"({"scene":"meadow"})";
  EXPECT_THAT(other.post("/api/v1/scenes", body, std::string(kJson) + "Origin: http://evil.example\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(other.post("/api/v1/scenes", body, "Content-Type: text/plain\r\n"), StartsWith("HTTP/1.1 415"));
  EXPECT_EQ(asked_, "");
  EXPECT_THAT(other.post("/api/v1/scenes", body, std::string(kJson) + "Origin: http://127.0.0.1\r\n"),
              StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(asked_, "meadow from here;");
}
/// <img src="http://127.0.0.1:7480/api/v1/configuration"> has no origin, and would start a program here.
TEST_F(WebServerTest, APictureOfAnotherSiteStartsNoWorkAndReadsNothing) {
  Settings shared = settings();
  shared.origins = {"https://editor.p5js.org"};
  Server server(std::move(shared));
  server.publish_sensors(status_of("roof"), status_of("elsewhere"));
  Client client(server.local_endpoint());
  for (const std::string site : {"cross-site", "same-site"}) {
    const std::string other = "Sec-Fetch-Site: " + site + "\r\n";
    for (const Route& route : routes()) {
      const std::string path(route.path);
      if (!path.starts_with("/api/") || route.method != "GET") continue;
      EXPECT_THAT(client.get(path, other), StartsWith("HTTP/1.1 403")) << path;
    }
    EXPECT_THAT(client.post("/api/v1/scenes", R"({"scene":"meadow"})", kJson + other), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(client.get("/api/v1/status", other + "Origin: https://editor.p5js.org\r\n"),
                StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(client.get("/", other), StartsWith("HTTP/1.1 200")) << "a link to the page";
  }
  EXPECT_EQ(asked_, "");
  for (const std::string site : {"same-origin", "none"})
    EXPECT_THAT(client.get("/api/v1/status", "Sec-Fetch-Site: " + site + "\r\n"), StartsWith("HTTP/1.1 200")) << site;
}
TEST_F(WebServerTest, APageOfAListedOriginReadsTheApiAndChangesNothing) {
  Settings shared = settings();
  shared.origins = {"https://editor.p5js.org"};
  shared.log = [](std::size_t) { return std::vector<LogLine>(); };
  Server server(std::move(shared));
  server.publish_sensors(status_of("roof"), status_of("elsewhere"));
  Client client(server.local_endpoint());
  const std::string listed = "Origin: https://editor.p5js.org\r\n";
  const auto is_shared = HasSubstr("\r\nAccess-Control-Allow-Origin: https://editor.p5js.org\r\n");
  const auto varies = HasSubstr("\r\nVary: Origin\r\n");
  EXPECT_THAT(client.get("/api/v1/status", listed), AllOf(is_shared, varies, HasSubstr("\"elsewhere\"")))
      << "as from another machine: files without their folders";
  EXPECT_THAT(client.get("/api/v1/log", listed), AllOf(StartsWith("HTTP/1.1 401"), is_shared));
  EXPECT_THAT(client.get("/healthz", listed), Not(HasSubstr("Access-Control")));
  EXPECT_THAT(client.get("/api/v1/status", "Origin: https://evil.example\r\n"),
              AllOf(varies, Not(HasSubstr("Access-Control"))));
  EXPECT_THAT(client.get("/api/v1/status"), AllOf(varies, Not(HasSubstr("Access-Control")), HasSubstr("\"roof\"")));
  EXPECT_THAT(client.post("/api/v1/scenes", R"({"scene":"meadow"})", kJson + listed),
              AllOf(StartsWith("HTTP/1.1 403"), Not(HasSubstr("Access-Control"))));

  const auto preflight = [&](const std::string& path, const std::string& method, const std::string& origin) {
    client.send("OPTIONS " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + origin +
                "Access-Control-Request-Method: " + method + "\r\n\r\n");
    return client.answer();
  };
  EXPECT_THAT(preflight("/api/v1/status", "GET", listed),
              AllOf(StartsWith("HTTP/1.1 204"), is_shared, varies, HasSubstr("Access-Control-Allow-Methods: GET\r\n")));
  EXPECT_THAT(preflight("/api/v1/scenes", "POST", listed),
              AllOf(StartsWith("HTTP/1.1 405"), Not(HasSubstr("Access-Control"))));
  EXPECT_THAT(preflight("/api/v1/status", "GET", "Origin: https://evil.example\r\n"),
              AllOf(StartsWith("HTTP/1.1 405"), Not(HasSubstr("Access-Control"))));
  EXPECT_EQ(asked_, "");
}
TEST_F(WebServerTest, AFolderOfOwnPages) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "index.html") << "<p>mine";
  Settings own = settings();
  own.folder = folder.path();
  Server server(std::move(own));
  Client client(server.local_endpoint());
  EXPECT_THAT(client.get("/site/"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("<p>mine"),
                                          HasSubstr("script-src 'self'"), Not(HasSubstr("default-src 'none'"))));
  EXPECT_THAT(client.get("/site/../site_test"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(client.post("/site/", "{}", kJson), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(Client(server_.local_endpoint()).get("/site/"), HasSubstr("set [http] folder"));
}
TEST_F(WebServerTest, ARecordingIsForWhoMayChangeSomething_AndIsSentInPieces) {
  const test::TemporaryFolder folder;
  const std::string recorded(3'000'000, 'r');
  const std::string path = "/api/v1/recordings/wall-20261123T000000Z.windlog";
  std::ofstream(folder.path() / "wall-20261123T000000Z.windlog") << recorded;
  Settings recording = settings();
  recording.archive.recording = folder.path() / "wall.windlog";
  Server server(std::move(recording));
  Client client(server.local_endpoint());
  for (int i = 0; i < 2; ++i) {
    const std::string answer = client.get(path);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_TRUE(answer.ends_with("\r\n\r\n" + recorded));
  }
  client.send("HEAD " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(client.answer(), AllOf(HasSubstr("Content-Length: 3000000"), Not(HasSubstr("rrr"))));

  Client elsewhere(server.local_endpoint());
  const std::string forwarded = "X-Forwarded-For: 192.168.1.30\r\n";
  for (const std::string& one :
       {path, std::string("/api/v1/recordings"), std::string("/api/v1/jobs/1"), std::string("/api/v1/configuration")})
    EXPECT_THAT(elsewhere.get(one, forwarded), StartsWith("HTTP/1.1 401")) << one;
  EXPECT_THAT(elsewhere.post(path + "/verify", "{}", kJson + forwarded), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(elsewhere.post(path + "/verify", "{}", "Content-Type: text/plain\r\n"), StartsWith("HTTP/1.1 415"));
  Client(server.local_endpoint()).send("GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");  // and hangs up
  EXPECT_THAT(elsewhere.get("/api/v1/recordings"), HasSubstr("\"bytes\": 3000000"));
}
TEST_F(WebServerTest, WithATokenRightsComeFromItWhateverTheAddress) {
  Settings with_token = settings();
  with_token.takes_token = true;
  with_token.token = Secret("correct horse battery staple");
  Server server(std::move(with_token));
  server.publish_sensors(status_of("roof"), status_of("roof"));
  Client client(server.local_endpoint());
  const std::string body = R"({"scene":"meadow"})";
  for (const std::string& from : {std::string(kJson), std::string(kJson) + "X-Forwarded-For: 192.168.1.30\r\n"}) {
    EXPECT_THAT(client.get("/api/v1/status", from), StartsWith("HTTP/1.1 200")) << "reading needs none";
    EXPECT_THAT(client.post("/api/v1/scenes", body, from), StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(client.post("/api/v1/scenes", body, from + "Authorization: Bearer wrong\r\n"),
                StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(client.post("/api/v1/pair", R"({"code":"0000-0000"})", from), StartsWith("HTTP/1.1 403"));
    EXPECT_EQ(asked_, "");
    EXPECT_THAT(client.post("/api/v1/scenes", body, from + "Authorization: Bearer correct horse battery staple\r\n"),
                StartsWith("HTTP/1.1 200"));
    EXPECT_EQ(std::exchange(asked_, ""), "meadow from here;") << "trusted";
  }
  const std::string metrics = client.get("/metrics");
  EXPECT_THAT(metrics, HasSubstr("yuragi_http_refused_tokens_total 2\n"));
  EXPECT_THAT(metrics, HasSubstr("yuragi_http_pairings_total{result=\"refused\"} 2\n"));
  EXPECT_THAT(metrics, HasSubstr("yuragi_http_changes_total 2\n"));
}
/// A daemon with a token that keeps its pairings in a file.
class PairedBrowserTest : public WebServerTest {
 protected:
  std::unique_ptr<Server> start() {
    Settings with_token = settings();
    with_token.takes_token = true;
    with_token.token = kToken;
    with_token.pairings_file = file_;
    return std::make_unique<Server>(std::move(with_token));
  }
  /// The field of the header by which the browser that was paired is known.
  static std::string cookie_in(const std::string& answer) {
    const std::size_t begin = answer.find("yuragi_session=");
    return "Cookie: " + answer.substr(begin, answer.find(';', begin) - begin) + "\r\n";
  }
  static std::string change(const Server& server, const std::string& fields) {
    return Client(server.local_endpoint()).post("/api/v1/scenes", R"({"scene":"meadow"})", kJson + fields);
  }

  const Secret kToken{"correct horse battery staple"};
  const std::string kBearer = "Authorization: Bearer " + kToken.reveal() + "\r\n";
  const std::string code_ = R"({"code":")" +
                            Access(kToken).pairing_code(seconds(std::chrono::system_clock::now().time_since_epoch())) +
                            "\"}";
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "pairings.json";
};
TEST_F(PairedBrowserTest, ASessionAndAUsedCodeOutliveARestart_AndARevocationDoes) {
  auto server = start();
  const std::string cookie = cookie_in(Client(server->local_endpoint()).post("/api/v1/pair", code_, kJson));
  EXPECT_THAT(change(*server, cookie), StartsWith("HTTP/1.1 200"));

  server.reset();
  server = start();
  EXPECT_THAT(change(*server, cookie), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(Client(server->local_endpoint()).post("/api/v1/pair", code_, kJson), HasSubstr("has been used"));

  Client owner(server->local_endpoint());
  EXPECT_THAT(owner.get("/api/v1/sessions"), StartsWith("HTTP/1.1 401")) << "reading others is free, this is not";
  const std::string list = owner.get("/api/v1/sessions", kBearer);
  const std::string id = list.substr(list.find("\"id\": \"") + 7, Access::kSessionIdCharacters);
  const std::string revoke = R"({"revoke":")" + id + "\"}";
  EXPECT_THAT(owner.post("/api/v1/sessions", revoke, kJson), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(change(*server, cookie), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(owner.post("/api/v1/sessions", revoke, kJson + kBearer), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(owner.post("/api/v1/sessions", revoke, kJson + kBearer), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(change(*server, cookie), StartsWith("HTTP/1.1 401"));

  server.reset();
  server = start();
  EXPECT_THAT(change(*server, cookie), StartsWith("HTTP/1.1 401"));
}
TEST_F(PairedBrowserTest, ARevocationEndsTheWebSocketsOfItsSession) {
  const auto server = start();
  const std::string cookie = cookie_in(Client(server->local_endpoint()).post("/api/v1/pair", code_, kJson));
  const std::string upgrade =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  Client page(server->local_endpoint());
  EXPECT_THAT(page.get("/ws", upgrade + cookie), StartsWith("HTTP/1.1 101"));
  Client owner(server->local_endpoint());
  const std::string list = owner.get("/api/v1/sessions", kBearer);
  const std::string id = list.substr(list.find("\"id\": \"") + 7, Access::kSessionIdCharacters);
  EXPECT_THAT(owner.post("/api/v1/sessions", R"({"revoke":")" + id + "\"}", kJson + kBearer),
              StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(page.next_byte(), '\x88') << "a frame that closes (RFC 6455, 5.5.1)";
}
TEST_F(PairedBrowserTest, ARevocationThatCannotBeSavedHoldsUntilTheRestart_AndIsReported) {
  file_ = folder_.path() / "nowhere" / "pairings.json";
  const auto server = start();
  const std::string cookie = cookie_in(Client(server->local_endpoint()).post("/api/v1/pair", code_, kJson));
  EXPECT_THAT(change(*server, cookie), StartsWith("HTTP/1.1 200"));
  Client owner(server->local_endpoint());
  const std::string list = owner.get("/api/v1/sessions", kBearer);
  const std::string id = list.substr(list.find("\"id\": \"") + 7, Access::kSessionIdCharacters);
  EXPECT_THAT(owner.post("/api/v1/sessions", R"({"revoke":")" + id + "\"}", kJson + kBearer),
              AllOf(StartsWith("HTTP/1.1 500"), HasSubstr("after a restart")));
  EXPECT_THAT(change(*server, cookie), StartsWith("HTTP/1.1 401"));
}
TEST_F(WebServerTest, WithATokenThatCannotBeReadNobodyChangesAnything) {
  Settings locked = settings();
  locked.takes_token = true;
  locked.reading_takes_token = true;
  Server server(std::move(locked));
  server.publish_sensors(status_of("roof"), status_of("roof"));
  Client client(server.local_endpoint());
  EXPECT_THAT(client.get("/healthz"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(client.get("/healthz", "X-Forwarded-For: 192.168.1.30\r\n"), StartsWith("HTTP/1.1 401"));
  for (const char* const path : {"/api/v1/status", "/metrics", "/api/v1/log"})
    EXPECT_THAT(client.get(path), AllOf(StartsWith("HTTP/1.1 401"), HasSubstr("cannot be read"))) << path;
  EXPECT_THAT(client.post("/api/v1/scenes", R"({"scene":"meadow"})", std::string(kJson) + "Authorization: Bearer \r\n"),
              StartsWith("HTTP/1.1 401"));
  EXPECT_EQ(asked_, "");
}
TEST_F(WebServerTest, GarbageAndWhatIsTooLong) {
  const auto said_to = [this](const std::string& bytes) {
    Client client(server_.local_endpoint());
    client.send(bytes);
    return client.answer();
  };
  EXPECT_THAT(said_to("\x16\x03\x01\x02\x01 TLS?\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(said_to("GET /healthz HTTP/1.1\r\nX: " + std::string(20'000, 'a')), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(said_to("POST /api/v1/scenes HTTP/1.1\r\nHost: roof\r\nContent-Length: 9999999\r\n\r\n"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(Client(server_.local_endpoint()).get("/healthz"), StartsWith("HTTP/1.1 200")) << "others notice nothing";
}
TEST_F(WebServerTest, EndsWithItsConnections) {
  Client client(server_.local_endpoint());
  EXPECT_THAT(client.get("/healthz"), StartsWith("HTTP/1.1 200"));
  server_.close();
  EXPECT_TRUE(client.is_closed());
  server_.close();  // again: nothing
}

class SilentDaemonTest : public WebServerTest {
 protected:
  SilentDaemonTest() {
    replies_ = false;
    silent_ = std::make_unique<Server>(settings());
  }
  std::unique_ptr<Server> silent_;
};
TEST_F(SilentDaemonTest, AQuestionIsGivenUp) {
  EXPECT_THAT(Client(silent_->local_endpoint()).get("/api/v1/scenes"), StartsWith("HTTP/1.1 503"));
}

/// A daemon that records: its recording, and its log.
class RecordingDaemonTest : public WebServerTest {
 protected:
  /// What the daemon answers to who asks for `path`.
  std::string answer(const std::string& path, const std::string& fields = "") {
    Settings recording = settings();
    if (history_) recording.history = history_;
    recording.log = [](std::size_t most) {
      return std::vector<LogLine>(std::min<std::size_t>(most, 3), {1.5, "warning", "\xff"});
    };
    const Server server(std::move(recording));
    return Client(server.local_endpoint()).get(path, fields);
  }
  /// Its reading fails so.
  void fails(Failure failure) {
    history_ = [failure = std::move(failure)](unsigned, const auto& reply) { reply(failure); };
  }
  static constexpr const char* kElsewhere = "X-Forwarded-For: 192.0.2.7\r\n";

  std::function<void(unsigned, std::function<void(Result<std::string, Failure>)>)> history_;
};
TEST_F(RecordingDaemonTest, TheHistoryOfSoManyHours) {
  history_ = [](unsigned hours, const auto& reply) {
    reply({boost::system::in_place_value, std::to_string(hours) + " h"});
  };
  EXPECT_THAT(answer("/api/v1/history"), HasSubstr("24 h"));
  EXPECT_THAT(answer("/api/v1/history?hours=168", kElsewhere), HasSubstr("168 h"));
  EXPECT_THAT(answer("/api/v1/history?hours=8784"), HasSubstr("8784 h"));
  for (const char* const query :
       {"?hours=0", "?hours=8785", "?hours=99999999999999999999", "?hours=", "?hours=-1", "?hours=1x", "?days=1"})
    EXPECT_THAT(answer(std::string("/api/v1/history") + query), StartsWith("HTTP/1.1 400")) << query;
}
TEST_F(RecordingDaemonTest, WhyThereIsNoHistory) {
  EXPECT_THAT(answer("/api/v1/history"), AllOf(StartsWith("HTTP/1.1 404"), HasSubstr("[recording] file")));
  fails({"busy", FailureKind::kUnavailable});
  EXPECT_THAT(answer("/api/v1/history"), AllOf(StartsWith("HTTP/1.1 503"), HasSubstr("Retry-After: 5")));
  fails({"/home/anna/a.windlog: is damaged"});
  EXPECT_THAT(answer("/api/v1/history"), AllOf(StartsWith("HTTP/1.1 500"), HasSubstr("anna")));
  EXPECT_THAT(answer("/api/v1/history", kElsewhere), AllOf(StartsWith("HTTP/1.1 500"), Not(HasSubstr("anna"))));
}
TEST_F(RecordingDaemonTest, AReadingThatHangsHoldsUpNobody) {
  replies_ = false;  // nobody waits for long
  history_ = [](unsigned, const auto&) {};
  EXPECT_THAT(answer("/api/v1/history"), AllOf(StartsWith("HTTP/1.1 503"), HasSubstr("Retry-After: 5")));
}
TEST_F(RecordingDaemonTest, TheLogIsForWhoMayChangeSomething) {
  EXPECT_THAT(answer("/api/v1/log"), HasSubstr("\"level\": \"warning\""));
  EXPECT_THAT(answer("/api/v1/log?lines=501"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(answer("/api/v1/log", kElsewhere), StartsWith("HTTP/1.1 401"));
}

/// A server that is turned on a thread of the test's, with limits of the test's choice.
class HttpServerTest : public testing::Test {
 protected:
  void begin(const http::Limits& limits) {
    server_ =
        std::make_unique<http::Server>(io_, "127.0.0.1:0", limits, [](const http::Request& request, const auto& reply) {
          reply({.content_type = "text/plain", .body = request.method + " " + request.path + "?" + request.query});
        });
    endpoint_ = server_->local_endpoint();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~HttpServerTest() override {
    io_.stop();
    if (thread_.joinable()) thread_.join();
    server_.reset();
  }

  boost::asio::io_context io_;
  std::unique_ptr<http::Server> server_;
  std::string endpoint_;
  std::thread thread_;
};

TEST_F(HttpServerTest, PathAndQuery) {
  begin({});
  EXPECT_THAT(Client(endpoint_).get("/a?b=c?d"), HasSubstr("GET /a?b=c?d"));
}
TEST_F(HttpServerTest, WhoIsTooSlowHasToGo) {
  begin({.time = 50ms});
  Client client(endpoint_);
  client.send("GET / HTTP/1.1\r\n");
  EXPECT_TRUE(client.is_closed());
}
TEST_F(HttpServerTest, PlacesAreBounded_AndComeBack) {
  begin({.clients = {.max_clients = 2}});
  auto one = std::make_unique<Client>(endpoint_);
  auto two = std::make_unique<Client>(endpoint_);
  EXPECT_THAT(one->get("/"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(two->get("/"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(Client(endpoint_).get("/"), AllOf(StartsWith("HTTP/1.1 503"), HasSubstr("Retry-After: 10")));
  one.reset();
  std::string answer;
  for (const auto hangs = std::chrono::steady_clock::now() + 60s;
       !answer.starts_with("HTTP/1.1 200") && std::chrono::steady_clock::now() < hangs;) {
    Client next(endpoint_);
    try {
      answer = next.get("/");
    } catch (const boost::system::system_error&) {
      // refused while it was still speaking
    }
  }
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
}
TEST_F(HttpServerTest, WhoAsksForNothingTakesNoPlaceOfThoseWhoAsk) {
  begin({.clients = {.max_clients = 1}, .newcomers = {.max_clients = 3}});
  const Client silent(endpoint_);
  const Client silent_too(endpoint_);
  EXPECT_THAT(Client(endpoint_).get("/"), StartsWith("HTTP/1.1 200"));
}
TEST_F(HttpServerTest, ThoseWhoAskForNothingAreBounded) {
  begin({.newcomers = {.max_clients = 2}});
  const Client silent(endpoint_);
  const Client silent_too(endpoint_);
  EXPECT_THAT(Client(endpoint_).answer(), StartsWith("HTTP/1.1 503"));
}

}  // namespace
}  // namespace yuragi::daemon::web
