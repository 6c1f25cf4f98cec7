#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "engine/base/printable_text.hpp"
#include "engine/wire/decode_models.hpp"

namespace yuragi::wire {

/// Because texts are shown in terminals and logs.
bool read_text(const flatbuffers::String* from, std::string& to) {
  to.clear();
  if (from == nullptr) return true;
  if (from->size() > kMaxTextBytes) return false;
  to.assign(from->c_str(), from->size());
  make_printable(to);
  return true;
}

namespace {

constexpr double kMaxTimes = 1e3;
constexpr double kMaxViewerOffset_s = 1e10;  // a clock that begins in 1970 is off by 1.8e9
constexpr double kMaxWind_m_s = 1e3;
constexpr double kMaxWay_m = 1e6;
constexpr double kMaxDuration_s = 1e12;

bool read(const fb::Wind* from, wind::State& to) {
  if (from == nullptr || from->source() > fb::WindSource_MAX) return false;
  to.wind = {static_cast<double>(from->u_m_s()), static_cast<double>(from->v_m_s())};
  to.source = static_cast<wind::Source>(from->source());
  to.live_weight = static_cast<double>(from->live_weight());
  to.reading_age_s = static_cast<double>(from->reading_age_s());
  return is_within(to.wind.u_m_s, -kMaxWind_m_s, kMaxWind_m_s) &&
         is_within(to.wind.v_m_s, -kMaxWind_m_s, kMaxWind_m_s) && is_within(to.live_weight, 0.0, 1.0) &&
         is_within(to.reading_age_s, 0.0, kMaxDuration_s);
}

/// An older server does not send it: then the wind is in the middle.
bool read(const fb::WindPlace* from, wind::State& to) {
  if (from == nullptr) return true;
  to.upwind_m = static_cast<double>(from->upwind_m());
  to.to_middle_s = static_cast<double>(from->to_middle_s());
  to.is_place_configured = from->is_configured();
  return is_within(to.upwind_m, -kMaxWay_m, kMaxWay_m) && is_within(to.to_middle_s, 0.0, kMaxDuration_s);
}

bool read(const fb::Hello& from, Hello& to) {
  to.protocol = from.protocol();
  to.tick_rate_hz = from.tick_rate_hz();
  if (from.refused() != nullptr && !read_text(from.refused(), to.refused.emplace())) return false;
  if (const auto from_deg = from.wind_from_deg(); from_deg && is_within(*from_deg, 0.0, 360.0))
    to.wind_from_deg = *from_deg;
  to.takes_display = from.takes_display();
  return is_within(to.tick_rate_hz, 0.0, 1e6) && read_text(from.software(), to.software);
}

bool read(const fb::Subscribe& from, Subscribe& to) {
  to.protocol = from.protocol();
  to.poses = from.poses();
  to.sensors = from.sensors();
  to.raw = from.raw();
  to.takes_new_scenes = from.takes_new_scenes();
  to.thinning.every = from.every();
  to.rate_hz = from.rate_hz();
  to.wind = from.wind();
  const std::size_t named = from.scenes() == nullptr ? 0 : from.scenes()->size();
  if (named > kMaxScenes) return false;
  for (std::size_t i = 0; i < named; ++i) {
    const auto* name = from.scenes()->Get(static_cast<flatbuffers::uoffset_t>(i));
    if (!read_text(name, to.thinning.scenes.emplace_back())) return false;
  }
  std::string token;
  if (!read_text(from.token(), token)) return false;
  to.token = Secret(std::move(token));
  return is_within(to.thinning.every, 1, kMaxEvery) && is_within(to.rate_hz, 0.0, kMaxRate_hz) &&
         read_text(from.client(), to.client) && read_text(from.raw_sensor(), to.raw_sensor);
}

bool read(const fb::Scenes& from, Scenes& to) {
  const std::size_t count = from.scenes() == nullptr ? 0 : from.scenes()->size();
  if (count > kMaxScenes) return false;
  std::size_t room = 0;
  std::size_t pixels = 0;  // scenes can share a picture: few bytes must not need much memory
  for (std::size_t i = 0; i < count; ++i) {
    if (!read_scene(*from.scenes()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.scenes.emplace_back()))
      return false;
    room += room_of(to.scenes.back().skeleton);
    if (to.scenes.back().cloth.image != nullptr) pixels += to.scenes.back().cloth.image->rgb.size() / 3;
    if (room > kMaxStrands + kMaxPadding || pixels > kMaxPixels) return false;
  }
  return true;
}

bool read(const fb::Frame& from, Frame& to) {
  to.info.sequence = from.sequence();
  to.info.tick = from.tick();
  to.info.time_s = from.time_s();
  to.info.utc_ns = from.utc_ns();
  if (const auto from_deg = from.view_wind_from_deg(); from_deg && is_within(*from_deg, 0.0, 360.0)) {
    to.info.view_wind_from_deg = *from_deg;
  }
  const std::size_t count = from.scenes() == nullptr ? 0 : from.scenes()->size();
  if (count > kMaxScenes || !is_within(to.info.time_s, 0.0, kMaxDuration_s) || !read(from.wind(), to.info.wind) ||
      !read(from.wind_place(), to.info.wind)) {
    return false;
  }
  std::size_t room = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const fb::ScenePose& scene = *from.scenes()->Get(static_cast<flatbuffers::uoffset_t>(i));
    if (!read_pose(scene, to.poses.emplace_back(), to.opacities.emplace_back())) return false;
    room += room_of(to.poses.back());
    if (room > kMaxStrands + kMaxPadding) return false;
  }
  return true;
}

bool read(const flatbuffers::Optional<double>& from, std::optional<double>& to) {
  if (!from.has_value()) return true;
  to = *from;
  return std::isfinite(*from);
}

/// One of a newer server that this build does not know is left out.
bool read_quantities(const fb::Sensor& from, SensorStatus& to) {
  const std::size_t count = from.quantities() == nullptr ? 0 : from.quantities()->size();
  if (count > kMaxQuantities) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const auto* quantity = from.quantities()->Get(static_cast<flatbuffers::uoffset_t>(i));
    if (quantity->quantity() > fb::Quantity_MAX) continue;
    QuantityStatus& into = to.quantities.emplace_back();
    into.quantity = static_cast<wind::judging::Quantity>(quantity->quantity());
    into.is_missing = quantity->is_missing();
    if (!read(quantity->age_s(), into.age_s) || !read_text(quantity->reason(), into.reason)) return false;
    if (into.age_s && !is_within(*into.age_s, 0.0, kMaxDuration_s)) return false;
  }
  return true;
}

