#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>

#include "engine/wire/schema.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::wire {
namespace {

static_assert(std::endian::native == std::endian::little);

// Far beyond every real model, and small enough that sums and products of them stay finite.
constexpr float kMaxExtent_m = 1e6f;
constexpr float kMaxAngle_rad = 2.0f * std::numbers::pi_v<float>;
constexpr float kMaxBendStep_rad = 1e-3f;
constexpr float kUnitTolerance = 1e-2f;
constexpr double kMaxWind_m_s = 1e3;
constexpr double kMaxDuration_s = 1e12;

// Each read() answers false where the values contradict each other or are no numbers.

bool is_within(double value, double low, double high) {
  return value >= low && value <= high;
}  // false for NaN

/// Texts end up in terminals and logs: control characters (C0, DEL, and C1 in UTF-8) become question marks.
bool read(const flatbuffers::String* from, std::string& to) {
  to.clear();
  if (from == nullptr) return true;
  if (from->size() > kMaxTextBytes) return false;
  to.assign(from->c_str(), from->size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto byte = static_cast<unsigned char>(to[i]);
    const bool is_c1 = byte == 0xC2 && i + 1 < to.size() && static_cast<unsigned char>(to[i + 1]) < 0xA0;
    if (byte < 0x20 || byte == 0x7F || is_c1) to[i] = '?';
    if (is_c1) to[++i] = '?';
  }
  return true;
}

bool read(const fb::Wind* from, WindState& to) {
  if (from == nullptr || from->source() > fb::WindSource_MAX) return false;
  to.wind = {static_cast<double>(from->u_m_s()), static_cast<double>(from->v_m_s())};
  to.source = static_cast<WindSource>(from->source());
  to.live_weight = static_cast<double>(from->live_weight());
  to.reading_age_s = static_cast<double>(from->reading_age_s());
  return is_within(to.wind.u_m_s, -kMaxWind_m_s, kMaxWind_m_s) &&
         is_within(to.wind.v_m_s, -kMaxWind_m_s, kMaxWind_m_s) && is_within(to.live_weight, 0.0, 1.0) &&
         is_within(to.reading_age_s, 0.0, kMaxDuration_s);
}

/// `count` values within +-limit, padded with zeros to whole blocks.
bool read(const flatbuffers::Vector<float>* from, std::size_t count, float limit, std::vector<float>& to) {
  const std::size_t size = from == nullptr ? 0 : from->size();
  if (size != count) return false;
  to.assign(padded_to_blocks(count), 0.0f);
  if (count > 0) std::memcpy(to.data(), from->data(), count * sizeof(float));
  return std::all_of(to.begin(), to.end(), [limit](float value) { return std::abs(value) <= limit; });
}

/// Of `rest` and `curl` of every strand: are they unit vectors, one across the other?
bool is_frame(const StrandSkeleton& s) {
  for (std::size_t i = 0; i < s.strand_count; ++i) {
    const float rest = s.rest_x[i] * s.rest_x[i] + s.rest_y[i] * s.rest_y[i] + s.rest_z[i] * s.rest_z[i];
    const float curl = s.curl_x[i] * s.curl_x[i] + s.curl_y[i] * s.curl_y[i] + s.curl_z[i] * s.curl_z[i];
    const float across = s.rest_x[i] * s.curl_x[i] + s.rest_y[i] * s.curl_y[i] + s.rest_z[i] * s.curl_z[i];
    if (std::abs(rest - 1.0f) > kUnitTolerance || std::abs(curl - 1.0f) > kUnitTolerance ||
        std::abs(across) > kUnitTolerance)
      return false;
  }
  return true;
}

bool read(const fb::StrandSkeleton& from, StrandSkeleton& to) {
  const std::size_t count = from.root_x_m() == nullptr ? 0 : from.root_x_m()->size();
  if (count > kMaxStrands || from.links_per_strand() < 1 || from.links_per_strand() > kMaxLinksPerStrand) return false;
  to.strand_count = count;
  to.links_per_strand = from.links_per_strand();
  return read(from.root_x_m(), count, kMaxExtent_m, to.root_x_m) &&
         read(from.root_y_m(), count, kMaxExtent_m, to.root_y_m) &&
         read(from.root_z_m(), count, kMaxExtent_m, to.root_z_m) && read(from.rest_x(), count, 2.0f, to.rest_x) &&
         read(from.rest_y(), count, 2.0f, to.rest_y) && read(from.rest_z(), count, 2.0f, to.rest_z) &&
         read(from.curl_x(), count, 2.0f, to.curl_x) && read(from.curl_y(), count, 2.0f, to.curl_y) &&
         read(from.curl_z(), count, 2.0f, to.curl_z) &&
         read(from.rest_curl_rad(), count, kMaxAngle_rad, to.rest_curl_rad) &&
         read(from.link_length_m(), count, kMaxExtent_m, to.link_length_m) &&
         std::all_of(to.link_length_m.begin(), to.link_length_m.end(), [](float length) { return length >= 0.0f; }) &&
         is_frame(to);
}

/// Quantised bends back to radians, padded with zeros.
bool read(const flatbuffers::Vector<std::int16_t>* from, std::size_t count, float step_rad, std::vector<float>& to) {
  const std::size_t size = from == nullptr ? 0 : from->size();
  if (size != count) return false;
  to.assign(padded_to_blocks(count), 0.0f);
  if (count > 0)
    std::transform(from->data(), from->data() + count, to.begin(),
                   [step_rad](std::int16_t bend) { return step_rad * static_cast<float>(bend); });
  return true;
}

bool read(const fb::StrandPose& from, StrandPose& to) {
  const std::size_t count = from.bend_east() == nullptr ? 0 : from.bend_east()->size();
  const float step_rad = from.bend_step_rad();
  return count <= kMaxStrands && step_rad > 0.0f && step_rad <= kMaxBendStep_rad &&
         read(from.bend_east(), count, step_rad, to.bend_east_rad) &&
         read(from.bend_south(), count, step_rad, to.bend_south_rad);
}

bool read(const fb::Hello& from, Hello& to) {
  to.protocol = from.protocol();
  to.tick_rate_hz = from.tick_rate_hz();
  if (from.refused() != nullptr && !read(from.refused(), to.refused.emplace())) return false;
  return is_within(to.tick_rate_hz, 0.0, 1e6) && read(from.software(), to.software);
}

bool read(const fb::Subscribe& from, Subscribe& to) {
  to.protocol = from.protocol();
  to.poses = from.poses();
  to.sensors = from.sensors();
  return read(from.client(), to.client);
}

bool read(const fb::Scene& from, SceneModel& to) {
  if (!read(from.name(), to.name) || !read(from.kind(), to.kind)) return false;
  if (from.skeleton_type() > fb::Skeleton_MAX) {  // of a newer server
    to.skeleton.emplace<StrandSkeleton>().links_per_strand = 1;
    return true;
  }
  const auto* strands = from.skeleton_as_StrandSkeleton();
  return strands != nullptr && read(*strands, to.skeleton.emplace<StrandSkeleton>());
}

bool read(const fb::Scenes& from, Scenes& to) {
  const std::size_t count = from.scenes() == nullptr ? 0 : from.scenes()->size();
  if (count > kMaxScenes) return false;
  std::size_t strand_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!read(*from.scenes()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.scenes.emplace_back())) return false;
    strand_count += std::get<StrandSkeleton>(to.scenes.back().skeleton).strand_count;
    if (strand_count > kMaxStrands) return false;
  }
  return true;
}

