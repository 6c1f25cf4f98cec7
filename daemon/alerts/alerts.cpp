#include "daemon/alerts/alerts.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <system_error>

#include <spdlog/spdlog.h>

#include "daemon/alerts/shell_command.hpp"
#include "daemon/alerts/webhook.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::alerts {
namespace {

constexpr Nanoseconds kMaxCommand = std::chrono::minutes(1);
constexpr RetryTimes kWebhookRetries{
    .first = std::chrono::seconds(10), .longest = std::chrono::minutes(10), .give_up = std::chrono::hours(24)};
/// The log cuts longer lines.
constexpr std::size_t kMaxLoggedAtOnce_bytes = 3000;

void log_output(std::string_view alert, std::string_view output) {
  const bool is_cut = output.size() == kMaxCommandOutput_bytes;
  while (!output.empty()) {
    // Whole lines, as many as the log takes at once.
    std::string_view part = output.substr(0, kMaxLoggedAtOnce_bytes);
    if (const auto line_end = part.rfind('\n'); line_end != part.npos) part = part.substr(0, line_end + 1);
    output.remove_prefix(part.size());
    if (part.ends_with('\n')) part.remove_suffix(1);

    std::string text;
    while (true) {
      const std::size_t line_end = part.find('\n');
      std::string line(part.substr(0, line_end));
      make_printable(line);
      text += line;
      if (line_end == part.npos) break;
      text += '\n';
      part.remove_prefix(line_end + 1);
    }
    spdlog::info("alert {}: its command: {}", alert, text);
  }
  if (is_cut)
    spdlog::warn("alert {}: the output of its command is cut at {} KiB", alert, kMaxCommandOutput_bytes / 1024);
}

Result<void, Failure> run_and_log(const News& news, const std::stop_token& stop) {
  std::string output;
  auto result = run_command(news, kMaxCommand, stop, output);
  log_output(news.alert, output);
  return result;
}

const settings::AlertConfig* find(const std::vector<settings::AlertConfig>& alerts, std::string_view name) {
  const auto found = std::ranges::find(alerts, name, &settings::AlertConfig::name);
  return found != alerts.end() ? &*found : nullptr;
}

}  // namespace

Alerts::Alerts(const std::vector<settings::AlertConfig>& alerts, std::string host,
               const std::filesystem::path& record_file, const Instant& now)
    : judge_(alerts), host_(std::move(host)) {
  if (record_file.empty()) return;
  ledger_.emplace(record_file);
  resume(alerts, now);
}

Alerts::~Alerts() {
  // All at once: each may need a moment to stop its work.
  for (auto& [key, queue] : queues_) queue.request_stop();
}

void Alerts::resume(const std::vector<settings::AlertConfig>& alerts, const Instant& now) {
  const Record record = ledger_->record();
  judge_.resume(record.on, now);
  for (const auto& [way, news] : record.undelivered) {
    const settings::AlertConfig* const config = find(alerts, news.alert);
    const bool is_command = way == Channel::kCommand;
    if (config == nullptr || (is_command ? config->command.empty() : config->webhook.is_empty())) {
      spdlog::warn("alert {}: not sent, because the configuration no longer has it: {}", news.alert, news.message);
      ledger_->settle(way, news);
      continue;
    }
    News again = news;
    again.command = config->command;
    again.webhook = config->webhook;
    push(way, again);
  }
}

void Alerts::change(const std::vector<settings::AlertConfig>& alerts) {
  judge_.change(alerts);
  std::erase_if(
      queues_, [&](const auto& queue) { return find(alerts, queue.first.first) == nullptr && queue.second.is_idle(); });
}

void Alerts::judge(const wire::Sensors& status, std::optional<std::uint64_t> frames, const Instant& now) {
  const std::vector<News> all = judge_.judge(status, frames, now);
  if (ledger_) ledger_->set(judge_.on(), all);
  for (const News& news : all) {
    spdlog::warn("alert {}: {}: {}", news.alert, news.has_begun ? "began" : "ended", news.message);
    if (!news.command.empty()) push(Channel::kCommand, news);
    if (!news.webhook.is_empty()) push(Channel::kWebhook, news);
  }
}

void Alerts::push(Channel way, const News& news) {
  const bool is_command = way == Channel::kCommand;
  const auto report = [is_command](std::string_view alert, std::string_view what) {
    spdlog::warn("alert {}: {}: {}", alert, is_command ? "its command" : "its webhook", what);
  };
  const auto settle = [this, way](const News& settled) {
    if (ledger_) ledger_->settle(way, settled);
  };
  const auto deliver = [this, is_command](const News& one, const std::stop_token& stop) {
    return is_command ? run_and_log(one, stop) : post_to_webhook(one, host_, stop);
  };
  try {
    const auto queue = queues_
                           .try_emplace({news.alert, way}, DeliveryQueue::Calls{deliver, report, settle},
                                        is_command ? RetryTimes{} : kWebhookRetries)
                           .first;
    queue->second.push(news);
  } catch (const std::system_error& error) {
    report(news.alert, std::string("not sent, because no thread can be started: ") + error.what());
    settle(news);
  }
}

}  // namespace yuragi::daemon::alerts
