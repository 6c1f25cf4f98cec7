#include "engine/tables/parse_toml.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace yuragi::tables {
namespace {

/// Reads a document just closely enough to distinguish keys from values. An invalid document is misread only after its
/// first error, where the parser stops.
class LimitCheck {
 public:
  explicit LimitCheck(std::string_view text) : text_(text) {}

  /// Throws toml::parse_error.
  void run() {
    if (text_.size() > kMaxToml_bytes) {
      refuse(0, "too large: " + std::to_string(text_.size()) + " bytes (maximum " + std::to_string(kMaxToml_bytes) +
                    "); divide the file");
    }
    while (at_ < text_.size()) step();
  }

 private:
  /// An array or an inline table around the present place.
  struct Container {
    bool is_table;
    std::size_t levels;  ///< around it
  };

  void step() {
    const std::size_t begin = at_++;
    switch (text_[begin]) {
      case ' ':
      case '\t':
      case '\r':
        return;
      case '\n':
        if (containers_.empty()) begin_line();
        return;
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size());
        return;
      case '=':
        is_in_key_ = false;
        return;
      case ',':
        if (!containers_.empty() && containers_.back().is_table) begin_key();
        return;
      case '[':
        if (is_in_key_) {
          is_header_ = true;
          levels_ = 0;
        } else {
          open(false);
        }
        return;
      case '{':
        if (!is_in_key_) open(true);
        return;
      case ']':
        if (!is_in_key_) close();
        return;
      case '}':
        close();
        return;
      case '.':
        if (is_in_key_) ++key_parts_;
        break;
      case '"':
      case '\'':
        pass_string(begin);
        break;
      default:
        break;
    }
    if (is_in_key_) check_key(begin);
  }

  void begin_line() {
    if (is_header_) header_levels_ = key_parts_;
    is_header_ = false;
    levels_ = header_levels_;
    begin_key();
  }

  void begin_key() {
    is_in_key_ = true;
    key_parts_ = 1;
    key_bytes_ = 0;
  }

  /// The bytes from `begin` on belong to the key.
  void check_key(std::size_t begin) {
    if (key_bytes_ == 0) key_begin_ = begin;
    key_bytes_ += at_ - begin;
    if (key_bytes_ > kMaxTomlKey_bytes) {
      refuse(key_begin_, "this key is too long: more than " + std::to_string(kMaxTomlKey_bytes) + " bytes; shorten it");
    }
    check_levels(key_begin_);
  }

  void check_levels(std::size_t where) const {
    if (levels_ + key_parts_ <= kMaxTomlLevels) return;
    refuse(where, "nested too deeply: more than " + std::to_string(kMaxTomlLevels) +
                      " levels (parts of keys, and arrays); use fewer");
  }

  void open(bool is_table) {
    containers_.push_back({is_table, levels_});
    levels_ += key_parts_ + (is_table ? 0 : 1);
    key_parts_ = 0;
    check_levels(at_ - 1);
    if (is_table) begin_key();
  }

  void close() {
    is_in_key_ = false;
    key_parts_ = 0;
    if (containers_.empty()) return;
    levels_ = containers_.back().levels;
    containers_.pop_back();
  }

  void pass_string(std::size_t begin) {
    const char quote = text_[begin];
    const std::string three(3, quote);
    const bool is_long = text_.substr(begin, 3) == three;
    const std::string_view end = std::string_view(three).substr(0, is_long ? 3 : 1);
    at_ = begin + end.size();
    while (at_ < text_.size() && text_.substr(at_, end.size()) != end) {
      if (!is_long && text_[at_] == '\n') return;
      at_ += text_[at_] == '\\' && quote == '"' ? 2U : 1U;
    }
    at_ += end.size();
    // Two more quotes at its end are part of a long string.
    for (int more = 0; is_long && more < 2 && at_ < text_.size() && text_[at_] == quote; ++more) ++at_;
    at_ = std::min(at_, text_.size());
  }

  [[noreturn]] void refuse(std::size_t where, const std::string& what) const {
    const std::string_view before = text_.substr(0, where);
    const auto newlines = std::ranges::count(before, '\n');
    const std::string_view line = before.substr(before.rfind('\n') + 1);
    const auto characters = std::ranges::count_if(line, [](char byte) { return (byte & 0xC0) != 0x80; });
    throw toml::parse_error(what.c_str(), toml::source_position{static_cast<toml::source_index>(newlines + 1),
                                                                static_cast<toml::source_index>(characters + 1)});
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Container> containers_;
  std::size_t levels_ = 0;  ///< around the present key or value
  std::size_t header_levels_ = 0;
  bool is_header_ = false;
  bool is_in_key_ = true;
  std::size_t key_parts_ = 1;
  std::size_t key_bytes_ = 0;
  std::size_t key_begin_ = 0;
};

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view source_name) {
  LimitCheck(text).run();
  return toml::parse(text, source_name);
}

std::string toml_text(std::istream& in) {
  std::string text(kMaxToml_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace yuragi::tables
