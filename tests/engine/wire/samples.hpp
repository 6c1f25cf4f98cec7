#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "engine/wire/wire.hpp"

// Messages for the tests of the stream, with something in every field.

namespace yuragi::samples {

/// A meadow of strands at scattered places, leaning and curling every which way.
inline pose::StrandSkeleton meadow(std::size_t strand_count, std::size_t links_per_strand = 10) {
  std::mt19937 random(1);
  const auto uniform = [&random](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 10001u) / 10000.0f;
  };
  pose::StrandSkeleton s;
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

inline pose::StrandPose bent(std::size_t strand_count, float largest_rad = 1.5f) {
  std::mt19937 random(2);
  pose::StrandPose pose;
  for (auto* values : {&pose.bend_east_rad, &pose.bend_south_rad}) {
    values->assign(pose::padded_to_blocks(strand_count), 0.0f);
    for (std::size_t i = 0; i < strand_count; ++i)
      (*values)[i] = largest_rad * (static_cast<float>(random() % 20001u) / 10000.0f - 1.0f);
  }
  return pose;
}

/// A wavy cloth of 2 m by 2 m; 16 columns would need no padding.
inline pose::GridSkeleton cloth(std::size_t columns = 21, std::size_t rows = 9) {
  pose::GridSkeleton grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.is_first_column_fixed = true;
  for (auto* values : {&grid.rest_x_m, &grid.rest_y_m, &grid.rest_z_m}) values->assign(rows * grid.stride(), 0.0f);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t at = row * grid.stride() + column;
      grid.rest_x_m[at] = 2.0f * static_cast<float>(column) / static_cast<float>(columns - 1);
      grid.rest_y_m[at] = 3.0f - 2.0f * static_cast<float>(row) / static_cast<float>(rows - 1);
      grid.rest_z_m[at] = 0.1f * std::sin(10.0f * grid.rest_x_m[at]);
    }
  }
  return grid;
}

/// `count` values from -largest to largest.
inline std::vector<float> scattered(std::size_t count, float largest, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values(count);
  for (float& value : values) value = largest * (static_cast<float>(random() % 20001u) / 10000.0f - 1.0f);
  return values;
}

inline pose::GridPose blown(const pose::GridSkeleton& grid) {
  const std::size_t count = grid.rows * grid.stride();
  pose::GridPose pose{scattered(count, 1.5f, 3), scattered(count, 1.5f, 4), scattered(count, 1.5f, 5)};
  for (auto* values : {&pose.offset_x_m, &pose.offset_y_m, &pose.offset_z_m}) {
    for (std::size_t i = 0; i < count; ++i)
      if (i % grid.stride() >= grid.columns) (*values)[i] = 0.0f;
  }
  return pose;
}

/// A trunk, limbs on it, and leaves on the limbs, a spray on each, which are turned by blocks.
inline pose::TreeSkeleton tree() {
  pose::TreeSkeleton tree;
  const std::size_t counts[] = {1, 5, 5 * pose::kStrandsPerBlock - 3};
  for (std::size_t level = 0; level < 3; ++level) {
    pose::TreeLevel here;
    here.strands = meadow(counts[level], level == 2 ? 4 : 6);
    const std::size_t padded = here.strands.padded_count();
    here.base_radius_m.assign(padded, 0.0f);
    here.tip_radius_m.assign(padded, 0.0f);
    if (level > 0) {
      here.parent_level = level - 1;
      here.parent.assign(padded, 0);
      here.parent_link.assign(padded, 0);
    }
    for (std::size_t i = 0; i < counts[level]; ++i) {
      here.base_radius_m[i] = 0.1f / static_cast<float>(level + 1);
      here.tip_radius_m[i] = 0.02f / static_cast<float>(level + 1);
      if (level == 0) continue;
      here.parent[i] = static_cast<std::uint32_t>(level == 1 ? 0 : i / pose::kStrandsPerBlock);
      here.parent_link[i] = static_cast<std::uint32_t>((i + 1) % 6);
    }
    here.is_leaves = here.is_turned_by_block = level == 2;
    tree.levels.push_back(std::move(here));
  }
  tree.foliage = pose::FoliageColor::kAutumn;
  tree.copies = {.x_m = {10.0f, -7.5f}, .z_m = {3.0f, 4.0f}, .turn_rad = {0.0f, 1.5f}, .scale = {1.0f, 0.75f}};
  return tree;
}

