#include "daemon/web/pairings_file.hpp"

#include <exception>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "engine/base/contain.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::web {
PairingsFile::PairingsFile(std::filesystem::path file)
    : file_(std::move(file)),
      thread_([this](const std::stop_token& stop) { contain("keeping the paired browsers", [&] { work(stop); }); }) {}

PairingsFile::~PairingsFile() = default;

Pairings PairingsFile::read(const std::string& token_mark) const {
  Pairings none(token_mark);
  std::error_code error;
  if (file_.empty() || (!std::filesystem::exists(file_, error) && !error)) return none;
  const auto text = platform::read_whole(file_, Pairings::kMaxText_bytes);
  if (auto pairings = Pairings::parse(text ? *text : std::string())) {
    return pairings->token_mark() == token_mark ? std::move(*pairings) : none;
  }
  const std::filesystem::path aside = file_.string() + ".damaged";
  std::filesystem::rename(file_, aside, error);
  spdlog::warn("http: {} cannot be read: all browsers have to be paired again; {}", file_.string(),
               error ? "it is overwritten with the next pairing" : "it is kept as " + aside.string());
  return none;
}

void PairingsFile::save(const Pairings& pairings, Done done) {
  const std::lock_guard lock(mutex_);
  text_ = pairings.text();
  if (done) waiting_.push_back(std::move(done));
  changed_.notify_one();
}

void PairingsFile::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  // Also true once after a stop, if something is not written.
  while (changed_.wait(lock, stop, [this] { return text_.has_value(); })) {
    const std::string text = *std::exchange(text_, std::nullopt);
    const std::vector<Done> waiting = std::exchange(waiting_, {});
    lock.unlock();
    const auto saved = write(text);
    for (const Done& done : waiting) done(saved);
    lock.lock();
  }
}

Result<void, Failure> PairingsFile::write(const std::string& text) {
  if (file_.empty()) return {};
  std::string failure;
  try {
    using std::filesystem::perms;
    const auto written = platform::write_whole(file_, text, perms::owner_read | perms::owner_write);
    if (!written) failure = written.error().message;
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (!failure.empty() && failure != failure_)
    spdlog::warn("http: {}: pairings and revocations since then are lost at a restart", failure);
  failure_ = failure;
  if (failure.empty()) return {};
  return Failure{std::move(failure), FailureKind::kCannotCreate};
}

}  // namespace yuragi::daemon::web
