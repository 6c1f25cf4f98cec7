#include "daemon/tools/csv/csv_input.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_foreign.hpp"
#include "daemon/tools/csv/csv_lines.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

/// A text that is read in place.
class TextInPlace : public std::streambuf {
 public:
  explicit TextInPlace(std::string& text, std::size_t size) { setg(text.data(), text.data(), text.data() + size); }

 private:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type place = offset + (from == std::ios_base::cur ? gptr() - eback() : 0);
    if (from == std::ios_base::end || place < 0 || place > egptr() - eback()) return pos_type(off_type(-1));
    setg(eback(), eback() + place, egptr());
    return pos_type(place);
  }
  pos_type seekpos(pos_type place, std::ios_base::openmode which) override {
    return seekoff(off_type(place), std::ios_base::beg, which);
  }
};

/// A text, followed by the rest of another stream.
class TextThenStream : public std::streambuf {
 public:
  TextThenStream(std::string& text, std::istream& rest) : rest_(rest) {
    setg(text.data(), text.data(), text.data() + text.size());
  }

 private:
  int_type underflow() override {
    rest_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
    const std::streamsize count = rest_.gcount();
    if (count <= 0) return traits_type::eof();
    setg(block_.data(), block_.data(), block_.data() + count);
    return traits_type::to_int_type(block_.front());
  }

  std::istream& rest_;
  std::vector<char> block_ = std::vector<char>(std::size_t{1} << 16);
};

}  // namespace

Input::Input(std::istream& in) : in_(&in), begin_(in.tellg()) {
  constexpr std::size_t kExamined = std::size_t{1} << 16;
  if (begin_ == std::streampos(-1)) {
    keep();
    examine(std::string_view(kept_).substr(0, kExamined));
  } else {
    std::string beginning(kExamined, '\0');
    in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    examine(std::string_view(beginning).substr(0, static_cast<std::size_t>(in.gcount())));
    in.clear();
    in.seekg(begin_);
  }
  if (encoding_ == Encoding::kUtf8 || foreign_) return;
  if (begin_ == std::streampos(-1)) join();
  converted_ = converted_to_utf8(stream_ ? *stream_ : in, encoding_);
  in_ = converted_.get();
  begin_ = 0;
  is_whole_ = true;
}

void Input::examine(std::string_view beginning) {
  encoding_ = encoding_of(beginning);
  foreign_ = foreign_kind(beginning);
}

/// Keeps the beginning of a pipe.
void Input::keep() {
  in_->clear();
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  while (*in_ && kept_.size() < kMaxKept) {
    const std::size_t size = kept_.size();
    kept_.resize(size + kBlock);
    in_->read(kept_.data() + size, kBlock);
    kept_.resize(size + static_cast<std::size_t>(in_->gcount()));
  }
  is_whole_ = in_->eof();
}

/// Makes the whole of a pipe one stream.
void Input::join() {
  kept_buffer_.reset();
  joined_ = std::make_unique<TextThenStream>(kept_, *in_);
  stream_ = std::make_unique<std::istream>(joined_.get());
}

std::istream& Input::first_pass() {
  if (begin_ != std::streampos(-1)) {
    in_->clear();
    in_->seekg(begin_);
    return *in_;
  }
  const auto end = is_whole_ ? kept_.size() : std::min(kept_.size(), kept_.rfind('\n') + 1);
  kept_buffer_ = std::make_unique<TextInPlace>(kept_, end);
  stream_ = std::make_unique<std::istream>(kept_buffer_.get());
  return *stream_;
}

std::istream& Input::second_pass() {
  if (is_whole_) return first_pass();
  join();
  return *stream_;
}

Failure too_long_line(const std::string& name, std::size_t number) {
  return {name + ":" + std::to_string(number) + ": a line is longer than a megabyte; is it a CSV file?"};
}

Result<std::vector<std::string>, Failure> first_lines(Input& input, const std::string& name) {
  if (input.foreign()) return Failure{fmt::format("{}: is {}", name, *input.foreign())};
  std::vector<std::string> texts;
  Lines lines(input.first_pass(), 0);
  constexpr std::size_t kMaxLines = 400;
  constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
  for (std::size_t bytes = 0; texts.size() < kMaxLines && bytes < kMaxBytes && lines.next();) {
    texts.resize(lines.number() - 1);  // of the empty lines that were passed over
    const std::span<char> line = lines.line();
    texts.emplace_back(line.begin(), line.end());
    bytes += line.size();
  }
  if (lines.is_too_long()) return too_long_line(name, lines.number() + 1);
  return texts;
}

}  // namespace yuragi::daemon::tools::csv
