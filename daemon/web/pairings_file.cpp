#include "daemon/web/pairings_file.hpp"

#include <exception>
#include <fstream>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/settings/output_file.hpp"
#include "engine/base/contain.hpp"

namespace yuragi::daemon::web {
namespace {

/// Returns the text of a file, or nullopt if it is no regular file, too large or unreadable.
std::optional<std::string> text_of(const std::filesystem::path& file) {
  std::error_code error;
  // A pipe would keep the daemon waiting.
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  std::string text(Pairings::kMaxText_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || text.size() > Pairings::kMaxText_bytes) return std::nullopt;
  return text;
}

}  // namespace

PairingsFile::PairingsFile(std::filesystem::path file)
    : file_(std::move(file)),
      thread_([this](const std::stop_token& stop) { contain("keeping the paired browsers", [&] { work(stop); }); }) {}

PairingsFile::~PairingsFile() = default;

Pairings PairingsFile::read(const std::string& token_mark) const {
  Pairings none(token_mark);
  std::error_code error;
  if (file_.empty() || (!std::filesystem::exists(file_, error) && !error)) return none;
  const auto text = text_of(file_);
  if (auto pairings = Pairings::parse(text.value_or(""))) {
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
    const auto written = settings::write_whole(file_, text, perms::owner_read | perms::owner_write);
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
