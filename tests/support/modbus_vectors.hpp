#pragma once

#include <cstdint>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/places.hpp"

namespace yuragi {

/// One exchange of the shared collection of Modbus frames.
struct ModbusVector {
  std::string device;
  std::vector<std::uint8_t> request;
  std::vector<std::uint8_t> response;
};

/// The bytes of "01 03 ff".
inline std::vector<std::uint8_t> bytes_of_hex(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::uint8_t> bytes;
  for (unsigned byte = 0; in >> std::hex >> byte;) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

/// All exchanges of ../shared/data/vectors/modbus_vectors.json; none where that file is absent.
inline std::vector<ModbusVector> load_modbus_vectors() {
  std::ifstream in(test::source_path("../shared/data/vectors/modbus_vectors.json"));
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());

  // The file is flat enough for a pattern: the three fields of an entry stand in this order.
  static const std::regex kEntry(
      R"re("device": "([^"]*)",\s*"kind": "[^"]*",\s*"request": "([^"]*)",\s*"response": "([^"]*)")re");
  std::vector<ModbusVector> vectors;
  for (std::sregex_iterator at(text.begin(), text.end(), kEntry), end; at != end; ++at) {
    vectors.push_back({(*at)[1], bytes_of_hex((*at)[2]), bytes_of_hex((*at)[3])});
  }
  return vectors;
}

}  // namespace yuragi
