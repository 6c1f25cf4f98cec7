// The page that people see; its sources are in daemon/web/page.
#include "daemon/web/page.hpp"

#include <algorithm>

namespace yuragi::daemon::web {

std::string_view content_security_policy() {
  return "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self'; "
         "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

std::optional<HttpResponse> page_answer(const HttpRequest& request) {
  if (request.method != "GET" && request.method != "HEAD") return std::nullopt;
  const std::span<const PageFile> files = page_files();
  const auto file = std::ranges::find(files, std::string_view(request.path), &PageFile::path);
  if (file == files.end()) return std::nullopt;
  HttpResponse response{.content_type = std::string(file->content_type),
                        .fields = {{"Cache-Control", "no-cache"},  // kept, but asked for again each time
                                   {"Content-Security-Policy", std::string(content_security_policy())},
                                   {"ETag", std::string(file->entity_tag)}}};
  if (request.if_none_match == file->entity_tag)
    response.status = 304;
  else
    response.body = file->text;
  return response;
}

}  // namespace yuragi::daemon::web
