#include <limits>

#include <gtest/gtest.h>

#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"

namespace yuragi::wire {
namespace {

template <class T>
T decoded(const Bytes& bytes) {
  return std::get<T>(decode(samples::body(bytes)).value());
}

TEST(WireRoundTrip, HelloComesBackAsItWas) {
  const Hello hello = decoded<Hello>(encode(samples::hello()));
  EXPECT_EQ(hello.protocol, kProtocol);
  EXPECT_EQ(hello.software, "yuragi 0.1.0");
  EXPECT_EQ(hello.tick_rate_hz, 60.0);
  EXPECT_EQ(hello.refused, "full");
}

TEST(WireRoundTrip, AHelloThatRefusesNobodySaysSo) {
  EXPECT_FALSE(decoded<Hello>(encode(Hello{})).refused.has_value());
}

TEST(WireRoundTrip, SubscribeComesBackAsItWas) {
  const Subscribe wish = decoded<Subscribe>(encode(samples::subscribe()));
  EXPECT_EQ(wish.protocol, kProtocol);
  EXPECT_TRUE(wish.poses);
  EXPECT_TRUE(wish.sensors);
  EXPECT_EQ(wish.client, "a wall in Morioka");
  EXPECT_FALSE(decoded<Subscribe>(encode(Subscribe{.poses = false, .client = ""})).poses);
}

TEST(WireRoundTrip, ScenesComeBackBitForBitAndPaddedToBlocks) {
  const Scenes sent = samples::scenes();
  const Scenes got = decoded<Scenes>(encode(sent));
  ASSERT_EQ(got.scenes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(got.scenes[i].name, sent.scenes[i].name);
    EXPECT_EQ(got.scenes[i].kind, "grass");
    const auto& a = std::get<StrandSkeleton>(sent.scenes[i].skeleton);
    const auto& b = std::get<StrandSkeleton>(got.scenes[i].skeleton);
    EXPECT_EQ(b.strand_count, a.strand_count);
    EXPECT_EQ(b.links_per_strand, a.links_per_strand);
    EXPECT_EQ(b.root_x_m, a.root_x_m);
    EXPECT_EQ(b.root_y_m, a.root_y_m);
    EXPECT_EQ(b.root_z_m, a.root_z_m);
    EXPECT_EQ(b.rest_x, a.rest_x);
    EXPECT_EQ(b.rest_y, a.rest_y);
    EXPECT_EQ(b.rest_z, a.rest_z);
    EXPECT_EQ(b.curl_x, a.curl_x);
    EXPECT_EQ(b.curl_y, a.curl_y);
    EXPECT_EQ(b.curl_z, a.curl_z);
    EXPECT_EQ(b.rest_curl_rad, a.rest_curl_rad);
    EXPECT_EQ(b.link_length_m, a.link_length_m);
  }
}

TEST(WireRoundTrip, AFrameComesBackWithinHalfAQuantisationStep) {
  const Frame frame = decoded<Frame>(samples::frame_bytes());
  const FrameInfo sent = samples::frame_info();
  EXPECT_EQ(frame.info.sequence, sent.sequence);
  EXPECT_EQ(frame.info.tick, sent.tick);
  EXPECT_EQ(frame.info.time_s, sent.time_s);
  EXPECT_EQ(frame.info.utc_ns, sent.utc_ns);
  EXPECT_EQ(frame.info.wind.wind.u_m_s, sent.wind.wind.u_m_s);
  EXPECT_EQ(frame.info.wind.wind.v_m_s, sent.wind.wind.v_m_s);
  EXPECT_EQ(frame.info.wind.source, sent.wind.source);
  EXPECT_EQ(frame.info.wind.live_weight, sent.wind.live_weight);
  EXPECT_EQ(frame.info.wind.reading_age_s, sent.wind.reading_age_s);

  ASSERT_EQ(frame.poses.size(), 2u);
  const StrandPose bends = samples::bent(37);
  const auto& got = std::get<StrandPose>(frame.poses[0]);
  ASSERT_EQ(got.bend_east_rad.size(), 48u);
  ASSERT_EQ(got.bend_south_rad.size(), 48u);
  const float half_step_rad = 3.14159265f / 32767.0f * 0.5001f;
  for (std::size_t i = 0; i < 48; ++i) {
    EXPECT_NEAR(got.bend_east_rad[i], bends.bend_east_rad[i], half_step_rad) << i;
    EXPECT_NEAR(got.bend_south_rad[i], bends.bend_south_rad[i], half_step_rad) << i;
  }
}

TEST(WireRoundTrip, AFrameFitsItsScenesAndNoOthers) {
  const Frame frame = decoded<Frame>(samples::frame_bytes());
  EXPECT_TRUE(fits(frame, samples::scenes()));
  EXPECT_FALSE(fits(frame, samples::scenes(49)));
  EXPECT_FALSE(fits(frame, Scenes{}));
}

TEST(WireRoundTrip, SensorsComeBackAndAMissingValueStaysMissing) {
  const Sensors sensors = decoded<Sensors>(encode(samples::sensors()));
  ASSERT_EQ(sensors.sensors.size(), 2u);
  const SensorStatus& gauge = sensors.sensors[0];
  EXPECT_EQ(gauge.name, "roof");
  EXPECT_EQ(gauge.driver, "modbus");
  EXPECT_EQ(gauge.link, 1);
  EXPECT_EQ(gauge.health, 2);
  EXPECT_EQ(gauge.detail, "answers again");
  EXPECT_EQ(gauge.speed_m_s, 0.0);
  EXPECT_EQ(gauge.direction_deg, 359.5);
  EXPECT_EQ(gauge.gust_m_s, std::nullopt);
  EXPECT_TRUE(gauge.simulated);
  EXPECT_EQ(gauge.age_s, 0.25);
  EXPECT_EQ(gauge.interval_s, 1.0);
  EXPECT_EQ(gauge.readings, 1234u);
  EXPECT_EQ(gauge.refused, samples::sensors().sensors[0].refused);
  EXPECT_EQ(sensors.sensors[1].speed_m_s, std::nullopt);
  EXPECT_EQ(sensors.wind.wind.u_m_s, 3.25);
  EXPECT_EQ(sensors.late_ticks, 5u);
  EXPECT_EQ(sensors.clients, 2u);
}

TEST(WireRoundTrip, ALongTextIsCutAtTheStartOfACharacter) {
  std::string text = "x";
  while (text.size() < 2 * kMaxTextBytes) text += "ゆ";  // three bytes each
  const auto client = decoded<Subscribe>(encode(Subscribe{.client = text})).client;
  EXPECT_EQ(client.size(), 1 + 3 * ((kMaxTextBytes - 1) / 3));
  EXPECT_EQ(client, text.substr(0, client.size()));
}

TEST(WireRoundTrip, ControlCharactersInATextAreDefused) {
  const std::string text =
      "a\x1b[31m\n\x7f\xc2\x9b"
      "b \xe3\x82\x86 \xc2\xa9";
  EXPECT_EQ(decoded<Subscribe>(encode(Subscribe{.client = text})).client, "a?[31m????b \xe3\x82\x86 \xc2\xa9");
}

TEST(WireRoundTrip, MessagesDecodeWhereverTheyLieInMemory) {
  for (const Bytes& message : samples::one_of_each()) {
    const auto body = samples::body(message);
    for (std::size_t shift = 0; shift < 9; ++shift) {
      Bytes moved(shift + body.size());
      std::copy(body.begin(), body.end(), moved.begin() + static_cast<std::ptrdiff_t>(shift));
      EXPECT_TRUE(decode(std::span(moved).subspan(shift)).has_value()) << shift;
    }
  }
}

TEST(WireRoundTrip, TheSizePrefixIsTheBodysSize) {
  for (const Bytes& message : samples::one_of_each()) {
    const auto length = read_size_prefix(std::span(message).first<kSizePrefixBytes>(), kMaxServerMessageBytes);
    EXPECT_EQ(length.value(), message.size() - kSizePrefixBytes);
  }
}

TEST(WireRoundTrip, ASubscriptionIsWithinWhatTheServerReads) {
  EXPECT_LE(encode(Subscribe{.client = std::string(99999, 'x')}).size(), kSizePrefixBytes + kMaxClientMessageBytes);
}

}  // namespace
}  // namespace yuragi::wire
