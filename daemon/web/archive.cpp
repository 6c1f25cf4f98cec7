#include "daemon/web/archive.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "daemon/http/file_body.hpp"
#include "daemon/web/jobs.hpp"
#include "daemon/web/niced_child.hpp"
#include "daemon/web/problem.hpp"
#include "daemon/web/recording_list.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::web {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using What = ArchiveRequest::What;

constexpr auto kMaxCheck = std::chrono::seconds(60);
constexpr auto kMaxSearch = std::chrono::seconds(60);
constexpr auto kMaxTrial = std::chrono::seconds(90);
/// Beside the time that it listens: until the first readings, and for the rest.
constexpr auto kMaxCalibrationExtra = std::chrono::seconds(180);
constexpr auto kForgetEvery = std::chrono::minutes(1);
constexpr const char* kRecordingType = "application/vnd.sqlite3";
/// Of a copy beside its recording: what the recorder writes meanwhile, with room to spare.
constexpr std::uint64_t kRoomToSpare_bytes = 64'000'000;
/// A report is one page without scripts, shown as if it were of nobody.
constexpr const char* kReportPolicy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox";

http::Response json_response(const ordered_json& content, unsigned status = 200) {
  return {.status = status, .body = json_text(content, 2) + "\n"};
}

http::Response busy(const std::string& why) {
  http::Response response = problem(503, "Not yet", why);
  response.fields.push_back({"Retry-After", "5"});
  return response;
}

/// The name of a file for Content-Disposition (RFC 8187): letters, digits and some signs as they are, the rest as %XX.
std::string encoded(std::string_view name) {
  std::string text;
  for (const char letter : name) {
    const bool is_plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                          (letter >= '0' && letter <= '9') || letter == '.' || letter == '-' || letter == '_';
    text += is_plain ? std::string(1, letter) : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
  }
  return text;
}

/// Folders are left out of what a command has printed about the recording.
std::string without_folder(std::string text, const fs::path& recording) {
  const std::string folder = recording.parent_path().string() + "/";
  if (folder.size() < 2) return text;
  for (auto place = text.find(folder); place != std::string::npos; place = text.find(folder, place))
    text.erase(place, folder.size());
  return text;
}

/// The last complete line of what is printed, a line for each state.
std::string_view last_line(std::string_view text) {
  text = text.substr(0, text.rfind('\n') == std::string_view::npos ? 0 : text.rfind('\n'));
  const std::size_t before = text.rfind('\n');
  return before == std::string_view::npos ? text : text.substr(before + 1);
}

ordered_json job_json(const Job& job, const fs::path& recording) {
  constexpr std::array<std::string_view, 3> kStates = {"running", "done", "failed"};
  ordered_json content = {{"id", job.id},
                          {"kind", job.kind},
                          {"recording", job.recording.empty() ? ordered_json() : ordered_json(job.recording)},
                          {"state", kStates[static_cast<std::size_t>(job.state)]},
                          {"run_for_s", std::chrono::duration<double>(job.run_for).count()},
                          {"message", without_folder(job.message, recording)},
                          {"result", nullptr},
                          {"file", nullptr}};
  if (!job.printed.empty()) {
    const std::string text = without_folder(job.printed, recording);
    auto printed = ordered_json::parse(text, nullptr, false);
    if (printed.is_discarded()) printed = ordered_json::parse(last_line(text), nullptr, false);
    if (!printed.is_discarded()) content["result"] = std::move(printed);
  }
  if (job.file) {
    content["file"] = {
        {"path", "/api/v1/jobs/" + job.id + "/file"}, {"name", job.file->name}, {"bytes", job.file->bytes}};
  }
  return content;
}

}  // namespace

/// With the thread, which ends by itself if a disk hangs when the daemon ends.
struct Archive::Shared {
  struct Waiting {
    ArchiveRequest request;
    std::function<void(http::Response)> reply;
  };