inline pose::TreePose swayed(const pose::TreeSkeleton& tree, float largest_rad = 0.8f) {
  pose::TreePose pose;
  for (const pose::TreeLevel& level : tree.levels) pose.levels.push_back(bent(level.strands.strand_count, largest_rad));
  return pose;
}

/// A bowl; or three, one within another, that glow and whose rows move.
inline pose::SurfaceSkeleton bowl(bool glows, std::size_t columns = 15, std::size_t rows = 7) {
  pose::SurfaceSkeleton surface;
  surface.columns = columns;
  surface.rows = rows;
  surface.is_closed = glows;
  surface.shells = glows ? 3 : 1;
  if (glows) {
    surface.axis_x_m.assign(rows, 5.0f);
    surface.axis_z_m.assign(rows, 0.25f);
  }
  for (std::size_t i = 0; i < columns * rows; ++i) {
    const float around = 6.28f * static_cast<float>(i % columns) / static_cast<float>(columns);
    const std::size_t row = i / columns;
    const float up = 1.5f * static_cast<float>(row) / static_cast<float>(rows);
    surface.normal_x.push_back(std::cos(up) * std::cos(around));
    surface.normal_y.push_back(std::sin(up));
    surface.normal_z.push_back(std::cos(up) * std::sin(around));
    surface.rest_x_m.push_back(5.0f + 2.0f * surface.normal_x.back());
    surface.rest_y_m.push_back(2.0f * surface.normal_y.back());
    surface.rest_z_m.push_back(2.0f * surface.normal_z.back());
  }
  for (unsigned i = 0; glows && i < 4 * 256; ++i) surface.ramp_rgba.push_back(static_cast<std::uint8_t>(i * 7));
  return surface;
}

inline pose::SurfacePose risen(const pose::SurfaceSkeleton& surface) {
  const std::size_t count = surface.columns * surface.rows;
  const std::size_t rows = surface.moves_rows() ? surface.rows : 0;
  pose::SurfacePose pose{.displacement_m = scattered(count, 0.5f, 6),
                         .heat = {},
                         .row_east_m = scattered(rows, 0.7f, 8),
                         .row_south_m = scattered(rows, 0.7f, 9),
                         .row_drop_m = scattered(rows, 0.7f, 10),
                         .row_slope_east = scattered(rows, 1.1f, 11),
                         .row_slope_south = scattered(rows, 1.1f, 12)};
  if (surface.ramp_rgba.empty()) return pose;
  pose.heat = scattered(count, 0.5f, 7);
  for (float& heat : pose.heat) heat += 0.5f;
  return pose;
}

inline wind::State wind() {
  return {.wind = {3.25, -4.5},
          .source = wind::Source::kHandover,
          .live_weight = 0.75,
          .reading_age_s = 1.5,
          .upwind_m = -12.5,
          .to_middle_s = 0.75,
          .is_place_configured = true};
}

inline wire::Hello hello() {
  return {.software = "yuragi 0.1.0", .tick_rate_hz = 60.0, .refused = "full"};
}

inline wire::Subscribe subscribe() {
  return {.poses = true,
          .sensors = true,
          .client = "a wall in Morioka",
          .raw = true,
          .raw_sensor = "roof",
          .takes_new_scenes = true};
}

inline wire::Scenes scenes(std::size_t strand_count = 37) {
  return {{{"meadow", "grass", meadow(strand_count)}, {"bank", "grass", meadow(3, 1)}}};
}

