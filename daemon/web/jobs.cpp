#include "daemon/web/jobs.hpp"

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "engine/base/contain.hpp"

namespace yuragi::daemon::web {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr auto kMaxAtEnd = std::chrono::seconds(2);
constexpr int kFinding = 1;

/// The folder of a job, removed with all that is in it.
class JobFolder {
 public:
  /// `folder`: what an earlier process may have left there is removed; empty: a new one among the temporary files.
  explicit JobFolder(const fs::path& folder) : path_(folder) {
    if (folder.empty()) {
      std::string name = (fs::temp_directory_path() / "yuragi-job-XXXXXX").string();
      if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
      path_ = name;
      return;
    }
    fs::remove_all(folder);
    if (mkdir(folder.c_str(), S_IRWXU) != 0) throw std::system_error(errno, std::generic_category(), folder.string());
  }
  ~JobFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  JobFolder(const JobFolder&) = delete;
  JobFolder& operator=(const JobFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// What has become of an order.
struct Outcome {
  std::string failure, printed;
  std::optional<JobFile> file;
};

JobFile opened(const fs::path& path, const JobOrder& order) {
  auto file = std::make_shared<const platform::Descriptor>(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  struct stat about {};
  if (file->get() < 0 || fstat(file->get(), &about) != 0)
    throw std::system_error(errno, std::generic_category(), "its result cannot be opened");
  return {.file = std::move(file),
          .bytes = static_cast<std::uint64_t>(about.st_size),
          .name = order.result,
          .content_type = order.content_type};
}

Outcome carry_out(const JobOrder& order, const std::stop_token& stop,
                  const std::function<void(const std::string&)>& look) {
  std::vector<std::string> command = order.command;
  std::optional<JobFolder> folder;
  if (!order.result.empty()) {
    folder.emplace(order.folder);
    command.push_back((folder->path() / order.result).string());
  }
  ChildOutput output = run_niced(order.niceness, std::move(command), order.time, stop, order.input, look);
  const bool has_finding = order.is_finding_good && output.end && output.end->shell_code() == kFinding;
  if (std::string failure = failure_of(output); !failure.empty() && !has_finding)
    return {
        .failure = std::move(failure), .printed = order.shows_progress ? output.printed : std::string(), .file = {}};
  if (!folder) return {.failure = {}, .printed = std::move(output.printed), .file = {}};
  return {.failure = {}, .printed = {}, .file = opened(folder->path() / order.result, order)};
}

}  // namespace

struct Jobs::Work {
  struct Kept {
    Job job;
    steady_clock::time_point begun, ended;
  };

  std::stop_source stop{};  ///< of the job that runs, or ran last
  bool has_ended = false;
  mutable std::mutex mutex{};
  std::condition_variable is_done{};
  bool is_running = false;
  std::uint64_t count = 0;
  std::deque<Kept> kept{};  ///< oldest first; the last one may run

  void show(const std::string& printed) {
    const std::lock_guard lock(mutex);
    kept.back().job.printed = printed;
  }

  void finish(Outcome outcome) {
    const std::lock_guard lock(mutex);
    Kept& last = kept.back();
    last.ended = steady_clock::now();
    last.job.state = outcome.failure.empty() ? Job::State::kDone : Job::State::kFailed;
    last.job.message = std::move(outcome.failure);
    last.job.printed = std::move(outcome.printed);
    last.job.file = std::move(outcome.file);
    is_running = false;
    is_done.notify_all();
  }
};

Jobs::Jobs() : work_(std::make_shared<Work>()) {}

Jobs::~Jobs() {
  end();
}

void Jobs::end() {
  std::unique_lock lock(work_->mutex);
  work_->has_ended = true;
  work_->stop.request_stop();
  work_->is_done.wait_for(lock, kMaxAtEnd, [this] { return !work_->is_running; });
}

Result<std::string, Failure> Jobs::start(JobOrder order) {
  std::string id;
  std::stop_token stop;
  {
    const std::lock_guard lock(work_->mutex);
    if (work_->is_running) {
      const Job& running = work_->kept.back().job;
      return Failure{fmt::format("another job is running: {}{}{}; wait until it has ended", running.kind,
                                 running.recording.empty() ? "" : " of ", running.recording),
                     FailureKind::kUnavailable};
    }
    id = std::to_string(++work_->count);
    work_->kept.push_back({.job = {.id = id, .kind = order.kind, .recording = order.recording},
                           .begun = steady_clock::now(),
                           .ended = {}});
    if (work_->kept.size() > kMaxKept) work_->kept.pop_front();
    work_->is_running = true;
    if (!work_->has_ended) work_->stop = std::stop_source();
    stop = work_->stop.get_token();
  }
  try {
    std::thread([work = work_, stop, order = std::move(order)] {
      contain(
          "a job of the page",
          [&] {
            std::function<void(const std::string&)> look;
            if (order.shows_progress) look = [&work](const std::string& printed) { work->show(printed); };
            work->finish(carry_out(order, stop, look));
          },
          [&](const char* what) { work->finish({.failure = what, .printed = {}, .file = {}}); });
    }).detach();
  } catch (const std::exception& error) {  // no thread is to be had
    work_->finish({.failure = error.what(), .printed = {}, .file = {}});
  }
  return {boost::system::in_place_value, id};
}

bool Jobs::cancel(const std::string& id) {
  const std::lock_guard lock(work_->mutex);
  const auto found = std::ranges::find(work_->kept, id, [](const Work::Kept& one) { return one.job.id; });
  if (found == work_->kept.end()) return false;
  if (found->job.state == Job::State::kRunning) work_->stop.request_stop();
  return true;
}

std::optional<Job> Jobs::find(const std::string& id) const {
  const std::lock_guard lock(work_->mutex);
  const auto found = std::ranges::find(work_->kept, id, [](const Work::Kept& one) { return one.job.id; });
  if (found == work_->kept.end()) return std::nullopt;
  Job job = found->job;
  const bool is_running = job.state == Job::State::kRunning;
  job.run_for = (is_running ? steady_clock::now() : found->ended) - found->begun;
  return job;
}

void Jobs::forget_old() {
  const std::lock_guard lock(work_->mutex);
  std::erase_if(work_->kept, [](const Work::Kept& one) {
    return one.job.state != Job::State::kRunning && steady_clock::now() - one.ended > kKeptFor;
  });
}

}  // namespace yuragi::daemon::web