bool read(const fb::Sensor& from, SensorStatus& to) {
  if (from.link() > fb::LinkState_MAX || from.health() > fb::SensorHealth_MAX || from.state() > fb::SensorState_MAX) {
    return false;
  }
  to.link = static_cast<wind::LinkState>(from.link());
  to.health = static_cast<wind::SourceHealth>(from.health());
  to.simulated = from.simulated();
  to.age_s = from.age_s();
  to.interval_s = from.interval_s();
  to.readings = from.readings();
  to.frames = from.frames();
  to.reconnects = from.reconnects();
  to.replayed = from.replayed();
  to.reads_times_group = from.reads_times_group();
  to.state = static_cast<wind::judging::SensorState>(from.state());
  const std::size_t reasons = from.refused() == nullptr ? 0 : from.refused()->size();
  if (reasons > kMaxRefusalReasons) return false;
  for (std::size_t i = 0; i < reasons; ++i) {
    const auto* counter = from.refused()->Get(static_cast<flatbuffers::uoffset_t>(i));
    auto& [reason, refusals] = to.refused.emplace_back();
    refusals = counter->count();
    if (!read_text(counter->reason(), reason)) return false;
  }
  return is_within(to.reads_times_group, 1.0 / kMaxTimes, kMaxTimes) && is_within(to.age_s, 0.0, kMaxDuration_s) &&
         is_within(to.interval_s, 0.0, kMaxDuration_s) && read_text(from.name(), to.name) &&
         read_text(from.driver(), to.driver) && read_text(from.detail(), to.detail) &&
         read_text(from.state_reason(), to.state_reason) && read_text(from.value(), to.value) &&
         read(from.speed_m_s(), to.speed_m_s) && read(from.direction_deg(), to.direction_deg) &&
         read(from.gust_m_s(), to.gust_m_s) && read(from.raw_speed_m_s(), to.raw_speed_m_s) &&
         read(from.raw_direction_deg(), to.raw_direction_deg) && read_quantities(from, to);
}