/// Two colours, and a picture of 3 x 2 pixels.
inline look::ClothLook cloth_look() {
  look::Image image{.width_px = 3, .height_px = 2, .rgb = {}};
  for (std::uint8_t i = 0; i < 18; ++i) image.rgb.push_back(static_cast<std::uint8_t>(13 * i));
  return {.color = look::Color{0x1b, 0x2a, 0x49},
          .color_2 = look::Color{0xff, 0x80, 0x00},
          .image = std::make_shared<look::Image>(std::move(image))};
}

/// One scene of each kind of skeleton, and a surface with and without a glow.
inline wire::Scenes all_kinds() {
  return {{{"meadow", "grass", meadow(37)},
           {"window", "curtain", cloth(), cloth_look()},
           {"elm", "tree", tree()},
           {"pond", "ripple", bowl(false)},
           {"fire", "flame", bowl(true)}}};
}

/// The poses of all_kinds().
inline std::vector<pose::Pose> all_moved() {
  return {bent(37), blown(cloth()), swayed(tree()), risen(bowl(false)), risen(bowl(true))};
}

inline wire::FrameInfo frame_info() {
  return {.sequence = 7,
          .tick = 11,
          .time_s = 0.18,
          .utc_ns = 1'700'000'000'000'000'000,
          .wind = wind(),
          .view_wind_from_deg = 123.5};
}

/// The frame of scenes(strand_count), as its bytes.
inline wire::Bytes frame_bytes(std::size_t strand_count = 37, const wire::FrameInfo& info = frame_info()) {
  const wire::Scenes set = scenes(strand_count);
  const pose::Pose a = bent(strand_count);
  const pose::Pose b = bent(3);
  const std::vector<const pose::Skeleton*> skeletons{&set.scenes[0].skeleton, &set.scenes[1].skeleton};
  const std::vector<const pose::Pose*> poses{&a, &b};
  wire::FrameEncoder encoder;
  const auto bytes = encoder.encode(info, skeletons, poses);
  return {bytes.begin(), bytes.end()};
}

/// A frame of all_kinds(). Of opacity 0: hidden.
inline wire::Bytes frame_of_all_kinds(const std::vector<float>& opacities = {1.0f, 0.5f, 1.0f, 0.25f, 1.0f}) {
  const wire::Scenes set = all_kinds();
  const std::vector<pose::Pose> moved = all_moved();
  std::vector<const pose::Skeleton*> skeletons;
  std::vector<const pose::Pose*> poses;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    skeletons.push_back(&set.scenes[i].skeleton);
    poses.push_back(&moved[i]);
  }
  wire::FrameEncoder encoder;
  const auto bytes = encoder.encode(frame_info(), skeletons, poses, opacities);
  return {bytes.begin(), bytes.end()};
}

inline wire::Control control() {
  return {.scene = "elm", .shown = true, .hide_others = true, .over_s = 4.5};
}

inline wire::Control player_control() {
  return {.scene = "",
          .player = wire::PlayerCommand{.action = wire::PlayerAction::kSeek,
                                        .sensor = "roof",
                                        .count = 7,
                                        .place = "2018-07-20T14:05:00Z",
                                        .rate = 2.5}};
}

inline wire::ControlReply control_reply() {
  return {.done = true,
          .message = "elm is shown",
          .scenes = {{"elm", "tree", true}, {"pond", "ripple", false}},
          .players = {{.sensor = "roof",
                       .file = "storm.windlog",
                       .is_open = true,
                       .position_s = 90.5,
                       .length_s = 3600.0,
                       .recorded_utc_ns = 1'700'000'000'000'000'000,
                       .rate = 0.5,
                       .is_paused = true,
                       .is_finished = true,
                       .loops = true,
                       .rounds = 3,
                       .order = 5,
                       .orders_done = 4,
                       .refusal = "there is no reading from there on"},
                      {}}};
}

inline wire::Control hand_control() {
  return {.scene = "",
          .hand = wire::HandCommand{.part = wire::HandPart::kCamera,
                                    .is_release = true,
                                    .for_s = 90.5,
                                    .speed_m_s = 8.5,
                                    .direction_deg = 270.0,
                                    .camera = "gate"}};
}

