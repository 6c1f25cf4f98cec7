#include "daemon/tools/csv/csv_lines.hpp"

#include <algorithm>
#include <istream>

namespace yuragi::daemon::tools::csv {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// Trims and unquotes a field in place.
std::string_view plain_field(std::span<char> field) {
  while (!field.empty() && is_blank(field.front())) field = field.subspan(1);
  while (!field.empty() && is_blank(field.back())) field = field.first(field.size() - 1);
  if (field.size() < 2 || field.front() != '"' || field.back() != '"') return {field.data(), field.size()};

  field = field.subspan(1, field.size() - 2);
  std::size_t size = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field[i] == '"' && i + 1 < field.size() && field[i + 1] == '"') ++i;
    field[size++] = field[i];
  }
  return {field.data(), size};
}

}  // namespace

Lines::Lines(std::istream& in, char comment) : in_(in), comment_(comment), buffer_(kMaxLine + 1) {}

bool Lines::next() {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  while (in_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()))) {
    // gcount() includes the line end, which the last line may lack.
    size_ = static_cast<std::size_t>(in_.gcount()) - (in_.eof() ? 0 : 1);
    ++number_;
    if (size_ > 0 && buffer_[size_ - 1] == '\r') --size_;
    if (number_ == 1 && std::string_view(buffer_.data(), size_).starts_with(kByteOrderMark)) {
      std::copy(buffer_.begin() + kByteOrderMark.size(), buffer_.begin() + static_cast<std::ptrdiff_t>(size_),
                buffer_.begin());
      size_ -= kByteOrderMark.size();
    }
    const std::span<const char> text = line();
    const bool is_comment = comment_ != 0 && !text.empty() && text.front() == comment_;
    if (!is_comment && number_ >= first_ && !std::ranges::all_of(text, is_blank)) return true;
  }
  is_too_long_ = !in_.eof() && !in_.bad();
  return false;
}

void Lines::go_to(std::streamoff place, std::size_t number_before) {
  in_.clear();
  in_.seekg(place);
  number_ = number_before;
}

std::streamoff Lines::place() const {
  return in_.eof() ? -1 : static_cast<std::streamoff>(in_.tellg());
}

bool split_csv_line(std::span<char> line, char delimiter, std::vector<std::string_view>& fields) {
  fields.clear();
  const bool is_split_at_blanks = delimiter == ' ';
  if (is_split_at_blanks) {
    while (!line.empty() && is_blank(line.front())) line = line.subspan(1);
    while (!line.empty() && is_blank(line.back())) line = line.first(line.size() - 1);
  }
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') is_quoted = !is_quoted;
    const bool is_delimiter = is_split_at_blanks ? is_blank(line[i]) : line[i] == delimiter;
    if (!is_delimiter || is_quoted) continue;
    // Of several blanks only the last one separates.
    if (is_split_at_blanks && i + 1 < line.size() && is_blank(line[i + 1])) continue;
    fields.push_back(plain_field(line.subspan(begin, i - begin)));
    begin = i + 1;
  }
  fields.push_back(plain_field(line.subspan(begin)));
  return !is_quoted;
}

std::vector<std::string> fields_of(std::string_view line, char delimiter) {
  std::string text(line);
  std::vector<std::string_view> fields;
  if (!split_csv_line(text, delimiter, fields)) return {};
  return {fields.begin(), fields.end()};
}

}  // namespace yuragi::daemon::tools::csv
