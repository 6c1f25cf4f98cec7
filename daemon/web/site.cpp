#include "daemon/web/site.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "daemon/web/media_type.hpp"
#include "daemon/web/problem.hpp"
#include "daemon/web/query.hpp"
#include "engine/base/contain.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::web {
namespace {

namespace fs = std::filesystem;

/// A page may load and ask whatever is of this daemon, and no other server; no script stands in a page's text.
constexpr const char* kPolicy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src 'self' data: "
    "blob:; font-src 'self' data:; media-src 'self' blob:; worker-src 'self' blob:; base-uri 'none'; form-action "
    "'none'; frame-ancestors 'self'";

/// Without names that begin with a dot: "..", and what people hide.
bool is_plain(const fs::path& path) {
  return std::ranges::none_of(path, [](const fs::path& name) { return name.string().starts_with('.'); });
}

bool is_within(const fs::path& file, const fs::path& folder) {
  return std::ranges::mismatch(folder, file).in1 == folder.end();
}

http::Response not_found(const http::Request& request) {
  return problem(404, "Not found", request.path + " is no file of [http] folder");
}

std::string entity_tag_of(const fs::path& file, std::uintmax_t size, std::error_code& error) {
  return fmt::format("\"{:x}-{:x}\"", size, fs::last_write_time(file, error).time_since_epoch().count());
}

}  // namespace

bool is_of_site(std::string_view path) {
  return path.starts_with(kSitePath) || path == kSitePath.substr(0, kSitePath.size() - 1);
}

http::Response site_response(const fs::path& folder, const http::Request& request) {
  const auto redirection = [&request] {
    return http::Response{.status = 301, .fields = {{"Location", request.path + "/"}}};
  };
  if (request.path.size() < kSitePath.size()) return redirection();
  const auto name = path_decoded(std::string_view(request.path).substr(kSitePath.size()));
  if (!name || name->starts_with('/') || !is_plain(*name)) return not_found(request);
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return problem(404, "Not found", "[http] folder cannot be read: " + error.message());
  fs::path file = fs::canonical(root / *name, error);
  if (error || !is_within(file, root)) return not_found(request);
  if (fs::is_directory(file, error)) {
    if (!request.path.ends_with('/')) return redirection();
    file = fs::canonical(file / "index.html", error);
    if (error || !is_within(file, root)) return not_found(request);
  }
  if (!fs::is_regular_file(file, error)) return not_found(request);
  const std::uintmax_t size = fs::file_size(file, error);
  const std::string entity_tag = error ? std::string() : entity_tag_of(file, size, error);
  if (error) return not_found(request);
  http::Response response{.content_type = std::string(media_type_of(file).value_or("application/octet-stream")),
                          .fields = {{"Cache-Control", "no-cache"}, {"Content-Security-Policy", kPolicy}}};
  response.fields.emplace_back("ETag", entity_tag);
  if (request.if_none_match == entity_tag) {
    response.status = 304;
    return response;
  }
  auto text = platform::read_whole(file, kMaxSiteFile_bytes);
  if (!text) return problem(404, "Not served", request.path + " " + text.error().message);
  response.body = std::move(*text);
  return response;
}

/// With the thread, which ends by itself if a disk hangs when the daemon ends.
struct Site::Shared {
  struct Waiting {
    http::Request request;
    std::function<void(http::Response)> reply;
  };

  fs::path folder;
  std::mutex mutex{};
  std::condition_variable changed{};
  std::deque<Waiting> waiting{};
  bool is_ending = false;

  void work() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [this] { return is_ending || !waiting.empty(); });
      if (is_ending) return;
      const Waiting next = std::move(waiting.front());
      waiting.pop_front();
      lock.unlock();
      contain(
          "reading a file of [http] folder", [&] { next.reply(site_response(folder, next.request)); },
          [&](const char*) {
            next.reply(problem(500, "Not read", "this file could not be read, which is a fault of the program"));
          });
      lock.lock();
    }
  }
};

Site::Site(fs::path folder) {
  if (folder.empty()) return;
  shared_ = std::make_shared<Shared>();
  shared_->folder = std::move(folder);
  std::thread([shared = shared_] { contain("the thread of [http] folder", [&] { shared->work(); }); }).detach();
}

Site::~Site() {
  if (!shared_) return;
  const std::lock_guard lock(shared_->mutex);
  shared_->is_ending = true;
  shared_->changed.notify_all();
}

void Site::answer(const http::Request& request, std::function<void(http::Response)> reply) {
  if (!shared_) return reply(problem(404, "Not served", "set [http] folder to the folder with your pages"));
  {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->waiting.size() < kMaxWaiting) {
      shared_->waiting.push_back({request, std::move(reply)});
      shared_->changed.notify_all();
      return;
    }
  }
  reply(problem(503, "Not yet", "the disk of [http] folder does not respond"));
}

}  // namespace yuragi::daemon::web
