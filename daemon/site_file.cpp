#include "daemon/site_file.hpp"

#include <chrono>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "daemon/output_file.hpp"

namespace yuragi {
namespace {

constexpr const char* kTimesKey = "seconds_at_each_speed";
/// Many times what a file of ours holds: what is longer is none.
constexpr std::streamsize kLongestSiteFile = 64 * 1024;

/// An empty message where all went well.
Failure write_site_file(const std::filesystem::path& file, const std::vector<double>& times_s) {
  try {
    OutputFile output(file, true);
    std::ofstream out(output.working_path());
    out << nlohmann::json{{kTimesKey, times_s}}.dump() << '\n';
    out.close();
    if (!out) return {file.string() + ": could not be written; is there room, and may this user write there?"};
    output.commit();
    return {};
  } catch (const std::exception& error) {
    return {error.what()};
  }
}

}  // namespace

Result<std::vector<double>, Failure> SiteFile::read() const {
  std::ifstream in(file_);
  if (!in) return Failure{file_.string() + ": cannot be read"};
  std::string text(kLongestSiteFile, '\0');
  in.read(text.data(), kLongestSiteFile);
  text.resize(static_cast<std::size_t>(in.gcount()));

  const Failure none{file_.string() + ": is no memory of a site's wind"};
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains(kTimesKey) || !json[kTimesKey].is_array()) return none;
  std::vector<double> times_s;
  for (const auto& time_s : json[kTimesKey]) {
    if (!time_s.is_number()) return none;
    times_s.push_back(time_s.get<double>());
  }
  return times_s;
}

void SiteFile::save(std::span<const double> times_s) {
  std::vector<double> copy(times_s.begin(), times_s.end());
  // Where there is no thread to be had, wait() writes.
  writing_ = std::async(std::launch::async | std::launch::deferred, write_site_file, file_, std::move(copy));
}

bool SiteFile::is_writing() const {
  using namespace std::chrono_literals;
  return writing_.valid() && writing_.wait_for(0s) == std::future_status::timeout;
}

Failure SiteFile::wait() {
  return writing_.valid() ? writing_.get() : Failure{};
}

}  // namespace yuragi