/// An older server does not send it: then nothing is active.
bool read(const fb::Shaping* from, Shaping& to) {
  if (from == nullptr) return true;
  constexpr double kMaxGain = 1e3;
  const auto take = [](float value, double max, double& into) {
    into = static_cast<double>(value);
    return is_within(into, 0.0, max);
  };
  return take(from->site_gain(), kMaxGain, to.site_gain) && take(from->floor_gain(), kMaxGain, to.floor_gain) &&
         take(from->breeze_m_s(), kMaxWind_m_s, to.breeze_m_s) && take(from->opening(), 1.0, to.opening) &&
         take(from->ceiling_gain(), 1.0, to.ceiling_gain) && take(from->mean_m_s(), kMaxWind_m_s, to.mean_m_s) &&
         take(from->shaped_mean_m_s(), kMaxWind_m_s, to.shaped_mean_m_s) &&
         take(from->site_median_m_s(), kMaxWind_m_s, to.site_median_m_s) &&
         take(from->site_strong_m_s(), kMaxWind_m_s, to.site_strong_m_s) &&
         take(from->site_known_s(), kMaxDuration_s, to.site_known_s) && take(from->gusts(), kMaxGain, to.gusts) &&
         take(from->openness(), 1.0, to.openness) && read_text(from->text(), to.text);
}

/// An older server does not send it.
bool read(const fb::Lateness* from, std::optional<Lateness>& to) {
  if (from == nullptr) return true;
  to = Lateness{from->p50_s(), from->p99_s(), from->max_s()};
  return is_within(to->p50_s, 0.0, kMaxDuration_s) && is_within(to->p99_s, 0.0, kMaxDuration_s) &&
         is_within(to->max_s, 0.0, kMaxDuration_s);
}

/// A server without scenes, or an older one, does not send it.
bool read(const fb::Animation* from, std::optional<AnimationStatus>& to) {
  if (from == nullptr) return true;
  to = AnimationStatus{.running_s = from->running_s(), .period_s = from->period_s(), .tick_s = from->tick_s()};
  const std::size_t count = from->scenes() == nullptr ? 0 : from->scenes()->size();
  if (count > kMaxScenes) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const fb::SceneCost& cost = *from->scenes()->Get(static_cast<flatbuffers::uoffset_t>(i));
    SceneCost& read = to->scenes.emplace_back(SceneCost{.scene = {}, .tick_s = cost.tick_s()});
    if (!read_text(cost.scene(), read.scene) || !is_within(read.tick_s, 0.0, kMaxDuration_s)) return false;
  }
  return is_within(to->running_s, 0.0, kMaxDuration_s) && is_within(to->period_s, 0.0, kMaxDuration_s) &&
         is_within(to->tick_s, 0.0, kMaxDuration_s);
}

/// A server that does not record, or an older one, does not send it.
bool read(const fb::Recorder* from, std::optional<RecorderStatus>& to) {
  if (from == nullptr) return true;
  if (from->state() > fb::RecorderState_MAX) return false;
  to = RecorderStatus{.state = static_cast<RecorderState>(from->state()),
                      .written = from->written(),
                      .waiting = from->waiting(),
                      .lost = from->lost()};
  to->recorded_elsewhere = from->recorded_elsewhere();
  if (const auto free_bytes = from->free_bytes()) to->free_bytes = *free_bytes;
  return read_text(from->error(), to->error) && read_text(from->clock_doubt(), to->clock_doubt);
}

bool read(const fb::Feed& from, FeedStatus& to) {
  to.messages = from.messages();
  to.bytes = from.bytes();
  if (const auto age_s = from.last_sent_age_s()) {
    if (!is_within(*age_s, 0.0, kMaxDuration_s)) return false;
    to.last_sent_age_s = *age_s;
  }
  return read_text(from.kind(), to.kind) && read_text(from.name(), to.name) && read_text(from.target(), to.target) &&
         read_text(from.sends(), to.sends) && read_text(from.trouble(), to.trouble);
}

