#include <algorithm>
#include <span>

#include "engine/wire/schema.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::wire {

flatbuffers::Offset<flatbuffers::String> add_text(flatbuffers::FlatBufferBuilder& builder, std::string_view text) {
  std::size_t size = text.size();
  if (size > kMaxTextBytes) {
    size = kMaxTextBytes;
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0u) == 0x80u) --size;
  }
  return builder.CreateString(text.data(), size);
}

namespace {

using Builder = flatbuffers::FlatBufferBuilder;
using Text = flatbuffers::Offset<flatbuffers::String>;

/// The first `count` values: without the padding.
template <class T>
flatbuffers::Offset<flatbuffers::Vector<T>> add_values(Builder& builder, const std::vector<T>& values,
                                                       std::size_t count) {
  return builder.CreateVector(values.data(), count);
}

flatbuffers::Offset<fb::StrandSkeleton> add_skeleton(Builder& builder, const pose::StrandSkeleton& skeleton) {
  const auto add = [&](const std::vector<float>& values) { return add_values(builder, values, skeleton.strand_count); };
  const auto root_x = add(skeleton.root_x_m);
  const auto root_y = add(skeleton.root_y_m);
  const auto root_z = add(skeleton.root_z_m);
  const auto rest_x = add(skeleton.rest_x);
  const auto rest_y = add(skeleton.rest_y);
  const auto rest_z = add(skeleton.rest_z);
  const auto curl_x = add(skeleton.curl_x);
  const auto curl_y = add(skeleton.curl_y);
  const auto curl_z = add(skeleton.curl_z);
  const auto rest_curl = add(skeleton.rest_curl_rad);
  const auto link_length = add(skeleton.link_length_m);
  return fb::CreateStrandSkeleton(builder, static_cast<std::uint32_t>(skeleton.links_per_strand), root_x, root_y,
                                  root_z, rest_x, rest_y, rest_z, curl_x, curl_y, curl_z, rest_curl, link_length,
                                  static_cast<std::uint32_t>(skeleton.columns));
}

flatbuffers::Offset<fb::GridSkeleton> add_skeleton(Builder& builder, const pose::GridSkeleton& skeleton) {
  const auto add = [&](const std::vector<float>& padded) {
    float* values = nullptr;
    const auto vector = builder.CreateUninitializedVector(skeleton.columns * skeleton.rows, &values);
    for (std::size_t row = 0; row < skeleton.rows; ++row) {
      std::copy_n(padded.begin() + static_cast<std::ptrdiff_t>(row * skeleton.stride()), skeleton.columns,
                  values + row * skeleton.columns);
    }
    return flatbuffers::Offset<flatbuffers::Vector<float>>(vector);
  };
  const auto rest_x = add(skeleton.rest_x_m);
  const auto rest_y = add(skeleton.rest_y_m);
  const auto rest_z = add(skeleton.rest_z_m);
  return fb::CreateGridSkeleton(builder, static_cast<std::uint32_t>(skeleton.columns),
                                static_cast<std::uint32_t>(skeleton.rows), skeleton.is_first_column_fixed, rest_x,
                                rest_y, rest_z);
}

flatbuffers::Offset<fb::TreeSkeleton> add_skeleton(Builder& builder, const pose::TreeSkeleton& skeleton) {
  std::vector<flatbuffers::Offset<fb::TreeLevel>> levels;
  for (const pose::TreeLevel& level : skeleton.levels) {
    const std::size_t count = level.strands.strand_count;
    const std::size_t children = levels.empty() ? 0 : count;
    const auto strands = add_skeleton(builder, level.strands);
    const auto parent = add_values(builder, level.parent, children);
    const auto parent_link = add_values(builder, level.parent_link, children);
    const auto base_radius = add_values(builder, level.base_radius_m, count);
    const auto tip_radius = add_values(builder, level.tip_radius_m, count);
    levels.push_back(fb::CreateTreeLevel(builder, strands, static_cast<std::uint32_t>(level.parent_level), parent,
                                         parent_link, level.is_turned_by_block, level.is_leaves, base_radius,
                                         tip_radius));
  }
  const auto all_levels = builder.CreateVector(levels);
  const pose::TreeCopies& copies = skeleton.copies;
  if (copies.x_m.empty()) {
    return fb::CreateTreeSkeleton(builder, all_levels, static_cast<fb::FoliageColor>(skeleton.foliage));
  }
  const auto x = add_values(builder, copies.x_m, copies.x_m.size());
  const auto z = add_values(builder, copies.z_m, copies.z_m.size());
  const auto turn = add_values(builder, copies.turn_rad, copies.turn_rad.size());
  const auto scale = add_values(builder, copies.scale, copies.scale.size());
  return fb::CreateTreeSkeleton(builder, all_levels, static_cast<fb::FoliageColor>(skeleton.foliage), x, z, turn,
                                scale);
}

flatbuffers::Offset<fb::SurfaceSkeleton> add_skeleton(Builder& builder, const pose::SurfaceSkeleton& skeleton) {
  const auto add = [&](const std::vector<float>& values) {
    return add_values(builder, values, skeleton.columns * skeleton.rows);
  };
  const auto rest_x = add(skeleton.rest_x_m);
  const auto rest_y = add(skeleton.rest_y_m);
  const auto rest_z = add(skeleton.rest_z_m);
  const auto normal_x = add(skeleton.normal_x);
  const auto normal_y = add(skeleton.normal_y);
  const auto normal_z = add(skeleton.normal_z);
  const auto ramp = add_values(builder, skeleton.ramp_rgba, skeleton.ramp_rgba.size());
  const auto axis_x = add_values(builder, skeleton.axis_x_m, skeleton.axis_x_m.size());
  const auto axis_z = add_values(builder, skeleton.axis_z_m, skeleton.axis_z_m.size());
  return fb::CreateSurfaceSkeleton(builder, static_cast<std::uint32_t>(skeleton.columns),
                                   static_cast<std::uint32_t>(skeleton.rows), skeleton.is_closed, rest_x, rest_y,
                                   rest_z, normal_x, normal_y, normal_z, ramp,
                                   static_cast<std::uint32_t>(skeleton.shells), axis_x, axis_z);
}

/// The schema's kinds are those of skeleton.hpp, in the same order.
fb::Skeleton kind_of(const pose::Skeleton& skeleton) {
  return static_cast<fb::Skeleton>(skeleton.index() + fb::Skeleton_MIN + 1);
}
static_assert(fb::Skeleton_MAX == std::variant_size_v<pose::Skeleton>);
static_assert(fb::SensorState_MAX + 1 == wind::judging::kSensorStateNames.size(),
              "the states of sensor_state.hpp, in the same order");
static_assert(fb::FoliageColor_MAX + 1 == pose::kFoliageColorNames.size(), "those of skeleton.hpp");
static_assert(fb::LinkState_MAX + 1 == wind::kLinkStateNames.size(), "those of link_state.hpp");
static_assert(fb::SensorHealth_MAX + 1 == wind::kSourceHealthCount, "those of source_report.hpp");

flatbuffers::Offset<fb::QuantityStatus> add_quantity(Builder& builder, const QuantityStatus& quantity) {
  const auto reason = add_text(builder, quantity.reason);
  fb::QuantityStatusBuilder table(builder);
  table.add_quantity(static_cast<fb::Quantity>(quantity.quantity));
  if (quantity.age_s) table.add_age_s(*quantity.age_s);
  table.add_is_missing(quantity.is_missing);
  table.add_reason(reason);
  return table.Finish();
}

flatbuffers::Offset<fb::Sensor> add_sensor(Builder& builder, const SensorStatus& sensor) {
  std::vector<flatbuffers::Offset<fb::Counter>> refused;
  refused.reserve(sensor.refused.size());
  for (const auto& [reason, count] : sensor.refused)
    refused.push_back(fb::CreateCounter(builder, add_text(builder, reason), count));
  const auto refused_vector = builder.CreateVector(refused);
  const auto name = add_text(builder, sensor.name);
  const auto driver = add_text(builder, sensor.driver);
  const auto detail = add_text(builder, sensor.detail);
  const auto state_reason = add_text(builder, sensor.state_reason);
  std::vector<flatbuffers::Offset<fb::QuantityStatus>> quantities;
  for (const QuantityStatus& quantity : sensor.quantities) quantities.push_back(add_quantity(builder, quantity));
  const auto quantity_list = builder.CreateVector(quantities);
  const auto value = add_text(builder, sensor.value);

  fb::SensorBuilder table(builder);
  table.add_name(name);
  table.add_driver(driver);
  table.add_link(static_cast<fb::LinkState>(sensor.link));
  table.add_health(static_cast<fb::SensorHealth>(sensor.health));
  table.add_detail(detail);
  if (sensor.speed_m_s) table.add_speed_m_s(*sensor.speed_m_s);
  if (sensor.direction_deg) table.add_direction_deg(*sensor.direction_deg);
  if (sensor.gust_m_s) table.add_gust_m_s(*sensor.gust_m_s);
  table.add_simulated(sensor.simulated);
  table.add_age_s(sensor.age_s);
  table.add_interval_s(sensor.interval_s);
  table.add_readings(sensor.readings);
  table.add_refused(refused_vector);
  table.add_frames(sensor.frames);
  table.add_reconnects(sensor.reconnects);
  table.add_replayed(sensor.replayed);
  table.add_state(static_cast<fb::SensorState>(sensor.state));
  table.add_state_reason(state_reason);
  if (sensor.raw_speed_m_s) table.add_raw_speed_m_s(*sensor.raw_speed_m_s);
  if (sensor.raw_direction_deg) table.add_raw_direction_deg(*sensor.raw_direction_deg);
  table.add_quantities(quantity_list);
  table.add_value(value);
  table.add_reads_times_group(sensor.reads_times_group);
  return table.Finish();
}

flatbuffers::Offset<fb::Recorder> add_recorder(Builder& builder, const RecorderStatus& recorder) {
  const auto error = add_text(builder, recorder.error);
  const auto clock_doubt = add_text(builder, recorder.clock_doubt);
  fb::RecorderBuilder table(builder);
  table.add_state(static_cast<fb::RecorderState>(recorder.state));
  table.add_written(recorder.written);
  table.add_waiting(recorder.waiting);
  table.add_lost(recorder.lost);
  if (recorder.free_bytes) table.add_free_bytes(*recorder.free_bytes);
  table.add_error(error);
  table.add_clock_doubt(clock_doubt);
  table.add_recorded_elsewhere(recorder.recorded_elsewhere);
  return table.Finish();
}

flatbuffers::Offset<fb::Shaping> add_shaping(Builder& builder, const Shaping& shaping) {
  const auto text = add_text(builder, shaping.text);
  fb::ShapingBuilder table(builder);
  table.add_site_gain(static_cast<float>(shaping.site_gain));
  table.add_floor_gain(static_cast<float>(shaping.floor_gain));
  table.add_breeze_m_s(static_cast<float>(shaping.breeze_m_s));
  table.add_opening(static_cast<float>(shaping.opening));
  table.add_ceiling_gain(static_cast<float>(shaping.ceiling_gain));
  table.add_mean_m_s(static_cast<float>(shaping.mean_m_s));
  table.add_shaped_mean_m_s(static_cast<float>(shaping.shaped_mean_m_s));
  table.add_site_median_m_s(static_cast<float>(shaping.site_median_m_s));
  table.add_site_strong_m_s(static_cast<float>(shaping.site_strong_m_s));
  table.add_site_known_s(static_cast<float>(shaping.site_known_s));
  table.add_text(text);
  table.add_gusts(static_cast<float>(shaping.gusts));
  table.add_openness(static_cast<float>(shaping.openness));
  return table.Finish();
}

flatbuffers::Offset<fb::Look> add_look(Builder& builder, const look::Look& look) {
  fb::LookBuilder table(builder);
  table.add_sun(static_cast<fb::SunChoice>(look.sun));
  table.add_latitude_deg(look.latitude_deg);
  table.add_longitude_deg(look.longitude_deg);
  if (look.solar_time_h) table.add_solar_time_h(*look.solar_time_h);
  table.add_sun_height_deg(look.sun_height_deg);
  table.add_sun_azimuth_deg(look.sun_azimuth_deg);
  table.add_clouds(look.clouds);
  table.add_haze(look.haze);
  table.add_exposure_ev(look.exposure_ev);
  table.add_quality(static_cast<fb::Quality>(look.quality));
  table.add_palette(static_cast<fb::Palette>(look.palette));
  table.add_ground(static_cast<fb::GroundKind>(look.ground));
  table.add_density(look.density);
  table.add_ground_image_width_m(look.ground_image_width_m);
  return table.Finish();
}

flatbuffers::Offset<fb::Feed> add_feed(Builder& builder, const FeedStatus& feed) {
  const auto kind = add_text(builder, feed.kind);
  const auto name = add_text(builder, feed.name);
  const auto target = add_text(builder, feed.target);
  const auto sends = add_text(builder, feed.sends);
  const auto trouble = add_text(builder, feed.trouble);
  fb::FeedBuilder table(builder);
  table.add_kind(kind);
  table.add_name(name);
  table.add_target(target);
  table.add_sends(sends);
  table.add_messages(feed.messages);
  table.add_bytes(feed.bytes);
  if (feed.last_sent_age_s) table.add_last_sent_age_s(*feed.last_sent_age_s);
  table.add_trouble(trouble);
  return table.Finish();
}

flatbuffers::Offset<fb::Hold> add_hold(Builder& builder, const std::optional<Hold>& hold) {
  if (!hold) return {};
  fb::HoldBuilder table(builder);
  if (hold->left_s) table.add_left_s(*hold->left_s);
  return table.Finish();
}

flatbuffers::Offset<fb::ByHand> add_by_hand(Builder& builder, const ByHand& by_hand) {
  const auto wind = by_hand.wind ? fb::CreateHeldWind(builder, by_hand.wind->speed_m_s, by_hand.wind->direction_deg,
                                                      by_hand.wind->left_s)
                                 : flatbuffers::Offset<fb::HeldWind>();
  const auto blackout = add_hold(builder, by_hand.blackout);
  return fb::CreateByHand(builder, wind, blackout, add_hold(builder, by_hand.camera));
}

flatbuffers::Offset<fb::HandCommand> add_hand(Builder& builder, const HandCommand& hand) {
  const auto camera = add_text(builder, hand.camera);
  fb::HandCommandBuilder table(builder);
  table.add_part(static_cast<fb::HandPart>(hand.part));
  table.add_is_release(hand.is_release);
  if (hand.for_s) table.add_for_s(*hand.for_s);
  table.add_speed_m_s(hand.speed_m_s);
  table.add_direction_deg(hand.direction_deg);
  table.add_camera(camera);
  return table.Finish();
}

flatbuffers::Offset<fb::Camera> add_camera(Builder& builder, const look::Camera& camera) {
  const auto name = add_text(builder, camera.name);
  const auto scene = add_text(builder, camera.scene);
  fb::CameraBuilder table(builder);
  table.add_name(name);
  table.add_scene(scene);
  table.add_x_m(camera.target_x_m);
  table.add_y_m(camera.target_y_m);
  table.add_z_m(camera.target_z_m);
  table.add_heading_deg(camera.heading_deg);
  table.add_pitch_deg(camera.pitch_deg);
  if (camera.distance_m) table.add_distance_m(*camera.distance_m);
  table.add_fov_deg(camera.fov_deg);
  table.add_turn_deg_min(camera.turn_deg_min);
  table.add_sway_deg(camera.sway_deg);
  table.add_pan_deg(camera.pan_deg);
  table.add_dolly_m(camera.dolly_m);
  table.add_track_m(camera.track_m);
  table.add_period_s(camera.period_s);
  if (camera.from_h) table.add_from_h(*camera.from_h);
  table.add_fade_s(camera.fade_s);
  if (camera.wind_angle_deg) table.add_wind_angle_deg(*camera.wind_angle_deg);
  return table.Finish();
}

/// The first kMaxReloadItems of them.
flatbuffers::Offset<flatbuffers::Vector<Text>> add_texts(Builder& builder, const std::vector<std::string>& texts) {
  std::vector<Text> added;
  for (const std::string& text : std::span(texts).first(std::min(texts.size(), kMaxReloadItems))) {
    added.push_back(add_text(builder, text));
  }
  return builder.CreateVector(added);
}

flatbuffers::Offset<fb::ReloadReport> add_reload_report(Builder& builder, const ReloadReport& report) {
  const auto applied = add_texts(builder, report.applied);
  const auto takes_restart = add_texts(builder, report.takes_restart);
  const auto mistakes = add_texts(builder, report.mistakes);
  return fb::CreateReloadReport(builder, static_cast<fb::ReloadOutcome>(report.outcome), applied, takes_restart,
                                mistakes);
}

flatbuffers::Offset<fb::PlayerCommand> add_player(Builder& builder, const PlayerCommand& wish) {
  const auto sensor = add_text(builder, wish.sensor);
  const auto place = add_text(builder, wish.place);
  return fb::CreatePlayerCommand(builder, static_cast<fb::PlayerAction>(wish.action), sensor, wish.count, place,
                                 wish.rate);
}

flatbuffers::Offset<fb::PlayerState> add_player(Builder& builder, const PlayerState& player) {
  const auto sensor = add_text(builder, player.sensor);
  const auto file = add_text(builder, player.file);
  const auto refusal = add_text(builder, player.refusal);
  fb::PlayerStateBuilder table(builder);
  table.add_sensor(sensor);
  table.add_file(file);
  table.add_is_open(player.is_open);
  table.add_position_s(player.position_s);
  table.add_length_s(player.length_s);
  table.add_recorded_utc_ns(player.recorded_utc_ns);
  table.add_rate(player.rate);
  table.add_is_paused(player.is_paused);
  table.add_is_finished(player.is_finished);
  table.add_loops(player.loops);
  table.add_rounds(player.rounds);
  table.add_order(player.order);
  table.add_orders_done(player.orders_done);
  table.add_refusal(refusal);
  return table.Finish();
}

std::optional<fb::Lateness> to_schema(const std::optional<Lateness>& lateness) {
  if (!lateness) return std::nullopt;
  return fb::Lateness(lateness->p50_s, lateness->p99_s, lateness->max_s);
}

flatbuffers::Offset<fb::Animation> add_animation(Builder& builder, const AnimationStatus& animation) {
  std::vector<flatbuffers::Offset<fb::SceneCost>> scenes;
  for (const SceneCost& cost : animation.scenes)
    scenes.push_back(fb::CreateSceneCost(builder, add_text(builder, cost.scene), cost.tick_s));
  return fb::CreateAnimation(builder, animation.running_s, animation.period_s, animation.tick_s,
                             builder.CreateVector(scenes));
}

template <class Table>
Bytes finish(Builder& builder, fb::Body type, flatbuffers::Offset<Table> body) {
  fb::FinishSizePrefixedMessageBuffer(builder, fb::CreateMessage(builder, type, body.Union()));
  return Bytes(builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize());
}

}  // namespace

