// Any bytes as the answer of a web server, at places that are in the data, too; as a URL; and as a file of headers.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "drivers/bus/http_client.hpp"
#include "drivers/decode/json_pointer.hpp"
#include "drivers/decode/network/json_wind.hpp"
#include "drivers/json/headers_file.hpp"
#include "drivers/json/observation_watch.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

void read_answer(std::string_view answer, const decode::network::JsonPlaces& places) {
  const auto observation = decode::network::decode_json_wind(answer, places);
  if (!observation) return;
  require(observation->wind.speed_m_s.has_value());
  require(decode::checked(observation->wind).has_value());
  require(observation->time.size() <= decode::network::kMaxJsonTime);
  static_cast<void>(json::moment_of(observation->time));
  json::ObservationWatch watch(std::chrono::minutes(1), std::chrono::minutes(1));
  static_cast<void>(watch.take(*observation, {}));
  require(watch.take(*observation, {}) != json::Novelty::kNew);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_answer(text, {.speed = "/wind/speed", .direction = "/wind/direction", .gust = "/wind/gust", .time = "/time"});
  read_answer(text, {.speed = "/0", .direction = "/1", .gust = "/2", .time = "/3"});

  // The first line is a pointer, the rest the answer.
  const std::size_t end = text.find('\n');
  const std::string pointer(text.substr(0, end));
  if (end != std::string_view::npos && !pointer.empty() && decode::is_json_pointer(pointer))
    read_answer(text.substr(end + 1), {.speed = pointer, .direction = pointer, .gust = pointer, .time = pointer});

  static_cast<void>(json::moment_of(std::string(text)));
  if (const auto url = bus::url_parts(std::string(text))) require(!url->host.empty() && url->port != 0);
  if (const auto headers = json::headers_of(text)) {
    for (const Secret& header : *headers) require(header.reveal().find_first_of("\r\n") == std::string::npos);
  }
  return 0;
}
