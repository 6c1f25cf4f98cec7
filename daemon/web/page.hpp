#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "daemon/http/server.hpp"

namespace yuragi::daemon::web {

/// One of the files that make the page; all of them are compiled in.
struct PageFile {
  std::string_view path;  ///< "/page.js"
  std::string_view content_type;
  std::string_view entity_tag;  ///< a digest of the text, in quotes (R. Fielding and others, RFC 9110, 2022, 8.8.3)
  std::string_view text;
};

std::span<const PageFile> page_files();

/// What a file of the daemon's own pages needs of the browser.
enum class PageNeeds {
  kStyle,   ///< a page to read: its style sheet alone
  kScript,  ///< scripts, pictures and answers of the daemon
  kWasm,    ///< and it compiles WebAssembly, as the picture does
};

/// Returns the answer for a file of the daemon's own pages, still without its text. A browser keeps it but asks for it
/// again each time, and may load for it only what it needs of the daemon's own files and answers, and no script or
/// style within a page's text (W3C, Content Security Policy Level 3).
http::Response page_response(std::string_view content_type, PageNeeds needs);

/// Puts a file into the answer to a request, or, if the browser has it already by its entity tag, 304 (RFC
/// 9110, 13.1.2).
void put_file(http::Response& response, const http::Request& request, std::string_view entity_tag,
              std::string_view text);

/// The file of the page that a GET or HEAD asks for, or that the browser has it already (304). Nullopt: it asks for
/// something else. The files are the same for everybody and hold no secret. Pure.
std::optional<http::Response> page_answer(const http::Request& request);

}  // namespace yuragi::daemon::web
