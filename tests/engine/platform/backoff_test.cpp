#include "engine/platform/backoff.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace yuragi::platform {
namespace {

using namespace std::chrono_literals;

TEST(Backoff, DoublesUpToItsCapAndIsTheSameForASeed) {
  Backoff one(250ms, 10s, 42), same(250ms, 10s, 42), other(250ms, 10s, 43);
  Nanoseconds full = 250ms;
  bool differs = false;
  for (int i = 0; i < 50; ++i) {
    const Nanoseconds wait = one.next();
    EXPECT_EQ(wait, same.next());
    differs = differs || wait != other.next();
    EXPECT_LE(wait, full);
    EXPECT_GE(wait, full * 3 / 4);
    full = std::min<Nanoseconds>(2 * full, 10s);
  }
  EXPECT_TRUE(differs);
  one.reset();
  EXPECT_LE(one.next(), 250ms);
}

}  // namespace
}  // namespace yuragi::platform
