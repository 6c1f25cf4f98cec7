#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "engine/wire/schema.hpp"
#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/engine/wire/soundness.hpp"

// What decode() does with bytes that no encoder of ours made. The sanitizer presets make these tests sharp.

namespace yuragi::wire {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Does a message that decode() let through keep what wire.hpp and skeleton.hpp promise?
bool is_safe(const Message& message) {
  if (const auto* scenes = std::get_if<Scenes>(&message)) {
    return std::all_of(scenes->scenes.begin(), scenes->scenes.end(), [](const SceneModel& scene) {
      const auto& image = scene.cloth.image;
      const bool is_sound_image =
          image == nullptr || image->rgb.size() == std::size_t{3} * image->width_px * image->height_px;
      return samples::is_sound(scene.skeleton) && is_sound_image;
    });
  }
  if (const auto* trace = std::get_if<RawTrace>(&message)) {
    return trace->bytes.size() <= kMaxRawBytes && trace->bytes.size() <= trace->length;
  }
  if (const auto* frame = std::get_if<Frame>(&message)) {
    if (!std::isfinite(frame->info.time_s) || !std::isfinite(frame->info.wind.wind.u_m_s)) return false;
    if (!std::isfinite(frame->info.wind.upwind_m) || !(frame->info.wind.to_middle_s >= 0.0)) return false;
    if (frame->opacities.size() != frame->poses.size()) return false;
    return std::all_of(frame->poses.begin(), frame->poses.end(),
                       [](const pose::Pose& pose) { return samples::is_sound(pose); });
  }
  return true;
}

TEST(HostileBytes, EveryTruncationIsRefused) {
  for (const Bytes& message : samples::one_of_each()) {
    const auto body = samples::body(message);
    for (std::size_t length = 0; length < body.size(); ++length) {
      // A buffer of its own, so that the address sanitizer sees any read behind the end.
      const Bytes cut(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(length));
      const auto result = decode(cut);
      if (result) {
        EXPECT_TRUE(is_safe(*result)) << length;  // only padding was lost
        EXPECT_LT(body.size() - length, 8u);
      }
    }
  }
}

TEST(HostileBytes, RandomDamageIsRefusedOrHarmless) {
  std::mt19937 random(3);
  std::size_t refused = 0;
  for (const Bytes& message : samples::one_of_each()) {
    for (int i = 0; i < 4000; ++i) {
      Bytes damaged(samples::body(message).begin(), samples::body(message).end());
      const std::size_t places = 1 + random() % 4;
      for (std::size_t k = 0; k < places; ++k) {
        // Half of it where the structure is: the offsets at the front and the tables at the back.
        const std::size_t near_edge = std::min<std::size_t>(96, damaged.size());
        const std::size_t at = random() % 2 == 0 ? random() % near_edge : random() % damaged.size();
        damaged[at] = static_cast<std::uint8_t>(random());
      }
      const auto result = decode(damaged);
      if (result) {
        ASSERT_TRUE(is_safe(*result));
      } else {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 1000u);
}

TEST(HostileBytes, NoiseIsRefused) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    Bytes noise(random() % 200);
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
    EXPECT_FALSE(decode(noise).has_value());
  }
}

TEST(HostileBytes, TheFileIdentifierIsAskedFor) {
  Bytes hello = encode(samples::hello());
  ASSERT_EQ(std::string(hello.begin() + 8, hello.begin() + 12), "YURA");
  hello[8] = 'Z';
  EXPECT_EQ(decode(samples::body(hello)).error(), Error::kNotVerified);
}

TEST(HostileBytes, ASizePrefixOutOfBoundsIsRefused) {
  const auto read = [](std::array<std::uint8_t, 4> prefix) { return read_size_prefix(prefix, 4096); };
  EXPECT_EQ(read({0x00, 0x10, 0, 0}).value(), 4096u);
  EXPECT_EQ(read({0x01, 0x10, 0, 0}).error(), Error::kTooLong);
  EXPECT_EQ(read({0, 0, 0, 0}).error(), Error::kTooLong);
  EXPECT_EQ(read({0xff, 0xff, 0xff, 0xff}).error(), Error::kTooLong);
}

// ---- verified, but inconsistent ----

/// decode()'s answer to samples::scenes() after a change of the first skeleton.
Result<Message, Error> scenes_with(const std::function<void(pose::StrandSkeleton&)>& change) {
  Scenes scenes = samples::scenes();
  change(std::get<pose::StrandSkeleton>(scenes.scenes[0].skeleton));
  return decode(samples::body(encode(scenes)));
}

TEST(HostileBytes, SkeletonsOutOfBoundsAreRefused) {
  ASSERT_TRUE(scenes_with([](pose::StrandSkeleton&) {}).has_value());
  const std::vector<std::function<void(pose::StrandSkeleton&)>> changes{
      [](auto& s) { s.links_per_strand = 0; },
      [](auto& s) { s.links_per_strand = 257; },
      [](auto& s) { s.root_x_m[5] = kNan; },
      [](auto& s) { s.root_y_m[5] = kInfinity; },
      [](auto& s) { s.root_z_m[5] = 1e30f; },
      [](auto& s) { s.rest_x[5] = kNan; },
      [](auto& s) { s.rest_x[5] *= 1.5f; },
      [](auto& s) { s.curl_z[36] += 0.5f; },
      [](auto& s) { s.rest_curl_rad[0] = -kInfinity; },
      [](auto& s) { s.link_length_m[0] = -0.1f; },
      [](auto& s) { s.link_length_m[0] = kNan; },
      [](auto& s) { s.columns = s.strand_count + 1; },  // rows that are not full
      [](auto& s) { s.columns = s.strand_count - 1; },
      [](auto& s) {  // unit vectors, but not one across the other
        s.curl_x = s.rest_x;
        s.curl_y = s.rest_y;
        s.curl_z = s.rest_z;
      },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto result = scenes_with(changes[i]);
    ASSERT_FALSE(result.has_value()) << i;
    EXPECT_EQ(result.error(), Error::kInconsistent) << i;
  }
}

/// decode()'s answer to samples::all_kinds() after a change of scene `index`, which is of this kind.
template <class Kind>
Result<Message, Error> kinds_with(std::size_t index, const std::function<void(Kind&)>& change) {
  Scenes scenes = samples::all_kinds();
  change(std::get<Kind>(scenes.scenes[index].skeleton));
  return decode(samples::body(encode(scenes)));
}

TEST(HostileBytes, ClothsOutOfBoundsAreRefused) {
  ASSERT_TRUE(kinds_with<pose::GridSkeleton>(1, [](auto&) {}).has_value());
  const std::vector<std::function<void(pose::GridSkeleton&)>> changes{
      [](auto& s) { s.rest_x_m[5] = kNan; },
      [](auto& s) { s.rest_y_m[40] = kInfinity; },
      [](auto& s) { s.rest_z_m[0] = 1e30f; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_EQ(kinds_with<pose::GridSkeleton>(1, changes[i]).error(), Error::kInconsistent) << i;
}

TEST(HostileBytes, AFoliageThatIsNotKnownIsGreen) {
  const auto result = kinds_with<pose::TreeSkeleton>(
      2, [](auto& s) { s.foliage = static_cast<pose::FoliageColor>(pose::kFoliageColorNames.size()); });
  ASSERT_TRUE(result.has_value()) << "a newer server may have more colours";
  EXPECT_EQ(std::get<pose::TreeSkeleton>(std::get<Scenes>(*result).scenes[2].skeleton).foliage,
            pose::FoliageColor::kGreen);
}

TEST(HostileBytes, TreesOutOfBoundsAreRefused) {
  ASSERT_TRUE(kinds_with<pose::TreeSkeleton>(2, [](auto&) {}).has_value());
  const std::vector<std::function<void(pose::TreeSkeleton&)>> changes{
      [](auto& s) { s.levels.clear(); },
      [](auto& s) { s.levels.resize(pose::kMaxTreeLevels + 1, s.levels[1]); },
      [](auto& s) { s.levels[1].parent[4] = 1; },  // the trunk is alone
      [](auto& s) { s.levels[2].parent[0] = 5; },  // of five limbs, counted from 0
      [](auto& s) { s.levels[2].parent[0] = ~0u; },
      [](auto& s) { s.levels[2].parent_link[0] = 6; },  // of six links
      [](auto& s) { s.levels[1].parent_level = 1; },    // itself
      [](auto& s) { s.levels[1].parent_level = 2; },    // what grows on it
      [](auto& s) { s.levels[0].strands.rest_x[0] = kNan; },
      [](auto& s) { s.levels[1].strands.links_per_strand = 0; },
      [](auto& s) { s.levels[1].base_radius_m[0] = -1.0f; },
      [](auto& s) { s.levels[2].tip_radius_m[0] = kInfinity; },
      [](auto& s) { s.copies.x_m[0] = kNan; },
      [](auto& s) { s.copies.z_m[1] = kInfinity; },
      [](auto& s) { s.copies.turn_rad[0] = 100.0f; },
      [](auto& s) { s.copies.scale[0] = 0.0f; },
      [](auto& s) { s.copies.scale[1] = 1e3f; },
      [](auto& s) { s.copies.scale.pop_back(); },
      [](auto& s) { s.copies.x_m.pop_back(); },
      [](auto& s) {
        for (auto* values : {&s.copies.x_m, &s.copies.z_m, &s.copies.turn_rad, &s.copies.scale}) {
          values->assign(pose::kMaxTreeCopies + 1, 1.0f);
        }
      },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto result = kinds_with<pose::TreeSkeleton>(2, changes[i]);
    ASSERT_FALSE(result.has_value()) << i;
    EXPECT_EQ(result.error(), Error::kInconsistent) << i;
  }
}

TEST(HostileBytes, SurfacesOutOfBoundsAreRefused) {
  ASSERT_TRUE(kinds_with<pose::SurfaceSkeleton>(4, [](auto&) {}).has_value());
  const std::vector<std::function<void(pose::SurfaceSkeleton&)>> changes{
      [](auto& s) { s.rest_y_m[5] = kNan; },
      [](auto& s) { s.normal_x[5] += 0.5f; },
      [](auto& s) { s.normal_z[5] = kNan; },
      [](auto& s) { s.ramp_rgba.pop_back(); },
      [](auto& s) { s.ramp_rgba.resize(2048); },
      [](auto& s) { s.shells = 0; },
      [](auto& s) { s.shells = 4; },  // of 15 columns
      [](auto& s) { s.axis_x_m.pop_back(); },
      [](auto& s) { s.axis_z_m.clear(); },
      [](auto& s) { s.axis_z_m[3] = kNan; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_EQ(kinds_with<pose::SurfaceSkeleton>(4, changes[i]).error(), Error::kInconsistent) << i;
}

TEST(HostileBytes, CommandsByHandOutOfBoundsAreRefused) {
  const auto refusal = [](const HandCommand& hand) {
    return decode(samples::body(encode(Control{.scene = "", .hand = hand}))).error();
  };
  for (const double bad : {std::nan(""), 1e300, -1.0, 1e6}) {
    EXPECT_EQ(refusal({.part = HandPart::kWind, .for_s = bad}), Error::kInconsistent);
    EXPECT_EQ(refusal({.part = HandPart::kWind, .speed_m_s = bad}), Error::kInconsistent);
    EXPECT_EQ(refusal({.part = HandPart::kWind, .direction_deg = bad}), Error::kInconsistent);
  }
  EXPECT_EQ(refusal({.part = static_cast<HandPart>(4)}), Error::kInconsistent);
}

TEST(HostileBytes, ControlsOutOfBoundsAreRefused) {
  for (const double over_s : {-1.0, kMaxFade_s + 1.0, std::nan("")}) {
    EXPECT_EQ(decode(samples::body(encode(Control{.scene = "elm", .over_s = over_s}))).error(), Error::kInconsistent);
  }
  ControlReply reply;
  reply.scenes.resize(kMaxScenes + 1);
  EXPECT_EQ(decode(samples::body(encode(reply))).error(), Error::kInconsistent);
}

TEST(HostileBytes, ParametersBeyondTheLimitsAreNeverDecoded) {
  Control control = samples::parameter_control();
  control.parameters->edits.assign(1000, {std::string(5000, 'k'), std::string(5000, 'v')});
  const auto command = decode(samples::body(encode(control)));
  ASSERT_TRUE(command);
  const auto& edits = std::get<Control>(*command).parameters->edits;
  ASSERT_EQ(edits.size(), kMaxParameterEdits);
  EXPECT_EQ(edits[0].key.size(), kMaxTextBytes);

  // What no encoder of ours makes.
  const auto refuses_command = [](std::size_t edit_count) {
    flatbuffers::FlatBufferBuilder builder;
    std::vector<flatbuffers::Offset<fb::ParameterEdit>> list;
    for (std::size_t i = 0; i < edit_count; ++i) list.push_back(fb::CreateParameterEditDirect(builder, "haze", "1"));
    const auto parameters = fb::CreateParameterCommandDirect(builder, "", &list);
    const auto body = fb::CreateControl(builder, 0, true, false, 2.0F, 0, 0, parameters);
    fb::FinishSizePrefixedMessageBuffer(builder, fb::CreateMessage(builder, fb::Body_Control, body.Union()));
    const Bytes bytes(builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize());
    return !decode(samples::body(bytes));
  };
  EXPECT_FALSE(refuses_command(kMaxParameterEdits));
  EXPECT_TRUE(refuses_command(kMaxParameterEdits + 1));

  const auto refuses_limits = [](double min, double max) {
    ControlReply reply = samples::parameter_reply();
    reply.parameters->groups[0].parameters[0].min = min;
    reply.parameters->groups[0].parameters[0].max = max;
    return !decode(samples::body(encode(reply)));
  };
  EXPECT_FALSE(refuses_limits(-1.0, 1.0));
  EXPECT_TRUE(refuses_limits(1.0, -1.0));
  EXPECT_TRUE(refuses_limits(std::nan(""), 1.0));
  EXPECT_TRUE(refuses_limits(0.0, std::numeric_limits<double>::infinity()));
}

TEST(HostileBytes, PlayerCommandsOutOfBoundsAreRefused) {
  const auto refusal = [](const PlayerCommand& command) {
    const auto message = decode(samples::body(encode(Control{.scene = "", .player = command})));
    return message ? std::optional<Error>{} : message.error();
  };
  EXPECT_FALSE(refusal({}));
  for (const double rate : {-1.0, 0.0, 0.001, 1e9, std::nan("")}) {
    EXPECT_EQ(refusal({.rate = rate}), Error::kInconsistent) << rate;
  }
  EXPECT_EQ(refusal({.count = 0}), Error::kInconsistent);
  EXPECT_EQ(refusal({.count = kMaxSteps + 1}), Error::kInconsistent);
  EXPECT_EQ(refusal({.action = static_cast<PlayerAction>(6)}), Error::kInconsistent);

  ControlReply reply;
  for (const double position_s : {-1.0, std::nan(""), 1e300}) {
    reply.players.assign(1, {});
    reply.players[0].position_s = position_s;
    EXPECT_EQ(decode(samples::body(encode(reply))).error(), Error::kInconsistent) << position_s;
  }
  reply.players.assign(kMaxSensors + 1, {});
  EXPECT_EQ(decode(samples::body(encode(reply))).error(), Error::kInconsistent);
}

TEST(HostileBytes, FramesOutOfBoundsAreRefused) {
  const std::vector<std::function<void(FrameInfo&)>> changes{
      [](auto& f) { f.time_s = std::nan(""); },
      [](auto& f) { f.time_s = -1.0; },
      [](auto& f) { f.wind.wind.u_m_s = std::nan(""); },
      [](auto& f) { f.wind.wind.v_m_s = 1e9; },
      [](auto& f) { f.wind.live_weight = 1.5; },
      [](auto& f) { f.wind.reading_age_s = -1.0; },
      [](auto& f) { f.wind.source = static_cast<wind::Source>(3); },
      [](auto& f) { f.wind.upwind_m = std::nan(""); },
      [](auto& f) { f.wind.upwind_m = 1e7; },
      [](auto& f) { f.wind.to_middle_s = std::nan(""); },
      [](auto& f) { f.wind.to_middle_s = -1.0; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    FrameInfo info = samples::frame_info();
    changes[i](info);
    const auto result = decode(samples::body(samples::frame_bytes(37, info)));
    ASSERT_FALSE(result.has_value()) << i;
    EXPECT_EQ(result.error(), Error::kInconsistent) << i;
  }
}

TEST(HostileBytes, SensorsOutOfBoundsAreRefused) {
  const std::vector<std::function<void(Sensors&)>> changes{
      [](auto& s) { s.sensors[0].link = static_cast<wind::LinkState>(3); },
      [](auto& s) { s.sensors[0].health = static_cast<wind::SourceHealth>(3); },
      [](auto& s) {
        s.sensors[0].state = static_cast<wind::judging::SensorState>(wind::judging::kSensorStateNames.size());
      },
      [](auto& s) { s.sensors[0].speed_m_s = std::nan(""); },
      [](auto& s) { s.sensors[0].age_s = -1.0; },
      [](auto& s) { s.sensors[0].interval_s = std::nan(""); },
      [](auto& s) { s.sensors.resize(kMaxSensors + 1); },
      [](auto& s) { s.sensors[0].refused.resize(kMaxRefusalReasons + 1); },
      [](auto& s) { s.shaping.site_gain = std::nan(""); },
      [](auto& s) { s.shaping.floor_gain = -1.0; },
      [](auto& s) { s.shaping.opening = 1.5; },
      [](auto& s) { s.shaping.mean_m_s = 1e9; },
      [](auto& s) { s.shaping.gusts = std::nan(""); },
      [](auto& s) { s.shaping.gusts = -0.5; },
      [](auto& s) { s.shaping.openness = 1.5; },
      [](auto& s) { s.by_hand.wind = HeldWind{.speed_m_s = std::nan("")}; },
      [](auto& s) { s.by_hand.wind = HeldWind{.direction_deg = -1.0}; },
      [](auto& s) { s.by_hand.wind = HeldWind{.left_s = 1e300}; },
      [](auto& s) { s.by_hand.blackout = Hold{.left_s = -1.0}; },
      [](auto& s) { s.by_hand.camera = Hold{.left_s = std::nan("")}; },
      [](auto& s) { s.wind.upwind_m = std::nan(""); },
      [](auto& s) { s.wind.upwind_m = -1e7; },
      [](auto& s) { s.wind.to_middle_s = -1.0; },
      [](auto& s) { s.wind.to_middle_s = 1e30; },
      [](auto& s) { s.gust_reach_across = std::nan(""); },
      [](auto& s) { s.gust_reach_along = 0.0; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Sensors sensors = samples::sensors();
    changes[i](sensors);
    const auto result = decode(samples::body(encode(sensors)));
    ASSERT_FALSE(result.has_value()) << i;
    EXPECT_EQ(result.error(), Error::kInconsistent) << i;
  }
}

// ---- built by hand, since our encoders cannot ----

/// decode()'s answer to a message of this kind, whose body `build` adds.
template <class Build>
Result<Message, Error> decode_built(fb::Body kind, Build build) {
  flatbuffers::FlatBufferBuilder builder;
  const flatbuffers::Offset<void> body = build(builder);
  fb::FinishSizePrefixedMessageBuffer(builder, fb::CreateMessage(builder, kind, body));
  return decode({builder.GetBufferPointer() + kSizePrefixBytes, builder.GetSize() - kSizePrefixBytes});
}

TEST(HostileBytes, PosesOfTwoLengthsAreRefused) {
  const auto result = decode_built(fb::Body_Frame, [](auto& builder) {
    const auto east = builder.CreateVector(std::vector<std::int16_t>(16));
    const auto south = builder.CreateVector(std::vector<std::int16_t>(15));
    const auto pose = fb::CreateStrandPose(builder, 1e-4f, east, south);
    const auto scene = fb::CreateScenePose(builder, fb::Pose_StrandPose, pose.Union());
    const fb::Wind wind(1, 1, 0, 0, fb::WindSource_Default);
    return fb::CreateFrame(builder, 1, 1, 1.0, 1, &wind, builder.CreateVector(std::vector{scene})).Union();
  });
  EXPECT_EQ(result.error(), Error::kInconsistent);
}

TEST(HostileBytes, AnAbsurdQuantisationStepIsRefused) {
  for (const float step : {0.0f, -1e-4f, 1.0f, kNan}) {
    const auto result = decode_built(fb::Body_Frame, [step](auto& builder) {
      const auto pose = fb::CreateStrandPose(builder, step);
      const auto scene = fb::CreateScenePose(builder, fb::Pose_StrandPose, pose.Union());
      const fb::Wind wind(1, 1, 0, 0, fb::WindSource_Default);
      return fb::CreateFrame(builder, 1, 1, 1.0, 1, &wind, builder.CreateVector(std::vector{scene})).Union();
    });
    EXPECT_EQ(result.error(), Error::kInconsistent) << step;
  }
}

/// decode()'s answer to a frame of one scene, whose pose `build` adds.
template <class Build>
Result<Message, Error> decode_pose(fb::Pose kind, float opacity, Build build) {
  return decode_built(fb::Body_Frame, [&](auto& builder) {
    const flatbuffers::Offset<void> pose = build(builder);
    const auto scene = fb::CreateScenePose(builder, kind, pose, opacity);
    const fb::Wind wind(1, 1, 0, 0, fb::WindSource_Default);
    return fb::CreateFrame(builder, 1, 1, 1.0, 1, &wind, builder.CreateVector(std::vector{scene})).Union();
  });
}

TEST(HostileBytes, WaysOfAnAbsurdStepOrOfUnequalLengthsAreRefused) {
  const auto grid = [](std::uint32_t columns, float step_m, std::size_t last) {
    return decode_pose(fb::Pose_GridPose, 1.0f, [&](auto& builder) {
      const auto ways = builder.CreateVector(std::vector<std::int16_t>(12));
      const auto others = builder.CreateVector(std::vector<std::int16_t>(last));
      return fb::CreateGridPose(builder, columns, step_m, ways, ways, others).Union();
    });
  };
  ASSERT_TRUE(grid(4, 1e-4f, 12).has_value());
  for (const float step_m : {0.0f, -1e-4f, 2.0f, kNan}) EXPECT_FALSE(grid(4, step_m, 12).has_value()) << step_m;
  for (const std::uint32_t columns : {0u, 5u, 13u, ~0u}) EXPECT_FALSE(grid(columns, 1e-4f, 12).has_value()) << columns;
  EXPECT_FALSE(grid(4, 1e-4f, 11).has_value());

  const auto surface = [](float step_m, std::size_t heats, std::size_t rows = 0, std::size_t last_rows = 0,
                          float slope_step = 1e-4f) {
    return decode_pose(fb::Pose_SurfacePose, 1.0f, [&](auto& builder) {
      const auto ways = builder.CreateVector(std::vector<std::int16_t>(12));
      const auto heat = builder.CreateVector(std::vector<std::uint8_t>(heats));
      const auto row_ways = builder.CreateVector(std::vector<std::int16_t>(rows));
      const auto last = builder.CreateVector(std::vector<std::int16_t>(last_rows));
      return fb::CreateSurfacePose(builder, step_m, ways, heat, row_ways, row_ways, row_ways, slope_step, row_ways,
                                   last)
          .Union();
    });
  };
  ASSERT_TRUE(surface(1e-4f, 12, 4, 4).has_value());
  EXPECT_FALSE(surface(1e-4f, 12, 4, 3).has_value());
  EXPECT_FALSE(surface(1e-4f, 12, 4, 0).has_value());
  EXPECT_FALSE(surface(1e-4f, 12, 13, 13).has_value()) << "more rows than points";
  for (const float step : {0.0f, 2.0f, kNan}) EXPECT_FALSE(surface(1e-4f, 12, 4, 4, step).has_value()) << step;
  ASSERT_TRUE(surface(1e-4f, 12).has_value());
  ASSERT_TRUE(surface(1e-4f, 0).has_value());
  EXPECT_FALSE(surface(kNan, 12).has_value());
  EXPECT_FALSE(surface(1e-4f, 11).has_value());
}

TEST(HostileBytes, AnOpacityOutOfBoundsIsRefusedAndSoIsAPoseThatIsMissedWhereItIsSeen) {
  const auto pose = [](auto& builder) { return fb::CreateStrandPose(builder, 1e-4f).Union(); };
  ASSERT_TRUE(decode_pose(fb::Pose_StrandPose, 0.5f, pose).has_value());
  for (const float opacity : {-0.1f, 1.1f, kNan, kInfinity})
    EXPECT_FALSE(decode_pose(fb::Pose_StrandPose, opacity, pose).has_value()) << opacity;

  const auto nothing = [](auto&) { return flatbuffers::Offset<void>(); };
  EXPECT_TRUE(decode_pose(fb::Pose_NONE, 0.0f, nothing).has_value());
  EXPECT_FALSE(decode_pose(fb::Pose_NONE, 0.5f, nothing).has_value());
}

TEST(HostileBytes, AGridOfMorePointsThanThereAreIsRefused) {
  for (const auto& size : {std::pair{1u, 1u << 20}, {~0u, ~0u}, {1u << 16, 1u << 16}, {2u, 6u}, {4u, 4u}}) {
    const auto columns = size.first;
    const auto rows = size.second;
    const auto cloth = decode_built(fb::Body_Scenes, [&](auto& builder) {
      const auto values = builder.CreateVector(std::vector<float>(12));
      const auto grid = fb::CreateGridSkeleton(builder, columns, rows, false, values, values, values).Union();
      const auto scene = fb::CreateScene(builder, 0, 0, fb::Skeleton_GridSkeleton, grid);
      return fb::CreateScenes(builder, builder.CreateVector(std::vector{scene})).Union();
    });
    EXPECT_EQ(cloth.has_value(), columns * rows == 12) << columns << ' ' << rows;
  }
}

TEST(HostileBytes, APictureThatIsNotAsLargeAsItSaysIsRefused) {
  const auto with_image = [](std::uint32_t width_px, std::uint32_t height_px, std::size_t bytes) {
    return decode_built(fb::Body_Scenes, [&](auto& builder) {
      const auto values = builder.CreateVector(std::vector<float>(4));
      const auto grid = fb::CreateGridSkeleton(builder, 2, 2, false, values, values, values).Union();
      const auto rgb = builder.CreateVector(std::vector<std::uint8_t>(bytes));
      const auto cloth = fb::CreateCloth(builder, flatbuffers::nullopt, flatbuffers::nullopt, width_px, height_px, rgb);
      const auto scene = fb::CreateScene(builder, 0, 0, fb::Skeleton_GridSkeleton, grid, cloth);
      return fb::CreateScenes(builder, builder.CreateVector(std::vector{scene})).Union();
    });
  };
  EXPECT_TRUE(with_image(5, 4, 60).has_value());
  EXPECT_TRUE(with_image(1024, 1024, 3U << 20).has_value());
  EXPECT_TRUE(with_image(0, 0, 0).has_value());
  struct Case {
    std::uint32_t width_px, height_px;
    std::size_t bytes;
  };
  for (const auto& [width_px, height_px, bytes] :
       {Case{5, 4, 59}, Case{5, 4, 61}, Case{5, 0, 60}, Case{0, 0, 3}, Case{8192, 1, 3 * 8192},
        Case{1025, 1024, 3 * 1025 * 1024}, Case{1U << 31, 1U << 31, 0}, Case{0xFFFFFFFF, 0xFFFFFFFF, 3}}) {
    EXPECT_EQ(with_image(width_px, height_px, bytes).error(), Error::kInconsistent)
        << width_px << ' ' << height_px << ' ' << bytes;
  }
}

TEST(HostileBytes, ScenesThatShareAPictureDoNotAskForMuchMemory) {
  const auto shared = [](std::size_t scene_count) {
    return decode_built(fb::Body_Scenes, [&](auto& builder) {
      const auto values = builder.CreateVector(std::vector<float>(4));
      const auto grid = fb::CreateGridSkeleton(builder, 2, 2, false, values, values, values).Union();
      const auto rgb = builder.CreateVector(std::vector<std::uint8_t>(3U << 20));
      const auto cloth = fb::CreateCloth(builder, flatbuffers::nullopt, flatbuffers::nullopt, 1024, 1024, rgb);
      std::vector<flatbuffers::Offset<fb::Scene>> scenes;
      for (std::size_t i = 0; i < scene_count; ++i) {
        scenes.push_back(fb::CreateScene(builder, 0, 0, fb::Skeleton_GridSkeleton, grid, cloth));
      }
      return fb::CreateScenes(builder, builder.CreateVector(scenes)).Union();
    });
  };
  EXPECT_TRUE(shared(8).has_value());
  EXPECT_EQ(shared(9).error(), Error::kInconsistent);
}

TEST(HostileBytes, AFrameWithoutWindIsRefused) {
  const auto result = decode_built(fb::Body_Frame, [](auto& builder) { return fb::CreateFrame(builder).Union(); });
  EXPECT_EQ(result.error(), Error::kInconsistent);
}

TEST(HostileBytes, ASkeletonOfUnequalArraysIsRefused) {
  const auto result = decode_built(fb::Body_Scenes, [](auto& builder) {
    const auto roots = builder.CreateVector(std::vector<float>(3));
    const auto skeleton = fb::CreateStrandSkeleton(builder, 4, roots, roots, roots).Union();
    const auto scene = fb::CreateScene(builder, 0, 0, fb::Skeleton_StrandSkeleton, skeleton);
    return fb::CreateScenes(builder, builder.CreateVector(std::vector{scene})).Union();
  });
  EXPECT_EQ(result.error(), Error::kInconsistent);
}

TEST(HostileBytes, ASceneWithoutSkeletonIsRefused) {
  const auto result = decode_built(fb::Body_Scenes, [](auto& builder) {
    const auto scene = fb::CreateScene(builder);
    return fb::CreateScenes(builder, builder.CreateVector(std::vector{scene})).Union();
  });
  EXPECT_EQ(result.error(), Error::kInconsistent);
}

TEST(HostileBytes, FewBytesCannotAskForMuchMemory) {
  // One long array of bends, which many poses share.
  const auto result = decode_built(fb::Body_Frame, [](auto& builder) {
    const auto bends = builder.CreateVector(std::vector<std::int16_t>(kMaxStrands / 8));
    std::vector<flatbuffers::Offset<fb::ScenePose>> scenes;
    for (std::size_t i = 0; i < kMaxScenes; ++i) {
      const auto pose = fb::CreateStrandPose(builder, 1e-4f, bends, bends);
      scenes.push_back(fb::CreateScenePose(builder, fb::Pose_StrandPose, pose.Union()));
    }
    const fb::Wind wind(1, 1, 0, 0, fb::WindSource_Default);
    return fb::CreateFrame(builder, 1, 1, 1.0, 1, &wind, builder.CreateVector(scenes)).Union();
  });
  EXPECT_EQ(result.error(), Error::kInconsistent);
}

TEST(HostileBytes, ATreesLevelsCannotAskForMuchMemoryEither) {
  const auto result = decode_pose(fb::Pose_TreePose, 1.0f, [](auto& builder) {
    const auto bends = builder.CreateVector(std::vector<std::int16_t>(kMaxStrands / 4));
    std::vector<flatbuffers::Offset<fb::StrandPose>> levels(pose::kMaxTreeLevels);
    for (auto& level : levels) level = fb::CreateStrandPose(builder, 1e-4f, bends, bends);
    return fb::CreateTreePose(builder, builder.CreateVector(levels)).Union();
  });
  EXPECT_EQ(result.error(), Error::kInconsistent);
}

TEST(HostileBytes, AVeryLongTextIsRefused) {
  const auto result = decode_built(fb::Body_Subscribe, [](auto& builder) {
    return fb::CreateSubscribe(builder, 1, true, false, builder.CreateString(std::string(kMaxTextBytes + 1, 'x')))
        .Union();
  });
  EXPECT_EQ(result.error(), Error::kInconsistent);
}

TEST(HostileBytes, AWishForTheWindIsYesOrNoWhateverTheByte) {
  for (const std::uint8_t byte : std::array<std::uint8_t, 4>{0, 1, 2, 255}) {
    const auto result = decode_built(fb::Body_Subscribe, [&](auto& builder) {
      fb::SubscribeBuilder table(builder);
      table.add_protocol(1);
      builder.template AddElement<std::uint8_t>(fb::Subscribe::VT_WIND, byte, 0);
      return table.Finish().Union();
    });
    ASSERT_TRUE(result.has_value()) << int{byte};
    EXPECT_EQ(std::get<Subscribe>(*result).wind, byte != 0) << int{byte};
  }
}

TEST(HostileBytes, ARawTraceOfMoreThanIsPromisedIsRefused) {
  const auto trace = [](std::size_t kept, std::uint32_t length) {
    return decode_built(fb::Body_RawTrace, [&](auto& builder) {
      const auto sensor = builder.CreateString("roof");
      const auto bytes = builder.CreateVector(std::vector<std::uint8_t>(kept));
      return fb::CreateRawTrace(builder, sensor, 1, 1, true, bytes, length, 0).Union();
    });
  };
  EXPECT_TRUE(trace(kMaxRawBytes, 2000).has_value());
  EXPECT_TRUE(trace(0, 0).has_value());
  EXPECT_EQ(trace(kMaxRawBytes + 1, 2000).error(), Error::kInconsistent);
  EXPECT_EQ(trace(8, 7).error(), Error::kInconsistent) << "more bytes than the message has";
}

// ---- of an older or a newer server ----

TEST(OlderServer, AWindWithoutAPlaceIsInTheMiddleAndGustsAreTheRealOnes) {
  const fb::Wind wind(1, 1, 0, 0, fb::WindSource_Default);
  const auto frame = decode_built(fb::Body_Frame,
                                  [&](auto& builder) { return fb::CreateFrame(builder, 1, 1, 1.0, 1, &wind).Union(); });
  const auto sensors = decode_built(fb::Body_Sensors, [&](auto& builder) {
    return fb::CreateSensors(builder, 0, &wind, 0, 0, fb::CreateShaping(builder)).Union();
  });
  for (const wind::State& state : {std::get<Frame>(frame.value()).info.wind, std::get<Sensors>(sensors.value()).wind}) {
    EXPECT_EQ(state.upwind_m, 0.0);
    EXPECT_EQ(state.to_middle_s, 0.0);
    EXPECT_FALSE(state.is_place_configured);
  }
  EXPECT_EQ(std::get<Sensors>(sensors.value()).shaping.gusts, 1.0);
  EXPECT_EQ(std::get<Sensors>(sensors.value()).shaping.openness, 1.0);
}

TEST(NewerServer, ABodyOfAnUnknownKindIsToldApartFromABadOne) {
  const auto build = [](auto& builder) { return fb::CreateHello(builder).Union(); };
  EXPECT_EQ(decode_built(static_cast<fb::Body>(fb::Body_MAX + 1), build).error(), Error::kUnknown);
  EXPECT_EQ(decode_built(fb::Body_NONE, build).error(), Error::kUnknown);
}

TEST(NewerServer, ASceneOfAnUnknownKindHasNoStrandsAndFitsItsPoses) {
  const auto scenes = decode_built(fb::Body_Scenes, [](auto& builder) {
    const auto kind = builder.CreateString("cloud");
    const auto unknown = fb::CreateHello(builder).Union();
    const auto scene = fb::CreateScene(builder, 0, kind, static_cast<fb::Skeleton>(fb::Skeleton_MAX + 1), unknown);
    return fb::CreateScenes(builder, builder.CreateVector(std::vector{scene})).Union();
  });
  const auto frame = decode_built(fb::Body_Frame, [](auto& builder) {
    const auto unknown = fb::CreateHello(builder).Union();
    const auto scene = fb::CreateScenePose(builder, static_cast<fb::Pose>(fb::Pose_MAX + 1), unknown);
    const fb::Wind wind(1, 1, 0, 0, fb::WindSource_Default);
    return fb::CreateFrame(builder, 1, 1, 1.0, 1, &wind, builder.CreateVector(std::vector{scene})).Union();
  });
  const auto& known = std::get<Scenes>(scenes.value());
  EXPECT_EQ(known.scenes.at(0).kind, "cloud");
  EXPECT_EQ(std::get<pose::StrandSkeleton>(known.scenes[0].skeleton).strand_count, 0u);
  EXPECT_TRUE(fits(std::get<Frame>(frame.value()), known));
}

}  // namespace
}  // namespace yuragi::wire
