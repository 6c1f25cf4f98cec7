// The packets of lamps and fans, byte by byte, as the tables of ANSI E1.31-2018 and Art-Net 4 have them.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/feeds/artnet_packet.hpp"
#include "daemon/feeds/component_id.hpp"
#include "daemon/feeds/e131_packet.hpp"

namespace yuragi::daemon::feeds {
namespace {

using testing::ElementsAreArray;

DmxLevels some_levels() {
  DmxLevels levels{};
  levels[0] = 0x11;
  levels[1] = 0xFF;
  levels[511] = 0x7E;
  return levels;
}

std::vector<std::uint8_t> part_of(std::span<const std::uint8_t> bytes, std::size_t from, std::size_t end) {
  return {bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.begin() + static_cast<std::ptrdiff_t>(end)};
}

using Bytes = std::vector<std::uint8_t>;

TEST(E131PacketTest, HasTheFieldsOfTheStandard) {
  ComponentId component{};
  for (std::size_t i = 0; i < component.size(); ++i) component[i] = static_cast<std::uint8_t>(0xA0 + i);
  const auto packet = encode_e131(
      {.component = component, .source = "Yuragi hall", .priority = 150, .sequence = 0x21, .universe = 0x1234},
      some_levels());
  ASSERT_EQ(packet.size(), 638U);
  // Root layer: preamble, postamble, identifier "ASC-E1.17", flags and length 0x7000 + 622, vector 4, CID.
  EXPECT_THAT(part_of(packet, 0, 22),
              ElementsAreArray(Bytes{0x00, 0x10, 0x00, 0x00, 0x41, 0x53, 0x43, 0x2d, 0x45, 0x31, 0x2e,
                                     0x31, 0x37, 0x00, 0x00, 0x00, 0x72, 0x6e, 0x00, 0x00, 0x00, 0x04}));
  EXPECT_THAT(part_of(packet, 22, 38), ElementsAreArray(component));
  // Framing layer: 0x7000 + 600, vector 2, name, priority, synchronization 0, sequence, options, universe.
  EXPECT_THAT(part_of(packet, 38, 44), ElementsAreArray(Bytes{0x72, 0x58, 0x00, 0x00, 0x00, 0x02}));
  std::string name = "Yuragi hall";
  name.resize(64);
  EXPECT_THAT(part_of(packet, 44, 108), ElementsAreArray(Bytes(name.begin(), name.end())));
  EXPECT_THAT(part_of(packet, 108, 115), ElementsAreArray(Bytes{150, 0x00, 0x00, 0x21, 0x00, 0x12, 0x34}));
  // DMP layer: 0x7000 + 523, vector 2, types, first address 0, increment 1, count 513, start code 0.
  EXPECT_THAT(part_of(packet, 115, 126),
              ElementsAreArray(Bytes{0x72, 0x0b, 0x02, 0xa1, 0x00, 0x00, 0x00, 0x01, 0x02, 0x01, 0x00}));
  EXPECT_THAT(part_of(packet, 126, 638), ElementsAreArray(some_levels()));
}

TEST(E131PacketTest, TheLastPacketsAreMarked) {
  const auto packet = encode_e131({.source = "a", .is_terminated = true}, {});
  EXPECT_EQ(packet[112], 0x40);
}

TEST(E131PacketTest, ALongNameIsCutBetweenCharacters) {
  const std::string source = std::string(62, 'x') + "\u00fc" + "y";  // its last byte would be the 64th
  const auto packet = encode_e131({.source = source}, {});
  EXPECT_EQ(packet[44 + 61], 'x');
  EXPECT_EQ(packet[44 + 62], 0);
  EXPECT_EQ(packet[44 + 63], 0);
}

TEST(ArtNetPacketTest, HasTheFieldsOfTheStandard) {
  const auto packet = encode_artdmx(0x1234, 0x21, some_levels());
  ASSERT_EQ(packet.size(), 530U);
  // "Art-Net", OpDmx 0x5000, version 14, sequence, physical, subnet and universe, net, length 512.
  EXPECT_THAT(part_of(packet, 0, 18), ElementsAreArray(Bytes{0x41, 0x72, 0x74, 0x2d, 0x4e, 0x65, 0x74, 0x00, 0x00, 0x50,
                                                             0x00, 0x0e, 0x21, 0x00, 0x34, 0x12, 0x02, 0x00}));
  EXPECT_THAT(part_of(packet, 18, 530), ElementsAreArray(some_levels()));
}

TEST(ComponentIdTest, IsAUuidOfTheMachineAndTheFeed) {
  const ComponentId id = component_id_of("machine", "dmx");
  EXPECT_EQ(id, component_id_of("machine", "dmx"));
  EXPECT_NE(id, component_id_of("machine", "dmx 2"));
  EXPECT_NE(id, component_id_of("another", "dmx"));
  EXPECT_EQ(id[6] >> 4U, 5U) << "version";
  EXPECT_EQ(id[8] >> 6U, 2U) << "variant";
  EXPECT_EQ(machine_id(), machine_id());
}

}  // namespace
}  // namespace yuragi::daemon::feeds
