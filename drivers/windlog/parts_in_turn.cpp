#include "drivers/windlog/parts_in_turn.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/windlog/contents.hpp"
#include "drivers/windlog/iso_time.hpp"
#include "drivers/windlog/merged_readings.hpp"
#include "drivers/windlog/recording_parts.hpp"

namespace yuragi::drivers::windlog {
namespace {

/// The moment in the name of a part; the last file of a series is named as the whole.
std::optional<UtcTime> begin_by_name(const std::vector<std::filesystem::path>& files, std::size_t index) {
  constexpr std::size_t kMomentLength = std::string_view("-20261123T000000Z").size();
  std::filesystem::path whole = files[index];
  const std::string stem = whole.stem().string();
  if (stem.size() <= kMomentLength) return std::nullopt;
  whole.replace_filename(stem.substr(0, stem.size() - kMomentLength) + whole.extension().string());
  return begin_of_part(whole, files[index]);
}

/// " from ... to ...", by the moments in the names of a file and the next.
std::string span_by_names(const std::vector<std::filesystem::path>& files, std::size_t index) {
  const auto begin = begin_by_name(files, index);
  const auto end = index + 1 < files.size() ? begin_by_name(files, index + 1) : std::nullopt;
  std::string span;
  if (begin) span += " from " + iso_time_text(*begin) + (end ? "" : " on");
  if (end) span += " up to " + iso_time_text(*end);
  return span;
}

std::optional<FileIdentity> identity_now(const std::filesystem::path& file) {
  const auto found = identity_of(file);
  if (!found) return std::nullopt;
  return *found;
}

/// The name of a part that its writer may have completed since it was opened.
std::filesystem::path present_name(const PartsInTurn::Part& part) {
  if (!part.identity || identity_now(part.file) == part.identity) return part.file;
  const auto completed = completed_parts(part.file);
  const auto found = std::ranges::find_if(
      completed, [&part](const RecordingPart& each) { return identity_now(each.file) == part.identity; });
  return found == completed.end() ? part.file : found->file;
}

/// One part after the other, of which one is open.
class BlocksInTurn final : public ReadingBlocks {
 public:
  BlocksInTurn(const PartsInTurn& contents, std::vector<bool> of_sensors)
      : contents_(contents), of_sensors_(std::move(of_sensors)) {}

  void seek(Nanoseconds log_time) override {
    part_ = 0;
    while (part_ + 1 < contents_.parts().size() && contents_.parts()[part_].log_end < log_time) ++part_;
    from_ = log_time;
    readings_.reset();
    read_to_.reset();
  }

  Result<void, Failure> read(std::vector<LoggedReading>& block, std::size_t& skipped) override {
    block.clear();
    while (part_ < contents_.parts().size()) {
      if (!readings_) {
        if (auto opened = open(); !opened) return opened;
      }
      const std::size_t skipped_before = readings_->skipped();
      while (block.size() < static_cast<std::size_t>(kBlockRows)) {
        const auto next = readings_->next();
        if (!next && block.empty() && !contents_.leave_out_rest(contents_.parts()[part_], read_to_, next.error())) {
          return next.error();
        }
        if (!next || !*next) break;
        read_to_ = (*next)->reading.time.utc;
        block.push_back(**next);
        block.back().log_time += contents_.parts()[part_].log_begin;
        block.back().sensor += contents_.parts()[part_].first_sensor;
      }
      skipped += readings_->skipped() - skipped_before;
      // The last one may still grow.
      if (!block.empty() || part_ + 1 == contents_.parts().size()) return {};
      ++part_;
      readings_.reset();
      read_to_.reset();
    }
    return {};
  }

 private:
  Result<void, Failure> open() {
    const PartsInTurn::Part& part = contents_.parts()[part_];
    auto file = contents_.open_part(part);
    if (!file) return file.error();
    auto blocks = file->readings->blocks(PartsInTurn::flags_of(part, of_sensors_));
    if (!blocks) return blocks.error();
    file_ = std::move(*file);
    readings_.emplace(file_.database.get(), std::move(*blocks));
    readings_->seek(from_ - part.log_begin);
    return {};
  }

