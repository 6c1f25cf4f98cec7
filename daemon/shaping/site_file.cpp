#include "daemon/shaping/site_file.hpp"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/base/json_text.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::shaping {
namespace {

constexpr const char* kTimesKey = "seconds_at_each_speed";
constexpr const char* kOctavesKnownKey = "seconds_of_each_octave_of_gusts";
constexpr const char* kOctavesKey = "decibels_of_each_octave_of_gusts";
constexpr const char* kGainsKey = "relative_gains";
constexpr const char* kReadsKey = "reads";
constexpr const char* kSecondsKey = "seconds";
constexpr const char* kReachKey = "gust_reach";
constexpr const char* kAcrossKey = "across";
constexpr const char* kAlongKey = "along";
constexpr const char* kAcrossDeviationKey = "across_deviation";
constexpr const char* kAlongDeviationKey = "along_deviation";
/// More sensors than any installation has.
constexpr std::size_t kMaxSensors = 256;
/// Many times the size of a valid file: a larger one is refused.
constexpr std::size_t kMaxSiteFile_bytes = 64UL * 1024;

nlohmann::json json_of_gains(const wind::judging::LearntByName& gains) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, learnt] : gains)
    json[name] = {{kReadsKey, std::exp(learnt.deviation)}, {kSecondsKey, learnt.learnt_s}};
  return json;
}

/// Factors, and the standard deviations of their logarithms.
nlohmann::json json_of_reach(const wind::blend::GustReach& reach) {
  return {{kAcrossKey, std::exp(reach.across_ln)},
          {kAcrossDeviationKey, std::sqrt(reach.across_variance)},
          {kAlongKey, std::exp(reach.along_ln)},
          {kAlongDeviationKey, std::sqrt(reach.along_variance)}};
}

/// The failure has an empty text if there was none.
Failure write_site_file(const std::filesystem::path& file, const SiteMemory& memory) {
  try {
    nlohmann::json json = {
        {kTimesKey, memory.times_s}, {kOctavesKnownKey, memory.octaves_known_s}, {kOctavesKey, memory.octaves_db}};
    if (!memory.gains.empty()) json[kGainsKey] = json_of_gains(memory.gains);
    if (memory.reach != wind::blend::GustReach{}) json[kReachKey] = json_of_reach(memory.reach);
    const auto written = platform::write_whole(file, json_text(json) + '\n');
    return written ? Failure{} : written.error();
  } catch (const std::exception& error) {
    return {error.what()};
  }
}

/// The numbers of a key, none if it is missing; false if it has another type.
bool read_numbers(const nlohmann::json& json, const char* key, std::vector<double>& numbers) {
  if (!json.contains(key)) return true;
  const nlohmann::json& row = json[key];
  if (!row.is_array()) return false;
  for (const auto& number : row) {
    if (!number.is_number()) return false;
    numbers.push_back(number.get<double>());
  }
  return true;
}

/// Counts the names of sensors while the file is parsed: the parser keeps the last of two that are the same.
class NameCount {
 public:
  bool operator()(int depth, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    if (event != nlohmann::json::parse_event_t::key) return true;
    if (depth == 1) is_in_gains_ = parsed == kGainsKey;
    if (depth == 2 && is_in_gains_) ++count_;
    return true;
  }
  std::size_t count() const { return count_; }

 private:
  bool is_in_gains_ = false;
  std::size_t count_ = 0;
};

/// Takes the gains. Returns what is wrong with them; empty: nothing.
std::string read_gains(const nlohmann::json& json, std::size_t names, wind::judging::LearntByName& gains) {
  if (!json.is_object()) return "is not an object";
  if (names != json.size()) return "names a sensor twice";
  if (names > kMaxSensors) return fmt::format("names {} sensors", names);
  wind::judging::LearntByName all;
  for (const auto& [name, learnt] : json.items()) {
    const auto is_number = [&learnt = learnt](const char* key) {
      return learnt.contains(key) && learnt[key].is_number();
    };
    if (!learnt.is_object() || !is_number(kReadsKey) || !is_number(kSecondsKey))
      return "has values that are not numbers";
    const auto reads = learnt[kReadsKey].get<double>();
    if (!(reads > 0.0)) return "has a sensor that reads 0 or less";
    all[name] = {.deviation = std::log(reads), .learnt_s = learnt[kSecondsKey].get<double>()};
  }
  gains = std::move(all);
  return {};
}

/// Takes the reach of gusts. Returns what is wrong with it; empty: nothing.
std::string read_reach(const nlohmann::json& json, wind::blend::GustReach& reach) {
  for (const char* key : {kAcrossKey, kAcrossDeviationKey, kAlongKey, kAlongDeviationKey}) {
    if (!json.is_object() || !json.contains(key) || !json[key].is_number())
      return fmt::format("has no number \"{}\"", key);
  }
  const auto square = [&json](const char* key) { return json[key].get<double>() * json[key].get<double>(); };
  const wind::blend::GustReach all = {.across_ln = std::log(json[kAcrossKey].get<double>()),
                                      .along_ln = std::log(json[kAlongKey].get<double>()),
                                      .across_variance = square(kAcrossDeviationKey),
                                      .along_variance = square(kAlongDeviationKey)};
  if (!is_valid(all)) return "has impossible values";
  reach = all;
  return {};
}

}  // namespace

Result<SiteMemory, Failure> SiteFile::read() const {
  const auto text = platform::read_whole(file_, kMaxSiteFile_bytes);
  if (!text) return Failure{file_.string() + ": " + text.error().message};

  const Failure none{file_.string() + ": is not a file of a site's wind"};
  NameCount names;
  const auto json = nlohmann::json::parse(*text, std::ref(names), false);
  if (!json.is_object() || !json.contains(kTimesKey)) return none;
  SiteMemory memory;
  const bool is_read = read_numbers(json, kTimesKey, memory.times_s) &&
                       read_numbers(json, kOctavesKnownKey, memory.octaves_known_s) &&
                       read_numbers(json, kOctavesKey, memory.octaves_db);
  if (!is_read) return none;
  if (json.contains(kGainsKey)) memory.gains_refusal = read_gains(json[kGainsKey], names.count(), memory.gains);
  if (json.contains(kReachKey)) memory.reach_refusal = read_reach(json[kReachKey], memory.reach);
  return memory;
}

Result<std::filesystem::path, Failure> SiteFile::set_aside() const {
  std::filesystem::path aside = file_.string() + ".unreadable";
  std::error_code error;
  for (int number = 2; std::filesystem::exists(std::filesystem::symlink_status(aside, error)); ++number)
    aside = fmt::format("{}.unreadable-{}", file_.string(), number);
  std::filesystem::rename(file_, aside, error);
  if (error) return Failure{file_.string() + ": cannot be renamed: " + error.message()};
  return {boost::system::in_place_value, aside};
}

void SiteFile::save(SiteMemory memory) {
  // If no thread can be created, wait() writes the file.
  writing_ = std::async(std::launch::async | std::launch::deferred, write_site_file, file_, std::move(memory));
}

bool SiteFile::is_writing() const {
  using namespace std::chrono_literals;
  return writing_.valid() && writing_.wait_for(0s) == std::future_status::timeout;
}

Failure SiteFile::wait() {
  return writing_.valid() ? writing_.get() : Failure{};
}

}  // namespace yuragi::daemon::shaping
