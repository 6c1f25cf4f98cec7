#include <cstdint>
#include <cstdlib>
#include <span>

#include "daemon/follow/history_stream.hpp"
#include "daemon/follow/questions.hpp"

// Hostile questions, reports and histories of followers, and replies of whoever writes to a follower's inbox. What is
// accepted is the same after it was written and read again.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace yuragi::daemon::follow;
  const std::span bytes(data, size);
  if (const auto question = decode_question(bytes)) {
    const auto again = decode_question(encode(*question));
    if (!again || again->epoch != question->epoch || again->from != question->from) std::abort();
  }
  if (const auto reply = decode_reply(bytes)) {
    const Bytes written = std::visit([](const auto& held) { return encode(held); }, *reply);
    if (!decode_reply(written)) std::abort();
  }
  if (const auto report = decode_node_report(bytes)) {
    if (!decode_node_report(encode(*report))) std::abort();
  }
  if (const auto history = decode_node_entries(bytes)) {
    if (!decode_node_entries(encode(*history))) std::abort();
  }
  (void)decode_stream_reply(bytes);
  return 0;
}
