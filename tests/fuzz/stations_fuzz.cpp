// Any bytes as a message of a hub of weather stations.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/decode/network/tempest.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (const auto message = decode::network::decode_tempest({reinterpret_cast<const char*>(data), size})) {
    require(!message->serial_number.empty() && !message->hub_serial_number.empty());
    require(!message->wind || decode::checked(*message->wind).has_value());
    require(!message->wind || message->wind->speed_m_s.has_value());
  }
  return 0;
}