Bytes encode(const Hello& hello) {
  Builder builder;
  const auto software = add_text(builder, hello.software);
  const auto refused = hello.refused ? add_text(builder, *hello.refused) : Text();
  fb::HelloBuilder table(builder);
  table.add_protocol(hello.protocol);
  table.add_software(software);
  table.add_tick_rate_hz(hello.tick_rate_hz);
  if (hello.refused) table.add_refused(refused);
  if (hello.wind_from_deg) table.add_wind_from_deg(*hello.wind_from_deg);
  table.add_takes_display(hello.takes_display);
  return finish(builder, fb::Body_Hello, table.Finish());
}

Bytes encode(const Subscribe& subscribe) {
  Builder builder;
  const auto client = add_text(builder, subscribe.client);
  const auto raw_sensor = subscribe.raw_sensor.empty() ? Text() : add_text(builder, subscribe.raw_sensor);
  std::vector<Text> names;
  for (const std::string& name : subscribe.thinning.scenes) names.push_back(add_text(builder, name));
  const auto token = subscribe.token.is_empty() ? Text() : add_text(builder, subscribe.token.reveal());
  const auto scenes = names.empty() ? 0 : builder.CreateVector(names);
  return finish(builder, fb::Body_Subscribe,
                fb::CreateSubscribe(builder, subscribe.protocol, subscribe.poses, subscribe.sensors, client,
                                    subscribe.raw, raw_sensor, subscribe.takes_new_scenes, scenes,
                                    subscribe.thinning.every, subscribe.rate_hz, token, subscribe.wind));
}