/// Never refuses: values are limited to their range, so that a picture is shown.
void read(const fb::Look* from, look::Look& to) {
  if (from == nullptr) return;
  look::Look look{.sun = static_cast<look::SunChoice>(from->sun()),
                  .latitude_deg = from->latitude_deg(),
                  .longitude_deg = from->longitude_deg(),
                  .sun_height_deg = from->sun_height_deg(),
                  .sun_azimuth_deg = from->sun_azimuth_deg(),
                  .clouds = from->clouds(),
                  .haze = from->haze(),
                  .exposure_ev = from->exposure_ev(),
                  .quality = static_cast<look::Quality>(from->quality()),
                  .palette = static_cast<look::Palette>(from->palette()),
                  .ground = static_cast<look::GroundKind>(from->ground()),
                  .ground_image_width_m = from->ground_image_width_m(),
                  .density = from->density()};
  if (const auto hour = from->solar_time_h()) look.solar_time_h = *hour;
  to = look::within_limits(look);
}

/// Refuses only a text that is too long.
bool read(const fb::Camera& from, look::Camera& to) {
  look::Camera camera{.target_x_m = from.x_m(),
                      .target_y_m = from.y_m(),
                      .target_z_m = from.z_m(),
                      .heading_deg = from.heading_deg(),
                      .pitch_deg = from.pitch_deg(),
                      .fov_deg = from.fov_deg(),
                      .turn_deg_min = from.turn_deg_min(),
                      .sway_deg = from.sway_deg(),
                      .pan_deg = from.pan_deg(),
                      .dolly_m = from.dolly_m(),
                      .track_m = from.track_m(),
                      .period_s = from.period_s(),
                      .fade_s = from.fade_s()};
  if (const auto distance_m = from.distance_m()) camera.distance_m = *distance_m;
  if (const auto angle_deg = from.wind_angle_deg()) camera.wind_angle_deg = *angle_deg;
  if (const auto hour = from.from_h()) camera.from_h = *hour;
  to = look::within_limits(camera);
  return read_text(from.name(), to.name) && read_text(from.scene(), to.scene);
}

/// The first kMaxCameras of them: a newer server may have more.
bool read_cameras(const fb::Sensors& from, Sensors& to) {
  const std::size_t count = from.cameras() == nullptr ? 0 : from.cameras()->size();
  for (std::size_t i = 0; i < std::min(count, look::kMaxCameras); ++i) {
    if (!read(*from.cameras()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.cameras.emplace_back())) return false;
  }
  to.camera = from.camera() < to.cameras.size() ? from.camera() : 0;
  return true;
}

bool read(const fb::Hold* from, std::optional<Hold>& to) {
  if (from == nullptr) return true;
  to = Hold{.left_s = from->left_s()};
  return !to->left_s || is_within(*to->left_s, 0.0, kMaxHandHold_s);
}

bool read(const fb::ByHand& from, ByHand& to) {
  if (const fb::HeldWind* const wind = from.wind()) {
    to.wind = HeldWind{wind->speed_m_s(), wind->direction_deg(), wind->left_s()};
    if (!is_within(to.wind->speed_m_s, 0.0, kMaxHandWind_m_s) || !is_within(to.wind->direction_deg, 0.0, 360.0) ||
        !is_within(to.wind->left_s, 0.0, kMaxHandWind_s))
      return false;
  }
  return read(from.blackout(), to.blackout) && read(from.camera(), to.camera);
}

bool read(const fb::HandCommand& from, HandCommand& to) {
  if (from.part() > fb::HandPart_MAX) return false;
  to.part = static_cast<HandPart>(from.part());
  to.is_release = from.is_release();
  to.for_s = from.for_s();
  to.speed_m_s = from.speed_m_s();
  to.direction_deg = from.direction_deg();
  return (!to.for_s || is_within(*to.for_s, 0.0, kMaxHandHold_s)) && is_within(to.speed_m_s, 0.0, kMaxHandWind_m_s) &&
         is_within(to.direction_deg, 0.0, 360.0) && read_text(from.camera(), to.camera);
}

