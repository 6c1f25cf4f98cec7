#include "daemon/web/guide.hpp"

#include <string_view>
#include <system_error>

#include "daemon/web/page.hpp"
#include "daemon/web/problem.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::web {
namespace {

constexpr std::string_view kGuidePath = "/guide/";
constexpr std::size_t kMaxGuideFiles = 64;
constexpr std::size_t kMaxGuideFile_bytes = 1024UL * 1024;

/// nullopt: it is not served.
std::optional<std::string> content_type_of(const std::filesystem::path& file) {
  if (file.extension() == ".html") return "text/html; charset=utf-8";
  if (file.extension() == ".css") return "text/css; charset=utf-8";
  return std::nullopt;
}

}  // namespace

std::filesystem::path installed_guide() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / "../share/yuragi/guide";
}

Guide::Guide(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (files_.size() == kMaxGuideFiles) break;
    if (!content_type_of(entry.path())) continue;
    if (auto text = platform::read_whole(entry.path(), kMaxGuideFile_bytes))
      files_.emplace(entry.path().filename(), std::move(*text));
  }
}

std::optional<http::Response> Guide::answer(const http::Request& request) const {
  const bool only_reads = request.method == "GET" || request.method == "HEAD";
  if (!only_reads || !request.path.starts_with(kGuidePath)) return std::nullopt;
  std::string name = request.path.substr(kGuidePath.size());
  if (name.empty()) name = "index.html";
  const auto file = files_.find(name);
  if (file == files_.end()) {
    return problem(404, "No such page",
                   files_.empty() ? "the guide is not installed beside this program; read config/guide in the sources"
                                  : "the guide has no page " + name + "; " + std::string(kGuidePath) + " lists all");
  }
  http::Response response = page_response(*content_type_of(file->first));
  response.body = file->second;
  return response;
}

}  // namespace yuragi::daemon::web