  ArchiveSettings settings;
  std::mutex mutex{};
  std::condition_variable changed{};
  std::deque<Waiting> waiting{};
  std::stop_source stop{};
  Jobs jobs{};
  // Of the thread:
  KnownRecordings known{};
  std::string known_drivers{};  ///< empty: not yet asked for
  std::vector<std::weak_ptr<const http::FileBody>> sent{};

  void work() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait_for(lock, kForgetEvery, [this] { return stop.stop_requested() || !waiting.empty(); });
      if (stop.stop_requested()) return;
      std::optional<Waiting> next;
      if (!waiting.empty()) {
        next = std::move(waiting.front());
        waiting.pop_front();
      }
      lock.unlock();
      jobs.forget_old();
      if (next) carry_out(*next);
      lock.lock();
    }
  }

  void carry_out(const Waiting& next) {
    contain(
        "a request about recordings", [&] { next.reply(answer_to(next.request)); },
        [&](const char*) {
          next.reply(problem(500, "Not done", "this could not be done, which is a fault of the program"));
        });
  }

  http::Response answer_to(const ArchiveRequest& request) {
    switch (request.what) {
      case What::kList:
        return {.body = recordings_json(list_recordings(settings.recording, known))};
      case What::kDownload:
        return download(request.name);
      case What::kVerify:
      case What::kReport:
      case What::kCopy:
        return start(request);
      case What::kSupportBundle:
        return started(bundle_order());
      case What::kJob:
        return job(request.name);
      case What::kJobFile:
        return job_file(request.name);
      case What::kCancelJob:
        return jobs.cancel(request.name) ? job(request.name) : no_job();
      case What::kConfiguration:
        return configuration();
      case What::kDrivers:
        return drivers();
      case What::kSensors:
        return setup().list();
      case What::kFindSensors:
        return started({.kind = "find",
                        .command = command({"sensors", "list", "--all", "--json"}),
                        .niceness = Niceness::kAwaited,
                        .time = kMaxSearch});
      case What::kTrySensor:
        return try_sensor(request.sensor);
      case What::kAddSensor:
        return setup().add(request.sensor);
      case What::kRemoveSensor:
        return setup().remove(request.name);
      case What::kKept:
        return setup().list_values();
      case What::kKeep:
        return setup().keep(request.values);
      case What::kForgetKept:
        return setup().forget_values();
      case What::kUndoPage:
        return setup().undo();
      case What::kCalibrations:
        return calibrations();
      case What::kCalibrate:
        return calibrate(request.name, request.calibration);
      case What::kKeepCalibration:
        return setup().calibrate(request.name, request.found);
      case What::kForgetCalibration:
        return setup().forget_calibration(request.name);
    }
    return problem(500, "Not done", "this request is not known");
  }

  http::Response not_found() const {
    if (settings.recording.empty()) {
      return problem(404, "Nothing is recorded",
                     "the daemon records nothing: name a file in [recording] file, or start it with --record "
                     "FILE.windlog");
    }
    return problem(404, "Not found", "no recording has this name; /api/v1/recordings lists all");
  }

  /// Never of the file that is written: closing it here would release the locks that SQLite has on it.
  http::Response download(const std::string& name) {
    const auto found = recording_named(settings.recording, name);
    if (!found) return not_found();
    if (found->is_written) {
      return problem(409, "Being written",
                     "this recording is being written: POST " + std::string("/api/v1/recordings/") + encoded(name) +
                         "/copy makes a copy");
    }
    auto file = std::make_shared<const platform::Descriptor>(
        open(found->file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat about {};
    if (file->get() < 0 || fstat(file->get(), &about) != 0 || !S_ISREG(about.st_mode)) return not_found();
    return send({.file = std::move(file),
                 .bytes = static_cast<std::uint64_t>(about.st_size),
                 .name = name,
                 .content_type = kRecordingType});
  }

  http::Response send(const JobFile& file) {
    std::erase_if(sent, [](const auto& one) { return one.expired(); });
    if (sent.size() >= kMaxDownloads) return busy("other files are being downloaded; wait until they are complete");
    http::Response response{.content_type = file.content_type};
    if (file.content_type.starts_with("text/html")) {
      response.fields.emplace_back("Content-Security-Policy", kReportPolicy);
    } else {
      response.fields.emplace_back("Content-Disposition", "attachment; filename*=UTF-8''" + encoded(file.name));
    }
    response.file = std::make_shared<const http::FileBody>(file.file, file.bytes);
    sent.push_back(response.file);
    return response;
  }

  std::vector<std::string> command(std::initializer_list<std::string> words) const {
    std::vector<std::string> all = settings.program;
    all.insert(all.end(), words);
    return all;
  }

  http::Response start(const ArchiveRequest& request) {
    const auto found = recording_named(settings.recording, request.name);
    if (!found) return not_found();
    const std::string file = found->file.string();
    JobOrder order{.recording = request.name};
    if (request.what == What::kVerify) {
      order.kind = "verify";
      order.command = command({"verify", file, "--json"});
      order.is_finding_good = true;
    } else if (request.what == What::kReport) {
      order.kind = "report";
      order.command = command({"report", file});
      if (!settings.configuration.empty())
        order.command.insert(order.command.end(), {"--config", settings.configuration.string()});
      order.command.emplace_back("--output");
      order.result = found->file.stem().string() + ".html";
      order.content_type = "text/html; charset=utf-8";
    } else {
      std::error_code error;
      const fs::space_info disk = fs::space(found->file.parent_path(), error);
      const std::uint64_t needed_bytes = found->bytes + settings.least_free_bytes + kRoomToSpare_bytes;
      if (error || disk.available < needed_bytes) {
        return problem(409, "No room",
                       fmt::format("a copy needs {} MB on the disk of the recording; {} MB are free",
                                   needed_bytes / 1'000'000, error ? 0 : disk.available / 1'000'000));
      }
      order.kind = "copy";
      order.command = command({"export", file, "--this-file", "--output"});
      order.result = found->file.filename().string();
      order.content_type = kRecordingType;
      // One name: what a daemon that was killed has left there is removed by the next copy.
      order.folder = found->file.parent_path() / ("." + settings.recording.filename().string() + "-copy");
    }
    return started(std::move(order));
  }

  JobOrder bundle_order() const {
    JobOrder order{.kind = "support-bundle", .command = command({"support-bundle"}), .niceness = Niceness::kAwaited};
    if (!settings.configuration.empty())
      order.command.insert(order.command.end(), {"--config", settings.configuration.string()});
    if (!settings.stream.empty()) order.command.insert(order.command.end(), {"--connect", settings.stream});
    order.command.emplace_back("--out");
    order.result = "yuragi-support.tar.gz";
    order.content_type = "application/gzip";
    order.time = std::chrono::minutes(5);
    return order;
  }

  http::Response started(JobOrder order) {
    const auto id = jobs.start(std::move(order));
    if (!id) return problem(409, "Busy", id.error().message);
    http::Response response = json_response(job_json(*jobs.find(*id), settings.recording), 202);
    response.fields.emplace_back("Location", "/api/v1/jobs/" + *id);
    return response;
  }

  static http::Response no_job() {
    return problem(404, "Not found", "no job has this id, or its result is older than 10 minutes");
  }
  http::Response job(const std::string& id) const {
    const auto found = jobs.find(id);
    return found ? json_response(job_json(*found, settings.recording)) : no_job();
  }
  http::Response job_file(const std::string& id) {
    const auto found = jobs.find(id);
    if (!found || !found->file) return no_job();
    return send(*found->file);
  }

  PageSetup setup() const { return {settings.configuration, settings.page, settings.taking_over, settings.sensors}; }

  /// What this program prints, for a request that waits for it.
  ChildOutput printed_by(std::initializer_list<std::string> words) const {
    return run_niced(Niceness::kAwaited, command(words), kMaxCheck, stop.get_token());
  }

  http::Response drivers() {
    if (known_drivers.empty()) {
      const ChildOutput output = printed_by({"sensors", "describe", "--json"});
      if (std::string failure = failure_of(output); !failure.empty()) return busy(failure);
      known_drivers = for_the_page(output.printed);
    }
    return {.body = known_drivers};
  }

  http::Response try_sensor(const settings::PageSensor& sensor) {
    auto text = setup().trial(sensor);
    if (!text) return problem(409, "Not done", text.error().message);
    return started({.kind = "try",
                    .command = command({"sensors", "try", "-", "--json"}),
                    .input = std::move(*text),
                    .niceness = Niceness::kAwaited,
                    .shows_progress = true,
                    .time = kMaxTrial});
  }

  http::Response calibrations() const {
    if (settings.configuration.empty())
      return problem(404, "No file", "the daemon runs without a configuration file: nothing can be calibrated");
    const ChildOutput output = printed_by({"calibrate", "list", "--config", settings.configuration.string(), "--json"});
    if (std::string failure = failure_of(output); !failure.empty()) return busy(failure);
    auto sensors = ordered_json::parse(output.printed, nullptr, false);
    return json_response({{"sensors", sensors.is_discarded() ? ordered_json::array() : std::move(sensors)}});
  }

  http::Response calibrate(const std::string& sensor, const CalibrationOrder& wanted) {
    if (auto refusal = setup().calibration_refusal(sensor, wanted.reference)) return std::move(*refusal);
    JobOrder order{
        .kind = "calibrate", .command = command({"calibrate"}), .niceness = Niceness::kAwaited, .shows_progress = true};
    for (std::string& word : words_of(wanted, sensor)) order.command.push_back(std::move(word));
    order.command.push_back("--config=" + settings.configuration.string());
    if (!settings.stream.empty()) order.command.push_back("--connect=" + settings.stream);
    order.time = from_seconds(wanted.duration_s.value_or(CalibrationOrder::kMaxDuration_s)) + kMaxCalibrationExtra;
    return started(std::move(order));
  }

  /// As the next start would read it.
  http::Response configuration() const {
    if (settings.configuration.empty())
      return problem(404, "No file", "the daemon runs without a configuration file; `yuragi describe` lists all keys");
    const ChildOutput output = printed_by({"check-config", settings.configuration.string(), "--full", "--json"});
    if (!output.end || output.end->signal != 0) return busy("the configuration was not read: " + failure_of(output));
    auto values = ordered_json::parse(output.printed, nullptr, false);
    ordered_json findings = ordered_json::array();
    for (std::string_view rest = output.complaints; !rest.empty();) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      if (end > 0) findings.push_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return json_response({{"file", settings.configuration.filename().string()},
                          {"is_valid", output.end->is_good()},
                          {"findings", std::move(findings)},
                          {"configuration", values.is_discarded() ? ordered_json() : std::move(values)}});
  }
};

Archive::Archive(ArchiveSettings settings) : shared_(std::make_shared<Shared>()) {
  for (fs::path* const file : {&settings.recording, &settings.configuration}) {
    if (!file->empty()) *file = fs::absolute(*file);
  }
  shared_->settings = std::move(settings);
  std::thread([shared = shared_] { contain("the thread of recordings", [&] { shared->work(); }); }).detach();
}

Archive::~Archive() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop.request_stop();
    shared_->changed.notify_all();
  }
  shared_->jobs.end();
}

void Archive::answer(ArchiveRequest request, std::function<void(http::Response)> reply) {
  {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->waiting.size() < kMaxWaiting) {
      shared_->waiting.push_back({std::move(request), std::move(reply)});
      shared_->changed.notify_all();
      return;
    }
  }
  reply(busy("the disk of the recordings does not respond"));
}

}  // namespace yuragi::daemon::web