bool read(const fb::Sensors& from, Sensors& to) {
  const std::size_t count = from.sensors() == nullptr ? 0 : from.sensors()->size();
  if (count > kMaxSensors || !read(from.wind(), to.wind) || !read(from.wind_place(), to.wind)) return false;
  for (std::size_t i = 0; i < count; ++i)
    if (!read(*from.sensors()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.sensors.emplace_back())) return false;
  to.late_ticks = from.late_ticks();
  to.clients = from.clients();
  to.refused_clients = from.refused_clients();
  to.stuck_clients = from.stuck_clients();
  to.idle_clients = from.idle_clients();
  read(from.look(), to.look);
  to.parameters_revision = from.parameters_revision();
  to.recent_ticks = from.recent_ticks();
  to.given_up = from.given_up();
  to.recent_skipped_ticks = std::min(from.recent_skipped_ticks(), to.recent_ticks);
  to.gust_reach_across = from.gust_reach_across();
  to.gust_reach_along = from.gust_reach_along();
  const std::size_t troubles = from.troubles() == nullptr ? 0 : from.troubles()->size();
  if (troubles > kMaxTroubles) return false;
  for (std::size_t i = 0; i < troubles; ++i) {
    if (!read_text(from.troubles()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.troubles.emplace_back()))
      return false;
  }
  const std::size_t feeds = from.feeds() == nullptr ? 0 : from.feeds()->size();
  if (feeds > kMaxFeeds) return false;
  for (std::size_t i = 0; i < feeds; ++i) {
    if (!read(*from.feeds()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.feeds.emplace_back())) return false;
  }
  const auto is_reach = [](const std::optional<double>& reach) {
    return !reach || is_within(*reach, 1.0 / kMaxTimes, kMaxTimes);
  };
  return is_reach(to.gust_reach_across) && is_reach(to.gust_reach_along) && read_cameras(from, to) &&
         read(from.shaping(), to.shaping) && read(from.io_lateness(), to.io_lateness) &&
         read(from.tick_lateness(), to.tick_lateness) && read(from.recorder(), to.recorder) &&
         read(from.animation(), to.animation) && (from.by_hand() == nullptr || read(*from.by_hand(), to.by_hand));
}

bool read(const fb::Display& from, Display& to) {
  to.given_up = from.given_up();
  if (from.clock_offset_s()) to.clock_offset_s = *from.clock_offset_s();
  return !to.clock_offset_s || is_within(*to.clock_offset_s, -kMaxViewerOffset_s, kMaxViewerOffset_s);
}

bool read(const fb::PlayerCommand& from, PlayerCommand& to) {
  if (from.action() > fb::PlayerAction_MAX) return false;
  to.action = static_cast<PlayerAction>(from.action());
  to.count = from.count();
  to.rate = from.rate();
  return to.count >= 1 && to.count <= kMaxSteps && is_within(to.rate, kMinPlayRate, kMaxPlayRate) &&
         read_text(from.sensor(), to.sensor) && read_text(from.place(), to.place);
}

bool read(const fb::PlayerState& from, PlayerState& to) {
  to.is_open = from.is_open();
  to.position_s = from.position_s();
  to.length_s = from.length_s();
  to.recorded_utc_ns = from.recorded_utc_ns();
  to.rate = from.rate();
  to.is_paused = from.is_paused();
  to.is_finished = from.is_finished();
  to.loops = from.loops();
  to.rounds = from.rounds();
  to.order = from.order();
  to.orders_done = from.orders_done();
  return is_within(to.position_s, 0.0, kMaxDuration_s) && is_within(to.length_s, 0.0, kMaxDuration_s) &&
         is_within(to.rate, kMinPlayRate, kMaxPlayRate) && read_text(from.sensor(), to.sensor) &&
         read_text(from.file(), to.file) && read_text(from.refusal(), to.refusal);
}

bool read(const fb::ReloadCommand& from, ReloadCommand& to) {
  return read_text(from.file(), to.file);
}

using TextVector = flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>;

bool read_texts(const TextVector* from, std::vector<std::string>& to) {
  if (from == nullptr) return true;
  if (from->size() > kMaxReloadItems) return false;
  for (flatbuffers::uoffset_t i = 0; i < from->size(); ++i) {
    if (!read_text(from->Get(i), to.emplace_back())) return false;
  }
  return true;
}

bool read(const fb::ReloadReport& from, ReloadReport& to) {
  to.outcome =
      from.outcome() > fb::ReloadOutcome_MAX ? ReloadOutcome::kFailed : static_cast<ReloadOutcome>(from.outcome());
  return read_texts(from.applied(), to.applied) && read_texts(from.takes_restart(), to.takes_restart) &&
         read_texts(from.mistakes(), to.mistakes);
}

