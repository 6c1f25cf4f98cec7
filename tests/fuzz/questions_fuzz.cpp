#include <cstdint>
#include <cstdlib>
#include <span>

#include "daemon/follow/questions.hpp"

// Hostile questions and reports of followers, and replies of whoever writes to a follower's inbox. What is accepted is
// the same after it was written and read again.

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
  return 0;
}
