#include "daemon/history/history_reader.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <sys/resource.h>

#include "engine/base/contain.hpp"

namespace yuragi::daemon::history {
namespace {

using std::chrono::steady_clock;

constexpr int kMinPriority = 19;
constexpr auto kMaxAtEnd = std::chrono::seconds(2);

struct Kept {
  unsigned hours = 0;
  std::string text;
  steady_clock::time_point read_at;
};

}  // namespace

struct Reader::Work {
  Read read;
  Nanoseconds kept_for{0};
  std::stop_source stop{};

  std::mutex mutex{};
  std::condition_variable is_done{};
  bool is_reading = false;
  std::optional<Kept> kept{};

  Result<std::string, Failure> carry_out(unsigned hours) const noexcept {
    try {
      return read(hours, stop.get_token());
    } catch (const std::exception& error) {
      return Failure{error.what()};
    }
  }
  void finish(unsigned hours, const Result<std::string, Failure>& result) {
    const std::lock_guard lock(mutex);
    is_reading = false;
    is_done.notify_all();
    if (result) kept = Kept{hours, *result, steady_clock::now()};
  }
};

Reader::Reader(Read read, Nanoseconds kept_for) : work_(std::make_shared<Work>()) {
  work_->read = std::move(read);
  work_->kept_for = kept_for;
}

Reader::~Reader() {
  work_->stop.request_stop();
  std::unique_lock lock(work_->mutex);
  work_->is_done.wait_for(lock, kMaxAtEnd, [this] { return !work_->is_reading; });
}

void Reader::ask(unsigned hours, const Reply& reply) {
  std::optional<Result<std::string, Failure>> at_once;
  {
    const std::lock_guard lock(work_->mutex);
    const auto& kept = work_->kept;
    if (kept && kept->hours == hours && steady_clock::now() - kept->read_at < work_->kept_for)
      at_once.emplace(boost::system::in_place_value, kept->text);
    else if (work_->is_reading)
      at_once.emplace(Failure{"the recording is being read; ask again in some seconds", FailureKind::kUnavailable});
    else
      work_->is_reading = true;
  }
  if (at_once) return reply(*at_once);
  try {
    std::thread([work = work_, hours, reply] {
      contain("reading the recording for the page", [&] {
        setpriority(PRIO_PROCESS, 0, kMinPriority);  // of this thread alone, on Linux
        const auto result = work->carry_out(hours);
        work->finish(hours, result);
        reply(result);
      });
    }).detach();
  } catch (const std::exception& error) {  // no thread is to be had
    const Failure failure{error.what(), FailureKind::kUnavailable};
    work_->finish(hours, failure);
    reply(failure);
  }
}

}  // namespace yuragi::daemon::history
