// By libcurl, against a server on the loopback.
#include "daemon/alerts/webhook.hpp"

#include <mutex>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/free_port.hpp"
#include "tests/support/scripted_server.hpp"

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const News kNews{
    .alert = "roof", .has_begun = true, .message = "sensor \"roof\" is stale", .time = UtcTime(1'782'000'000s + 250ms)};

News news_for(const std::string& webhook) {
  News news = kNews;
  news.webhook = Secret(webhook);
  return news;
}

/// A server that gives one answer, and keeps what it was sent.
class WebhookServer {
 public:
  explicit WebhookServer(std::string answer)
      : server_([this, answer](const ScriptedServer::Bytes& bytes) -> std::optional<ScriptedServer::Bytes> {
          const std::lock_guard lock(mutex_);
          request_.append(bytes.begin(), bytes.end());
          if (!request_.ends_with('}')) return ScriptedServer::Bytes();
          return ScriptedServer::Bytes(answer.begin(), answer.end());
        }) {}

  std::string url() const { return "http://127.0.0.1:" + std::to_string(server_.port()) + "/hooks/s3cret"; }
  std::string request() {
    const std::lock_guard lock(mutex_);
    return request_;
  }

 private:
  std::mutex mutex_;
  std::string request_;
  ScriptedServer server_;
};

TEST(Webhook, BodyIsJson) {
  const auto body = nlohmann::json::parse(webhook_body(kNews, "wall-3"));
  EXPECT_EQ(body, nlohmann::json::parse(R"({"alert": "roof", "state": "began", "message": "sensor \"roof\" is stale",
      "host": "wall-3", "time": "2026-06-21T00:00:00Z", "text": "Yuragi on wall-3: sensor \"roof\" is stale"})"));
  News hostile = kNews;
  hostile.has_begun = false;
  hostile.message = "\xff\x01";
  EXPECT_EQ(nlohmann::json::parse(webhook_body(hostile, "wall-3"))["state"], "ended");
}

TEST(Webhook, IsPosted) {
  WebhookServer server("HTTP/1.1 204 No Content\r\n\r\n");
  ASSERT_TRUE(post_to_webhook(news_for(server.url()), "wall-3", {}).has_value());
  const std::string request = server.request();
  EXPECT_THAT(request, StartsWith("POST /hooks/s3cret HTTP/1.1\r\n"));
  EXPECT_THAT(request, HasSubstr("Content-Type: application/json\r\n"));
  EXPECT_THAT(request, testing::EndsWith(webhook_body(kNews, "wall-3")));
}

TEST(Webhook, SaysWhyNotAndHidesItsUrl) {
  WebhookServer server("HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n");
  const auto refused = post_to_webhook(news_for(server.url()), "wall-3", {});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().message, "127.0.0.1 replies with HTTP 404: check the webhook");

  const auto nobody =
      post_to_webhook(news_for("http://127.0.0.1:" + std::to_string(free_port(SOCK_STREAM)) + "/s3cret"), "wall-3", {});
  ASSERT_FALSE(nobody.has_value());
  EXPECT_THAT(nobody.error().message, StartsWith("127.0.0.1 cannot be reached ("));
  EXPECT_THAT(nobody.error().message, Not(HasSubstr("s3cret")));
}

TEST(Webhook, FollowsNobodyElsewhere) {
  WebhookServer server("HTTP/1.1 302 Found\r\nLocation: file:///etc/passwd\r\nContent-Length: 0\r\n\r\n");
  const auto moved = post_to_webhook(news_for(server.url()), "wall-3", {});
  ASSERT_FALSE(moved.has_value());
  EXPECT_THAT(moved.error().message, HasSubstr("HTTP 302"));
}

TEST(Webhook, GivesUpWhenAStopIsRequested) {
  WebhookServer silent("");
  std::stop_source stop;
  std::thread other([&stop] { stop.request_stop(); });
  EXPECT_FALSE(post_to_webhook(news_for(silent.url()), "wall-3", stop.get_token()).has_value());
  other.join();
}

}  // namespace
}  // namespace yuragi::daemon::alerts
