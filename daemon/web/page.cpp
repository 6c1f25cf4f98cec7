// The page that people see; its sources are in daemon/web/page.
#include "daemon/web/page.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace yuragi::daemon::web {

namespace {

constexpr std::string_view kPictureAlone = "/wall";

}  // namespace

http::Response page_response(std::string_view content_type, PageNeeds needs) {
  const std::string scripts =
      needs == PageNeeds::kStyle
          ? ""
          : fmt::format("script-src 'self'{}; connect-src 'self'; img-src 'self'; manifest-src 'self'; ",
                        needs == PageNeeds::kWasm ? " 'wasm-unsafe-eval'" : "");
  return {.content_type = std::string(content_type),
          .fields = {{"Cache-Control", "no-cache"},
                     {"Content-Security-Policy",
                      fmt::format("default-src 'none'; style-src 'self'; {}base-uri 'none'; form-action 'none'; "
                                  "frame-ancestors 'none'",
                                  scripts)}}};
}

void put_file(http::Response& response, const http::Request& request, std::string_view entity_tag,
              std::string_view text) {
  response.fields.emplace_back("ETag", entity_tag);
  if (request.if_none_match == entity_tag)
    response.status = 304;
  else
    response.body = text;
}

std::optional<http::Response> page_answer(const http::Request& request) {
  if (request.method != "GET" && request.method != "HEAD") return std::nullopt;
  const std::span<const PageFile> files = page_files();
  const auto file = std::ranges::find(files, std::string_view(request.path), &PageFile::path);
  if (file == files.end()) return std::nullopt;
  http::Response response =
      page_response(file->content_type, file->path == kPictureAlone ? PageNeeds::kWasm : PageNeeds::kScript);
  put_file(response, request, file->entity_tag, file->text);
  return response;
}

}  // namespace yuragi::daemon::web