  const PartsInTurn& contents_;
  std::vector<bool> of_sensors_;
  std::size_t part_ = 0;
  Nanoseconds from_{0};
  std::optional<UtcTime> read_to_;  ///< in this part
  StoredFile file_;
  std::optional<MergedReadings> readings_;  ///< of file_
};

}  // namespace

Result<std::unique_ptr<PartsInTurn>, Failure> PartsInTurn::open(const std::vector<std::filesystem::path>& files,
                                                                const std::stop_token& stop) {
  auto series = std::make_unique<PartsInTurn>();
  series->stop_ = stop;
  std::optional<Failure> first;
  std::size_t readable = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto added = series->add(files[i]);
    if (added) {
      ++readable;
      continue;
    }
    if (stop.stop_requested()) return added.error();
    if (!first) first = added.error();
    series->leave_out(files[i], span_by_names(files, i), added.error());
  }
  if (first && readable == 0) return *first;
  return series;
}

Result<StoredFile, Failure> PartsInTurn::open_part(const Part& part) const {
  constexpr int kMaxRenames = 3;
  for (int renames = 0; renames < kMaxRenames; ++renames) {
    const std::filesystem::path name = present_name(part);
    auto opened = open_stored_file(name, stop_);
    if (!part.identity || identity_now(name) == part.identity) return opened;
  }
  return Failure{part.file.string() + ": was removed while it was read", FailureKind::kNoInput};
}

void PartsInTurn::leave_out(const std::filesystem::path& file, const std::string& span, const Failure& failure) const {
  if (!damaged_files_.insert(file).second) return;
  damage_.push_back(failure.message + "; its readings" + span + " are left out");
}

bool PartsInTurn::leave_out_rest(const Part& part, const std::optional<UtcTime>& read_to,
                                 const Failure& failure) const {
  if (stop_.stop_requested() || failure.kind != FailureKind::kBadData) return false;
  leave_out(part.file, (read_to ? " after " + iso_time_text(*read_to) : "") + " up to " + iso_time_text(part.last),
            failure);
  return true;
}

Result<void, Failure> PartsInTurn::add(const std::filesystem::path& file) {
  auto opened = open_stored_file(file, stop_);
  if (!opened && is_blank_file(file)) return {};
  if (!opened) return opened.error();
  const StoredReadings& own = *opened->readings;
  const auto begun = own.sessions.empty() ? own.begun_without_readings : std::optional(own.sessions.front().first.utc);
  if (!begun) return {};

  Part part{
      .file = file, .identity = identity_now(file), .first_sensor = sensors.size(), .sensor_count = own.sensors.size()};
  if (!sessions.empty()) {
    const Nanoseconds gap = *begun - sessions.back().last.utc;
    part.log_begin = sessions.back().log_end() + std::max(gap, Nanoseconds{0});
  } else if (own.sessions.empty()) {
    if (!parts_.empty()) part.log_begin = std::max(*begun - parts_.front().last, Nanoseconds{0});
  } else {
    // Log time begins with the first reading. Quantities before it have a log time below zero.
    for (Part& earlier : parts_) earlier.log_begin = earlier.log_end = std::min(earlier.last - *begun, Nanoseconds{0});
  }
  std::map<std::int64_t, std::int64_t> number_of;  // of a session, by its id in the file
  for (LoggedSession session : own.sessions) {
    session_places_.emplace_back(parts_.size(), session.id);
    number_of[session.id] = static_cast<std::int64_t>(session_places_.size());
    session.id = static_cast<std::int64_t>(session_places_.size());
    session.log_begin += part.log_begin;
    sessions.push_back(std::move(session));
  }
  for (LoggedSensor sensor : own.sensors) {
    const auto number = number_of.find(sensor.session);
    sensor.session = number == number_of.end() ? 0 : number->second;  // 0: of a session without readings
    sensors.push_back(std::move(sensor));
  }
  part.log_end = own.sessions.empty() ? part.log_begin : sessions.back().log_end();
  part.last = own.sessions.empty() ? *begun : sessions.back().last.utc;
  parts_.push_back(std::move(part));
  return {};
}

