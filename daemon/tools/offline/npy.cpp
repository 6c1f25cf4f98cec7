#include "daemon/tools/offline/npy.hpp"

#include <bit>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they stand in memory");

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

  platform::OutputFile output(file, true);
  std::ofstream out(output.working_path(), std::ios::binary);
  const std::string header = npy_header(shape);
  out.write(header.data(), static_cast<std::streamsize>(header.size()));
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
  // Closing writes what is still buffered: only then is it known whether all was written.
  out.close();
  if (!out) {
    throw FailureError({"cannot write " + file.string() + "; is its folder writable, and the disk not full?",
                        FailureKind::kCannotCreate});
  }
  output.commit().value();
}

}  // namespace yuragi::daemon::tools::offline