bool read(const fb::ScenePose& from, Pose& to) {
  if (from.pose_type() > fb::Pose_MAX) {  // of a newer server
    to = StrandPose{};
    return true;
  }
  const auto* strands = from.pose_as_StrandPose();
  return strands != nullptr && read(*strands, to.emplace<StrandPose>());
}

bool read(const fb::Frame& from, Frame& to) {
  to.info.sequence = from.sequence();
  to.info.tick = from.tick();
  to.info.time_s = from.time_s();
  to.info.utc_ns = from.utc_ns();
  const std::size_t count = from.scenes() == nullptr ? 0 : from.scenes()->size();
  if (count > kMaxScenes || !is_within(to.info.time_s, 0.0, kMaxDuration_s) || !read(from.wind(), to.info.wind))
    return false;
  std::size_t strand_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!read(*from.scenes()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.poses.emplace_back())) return false;
    to.opacities.push_back(1.0f);
    strand_count += std::get<StrandPose>(to.poses.back()).bend_east_rad.size();
    if (strand_count > kMaxStrands + kMaxScenes * kStrandsPerBlock) return false;
  }
  return true;
}

bool read(const flatbuffers::Optional<double>& from, std::optional<double>& to) {
  if (!from.has_value()) return true;
  to = *from;
  return std::isfinite(*from);
}

