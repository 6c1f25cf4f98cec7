// A program of its own, since it decides what memory there is.
#include <atomic>
#include <new>

#include <gtest/gtest.h>

#include "tests/support/replaced_allocation.hpp"
#include "tests/viewer/stream_server.hpp"
#include "viewer/stream/stream_connection.hpp"

namespace {
constexpr std::size_t kLarge = std::size_t{256} * 1024;
std::atomic<bool> is_large_memory_gone = false;
}  // namespace

void* yuragi::test::allocate(std::size_t size) {
  if (is_large_memory_gone && size > kLarge) throw std::bad_alloc();
  return allocate_as_usual(size);
}

namespace yuragi::viewer::stream {
namespace {

TEST(StreamConnection, GivesUpWhereThereIsNoMemoryForAMessageAndTriesAgain) {
  const wire::Bytes hello = wire::encode(wire::Hello{wire::kProtocol, "a test", 60.0});
  StreamServer server(hello);
  const Connection connection({.host = "127.0.0.1", .port = server.port(), .min_backoff = std::chrono::seconds(1)});
  ASSERT_TRUE(server.wait_for_subscriptions(1));

  is_large_memory_gone = true;
  const wire::Bytes length = {0, 0, 0x40, 0};  // 4 MiB, of which the first one comes
  server.send(length);
  const wire::Bytes piece(kLarge / 4);
  for (int i = 0; i < 16; ++i) server.send(piece);
  EXPECT_TRUE(server.wait_for_subscriptions(2)) << "it has come again";
  is_large_memory_gone = false;
}

}  // namespace
}  // namespace yuragi::viewer::stream
