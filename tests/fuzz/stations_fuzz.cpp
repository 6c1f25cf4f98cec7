// Any bytes as a message of a hub of weather stations, as the reply of a gateway (its size and sum are mended, too, so
// that values are reached), and as a push.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decode/network/ecowitt.hpp"
#include "drivers/decode/network/ecowitt_gateway.hpp"
#include "drivers/decode/network/station_push.hpp"
#include "drivers/decode/network/tempest.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

void read_reply(decode::ByteSpan reply) {
  if (const auto values = decode::network::decode_ecowitt(reply)) {
    require(reply.size() == *decode::network::ecowitt_reply_size(reply));
    require(!values->wind || decode::checked(*values->wind).has_value());
    require(!values->wind || values->wind->speed_m_s.has_value());
  }
}

void read_mended_reply(decode::ByteSpan items) {
  const std::size_t size = items.size() + 4;
  std::vector<std::uint8_t> reply = {0xFF, 0xFF, 0x27, static_cast<std::uint8_t>((size >> 8U) & 0xFFU),
                                     static_cast<std::uint8_t>(size & 0xFFU)};
  reply.insert(reply.end(), items.begin(), items.end());
  reply.push_back(static_cast<std::uint8_t>(decode::sum_16(decode::ByteSpan(reply).subspan(2)) & 0xFFU));
  read_reply(reply);
}

void read_push(std::string_view target) {
  const auto parts = decode::network::split_push_target(target);
  require(parts.path.size() + parts.form.size() <= target.size());
  const std::string wslink = "wsid=a&" + std::string(parts.form);
  for (const std::string_view form : {target, parts.form, std::string_view(wslink)}) {
    const auto push = decode::network::decode_station_push(form);
    if (!push) continue;
    require(!push->wind || decode::checked(*push->wind).has_value());
    require(!push->wind || push->wind->speed_m_s.has_value());
    require(decode::network::push_text(push->kind).size() <= 40);
    const std::string shown = decode::network::without_push_secrets(form);
    require(shown.find("PASSKEY=") == shown.npos || shown.find("PASSKEY=(secret)") != shown.npos);
    require(shown.find("wspw=") == shown.npos || shown.find("wspw=(secret)") != shown.npos);
    require(shown.find("PASSWORD=") == shown.npos || shown.find("PASSWORD=(secret)") != shown.npos);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (const auto message = decode::network::decode_tempest({reinterpret_cast<const char*>(data), size})) {
    require(!message->serial_number.empty() && !message->hub_serial_number.empty());
    require(!message->wind || decode::checked(*message->wind).has_value());
    require(!message->wind || message->wind->speed_m_s.has_value());
  }
  read_push({reinterpret_cast<const char*>(data), size});
  if (const auto gateway = decode::network::decode_ecowitt_gateway({data, size})) {
    require(gateway->mac.size() == 17 && gateway->port != 0);
  }
  read_reply({data, size});
  read_mended_reply({data, size});
  return 0;
}
