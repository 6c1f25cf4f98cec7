#include "daemon/recording/recorder.hpp"

#include <utility>

#include "engine/base/contain.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::recording {

Recorder::Recorder(const std::filesystem::path& file, Info info, RecorderReport report, const RecorderLimits& limits,
                   const settings::RecordingConfig& rules, const std::filesystem::path& synchronized_file,
                   RecorderStart start)
    : limits_(limits),
      worker_(std::make_shared<RecorderWorker>(file, rules, std::move(info), std::move(report), limits,
                                               synchronized_file, start)),
      thread_(
          [worker = worker_](const std::stop_token& stop) { contain("the recorder", [&] { worker->run(stop); }); }) {}

Recorder::~Recorder() {
  close();
}

void Recorder::close() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  if (worker_->wait_for_end(limits_.most_at_end)) return thread_.join();
  thread_.detach();
  const RecorderStatus status = worker_->status();
  worker_->report_at_last("the disk does not respond: ended with " + count_text(status.waiting, "reading") +
                          " that were possibly not written");
}

}  // namespace yuragi::daemon::recording