inline wire::ByHand by_hand() {
  return {.wind = wire::HeldWind{.speed_m_s = 8.5, .direction_deg = 270.0, .left_s = 42.5},
          .blackout = wire::Hold{},
          .camera = wire::Hold{.left_s = 12.5}};
}

inline wire::ControlReply reload_reply() {
  return {.done = true,
          .message = "2 changes applied",
          .scenes = {},
          .players = {},
          .reload = wire::ReloadReport{.outcome = wire::ReloadOutcome::kMistake,
                                       .applied = {"[shaping] floor: 0.0 -> 1.5", "scene elm: is new"},
                                       .takes_restart = {"seed: 1 -> 2"},
                                       .mistakes = {"wall.toml:3:1: seed: is \"a\""}}};
}

inline wire::Control parameter_control() {
  return {.scene = "",
          .parameters = wire::ParameterCommand{
              .scene = "elm", .edits = {{"height", "7.5"}, {"species", std::nullopt}}, .describe = true, .number = 77}};
}

inline wire::ControlReply parameter_reply() {
  const wire::ParameterState haze{.name = "haze",
                                  .unit = "EV",
                                  .kind = wire::ParameterKind::kNumber,
                                  .min = 0.0,
                                  .max = 1.0,
                                  .help = "0: very clear air; 1: fog",
                                  .default_value = "0.15",
                                  .value = "0.4",
                                  .configured = "0.2"};
  const wire::ParameterState species{.name = "species",
                                     .kind = wire::ParameterKind::kText,
                                     .choices = {"cherry", "zelkova"},
                                     .help = "of the tree",
                                     .left_out = "as the season says",
                                     .change = KeyChange::kCrossFade};
  return {.done = true,
          .message = "[look] haze: 0.2 -> 0.4",
          .scenes = {},
          .parameters = wire::ParameterReport{
              .number = 77, .refusal = "not from there", .groups = {{"", "", {haze}}, {"elm", "tree", {species}}}}};
}

