#include "daemon/follow/nkey.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::follow {
namespace {

// A pair of the documentation of NATS.
const char* const kSeed = "SUACSSL3UAHUDXKFSNVUZRF5UHPMWZ6BFDTJ7M6USDXIEDNPPQYYYCU3VY";

TEST(NkeyTest, TheSeedOfAUserHasItsPublicKey) {
  EXPECT_EQ(public_nkey(Secret(kSeed)), "UDXU4RCSJNZOIQHZNWXHXORDPRTGNJAHAHFRGZNEEJCPQTT2M7NLCNF4");
}

TEST(NkeyTest, AnInvalidSeedHasNone) {
  std::string seed = kSeed;
  EXPECT_EQ(public_nkey(Secret()), std::nullopt);
  EXPECT_EQ(public_nkey(Secret(seed + "AA")), std::nullopt);
  EXPECT_EQ(public_nkey(Secret(seed.substr(1))), std::nullopt);
  EXPECT_EQ(public_nkey(Secret("UDXU4RCSJNZOIQHZNWXHXORDPRTGNJAHAHFRGZNEEJCPQTT2M7NLCNF4")), std::nullopt);
  for (std::size_t i = 0; i < seed.size(); ++i) {
    std::string hurt = seed;
    hurt[i] = hurt[i] == 'B' ? 'C' : 'B';
    EXPECT_EQ(public_nkey(Secret(hurt)), std::nullopt) << i;
    hurt[i] = '1';  // not of base32
    EXPECT_EQ(public_nkey(Secret(hurt)), std::nullopt) << i;
  }
}

}  // namespace
}  // namespace yuragi::daemon::follow
