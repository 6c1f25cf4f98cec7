#pragma once

#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace yuragi::daemon::tools::report {

/// Writes a page piece by piece. Its arguments are HTML: text from outside has to be escaped by page_text().
/// Thread-safe: no.
class PageWriter {
 public:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(html_), format, std::forward<Arguments>(arguments)...);
  }
  /// A row of a table of two columns; `value` is HTML.
  void row(std::string_view name, std::string_view value) { add("<tr><th>{}</th><td>{}</td></tr>\n", name, value); }
  void tile(std::string_view value, std::string_view name) {
    add("<div class=\"tile\"><b>{}</b><span>{}</span></div>\n", value, name);
  }
  void figure(std::string_view svg, std::string_view caption) {
    add("<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n", svg, caption);
  }
  std::string take() { return std::move(html_); }

 private:
  std::string html_;
};

}  // namespace yuragi::daemon::tools::report
