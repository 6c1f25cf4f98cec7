#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace yuragi::daemon::settings {

/// Converts lines and columns of TOML (in code points, from 1) to byte offsets in the text.
class TextPlaces {
 public:
  /// `text` must outlive this object.
  explicit TextPlaces(std::string_view text) : text_(text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    starts_.push_back(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') starts_.push_back(i + 1);
    }
  }

  std::size_t at(const toml::source_position& place) const {
    std::size_t offset = line_start(place.line);
    for (toml::source_index column = 1; column < place.column && offset < text_.size(); ++column) {
      ++offset;
      while (offset < text_.size() && (static_cast<unsigned char>(text_[offset]) & 0xC0U) == 0x80U) ++offset;
    }
    return offset;
  }
  /// The offset of a line, from 1; after the last one the end of the text.
  std::size_t line_start(std::size_t line) const {
    return line == 0 ? 0 : line <= starts_.size() ? starts_[line - 1] : text_.size();
  }
  std::size_t line_count() const { return starts_.size(); }

  /// A line, trimmed.
  std::string_view trimmed_line(std::size_t line) const {
    std::string_view content = text_.substr(line_start(line), line_start(line + 1) - line_start(line));
    content.remove_prefix(std::min(content.find_first_not_of(" \t"), content.size()));
    return content.substr(0, content.find_last_not_of(" \t\r\n") + 1);
  }
  std::string_view indentation(std::size_t line) const {
    const std::string_view content = text_.substr(line_start(line));
    return content.substr(0, std::min(content.find_first_not_of(" \t"), content.size()));
  }
  std::string_view line_end() const { return text_.find("\r\n") != std::string_view::npos ? "\r\n" : "\n"; }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

}  // namespace yuragi::daemon::settings