namespace {

flatbuffers::Optional<std::uint32_t> to_schema(const std::optional<look::Color>& color) {
  if (!color) return flatbuffers::nullopt;
  return std::uint32_t{color->red} << 16 | std::uint32_t{color->green} << 8 | color->blue;
}

/// Null for a default ClothLook.
flatbuffers::Offset<fb::Cloth> add_cloth(Builder& builder, const look::ClothLook& cloth) {
  if (cloth == look::ClothLook{}) return {};
  if (cloth.image == nullptr) return fb::CreateCloth(builder, to_schema(cloth.color), to_schema(cloth.color_2));
  const auto rgb = builder.CreateVector(cloth.image->rgb);
  return fb::CreateCloth(builder, to_schema(cloth.color), to_schema(cloth.color_2), cloth.image->width_px,
                         cloth.image->height_px, rgb);
}

}  // namespace

Bytes encode(const Scenes& scenes) {
  Builder builder;
  std::vector<flatbuffers::Offset<fb::Scene>> tables;
  tables.reserve(scenes.scenes.size());
  for (const SceneModel& scene : scenes.scenes) {
    const auto name = add_text(builder, scene.name);
    const auto kind = add_text(builder, scene.kind);
    const auto skeleton =
        std::visit([&](const auto& model) { return add_skeleton(builder, model).Union(); }, scene.skeleton);
    const auto cloth = add_cloth(builder, scene.cloth);
    tables.push_back(fb::CreateScene(builder, name, kind, kind_of(scene.skeleton), skeleton, cloth));
  }
  return finish(builder, fb::Body_Scenes, fb::CreateScenes(builder, builder.CreateVector(tables)));
}