std::vector<bool> PartsInTurn::flags_of(const Part& part, const std::vector<bool>& of_sensors) {
  const auto begin = of_sensors.begin() + static_cast<std::ptrdiff_t>(part.first_sensor);
  return {begin, begin + static_cast<std::ptrdiff_t>(part.sensor_count)};
}

Result<std::vector<std::unique_ptr<ReadingBlocks>>, Failure> PartsInTurn::blocks(
    const std::vector<bool>& of_sensors) const {
  std::vector<std::unique_ptr<ReadingBlocks>> all;
  all.push_back(std::make_unique<BlocksInTurn>(*this, of_sensors));
  return all;
}

Result<std::optional<Nanoseconds>, Failure> PartsInTurn::log_time_of(UtcTime moment) const {
  for (const Part& part : parts_) {
    auto file = open_part(part);
    if (!file) return file.error();
    const auto found = file->readings->log_time_of(moment);
    if (!found && leave_out_rest(part, std::nullopt, found.error())) continue;
    if (!found) return found.error();
    if (*found) return std::optional(part.log_begin + **found);
  }
  return std::optional<Nanoseconds>{};
}

Result<std::optional<Nanoseconds>, Failure> PartsInTurn::last_log_time(const std::vector<bool>& of_sensors) const {
  for (std::size_t back = 0; back < parts_.size(); ++back) {
    const Part& part = parts_[parts_.size() - 1 - back];
    const std::vector<bool> flags = flags_of(part, of_sensors);
    if (std::ranges::find(flags, true) == flags.end()) continue;
    auto file = open_part(part);
    if (!file) return file.error();
    const auto found = file->readings->last_log_time(flags);
    if (!found && leave_out_rest(part, std::nullopt, found.error())) continue;
    if (!found) return found.error();
    if (*found) return std::optional(part.log_begin + **found);
  }
  return std::optional<Nanoseconds>{};
}

Result<std::size_t, Failure> PartsInTurn::each_quantities(Nanoseconds from, Nanoseconds to,
                                                          const UseQuantities& use) const {
  std::size_t skipped = 0;
  for (std::size_t index = 0; index < parts_.size(); ++index) {
    const Part& part = parts_[index];
    const bool is_last = index + 1 == parts_.size();
    if (part.log_begin >= to) break;
    if (from > Nanoseconds{0} && !is_last && parts_[index + 1].log_begin <= from) continue;
    auto file = open_part(part);
    if (!file) return file.error();
    const auto passed = file->readings->each_quantities(from <= Nanoseconds{0} ? Nanoseconds{0} : from - part.log_begin,
                                                        to == Nanoseconds::max() ? to : to - part.log_begin,
                                                        [&](LoggedQuantities logged) {
                                                          logged.log_time += part.log_begin;
                                                          logged.sensor += part.first_sensor;
                                                          use(logged);
                                                        });
    if (passed) {
      skipped += *passed;
    } else if (!leave_out_rest(part, std::nullopt, passed.error())) {
      return passed.error();
    }
  }
  return skipped;
}

Result<std::string, Failure> PartsInTurn::configuration(std::int64_t session) const {
  if (session < 1 || session > static_cast<std::int64_t>(session_places_.size())) {
    return Failure{"there is no session " + std::to_string(session)};
  }
  const auto& [part, id] = session_places_[static_cast<std::size_t>(session - 1)];
  auto file = open_part(parts_[part]);
  if (!file) return file.error();
  return file->readings->configuration(id);
}

}  // namespace yuragi::drivers::windlog
