#include "daemon/alerts/alert_ledger.hpp"

#include <algorithm>
#include <exception>
#include <fstream>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "engine/base/contain.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::alerts {

Ledger::Ledger(std::filesystem::path file)
    : file_(std::move(file)),
      record_(read()),
      thread_([this](const std::stop_token& stop) { contain("keeping alerts on the disk", [&] { work(stop); }); }) {}

Ledger::~Ledger() = default;

Record Ledger::read() const {
  std::error_code error;
  if (!std::filesystem::exists(file_, error) && !error) return {};
  std::string text;
  // Not a pipe, which would keep the daemon waiting.
  if (std::filesystem::is_regular_file(file_, error)) {
    std::ifstream in(file_, std::ios::binary);
    text.resize(kMaxAlertRecord_bytes);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
  }
  const auto record = parse_alert_record(text);
  if (record) return *record;
  spdlog::warn("alerts: {} {}: it is ignored, and overwritten with the next alert", file_.string(),
               record.error().message);
  return {};
}

Record Ledger::record() const {
  const std::lock_guard lock(mutex_);
  return record_;
}

void Ledger::set(std::vector<Active> on, const std::vector<News>& news) {
  const std::lock_guard lock(mutex_);
  if (news.empty() && on == record_.on) return;
  record_.on = std::move(on);
  for (const News& one : news) {
    const News kept{.alert = one.alert, .has_begun = one.has_begun, .message = one.message, .time = one.time};
    if (!one.command.empty()) record_.undelivered.push_back({Channel::kCommand, kept});
    if (!one.webhook.is_empty()) record_.undelivered.push_back({Channel::kWebhook, kept});
  }
  has_changed_ = true;
  changed_.notify_one();
}

void Ledger::settle(Channel way, const News& news) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(record_.undelivered, [&](const UndeliveredNews& one) {
    return one.way == way && one.news.alert == news.alert && one.news.has_begun == news.has_begun &&
           one.news.time == news.time && one.news.message == news.message;
  });
  if (found == record_.undelivered.end()) return;
  record_.undelivered.erase(found);
  has_changed_ = true;
  changed_.notify_one();
}

void Ledger::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  // Also true once after a stop, if something has changed.
  while (changed_.wait(lock, stop, [this] { return has_changed_; })) {
    has_changed_ = false;
    const Record record = record_;
    lock.unlock();
    save(record);
    lock.lock();
  }
}

void Ledger::save(const Record& record) {
  std::string failure;
  const bool is_empty = record.on.empty() && record.undelivered.empty();
  try {
    if (is_empty) {
      std::error_code error;
      if (!std::filesystem::remove(file_, error) && error) failure = file_.string() + ": " + error.message();
    } else if (const auto written = platform::write_whole(file_, text_of(record)); !written) {
      failure = written.error().message;
    }
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (failure.empty()) {
    spdlog::debug("alerts: {} is {}", file_.string(), is_empty ? "removed" : "written");
  } else if (failure != failure_) {
    spdlog::warn("alerts: {}: undelivered alerts would be lost at a restart", failure);
  }
  failure_ = std::move(failure);
}

}  // namespace yuragi::daemon::alerts
