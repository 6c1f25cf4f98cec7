// The Kestrel: its lines, and what it can do wrong, with a simulator at the other end of a real wire.
#include "drivers/decode/text/kestrel.hpp"

#include <gtest/gtest.h>

#include "drivers/text/byte_port_parameters.hpp"
#include "tests/support/text_fault_bench.hpp"

namespace yuragi::simulators::text {
std::unique_ptr<Device> make_kestrel();
}

namespace yuragi::drivers::text {
std::unique_ptr<sensor::Sensor> make_kestrel_sensor(const ParameterValues& values, std::unique_ptr<bus::BytePort> port);

namespace {

using decode::Refusal;
using decode::text::decode_kestrel;
using simulators::core::FaultKind;

TEST(Kestrel, ReadsTheLinesOfItsManual) {
  const auto wind = decode_kestrel("$K,003.4,231.0*4C");
  ASSERT_TRUE(wind);
  EXPECT_EQ(wind->speed_m_s, 3.4);
  EXPECT_EQ(wind->direction_deg, 231.0);
}

TEST(Kestrel, RefusesWhatIsNone) {
  EXPECT_EQ(decode_kestrel("").error(), Refusal::kTooShort);
  EXPECT_EQ(decode_kestrel("$K,003.4,231.0").error(), Refusal::kBadChecksum);
  EXPECT_EQ(decode_kestrel("$K,003.4,231.0*4D").error(), Refusal::kBadChecksum);
  EXPECT_EQ(decode_kestrel("$L,003.4,231.0*4B").error(), Refusal::kNotMine);
  EXPECT_EQ(decode_kestrel("$K,003.4*4E").error(), Refusal::kMalformed);
  EXPECT_EQ(decode_kestrel("$K,903.4,231.0*45").error(), Refusal::kImplausible);
}

class KestrelFault : public TextFaultBench {
 protected:
  KestrelFault() : TextFaultBench("kestrel", {.speed_m_s = 7.0, .direction_deg = 123.0}) {}

  void SetUp() override {
    connect(Wire::kPty, simulators::text::make_kestrel(), 4.0, {}, [](const ParameterValues& values, TextBench& bench) {
      return make_kestrel_sensor(values, bench.port(byte_port_address_of(values)));
    });
    ASSERT_TRUE(is_live());
  }
  void expect_only_the_wind() override {
    for (const wind::Reading& reading : bench_.sink.readings) {
      EXPECT_EQ(reading.speed_m_s, 7.0);
      EXPECT_EQ(reading.direction_deg, 123.0);
    }
  }
};

TEST_F(KestrelFault, Silence) {
  bench_.run(1.0, FaultKind::kSilence);
  expect_silence(FaultKind::kSilence, 8.0);
  expect_return();
}

TEST_F(KestrelFault, BadChecksum) {
  bench_.run(1.0, FaultKind::kBadChecksum);
  bench_.run(5.0, FaultKind::kBadChecksum);
  EXPECT_TRUE(bench_.sink.readings.empty());
  EXPECT_GE(bench_.sink.count(Refusal::kBadChecksum), 18);
  expect_return();
}

}  // namespace
}  // namespace yuragi::drivers::text
