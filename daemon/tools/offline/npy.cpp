#include "daemon/tools/offline/npy.hpp"

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/base/result.hpp"

namespace yuragi {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they stand in memory");

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw FailureError({fmt::format("cannot write {}: {}", file.string(), reason), FailureKind::kCannotCreate});
}

/// A file beside the wanted one, which is removed unless it has taken the wanted one's name.
class PartialFile {
 public:
  explicit PartialFile(const std::filesystem::path& target)
      : target_(target), path_(target.string() + fmt::format(".part-{}", ::getpid())) {
    stream_.reset(std::fopen(path_.c_str(), "wbx"));
    if (!stream_) fail(target_, std::generic_category().message(errno));
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    stream_.reset();
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(path_, ignored);
  }

  void write(const void* bytes, std::size_t count) {
    if (std::fwrite(bytes, 1, count, stream_.get()) != count) fail(target_, std::generic_category().message(errno));
  }

  void commit() {
    // Closing writes what is still buffered: only now is it known whether all of it found room.
    if (std::fclose(stream_.release()) != 0) fail(target_, std::generic_category().message(errno));
    std::error_code error;
    std::filesystem::rename(path_, target_, error);
    if (error) fail(target_, error.message());
    committed_ = true;
  }

 private:
  struct Close {
    void operator()(std::FILE* stream) const noexcept { static_cast<void>(std::fclose(stream)); }
  };

  std::filesystem::path target_;
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> stream_;
  bool committed_ = false;
};

}  // namespace

std::string npy_header(std::span<const std::size_t> shape) {
  // Magic, version, length, and the description padded with spaces so that the values start at a multiple of 64.
  std::string description = "{'descr': '<f4', 'fortran_order': False, 'shape': (";
  for (const std::size_t length : shape) description += fmt::format("{},", length);
  description += "), }";

  constexpr std::size_t kPreamble = 10;
  constexpr std::size_t kAlignment = 64;
  const std::size_t unpadded = kPreamble + description.size() + 1;
  description.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  description += '\n';

  const auto length = static_cast<std::uint16_t>(description.size());
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(length & 0xffU);
  header += static_cast<char>(length >> 8U);
  return header + description;
}

void write_npy(const std::filesystem::path& file, std::span<const std::size_t> shape, std::span<const float> values) {
  std::size_t count = 1;
  for (const std::size_t length : shape) count *= length;
  if (count != values.size()) throw std::logic_error("the shape does not hold the values");

  // Renaming onto a device or a link would replace it: follow links, and leave everything but files alone.
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail(file, "it exists and is not a regular file");
  }
  const auto target = std::filesystem::exists(status) ? std::filesystem::canonical(file) : file;

  PartialFile partial(target);
  const std::string header = npy_header(shape);
  partial.write(header.data(), header.size());
  partial.write(values.data(), values.size_bytes());
  partial.commit();
}

}  // namespace yuragi