inline wire::Sensors sensors() {
  wire::SensorStatus gauge;
  gauge.name = "roof";
  gauge.driver = "modbus";
  gauge.link = wind::LinkState::kConnected;
  gauge.health = wind::SourceHealth::kStale;
  gauge.detail = "answers again";
  gauge.speed_m_s = 0.0;
  gauge.direction_deg = 359.5;
  gauge.simulated = true;
  gauge.age_s = 0.25;
  gauge.interval_s = 1.0;
  gauge.readings = 1234;
  gauge.refused = {{"timeout", 3}, {"exception", 1}};
  gauge.frames = 1250;
  gauge.reconnects = 2;
  gauge.replayed = true;
  gauge.state = wind::judging::SensorState::kFrozen;
  gauge.state_reason = "the same 3.42 m/s 61 times";
  gauge.value = "mean over 3 s (its manual)";
  gauge.reads_times_group = 1.25;
  gauge.raw_speed_m_s = 0.5;
  gauge.raw_direction_deg = 349.5;
  gauge.quantities = {
      {.quantity = wind::judging::Quantity::kDirection, .age_s = 180.5, .is_missing = true, .reason = "none for 3 min"},
      {.quantity = wind::judging::Quantity::kGust}};
  const wire::Shaping shaping{.site_gain = 1.75,
                              .floor_gain = 2.5,
                              .breeze_m_s = 0.25,
                              .opening = 0.5,
                              .ceiling_gain = 0.875,
                              .mean_m_s = 0.75,
                              .shaped_mean_m_s = 1.5,
                              .site_median_m_s = 1.25,
                              .site_strong_m_s = 3.5,
                              .site_known_s = 86400.0,
                              .text = "floor: raised 0.8 to 1.5 m/s",
                              .gusts = 2.25,
                              .openness = 0.25};
  return {
      .sensors = {gauge, {}},
      .wind = wind(),
      .late_ticks = 5,
      .clients = 2,
      .shaping = shaping,
      .refused_clients = 6,
      .stuck_clients = 7,
      .idle_clients = 8,
      .io_lateness = wire::Lateness{.p50_s = 0.0625, .p99_s = 0.125, .max_s = 1.5},
      .tick_lateness = wire::Lateness{.p50_s = 0.03125, .p99_s = 0.25, .max_s = 2.5},
      .recorder = wire::RecorderStatus{.state = wire::RecorderState::kRetrying,
                                       .written = 9,
                                       .waiting = 10,
                                       .lost = 11,
                                       .free_bytes = 0,
                                       .error = "wall.windlog: the disk is full",
                                       .clock_doubt = "the clock is doubted: it jumped",
                                       .recorded_elsewhere = 12},
      .look = look::Look{.sun = look::SunChoice::kTime,
                         .latitude_deg = -33.5,
                         .longitude_deg = 18.25,
                         .solar_time_h = 6.5,
                         .sun_height_deg = 12.0,
                         .sun_azimuth_deg = 80.0,
                         .clouds = 0.75,
                         .haze = 0.5,
                         .exposure_ev = -1.5,
                         .quality = look::Quality::kMedium,
                         .palette = look::Palette::kWinter,
                         .ground = look::GroundKind::kSand,
                         .ground_image_width_m = 1.5,
                         .density = 0.75},
      .cameras = {look::Camera{.name = "dawn", .wind_angle_deg = 75.0, .from_h = 5.5}, look::Camera{.name = "night",
                                                                                                    .scene = "fire",
                                                                                                    .target_x_m = 1.0,
                                                                                                    .target_y_m = 2.0,
                                                                                                    .target_z_m = 3.0,
                                                                                                    .heading_deg = 90.0,
                                                                                                    .pitch_deg = -5.0,
                                                                                                    .distance_m = 12.0,
                                                                                                    .fov_deg = 25.0,
                                                                                                    .turn_deg_min = 6.0,
                                                                                                    .sway_deg = 7.0,
                                                                                                    .pan_deg = 8.0,
                                                                                                    .dolly_m = 2.5,
                                                                                                    .track_m = 1.5,
                                                                                                    .period_s = 300.0,
                                                                                                    .from_h = 21.0,
                                                                                                    .fade_s = 30.0}},
      .camera = 1,
      .parameters_revision = 21,
      .animation = wire::AnimationStatus{.running_s = 3600.5,
                                         .period_s = 0.015625,
                                         .tick_s = 0.00390625,
                                         .scenes = {{"grass", 0.001953125}, {"fire", 0.0009765625}}},
      .recent_ticks = 36'000,
      .recent_skipped_ticks = 40,
      .troubles = {"the page cannot be served"},
      .given_up = 3,
      .gust_reach_across = 1.5,
      .feeds = {{.kind = "osc",
                 .name = "wall",
                 .target = "192.168.1.40:9000",
                 .sends = "wind",
                 .messages = 60,
                 .bytes = 9000,
                 .last_sent_age_s = 0.25,
                 .trouble = "nothing listens"},
                {.kind = "dmx", .name = "lamp", .target = "multicast", .sends = "2 channels"}}};
}

inline wire::RawTrace raw_trace() {
  return {.sensor = "roof",
          .mono_ns = 12'345'678'901,
          .utc_ns = 1'700'000'000'000'000'000,
          .received = true,
          .bytes = {0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A},
          .length = 7,
          .lost = 3};
}

/// One of each, in the order of wire::Message, scenes and a frame of all kinds, and a wish for players; with their size
/// prefixes.
inline std::vector<wire::Bytes> one_of_each() {
  return {wire::encode(hello()),           wire::encode(subscribe()),
          wire::encode(scenes()),          frame_bytes(),
          wire::encode(sensors()),         wire::encode(control()),
          wire::encode(control_reply()),   wire::encode(raw_trace()),
          wire::encode(all_kinds()),       frame_of_all_kinds(),
          wire::encode(player_control()),  wire::encode(parameter_control()),
          wire::encode(parameter_reply()), wire::encode(hand_control())};
}

/// What decode() takes: the bytes behind the size prefix.
inline std::span<const std::uint8_t> body(const wire::Bytes& message) {
  return std::span(message).subspan(wire::kSizePrefixBytes);
}

}  // namespace yuragi::samples
