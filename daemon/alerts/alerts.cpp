#include "daemon/alerts/alerts.hpp"

#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/alerts/shell_command.hpp"
#include "daemon/alerts/webhook.hpp"

namespace yuragi::daemon::alerts {
namespace {

constexpr Nanoseconds kMostOfCommand = std::chrono::minutes(1);
constexpr RetryTimes kWebhookRetries{
    .first = std::chrono::seconds(10), .longest = std::chrono::minutes(10), .give_up = std::chrono::hours(24)};

DeliveryQueue::Report report_of(std::string_view way) {
  return [way](std::string_view alert, std::string_view what) { spdlog::warn("alert {}: {}: {}", alert, way, what); };
}

}  // namespace

Alerts::Alerts(const std::vector<settings::AlertConfig>& alerts, std::string host)
    : judge_(alerts),
      commands_(
          [](const AlertNews& news, const std::stop_token& stop) { return run_command(news, kMostOfCommand, stop); },
          report_of("its command"), RetryTimes{}),
      webhooks_([host = std::move(host)](const AlertNews& news,
                                         const std::stop_token& stop) { return post_to_webhook(news, host, stop); },
                report_of("its webhook"), kWebhookRetries) {}

void Alerts::judge(const wire::Sensors& status, std::optional<std::uint64_t> frames, const Instant& now) {
  for (const AlertNews& news : judge_.judge(status, frames, now)) {
    spdlog::warn("alert {}: {}: {}", news.alert, news.has_begun ? "began" : "ended", news.message);
    if (!news.command.empty()) commands_.push(news);
    if (!news.webhook.is_empty()) webhooks_.push(news);
  }
}

}  // namespace yuragi::daemon::alerts
