#include "drivers/windlog/windlog_reader.hpp"

#include <utility>

#include "drivers/windlog/parts_in_turn.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/stored_file.hpp"

namespace yuragi::drivers::windlog {
namespace {

Result<void, Failure> copied(sqlite::Database& database, const std::filesystem::path& copy) {
  auto vacuum = database.prepare("VACUUM INTO ?1");
  if (!vacuum) return vacuum.error();
  const std::string name = std::filesystem::absolute(copy).string();
  vacuum->bind(1, std::string_view(name));
  if (vacuum->step() != sqlite::Statement::Step::kDone) return database.failure();
  return {};
}

}  // namespace

Result<Reader, Failure> Reader::open(const std::filesystem::path& file, const std::stop_token& stop) {
  constexpr int kMaxLooks = 3;
  for (int tries = 1;; ++tries) {
    const auto files = recording_files(file);
    auto reader = open(file, files, stop);
    // Where its writer completed a file meanwhile, one was missed, or taken for another.
    if (tries == kMaxLooks || recording_files(file) == files) return reader;
  }
}

Result<Reader, Failure> Reader::open(const std::filesystem::path& file, const std::vector<std::filesystem::path>& files,
                                     const std::stop_token& stop) {
  Reader reader(file);
  if (files.empty() || files == std::vector{file}) {
    auto opened = open_stored_file(file, stop);
    if (!opened) return opened.error();
    reader.database_ = std::move(opened->database);
    reader.stored_ = std::move(opened->readings);
  } else {
    auto series = PartsInTurn::open(files, stop);
    if (!series) return series.error();
    reader.stored_ = std::move(*series);
  }
  if (const auto chosen = reader.choose(std::vector<bool>(reader.sensors().size(), true)); !chosen) {
    return Failure{chosen.error().message, FailureKind::kBadData};
  }
  return reader;
}

Result<void, Failure> Reader::choose(const std::vector<bool>& of_sensors) {
  auto blocks = stored_->blocks(of_sensors);
  if (!blocks) return blocks.error();
  readings_.emplace(database_.get(), std::move(*blocks));
  seek(Nanoseconds{0});
  return {};
}

Result<std::optional<LoggedReading>, Failure> Reader::next() {
  if (sessions().empty()) return std::optional<LoggedReading>{};
  return readings_->next();
}

Result<void, Failure> Reader::copy_to(const std::filesystem::path& copy) {
  if (!database_) {
    return Failure{file_.string() + ": is a series of files, which can be copied as they are: `cp " +
                       (file_.parent_path() / file_.stem()).string() + "*" + file_.extension().string() + " FOLDER`",
                   FailureKind::kUsage};
  }
  return copied(*database_, copy);
}

Result<void, Failure> Reader::copy_file(const std::filesystem::path& file, const std::filesystem::path& copy) {
  const auto opened = open_stored_file(file, {});
  if (!opened) return opened.error();
  return copied(*opened->database, copy);
}

}  // namespace yuragi::drivers::windlog
