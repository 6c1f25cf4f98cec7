#include "drivers/bus/callback_exception.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::drivers::bus {
namespace {

using testing::ThrowsMessage;

TEST(CallbackException, IsKeptUntilTheLibraryHasReturnedAndThrownOnce) {
  CallbackException thrown;
  thrown.keep_from([] {});
  EXPECT_NO_THROW(thrown.rethrow());
  thrown.keep_from([] { throw std::runtime_error("first"); });
  thrown.keep_from([] { throw std::runtime_error("second"); });
  EXPECT_THAT([&] { thrown.rethrow(); }, ThrowsMessage<std::runtime_error>("first"));
  EXPECT_NO_THROW(thrown.rethrow());
}

}  // namespace
}  // namespace yuragi::drivers::bus