bool read(const fb::Control& from, Control& to) {
  if (from.reload() != nullptr && !read(*from.reload(), to.reload.emplace())) return false;
  if (from.player() != nullptr && !read(*from.player(), to.player.emplace())) return false;
  if (from.parameters() != nullptr && !read_parameters(*from.parameters(), to.parameters.emplace())) return false;
  if (from.hand() != nullptr && !read(*from.hand(), to.hand.emplace())) return false;
  to.shown = from.shown();
  to.hide_others = from.hide_others();
  to.over_s = static_cast<double>(from.over_s());
  return is_within(to.over_s, 0.0, kMaxFade_s) && read_text(from.scene(), to.scene);
}

bool read(const fb::ControlReply& from, ControlReply& to) {
  const std::size_t count = from.scenes() == nullptr ? 0 : from.scenes()->size();
  if (count > kMaxScenes || !read_text(from.message(), to.message)) return false;
  to.done = from.done();
  for (std::size_t i = 0; i < count; ++i) {
    const fb::SceneState& state = *from.scenes()->Get(static_cast<flatbuffers::uoffset_t>(i));
    SceneState& scene = to.scenes.emplace_back();
    scene.shown = state.shown();
    if (!read_text(state.name(), scene.name) || !read_text(state.kind(), scene.kind)) return false;
  }
  const std::size_t players = from.players() == nullptr ? 0 : from.players()->size();
  if (players > kMaxSensors) return false;
  for (std::size_t i = 0; i < players; ++i)
    if (!read(*from.players()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.players.emplace_back())) return false;
  if (from.parameters() != nullptr && !read_parameters(*from.parameters(), to.parameters.emplace())) return false;
  if (from.by_hand() != nullptr && !read(*from.by_hand(), to.by_hand.emplace())) return false;
  return from.reload() == nullptr || read(*from.reload(), to.reload.emplace());
}

bool read(const fb::RawTrace& from, RawTrace& to) {
  to.mono_ns = from.mono_ns();
  to.utc_ns = from.utc_ns();
  to.received = from.received();
  to.length = from.length();
  to.lost = from.lost();
  const std::size_t count = from.bytes() == nullptr ? 0 : from.bytes()->size();
  if (count > kMaxRawBytes || count > to.length) return false;
  if (count > 0) to.bytes.assign(from.bytes()->begin(), from.bytes()->end());
  return read_text(from.sensor(), to.sensor);
}

template <class T, class Table>
Result<Message, Error> read_body(const Table* table) {
  Message message(std::in_place_type<T>);
  if (table == nullptr || !read(*table, std::get<T>(message))) return Error::kInconsistent;
  return message;
}

/// Above the maximum depth and number of tables of a valid message.
flatbuffers::Verifier::Options verifier_options() {
  flatbuffers::Verifier::Options options;
  options.max_depth = 16;
  options.max_tables = 1u << 16;
  return options;
}

}  // namespace

Result<Message, Error> decode(std::span<const std::uint8_t> bytes) {
  // FlatBuffers 2.0 reads the root's offset and the identifier before it checks the length.
  if (bytes.size() < 2 * sizeof(flatbuffers::uoffset_t)) return Error::kNotVerified;
  if (bytes.size() > kMaxServerMessageBytes) return Error::kTooLong;

  // Alignment in a size-prefixed buffer counts from the prefix. An aligned copy with a prefix can be verified and read
  // in place, for any alignment of `bytes`.
  const auto length = static_cast<flatbuffers::uoffset_t>(bytes.size());
  const auto buffer = std::make_unique_for_overwrite<std::uint8_t[]>(kSizePrefixBytes + bytes.size());
  std::memcpy(buffer.get(), &length, sizeof length);
  std::memcpy(buffer.get() + kSizePrefixBytes, bytes.data(), bytes.size());

  flatbuffers::Verifier verifier(buffer.get(), kSizePrefixBytes + bytes.size(), verifier_options());
  if (!fb::VerifySizePrefixedMessageBuffer(verifier)) return Error::kNotVerified;

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
    case fb::Body_Control:
      return read_body<Control>(message.body_as_Control());
    case fb::Body_ControlReply:
      return read_body<ControlReply>(message.body_as_ControlReply());
    case fb::Body_RawTrace:
      return read_body<RawTrace>(message.body_as_RawTrace());
    case fb::Body_Display:
      return read_body<Display>(message.body_as_Display());
    case fb::Body_NONE:
      break;
  }
  return Error::kUnknown;
}

}  // namespace yuragi::wire
