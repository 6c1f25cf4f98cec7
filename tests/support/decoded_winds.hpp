#pragma once

#include <gtest/gtest.h>

#include "drivers/decode/decoded_wind.hpp"

namespace yuragi::test {

/// Passes if `decoded` was refused for this reason.
inline testing::AssertionResult is_refused_as(
    const Result<drivers::decode::DecodedWind, drivers::decode::Refusal>& decoded, drivers::decode::Refusal why) {
  if (!decoded && decoded.error() == why) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (decoded ? "accepted" : name_of(decoded.error())) << ", not " << name_of(why);
}

/// Passes if `decoded` was refused, or is what DecodedWind promises.
inline testing::AssertionResult is_refused_or_physical(
    const Result<drivers::decode::DecodedWind, drivers::decode::Refusal>& decoded) {
  if (!decoded) return testing::AssertionSuccess();
  const auto again = drivers::decode::checked(*decoded);
  return again ? testing::AssertionSuccess() : testing::AssertionFailure() << name_of(again.error());
}

}  // namespace yuragi::test
