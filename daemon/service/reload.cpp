#include "daemon/service/reload.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "engine/base/contain.hpp"
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
  for (const std::string& warning : report.mistakes) spdlog::warn("reload: {}", warning);
  if (!report.takes_restart.empty()) {
    spdlog::warn("reload: {} a restart: {}",
                 report.takes_restart.size() == 1 ? "this change needs" : "these changes need",
                 fmt::join(report.takes_restart, "; "));
  }
}

}  // namespace

/// One reload, from its request to its result. Its thread uses only this.
struct Reload::Task {
  std::function<void(std::function<void()>)> post;
  std::function<settings::Config()> read;
  decltype(ReloadParts::rehearse) rehearse;
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
  if (!is_given_up) post(done);  // the daemon still exists: its end takes the same mutex
}

void Reload::Task::try_to_work() {
  const settings::Config wanted = read();
  if (rehearse) contain("trying the next start", [&] { report.mistakes = rehearse(*running, wanted); });
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
    : parts_(std::move(parts)), running_(std::make_shared<const settings::Config>(running)), configured_(running_) {}

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
  if (!takes_another_reply()) {
    if (reply) reply(failure(wire::ReloadOutcome::kFailed, "too many requests at once; try again"));
    return;
  }
  Due& due = due_file();
  if (reply) due.asked.push_back(std::move(reply));
  go_on();
}

std::optional<std::string> Reload::mistake_in(const std::vector<settings::ParameterEdit>& edits) const {
  const bool has_scene = std::ranges::any_of(edits, [](const auto& edit) { return !edit.scene.empty(); });
  if (has_scene && !parts_.make_scenes) return "this daemon has no scenes";
  const auto next = settings::edited(*running_, *configured_, edits);
  if (next) return std::nullopt;
  return next.error().name + ": " + next.error().message;
}

void Reload::set(const std::vector<settings::ParameterEdit>& edits, Reply reply) {
  auto why = mistake_in(edits);
  if (!why && !takes_another_reply()) why = "too many requests at once; try again";
  if (why) {
    if (reply) reply(failure(wire::ReloadOutcome::kMistake, *why));
    return;
  }
  Due& due = due_edits(Due{.edits = edits}.is_of_look_alone());
  for (const settings::ParameterEdit& edit : edits) {
    // The last one counts.
    std::erase_if(due.edits, [&edit](const auto& one) { return one.scene == edit.scene && one.key == edit.key; });
    due.edits.push_back(edit);
  }
  if (reply) due.asked.push_back(std::move(reply));
  go_on();
}

bool Reload::is_under_way() const noexcept {
  return (task_ && present_.reads_file) || std::ranges::any_of(due_, &Due::reads_file);
}

bool Reload::Due::is_of_look_alone() const {
  return !reads_file && std::ranges::all_of(edits, [](const auto& edit) { return edit.scene.empty(); });
}

bool Reload::takes_another_reply() const {
  std::size_t waiting = 0;
  for (const Due& due : due_) waiting += due.asked.size();
  return waiting < kMaxWaiting;
}

Reload::Due& Reload::due_file() {
  if (due_.empty() || !due_.back().reads_file) due_.push_back({.reads_file = true});
  return due_.back();
}

/// Behind the last reading of the file, which would undo them: first those of [look], then those of scenes.
Reload::Due& Reload::due_edits(bool is_of_look_alone) {
  const auto last_file = std::find_if(due_.rbegin(), due_.rend(), [](const Due& due) { return due.reads_file; });
  const auto begin = last_file.base();
  const auto found =
      std::find_if(begin, due_.end(), [&](const Due& due) { return due.is_of_look_alone() == is_of_look_alone; });
  if (found != due_.end()) return *found;
  return *due_.insert(is_of_look_alone ? begin : due_.end(), Due{});
}

void Reload::go_on() {
  if (due_.empty() || task_) return;
  const bool is_settling = parts_.is_settling && parts_.is_settling();
  if (is_settling && !due_.front().is_of_look_alone()) return;
  present_ = std::move(due_.front());
  due_.pop_front();
  begin();
}

void Reload::begin() {
  task_ = std::make_shared<Task>();
  task_->post = parts_.post;
  task_->read = parts_.read;
  task_->make_scenes = parts_.make_scenes;
  task_->running = running_;
  seen_at_.reset();
  if (present_.reads_file) {
    task_->rehearse = parts_.rehearse;
  } else {
    task_->read = [running = running_, configured = configured_, edits = present_.edits] {
      auto next = settings::edited(*running, *configured, edits);
      if (!next) throw settings::ConfigError(next.error().name + ": " + next.error().message);
      return std::move(*next);
    };
  }
  std::erase_if(left_behind_, [](const auto& task) { return task.expired(); });
  if (present_.reads_file && left_behind_.size() >= kMaxLeftBehind) {
    task_->report = failure(wire::ReloadOutcome::kFailed,
                            fmt::format("{}: {} earlier attempts to read it have not returned; repair its disk or "
                                        "network share, or restart the daemon",
                                        parts_.file, left_behind_.size()));
    return parts_.post([this] { finish(); });
  }
  try {
    task_->thread = std::thread([task = task_, this] {
      contain("reading the configuration again", [&] { task->work([this] { finish(); }); });
    });
  } catch (const std::system_error& error) {
    task_->report = failure(wire::ReloadOutcome::kFailed, error.what());
    parts_.post([this] { finish(); });
  }
}

void Reload::finish() {
  const std::shared_ptr<Task> task = std::exchange(task_, nullptr);
  if (task->thread.joinable()) task->thread.join();  // it has posted this as the last thing that it did
  const Due done = std::exchange(present_, {});
  if (task->report.outcome == wire::ReloadOutcome::kDone) {
    running_ = std::make_shared<const settings::Config>(task->plan->next);
    if (done.reads_file) configured_ = running_;
    const auto& apply = done.reads_file ? parts_.apply : parts_.apply_edits;
    if (apply && !task->plan->applied.empty()) apply(*task->plan);
    if (task->adopt) task->adopt();
  }
  answer(done, task->report);
}

/// Then begins the next task.
void Reload::answer(const Due& done, const wire::ReloadReport& report) {
  if (done.reads_file) log(report, parts_.file);
  for (const Reply& reply : done.asked) reply(report);
  go_on();
}

void Reload::give_up_late(MonoTime now) {
  if (!task_ || !present_.reads_file) return;
  if (!seen_at_) seen_at_ = now;
  if (now - *seen_at_ < kMaxRead) return;
  {
    const std::lock_guard lock(task_->mutex);
    if (task_->has_read || !task_->thread.joinable()) return;  // it posts finish(), or has done so
    task_->is_given_up = true;
  }
  task_->thread.detach();
  left_behind_.push_back(std::exchange(task_, nullptr));
  answer(std::exchange(present_, {}),
         failure(wire::ReloadOutcome::kFailed,
                 fmt::format("{}: was not read within {:.0f} s; check its disk or network share, and the files that "
                             "it names, then reload again",
                             parts_.file, seconds(kMaxRead))));
}

}  // namespace yuragi::daemon::service
