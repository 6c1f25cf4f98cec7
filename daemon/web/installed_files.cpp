#include "daemon/web/installed_files.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "daemon/web/media_type.hpp"
#include "daemon/web/page.hpp"
#include "daemon/web/problem.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::web {
namespace {

constexpr std::size_t kMaxFiles = 64;
constexpr std::size_t kMaxFile_bytes = 4UL << 20;

/// In the order of preference.
struct Encoding {
  std::string_view extension, name;
};
constexpr std::array kEncodings = {Encoding{".br", "br"}, Encoding{".gz", "gzip"}};

/// Of the file before it was compressed; nullopt: such files are not served.
std::optional<std::string_view> content_type_of(std::filesystem::path file) {
  if (std::ranges::find(kEncodings, file.extension().string(), &Encoding::extension) != kEncodings.end())
    file.replace_extension();
  return media_type_of(file);
}

/// Returns true if a list as "gzip, deflate, br;q=1.0" has the word, and does not refuse it.
bool takes(std::string_view accepted, std::string_view word) {
  for (std::string_view rest = accepted; !rest.empty();) {
    std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    item.remove_prefix(std::min(item.size(), item.find_first_not_of(' ')));
    const std::string_view name = item.substr(0, item.find_first_of("; "));
    if (name == word) return item.find("q=0") == std::string_view::npos || item.find("q=0.") != std::string_view::npos;
  }
  return false;
}

}  // namespace

std::filesystem::path installed_folder(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / "../share/yuragi" / name;
}

InstalledFiles::InstalledFiles(Place place, const std::filesystem::path& folder) : place_(std::move(place)) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (files_.size() == kMaxFiles) break;
    if (!content_type_of(entry.path())) continue;
    if (auto text = platform::read_whole(entry.path(), kMaxFile_bytes)) {
      std::string entity_tag = fmt::format("\"{:016x}\"", std::hash<std::string>{}(*text));
      files_.emplace(entry.path().filename(), File{std::move(*text), std::move(entity_tag)});
    }
  }
}

const InstalledFiles::File* InstalledFiles::find(const std::string& name) const {
  const auto found = files_.find(name);
  return found == files_.end() ? nullptr : &found->second;
}

std::optional<http::Response> InstalledFiles::answer(const http::Request& request) const {
  const bool only_reads = request.method == "GET" || request.method == "HEAD";
  if (!only_reads || place_.path.empty() || !request.path.starts_with(place_.path)) return std::nullopt;
  std::string name = request.path.substr(place_.path.size());
  if (name.empty()) name = "index.html";
  const File* file = find(name);
  if (file == nullptr) {
    return problem(404, "Not here",
                   files_.empty()
                       ? fmt::format("{} is not installed beside this program; {}", place_.what, place_.remedy)
                       : fmt::format("{} has no file {}", place_.what, name));
  }
  http::Response response = page_response(*content_type_of(name), PageNeeds::kStyle);
  response.fields.emplace_back("Vary", "Accept-Encoding");
  for (const Encoding& encoding : kEncodings) {
    const File* const compressed = find(name + std::string(encoding.extension));
    if (compressed == nullptr || !takes(request.accept_encoding, encoding.name)) continue;
    file = compressed;
    response.fields.emplace_back("Content-Encoding", encoding.name);
    break;
  }
  put_file(response, request, file->entity_tag, file->text);
  return response;
}

}  // namespace yuragi::daemon::web