bool read(const fb::Sensor& from, SensorStatus& to) {
  if (from.link() > fb::LinkState_MAX || from.health() > fb::SensorHealth_MAX) return false;
  to.link = static_cast<std::uint8_t>(from.link());
  to.health = static_cast<std::uint8_t>(from.health());
  to.simulated = from.simulated();
  to.age_s = from.age_s();
  to.interval_s = from.interval_s();
  to.readings = from.readings();
  const std::size_t reasons = from.refused() == nullptr ? 0 : from.refused()->size();
  if (reasons > kMaxRefusalReasons) return false;
  for (std::size_t i = 0; i < reasons; ++i) {
    const auto* counter = from.refused()->Get(static_cast<flatbuffers::uoffset_t>(i));
    auto& [reason, refusals] = to.refused.emplace_back();
    refusals = counter->count();
    if (!read(counter->reason(), reason)) return false;
  }
  return is_within(to.age_s, 0.0, kMaxDuration_s) && is_within(to.interval_s, 0.0, kMaxDuration_s) &&
         read(from.name(), to.name) && read(from.driver(), to.driver) && read(from.detail(), to.detail) &&
         read(from.speed_m_s(), to.speed_m_s) && read(from.direction_deg(), to.direction_deg) &&
         read(from.gust_m_s(), to.gust_m_s);
}

bool read(const fb::Sensors& from, Sensors& to) {
  const std::size_t count = from.sensors() == nullptr ? 0 : from.sensors()->size();
  if (count > kMaxSensors || !read(from.wind(), to.wind)) return false;
  for (std::size_t i = 0; i < count; ++i)
    if (!read(*from.sensors()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.sensors.emplace_back())) return false;
  to.late_ticks = from.late_ticks();
  to.clients = from.clients();
  return true;
}

template <class T, class Table>
Result<Message, WireError> read_body(const Table* table) {
  Message message(std::in_place_type<T>);
  if (table == nullptr || !read(*table, std::get<T>(message))) return WireError::kInconsistent;
  return message;
}

/// Deeper and more numerous than anything the schema can hold within the limits.
flatbuffers::Verifier::Options verifier_options() {
  flatbuffers::Verifier::Options options;
  options.max_depth = 16;
  options.max_tables = 1u << 16;
  return options;
}

}  // namespace

Result<Message, WireError> decode(std::span<const std::uint8_t> bytes) {
  // Room for the root's offset and the identifier, which FlatBuffers 2.0 reads before it looks at the length.
  if (bytes.size() < 2 * sizeof(flatbuffers::uoffset_t)) return WireError::kNotVerified;
  if (bytes.size() > kMaxServerMessageBytes) return WireError::kTooLong;

  // Alignment in a size-prefixed buffer counts from the prefix. A copy that has one, in aligned memory, can be verified
  // and read in place, wherever `bytes` came to lie.
  const auto length = static_cast<flatbuffers::uoffset_t>(bytes.size());
  const auto buffer = std::make_unique_for_overwrite<std::uint8_t[]>(kSizePrefixBytes + bytes.size());
  std::memcpy(buffer.get(), &length, sizeof length);
  std::memcpy(buffer.get() + kSizePrefixBytes, bytes.data(), bytes.size());

  flatbuffers::Verifier verifier(buffer.get(), kSizePrefixBytes + bytes.size(), verifier_options());
  if (!fb::VerifySizePrefixedMessageBuffer(verifier)) return WireError::kNotVerified;

  const fb::Message& message = *fb::GetSizePrefixedMessage(buffer.get());
  switch (message.body_type()) {
    case fb::Body_Hello:
      return read_body<Hello>(message.body_as_Hello());
    case fb::Body_Subscribe:
      return read_body<Subscribe>(message.body_as_Subscribe());
    case fb::Body_Scenes:
      return read_body<Scenes>(message.body_as_Scenes());
    case fb::Body_Frame:
      return read_body<Frame>(message.body_as_Frame());
    case fb::Body_Sensors:
      return read_body<Sensors>(message.body_as_Sensors());
    case fb::Body_NONE:
      break;
  }
  return WireError::kUnknown;
}

}  // namespace yuragi::wire
