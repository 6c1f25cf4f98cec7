// Any bytes of a client of [osc_query]: as a request, as frames behind a good request for a WebSocket, or as the text
// of a good frame. It is answered or disconnected, no handler throws, and the next client is served.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "daemon/feeds/osc_query_feed.hpp"
#include "engine/base/address.hpp"
#include "engine/base/contain.hpp"
#include "tests/fuzz/web_client.hpp"

namespace {

using namespace yuragi;

void require(bool holds) {
  if (!holds) std::abort();
}

/// A feed that gets moments as fast as it takes them, for as long as the program runs.
Address serve() {
  // Never destroyed: the thread goes on until the program has ended.
  static daemon::feeds::Feed* const feed =
      daemon::feeds::make_osc_query_feed({.listen = "127.0.0.1:0", .name = "fuzz"}, {}).release();
  daemon::values::Moment moment;
  moment.sensors.resize(1);
  moment.names = std::make_shared<const daemon::values::Names>(daemon::values::Names{.sensors = {"roof"}});
  feed->send(moment);
  Address address = parse_address(feed->status().target).value();
  std::thread([moment]() mutable {
    for (int tick = 0;; ++tick) {
      moment.time_s = tick * 0.001;
      moment.mono = MonoTime(from_seconds(moment.time_s));
      contain("a feed", [&] { feed->send(moment); });
      std::this_thread::yield();
    }
  }).detach();
  return address;
}

std::optional<fuzz::WebReply> reply_to(const std::string& request, const std::string& frames) {
  static const Address address = serve();
  return fuzz::web_reply(address, request, frames);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  report_faults_to([](std::string_view, const char*) noexcept { std::abort(); });
  if (size == 0 || size > 60'000) return 0;
  const std::string rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::string request = fuzz::web_socket_request("/"), frames;
  switch (data[0] % 4) {
    case 0:
      request = rest;
      break;
    case 1:
      request = "GET " + rest + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
      break;
    case 2:
      frames = rest;
      break;
    default:
      frames = fuzz::web_socket_frame(1, rest);
  }
  const auto reply = reply_to(request, frames);
  require(!reply || reply->head.empty() || reply->head.starts_with("HTTP/1.1 "));
  require(!reply || !reply->head.starts_with("HTTP/1.1 500"));
  static unsigned count = 0;
  if (++count % 64 != 0) return 0;
  const auto served = reply_to("GET /?HOST_INFO HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n", "");
  require(!served || served->head.empty() || served->rest.find("\"NAME\":\"fuzz\"") != std::string::npos);
  return 0;
}
