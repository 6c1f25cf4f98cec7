#pragma once

#include <cstdint>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/places.hpp"

namespace yuragi::test {

/// The bytes of "01 03 ff"; the mark "xx" (any byte) is 0.
inline std::vector<std::uint8_t> hex_bytes(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::uint8_t> bytes;
  for (std::string word; in >> word;) {
    bytes.push_back(word == "xx" ? std::uint8_t{0} : static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
  }
  return bytes;
}

/// The entries of ../shared/data/vectors/NAME that have bytes and whose device begins so; none where the file is
/// absent.
inline std::vector<nlohmann::json> load_byte_vectors(std::string_view name, std::string_view device) {
  std::ifstream in(source_path("../shared/data/vectors/" + std::string(name)));
  const auto all = nlohmann::json::parse(in, nullptr, false);
  std::vector<nlohmann::json> chosen;
  if (!all.is_array()) return chosen;
  for (const auto& entry : all) {
    if (entry.value("device", "").starts_with(device)) chosen.push_back(entry);
  }
  return chosen;
}

/// Random bytes, `size` of them.
inline std::vector<std::uint8_t> random_bytes(std::mt19937_64& random, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

}  // namespace yuragi::test
