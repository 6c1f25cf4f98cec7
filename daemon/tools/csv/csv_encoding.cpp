#include "daemon/tools/csv/csv_encoding.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <vector>

#include <iconv.h>

#include "engine/base/printable_text.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

/// Counts the zero bytes at even and at odd places.
std::array<std::size_t, 2> zeros_of(std::string_view text) {
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < text.size(); ++i) zeros[i % 2] += text[i] == '\0' ? 1U : 0U;
  return zeros;
}

/// JIS X 0201 and JIS X 0208 in Shift_JIS; some of it has bytes that Latin-1 leaves to control characters.
bool can_only_be_shift_jis(std::string_view text) {
  bool has_control = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char lead = byte_at(text, i);
    const bool is_katakana = lead >= 0xA1 && lead <= 0xDF;
    if (lead < 0x80 || is_katakana) continue;
    const bool is_control = lead >= 0x81 && lead <= 0x9F;
    if (!is_control && !(lead >= 0xE0 && lead <= 0xFC)) return false;
    if (++i == text.size()) break;  // cut in two
    const unsigned char trail = byte_at(text, i);
    if (trail < 0x40 || trail == 0x7F || trail > 0xFC) return false;
    has_control = has_control || is_control;
  }
  return has_control;
}

/// Without a character that its end cuts in two.
std::string_view without_cut_character(std::string_view text) {
  constexpr std::size_t kMaxBytes = 4;
  for (std::size_t i = 1; i < kMaxBytes && i <= text.size(); ++i) {
    const unsigned char byte = byte_at(text, text.size() - i);
    if (byte < 0x80) break;
    if (byte >= 0xC0) return text.substr(0, text.size() - i);
  }
  return text;
}

const char* iconv_name_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::kUtf16Little:
      return "UTF-16LE";
    case Encoding::kUtf16Big:
      return "UTF-16BE";
    case Encoding::kShiftJis:
      return "CP932";
    case Encoding::kLatin1:
      return "ISO-8859-1";
    case Encoding::kUtf8:
      break;
  }
  return "UTF-8";
}

FailureError system_failure(const char* what) {
  return FailureError({std::string(what) + ": " + std::system_category().message(errno), FailureKind::kUnavailable});
}

/// A file without a name, read as a stream.
class TemporaryFile final : public std::streambuf {
 public:
  TemporaryFile() : file_(std::tmpfile(), std::fclose) {
    if (!file_) throw system_failure("cannot make a temporary file for the converted text");
  }

  void write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size())
      throw system_failure("cannot write the converted text to a temporary file");
  }
  void begin() {
    if (std::fflush(file_.get()) != 0) throw system_failure("cannot write the converted text to a temporary file");
    std::rewind(file_.get());
  }

 private:
  int_type underflow() override {
    const std::size_t count = std::fread(block_.data(), 1, block_.size(), file_.get());
    setg(block_.data(), block_.data(), block_.data() + count);
    return count == 0 ? traits_type::eof() : traits_type::to_int_type(block_.front());
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override {
    if (from == std::ios_base::cur) {
      const long file = std::ftell(file_.get());
      const off_type here = file - (egptr() - gptr());
      if (offset == 0) return pos_type(here);
      return seekpos(pos_type(here + offset), which);
    }
    if (from == std::ios_base::end) return pos_type(off_type(-1));
    return seekpos(pos_type(offset), which);
  }
  pos_type seekpos(pos_type place, std::ios_base::openmode /*which*/) override {
    if (std::fseek(file_.get(), static_cast<long>(off_type(place)), SEEK_SET) != 0) return pos_type(off_type(-1));
    setg(block_.data(), block_.data(), block_.data());
    return place;
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::vector<char> block_ = std::vector<char>(std::size_t{1} << 16);
};

/// A stream that owns what it reads from.
class TemporaryStream final : public std::istream {
 public:
  explicit TemporaryStream(std::unique_ptr<TemporaryFile> file) : std::istream(file.get()), file_(std::move(file)) {}

 private:
  std::unique_ptr<TemporaryFile> file_;
};

/// Closes what iconv_open() opened.
class Converter {
 public:
  explicit Converter(Encoding encoding) : handle_(iconv_open("UTF-8", iconv_name_of(encoding))) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the documented value of failure
    if (handle_ == reinterpret_cast<iconv_t>(-1)) throw system_failure("this system cannot convert the encoding");
  }
  ~Converter() { iconv_close(handle_); }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;

  /// Converts what is whole of `bytes`, and leaves the rest there.
  std::string convert(std::string& bytes, bool is_last) {
    std::string text;
    char* from = bytes.data();
    std::size_t left = bytes.size();
    while (left > 0) {
      std::array<char, 4096> block;
      char* to = block.data();
      std::size_t room = block.size();
      const std::size_t done = iconv(handle_, &from, &left, &to, &room);
      const int error = errno;
      text.append(block.data(), block.size() - room);
      if (done != static_cast<std::size_t>(-1) || error == E2BIG) continue;
      if (error == EINVAL && !is_last) break;  // a character that the next bytes complete
      text += '?';
      ++from;
      --left;
    }
    bytes.erase(0, bytes.size() - left);
    return text;
  }

 private:
  iconv_t handle_;
};

}  // namespace

std::string_view name_of(Encoding encoding) {
  static constexpr std::array<std::string_view, 5> kNames = {"UTF-8", "UTF-16", "UTF-16 (big endian)", "Shift_JIS",
                                                             "Latin-1"};
  return kNames.at(static_cast<std::size_t>(encoding));
}

Encoding encoding_of(std::string_view beginning) {
  if (byte_at(beginning, 0) == 0xFF && byte_at(beginning, 1) == 0xFE) return Encoding::kUtf16Little;
  if (byte_at(beginning, 0) == 0xFE && byte_at(beginning, 1) == 0xFF) return Encoding::kUtf16Big;
  const auto [even, odd] = zeros_of(beginning);
  constexpr std::size_t kMinShare = 4;  // a quarter of all bytes
  if (kMinShare * odd > beginning.size() && even == 0) return Encoding::kUtf16Little;
  if (kMinShare * even > beginning.size() && odd == 0) return Encoding::kUtf16Big;
  if (is_utf8(without_cut_character(beginning))) return Encoding::kUtf8;
  return can_only_be_shift_jis(beginning) ? Encoding::kShiftJis : Encoding::kLatin1;
}

std::unique_ptr<std::istream> converted_to_utf8(std::istream& in, Encoding encoding) {
  auto file = std::make_unique<TemporaryFile>();
  Converter converter(encoding);
  std::string bytes;
  std::vector<char> block(std::size_t{1} << 16);
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    bytes.append(block.data(), static_cast<std::size_t>(in.gcount()));
    file->write(converter.convert(bytes, !in));
  }
  file->begin();
  return std::make_unique<TemporaryStream>(std::move(file));
}

}  // namespace yuragi::daemon::tools::csv
