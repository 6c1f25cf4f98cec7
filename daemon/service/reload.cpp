#include "daemon/service/reload.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "engine/base/count_text.hpp"

namespace yuragi::daemon::service {
namespace {

/// How long the end waits for a file that is being read.
constexpr auto kPatienceAtEnd = std::chrono::milliseconds(500);

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

wire::ReloadReport failure(wire::ReloadOutcome outcome, const std::string& why) {
  return {.outcome = outcome, .mistakes = lines_of(why)};
}

void log(const wire::ReloadReport& report, const std::string& file) {
  if (report.outcome != wire::ReloadOutcome::kDone) {
    for (const std::string& mistake : report.mistakes) spdlog::error("reload: {}", mistake);
    spdlog::error("reload: {}: nothing was changed", file);
    return;
  }
  if (report.applied.empty()) {
    spdlog::info("reload: {}: nothing to apply", file);
  } else {
    spdlog::info("reload: {}: applied {}: {}", file, count_text(report.applied.size(), "change"),
                 fmt::join(report.applied, "; "));
  }
  if (!report.takes_restart.empty()) {
    spdlog::warn("reload: {} a restart: {}",
                 report.takes_restart.size() == 1 ? "this change takes" : "these changes take",
                 fmt::join(report.takes_restart, "; "));
  }
}

}  // namespace

/// One reload, from its request to its result. Its thread uses nothing else.
struct Reload::Task {
  std::function<void(std::function<void()>)> post;
  std::function<settings::Config()> read;
  decltype(ReloadParts::make_scenes) make_scenes;
  std::shared_ptr<const settings::Config> running;

  std::mutex mutex;
  std::condition_variable changed;
  bool is_given_up = false;
  bool has_read = false;  ///< from here on only the processor can take time
  std::thread thread;

  // The result, once `done` was posted.
  wire::ReloadReport report;
  std::optional<settings::ReloadPlan> plan;
  ReloadParts::Adopt adopt;

  void work(const std::function<void()>& done);
  void try_to_work();
  bool was_given_up() {
    const std::lock_guard lock(mutex);
    return is_given_up;
  }
};

void Reload::Task::work(const std::function<void()>& done) {
  try {
    try_to_work();
  } catch (const settings::ConfigError& error) {
    report = failure(wire::ReloadOutcome::kMistake, error.what());
  } catch (const std::exception& error) {
    report = failure(wire::ReloadOutcome::kFailed, error.what());
  }
  const std::lock_guard lock(mutex);
  has_read = true;
  changed.notify_all();
  if (!is_given_up) post(done);  // the daemon still stands: its end takes the same mutex
}

void Reload::Task::try_to_work() {
  const settings::Config wanted = read();
  {
    const std::lock_guard lock(mutex);
    has_read = true;
    changed.notify_all();
    if (is_given_up) return;
  }
  plan = settings::plan_reload(*running, wanted, static_cast<bool>(make_scenes));
  if (plan->changes_scenes) adopt = make_scenes(plan->next, [this] { return was_given_up(); });
  report.applied = plan->applied;
  report.takes_restart = plan->takes_restart;
}

Reload::Reload(const settings::Config& running, ReloadParts parts)
    : parts_(std::move(parts)), running_(std::make_shared<const settings::Config>(running)) {}

Reload::~Reload() {
  if (!task_) return;
  std::unique_lock lock(task_->mutex);
  task_->is_given_up = true;
  const bool has_read = task_->changed.wait_for(lock, kPatienceAtEnd, [this] { return task_->has_read; });
  lock.unlock();
  if (has_read) {
    task_->thread.join();
  } else {
    task_->thread.detach();
  }
}

void Reload::request(const std::string& expected_file, Reply reply) {
  const auto refuse = [&reply](const std::string& why) {
    spdlog::warn("reload: {}", why);
    if (reply) reply(failure(wire::ReloadOutcome::kNoFile, why));
  };
  if (!parts_.read) return refuse("the daemon was started without --config: there is no file to read again");
  if (!expected_file.empty() && expected_file != parts_.file) {
    return refuse("the daemon runs with " + parts_.file + ", not with " + expected_file);
  }
  std::vector<Reply>& asked = task_ ? asked_since_ : asked_;
  if (asked.size() >= kMostWaiting) {
    if (reply) reply(failure(wire::ReloadOutcome::kFailed, "too many ask at once; try again"));
    return;
  }
  if (reply) asked.push_back(std::move(reply));
  is_due_ = true;
  go_on();
}

void Reload::go_on() {
  if (!is_due_ || task_ || (parts_.is_settling && parts_.is_settling())) return;
  is_due_ = false;
  begin();
}

void Reload::begin() {
  task_ = std::make_shared<Task>();
  task_->post = parts_.post;
  task_->read = parts_.read;
  task_->make_scenes = parts_.make_scenes;
  task_->running = running_;
  try {
    task_->thread = std::thread([task = task_, this] { task->work([this] { finish(); }); });
  } catch (const std::system_error& error) {
    task_->report = failure(wire::ReloadOutcome::kFailed, error.what());
    parts_.post([this] { finish(); });
  }
}

void Reload::finish() {
  const std::shared_ptr<Task> task = std::exchange(task_, nullptr);
  if (task->thread.joinable()) task->thread.join();  // it has posted this as the last thing that it did
  if (task->report.outcome == wire::ReloadOutcome::kDone) {
    running_ = std::make_shared<const settings::Config>(task->plan->next);
    if (!task->plan->applied.empty()) parts_.apply(*task->plan);
    if (task->adopt) task->adopt();
  }
  log(task->report, parts_.file);
  for (const Reply& reply : std::exchange(asked_, std::exchange(asked_since_, {}))) reply(task->report);
  go_on();
}

}  // namespace yuragi::daemon::service