Bytes encode(const Sensors& sensors) {
  Builder builder;
  std::vector<flatbuffers::Offset<fb::Sensor>> tables;
  tables.reserve(sensors.sensors.size());
  for (const SensorStatus& sensor : sensors.sensors) tables.push_back(add_sensor(builder, sensor));
  const auto vector = builder.CreateVector(tables);
  const fb::Wind wind = to_schema(sensors.wind);
  const fb::WindPlace place = place_to_schema(sensors.wind);
  const auto shaping = add_shaping(builder, sensors.shaping);
  const auto io_lateness = to_schema(sensors.io_lateness);
  const auto tick_lateness = to_schema(sensors.tick_lateness);
  const auto recorder =
      sensors.recorder ? add_recorder(builder, *sensors.recorder) : flatbuffers::Offset<fb::Recorder>();
  const auto look = add_look(builder, sensors.look);
  std::vector<flatbuffers::Offset<fb::Camera>> cameras;
  for (const look::Camera& camera : sensors.cameras) cameras.push_back(add_camera(builder, camera));
  const auto camera_list = builder.CreateVector(cameras);
  const auto animation =
      sensors.animation ? add_animation(builder, *sensors.animation) : flatbuffers::Offset<fb::Animation>();
  std::vector<flatbuffers::Offset<flatbuffers::String>> troubles;
  for (std::size_t i = 0; i < std::min(sensors.troubles.size(), kMaxTroubles); ++i)
    troubles.push_back(add_text(builder, sensors.troubles[i]));
  const auto trouble_list = builder.CreateVector(troubles);
  std::vector<flatbuffers::Offset<fb::Feed>> feeds;
  for (std::size_t i = 0; i < std::min(sensors.feeds.size(), kMaxFeeds); ++i)
    feeds.push_back(add_feed(builder, sensors.feeds[i]));
  const auto feed_list = builder.CreateVector(feeds);
  const auto by_hand =
      sensors.by_hand == ByHand{} ? flatbuffers::Offset<fb::ByHand>() : add_by_hand(builder, sensors.by_hand);
  fb::SensorsBuilder table(builder);
  table.add_sensors(vector);
  table.add_wind(&wind);
  table.add_late_ticks(sensors.late_ticks);
  table.add_clients(sensors.clients);
  table.add_shaping(shaping);
  table.add_wind_place(&place);
  table.add_refused_clients(sensors.refused_clients);
  table.add_stuck_clients(sensors.stuck_clients);
  table.add_idle_clients(sensors.idle_clients);
  if (io_lateness) table.add_io_lateness(&*io_lateness);
  if (tick_lateness) table.add_tick_lateness(&*tick_lateness);
  if (sensors.recorder) table.add_recorder(recorder);
  table.add_look(look);
  table.add_cameras(camera_list);
  table.add_camera(static_cast<std::uint32_t>(sensors.camera));
  table.add_parameters_revision(sensors.parameters_revision);
  if (sensors.animation) table.add_animation(animation);
  table.add_recent_ticks(sensors.recent_ticks);
  table.add_recent_skipped_ticks(sensors.recent_skipped_ticks);
  table.add_troubles(trouble_list);
  table.add_feeds(feed_list);
  table.add_given_up(sensors.given_up);
  if (sensors.gust_reach_across) table.add_gust_reach_across(*sensors.gust_reach_across);
  if (sensors.gust_reach_along) table.add_gust_reach_along(*sensors.gust_reach_along);
  if (!by_hand.IsNull()) table.add_by_hand(by_hand);
  return finish(builder, fb::Body_Sensors, table.Finish());
}

