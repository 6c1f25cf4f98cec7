#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "engine/wire/wire.hpp"

// Messages for the tests of the stream, with something in every field.

namespace yuragi::samples {

/// A meadow of strands at scattered places, leaning and curling every which way.
inline StrandSkeleton meadow(std::size_t strand_count, std::size_t links_per_strand = 10) {
  std::mt19937 random(1);
  const auto uniform = [&random](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 10001u) / 10000.0f;
  };
  StrandSkeleton s;
  s.strand_count = strand_count;
  s.links_per_strand = links_per_strand;
  for (auto* values : {&s.root_x_m, &s.root_y_m, &s.root_z_m, &s.rest_x, &s.rest_y, &s.rest_z, &s.curl_x, &s.curl_y,
                       &s.curl_z, &s.rest_curl_rad, &s.link_length_m})
    values->assign(s.padded_count(), 0.0f);
  for (std::size_t i = 0; i < strand_count; ++i) {
    s.root_x_m[i] = uniform(-5.0f, 5.0f);
    s.root_y_m[i] = uniform(0.0f, 0.2f);
    s.root_z_m[i] = uniform(-5.0f, 5.0f);
    const float tilt = uniform(0.0f, 1.5f);
    const float around = uniform(0.0f, 6.28f);
    s.rest_x[i] = std::sin(tilt) * std::cos(around);
    s.rest_y[i] = std::cos(tilt);
    s.rest_z[i] = std::sin(tilt) * std::sin(around);
    s.curl_x[i] = std::cos(tilt) * std::cos(around);
    s.curl_y[i] = -std::sin(tilt);
    s.curl_z[i] = std::cos(tilt) * std::sin(around);
    s.rest_curl_rad[i] = uniform(-0.1f, 0.1f);
    s.link_length_m[i] = uniform(0.02f, 0.1f);
  }
  return s;
}

inline StrandPose bent(std::size_t strand_count, float largest_rad = 1.5f) {
  std::mt19937 random(2);
  StrandPose pose;
  for (auto* values : {&pose.bend_east_rad, &pose.bend_south_rad}) {
    values->assign(padded_to_blocks(strand_count), 0.0f);
    for (std::size_t i = 0; i < strand_count; ++i)
      (*values)[i] = largest_rad * (static_cast<float>(random() % 20001u) / 10000.0f - 1.0f);
  }
  return pose;
}

inline WindState wind() {
  return {.wind = {3.25, -4.5}, .source = WindSource::kHandover, .live_weight = 0.75, .reading_age_s = 1.5};
}

inline wire::Hello hello() {
  return {.software = "yuragi 0.1.0", .tick_rate_hz = 60.0, .refused = "full"};
}

inline wire::Subscribe subscribe() {
  return {.poses = true, .sensors = true, .client = "a wall in Morioka"};
}

inline wire::Scenes scenes(std::size_t strand_count = 37) {
  return {{{"meadow", "grass", meadow(strand_count)}, {"bank", "grass", meadow(3, 1)}}};
}

inline wire::FrameInfo frame_info() {
  return {.sequence = 7, .tick = 11, .time_s = 0.18, .utc_ns = 1'700'000'000'000'000'000, .wind = wind()};
}

/// The frame of scenes(strand_count), as its bytes.
inline wire::Bytes frame_bytes(std::size_t strand_count = 37, const wire::FrameInfo& info = frame_info()) {
  const wire::Scenes set = scenes(strand_count);
  const Pose a = bent(strand_count);
  const Pose b = bent(3);
  const std::vector<const Skeleton*> skeletons{&set.scenes[0].skeleton, &set.scenes[1].skeleton};
  const std::vector<const Pose*> poses{&a, &b};
  wire::FrameEncoder encoder;
  const auto bytes = encoder.encode(info, skeletons, poses);
  return {bytes.begin(), bytes.end()};
}

inline wire::Sensors sensors() {
  wire::SensorStatus gauge;
  gauge.name = "roof";
  gauge.driver = "modbus";
  gauge.link = 1;
  gauge.health = 2;
  gauge.detail = "answers again";
  gauge.speed_m_s = 0.0;
  gauge.direction_deg = 359.5;
  gauge.simulated = true;
  gauge.age_s = 0.25;
  gauge.interval_s = 1.0;
  gauge.readings = 1234;
  gauge.refused = {{"timeout", 3}, {"exception", 1}};
  return {.sensors = {gauge, {}}, .wind = wind(), .late_ticks = 5, .clients = 2};
}

/// One of each, with its size prefix.
inline std::vector<wire::Bytes> one_of_each() {
  return {wire::encode(hello()), wire::encode(subscribe()), wire::encode(scenes()), frame_bytes(),
          wire::encode(sensors())};
}

/// What decode() takes: the bytes behind the size prefix.
inline std::span<const std::uint8_t> body(const wire::Bytes& message) {
  return std::span(message).subspan(wire::kSizePrefixBytes);
}

}  // namespace yuragi::samples
