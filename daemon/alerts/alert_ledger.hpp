#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/alerts/alert_news.hpp"
#include "daemon/alerts/alert_record.hpp"

namespace yuragi::daemon::alerts {

/// Keeps in a file which alerts are on and what is undelivered, so that both outlive the process. A thread of its own
/// writes the file whole, or removes it if there is nothing to keep; the caller never waits for the disk. Failures are
/// logged, and cost only the saving. Thread-safe: yes. The constructor reads the file, the destructor writes it.
class Ledger {
 public:
  explicit Ledger(std::filesystem::path file);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  Record record() const;

  /// Sets which alerts are on, and adds the news to the undelivered ones, in one piece.
  void set(std::vector<Active> on, const std::vector<News>& news);

  /// Removes news that was delivered by this way, or will never be.
  void settle(Channel way, const News& news);

 private:
  Record read() const;
  void work(const std::stop_token& stop);
  void save(const Record& record);

  std::filesystem::path file_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Record record_;
  bool has_changed_ = false;
  std::string failure_;  ///< the last, which is logged once; only on the thread
  std::jthread thread_;
};

}  // namespace yuragi::daemon::alerts