Bytes encode(const Display& display) {
  Builder builder;
  fb::DisplayBuilder table(builder);
  table.add_given_up(display.given_up);
  if (display.clock_offset_s) table.add_clock_offset_s(*display.clock_offset_s);
  return finish(builder, fb::Body_Display, table.Finish());
}

Bytes encode(const Control& control) {
  Builder builder;
  const auto scene = add_text(builder, control.scene);
  const auto player = control.player ? add_player(builder, *control.player) : flatbuffers::Offset<fb::PlayerCommand>();
  const auto reload = control.reload ? fb::CreateReloadCommand(builder, add_text(builder, control.reload->file))
                                     : flatbuffers::Offset<fb::ReloadCommand>();
  const auto parameters =
      control.parameters ? add_parameters(builder, *control.parameters) : flatbuffers::Offset<fb::ParameterCommand>();
  const auto hand = control.hand ? add_hand(builder, *control.hand) : flatbuffers::Offset<fb::HandCommand>();
  return finish(builder, fb::Body_Control,
                fb::CreateControl(builder, scene, control.shown, control.hide_others,
                                  static_cast<float>(control.over_s), player, reload, parameters, hand));
}

Bytes encode(const ControlReply& reply) {
  Builder builder;
  std::vector<flatbuffers::Offset<fb::SceneState>> scenes;
  for (const SceneState& scene : reply.scenes) {
    const auto name = add_text(builder, scene.name);
    const auto kind = add_text(builder, scene.kind);
    scenes.push_back(fb::CreateSceneState(builder, name, kind, scene.shown));
  }
  std::vector<flatbuffers::Offset<fb::PlayerState>> players;
  for (const PlayerState& player : reply.players) players.push_back(add_player(builder, player));
  const auto message = add_text(builder, reply.message);
  const auto scene_vector = builder.CreateVector(scenes);
  const auto player_vector = builder.CreateVector(players);
  const auto reload =
      reply.reload ? add_reload_report(builder, *reply.reload) : flatbuffers::Offset<fb::ReloadReport>();
  const auto parameters =
      reply.parameters ? add_parameters(builder, *reply.parameters) : flatbuffers::Offset<fb::ParameterReport>();
  const auto by_hand = reply.by_hand ? add_by_hand(builder, *reply.by_hand) : flatbuffers::Offset<fb::ByHand>();
  return finish(
      builder, fb::Body_ControlReply,
      fb::CreateControlReply(builder, reply.done, message, scene_vector, player_vector, reload, parameters, by_hand));
}

Bytes encode(const RawTrace& trace) {
  Builder builder;
  const auto sensor = add_text(builder, trace.sensor);
  const auto bytes = builder.CreateVector(trace.bytes.data(), std::min(trace.bytes.size(), kMaxRawBytes));
  return finish(builder, fb::Body_RawTrace,
                fb::CreateRawTrace(builder, sensor, trace.mono_ns, trace.utc_ns, trace.received, bytes, trace.length,
                                   trace.lost));
}

}  // namespace yuragi::wire
