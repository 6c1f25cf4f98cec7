#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
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

TEST(WireRoundTrip, WhatAPartOfAWallGivesUpComesBack) {
  EXPECT_FALSE(decoded<Hello>(encode(Hello{})).takes_display);
  EXPECT_TRUE(decoded<Hello>(encode(Hello{.software = "", .takes_display = true})).takes_display);
  for (const std::uint8_t given_up : std::array<std::uint8_t, 3>{0, 4, 255}) {
    EXPECT_EQ(decoded<Display>(encode(Display{.given_up = given_up})).given_up, given_up);
  }
}

TEST(WireRoundTrip, TheClockOfAPartOfAWallComesBackUnlessItIsNoNumber) {
  EXPECT_EQ(decoded<Display>(encode(Display{})).clock_offset_s, std::nullopt);
  for (const double offset_s : {0.0, -0.0123, 3600.0})
    EXPECT_EQ(decoded<Display>(encode(Display{.clock_offset_s = offset_s})).clock_offset_s, offset_s);
  for (const double offset_s : {std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    const Bytes bytes = encode(Display{.clock_offset_s = offset_s});
    EXPECT_FALSE(decode(std::span(bytes).subspan(kSizePrefixBytes)));
  }
}

TEST(WireRoundTrip, SubscribeComesBackAsItWas) {
  const Subscribe subscribe = decoded<Subscribe>(encode(samples::subscribe()));
  EXPECT_EQ(subscribe.protocol, kProtocol);
  EXPECT_TRUE(subscribe.poses);
  EXPECT_TRUE(subscribe.sensors);
  EXPECT_EQ(subscribe.client, "a wall in Morioka");
  EXPECT_TRUE(subscribe.raw);
  EXPECT_EQ(subscribe.raw_sensor, "roof");
  EXPECT_TRUE(subscribe.takes_new_scenes);
  Subscribe less = samples::subscribe();
  less.thinning = {.scenes = {"elm", "pond"}, .every = 8};
  less.rate_hz = 12.5;
  less.token = Secret("a token of this wall");
  EXPECT_EQ(decoded<Subscribe>(encode(less)).thinning, less.thinning);
  EXPECT_EQ(decoded<Subscribe>(encode(less)).rate_hz, 12.5);
  EXPECT_EQ(decoded<Subscribe>(encode(less)).token, less.token);
  const Subscribe plain = decoded<Subscribe>(encode(Subscribe{.client = ""}));
  EXPECT_TRUE(plain.thinning.is_all());
  EXPECT_EQ(plain.rate_hz, 0.0);
  EXPECT_TRUE(plain.token.is_empty());
  EXPECT_FALSE(decoded<Subscribe>(encode(Subscribe{.client = ""})).raw) << "only where it is asked for";
  EXPECT_FALSE(decoded<Subscribe>(encode(Subscribe{.client = ""})).takes_new_scenes);
  EXPECT_FALSE(decoded<Subscribe>(encode(Subscribe{.poses = false, .client = ""})).poses);
}

TEST(WireRoundTrip, ASubscriptionToTheWindAloneComesBack) {
  const Subscribe wind =
      decoded<Subscribe>(encode(Subscribe{.poses = false, .client = "", .rate_hz = 20.0, .wind = true}));
  EXPECT_TRUE(wind.wind);
  EXPECT_TRUE(wind.wants_frames());
  EXPECT_EQ(wind.rate_hz, 20.0);
  EXPECT_TRUE(wind.frame_thinning().is_wind_alone);
  EXPECT_FALSE(wind.frame_thinning().is_all());
  const Subscribe both = decoded<Subscribe>(encode(Subscribe{.client = "", .thinning = {.every = 3}, .wind = true}));
  EXPECT_EQ(both.frame_thinning(), Thinning{.every = 3}) << "with poses it changes nothing";
  EXPECT_FALSE(decoded<Subscribe>(encode(Subscribe{.poses = false, .client = ""})).wants_frames());
}

TEST(WireRoundTrip, ASubscriptionThatCannotBeMetIsRefused) {
  const auto outcome = [](const Subscribe& wish) { return decode(samples::body(encode(wish))).has_value(); };
  EXPECT_TRUE(outcome({.client = "", .thinning = {.every = kMaxEvery}, .rate_hz = kMaxRate_hz}));
  EXPECT_FALSE(outcome({.client = "", .thinning = {.every = 0}}));
  EXPECT_FALSE(outcome({.client = "", .thinning = {.every = kMaxEvery + 1}}));
  EXPECT_FALSE(outcome({.client = "", .rate_hz = -1.0}));
  EXPECT_FALSE(outcome({.client = "", .rate_hz = std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(outcome({.client = "", .thinning = {.scenes = std::vector<std::string>(kMaxScenes + 1, "elm")}}));
}

TEST(WireRoundTrip, ScenesComeBackBitForBitAndPaddedToBlocks) {
  const Scenes sent = samples::scenes();
  const Scenes got = decoded<Scenes>(encode(sent));
  ASSERT_EQ(got.scenes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(got.scenes[i].name, sent.scenes[i].name);
    EXPECT_EQ(got.scenes[i].kind, "grass");
    const auto& a = std::get<pose::StrandSkeleton>(sent.scenes[i].skeleton);
    const auto& b = std::get<pose::StrandSkeleton>(got.scenes[i].skeleton);
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
    EXPECT_EQ(b.columns, 0U);
  }
}

TEST(WireRoundTrip, WhatAClothLooksLikeComesBackAsItWas) {
  const Scenes got = decoded<Scenes>(encode(samples::all_kinds()));
  EXPECT_EQ(got.scenes[1].cloth, samples::cloth_look());
  EXPECT_EQ(got.scenes[0].cloth, look::ClothLook{});

  Scenes plain = samples::all_kinds();
  plain.scenes[1].cloth = {.color = look::Color{0, 0, 0}};
  EXPECT_EQ(decoded<Scenes>(encode(plain)).scenes[1].cloth, plain.scenes[1].cloth) << "black is a colour, too";
}

TEST(WireRoundTrip, StrandsOnAGridComeBackWithItsColumns) {
  Scenes sent = samples::scenes();
  auto& strands = std::get<pose::StrandSkeleton>(sent.scenes[0].skeleton);
  strands = samples::meadow(6 * 7);
  strands.columns = 6;
  const Scenes got = decoded<Scenes>(encode(sent));
  EXPECT_EQ(std::get<pose::StrandSkeleton>(got.scenes[0].skeleton), strands);
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
  EXPECT_EQ(frame.info.wind.upwind_m, -12.5);
  EXPECT_EQ(frame.info.wind.to_middle_s, 0.75);
  EXPECT_TRUE(frame.info.wind.is_place_configured);
  EXPECT_EQ(frame.info.view_wind_from_deg, 123.5);

  ASSERT_EQ(frame.poses.size(), 2u);
  const pose::StrandPose bends = samples::bent(37);
  const auto& got = std::get<pose::StrandPose>(frame.poses[0]);
  ASSERT_EQ(got.bend_east_rad.size(), 48u);
  ASSERT_EQ(got.bend_south_rad.size(), 48u);
  const float half_step_rad = 3.14159265f / 32767.0f * 0.5001f;
  for (std::size_t i = 0; i < 48; ++i) {
    EXPECT_NEAR(got.bend_east_rad[i], bends.bend_east_rad[i], half_step_rad) << i;
    EXPECT_NEAR(got.bend_south_rad[i], bends.bend_south_rad[i], half_step_rad) << i;
  }
}

TEST(WireRoundTrip, SkeletonsOfAllKindsComeBackBitForBitAndPadded) {
  const Scenes sent = samples::all_kinds();
  const Scenes got = decoded<Scenes>(encode(sent));
  ASSERT_EQ(got.scenes.size(), sent.scenes.size());

  const auto& cloth = std::get<pose::GridSkeleton>(got.scenes[1].skeleton);
  const pose::GridSkeleton sent_cloth = samples::cloth();
  EXPECT_EQ(cloth.columns, 21u);
  EXPECT_EQ(cloth.rows, 9u);
  EXPECT_TRUE(cloth.is_first_column_fixed);
  EXPECT_EQ(cloth.rest_x_m, sent_cloth.rest_x_m);
  EXPECT_EQ(cloth.rest_y_m, sent_cloth.rest_y_m);
  EXPECT_EQ(cloth.rest_z_m, sent_cloth.rest_z_m);

  const auto& tree = std::get<pose::TreeSkeleton>(got.scenes[2].skeleton);
  const pose::TreeSkeleton sent_tree = samples::tree();
  EXPECT_EQ(tree.foliage, pose::FoliageColor::kAutumn);
  EXPECT_EQ(tree.copies, sent_tree.copies);
  ASSERT_EQ(tree.levels.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const pose::TreeLevel& a = sent_tree.levels[i];
    const pose::TreeLevel& b = tree.levels[i];
    EXPECT_EQ(b.strands.strand_count, a.strands.strand_count);
    EXPECT_EQ(b.strands.links_per_strand, a.strands.links_per_strand);
    EXPECT_EQ(b.strands.rest_y, a.strands.rest_y);
    EXPECT_EQ(b.strands.link_length_m, a.strands.link_length_m);
    EXPECT_EQ(b.parent_level, a.parent_level);
    EXPECT_EQ(b.parent, a.parent);
    EXPECT_EQ(b.parent_link, a.parent_link);
    EXPECT_EQ(b.is_leaves, a.is_leaves);
    EXPECT_EQ(b.is_turned_by_block, a.is_turned_by_block);
    EXPECT_EQ(b.base_radius_m, a.base_radius_m);
    EXPECT_EQ(b.tip_radius_m, a.tip_radius_m);
  }

  for (const std::size_t i : {3u, 4u}) {
    const auto& a = std::get<pose::SurfaceSkeleton>(sent.scenes[i].skeleton);
    const auto& b = std::get<pose::SurfaceSkeleton>(got.scenes[i].skeleton);
    EXPECT_EQ(b.columns, a.columns);
    EXPECT_EQ(b.rows, a.rows);
    EXPECT_EQ(b.is_closed, a.is_closed);
    EXPECT_EQ(b.shells, a.shells);
    EXPECT_EQ(b.axis_x_m, a.axis_x_m);
    EXPECT_EQ(b.axis_z_m, a.axis_z_m);
    EXPECT_EQ(b.rest_x_m, a.rest_x_m);
    EXPECT_EQ(b.rest_z_m, a.rest_z_m);
    EXPECT_EQ(b.normal_y, a.normal_y);
    EXPECT_EQ(b.ramp_rgba, a.ramp_rgba);
  }
}

TEST(WireRoundTrip, PosesOfAllKindsComeBackAsFineAsTheyArePromised) {
  const Frame frame = decoded<Frame>(samples::frame_of_all_kinds());
  const std::vector<pose::Pose> sent = samples::all_moved();
  EXPECT_EQ(frame.opacities, (std::vector{1.0f, 0.5f, 1.0f, 0.25f, 1.0f}));
  EXPECT_TRUE(fits(frame, samples::all_kinds()));
  constexpr double kClose[][2] = {{5e-5, 5e-5}, {0.1e-3, 0.1e-3}, {5e-5, 5e-5}, {0.2e-3, 0.0}, {0.2e-3, 2e-3}};
  for (std::size_t scene = 0; scene < sent.size(); ++scene) {
    const pose::Arrays<const float> a(sent[scene]);
    const pose::Arrays<const float> b(frame.poses[scene]);
    ASSERT_EQ(a.size(), b.size()) << scene;
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_EQ(a[k].size(), b[k].size()) << scene;
      for (std::size_t i = 0; i < a[k].size(); ++i)
        ASSERT_NEAR(static_cast<double>(a[k][i]), static_cast<double>(b[k][i]), kClose[scene][k > 0 ? 1 : 0])
            << scene << ' ' << k << ' ' << i;
    }
  }
}

TEST(WireRoundTrip, AHiddenSceneSendsNoPoseAndFitsAllTheSame) {
  const Bytes shown = samples::frame_of_all_kinds();
  const Bytes hidden = samples::frame_of_all_kinds({1.0f, 0.0f, 0.0f, 0.0f, 0.0f});
  EXPECT_LT(hidden.size(), samples::frame_bytes().size() + 100);
  EXPECT_GT(shown.size(), hidden.size() + 1000);
  const Frame frame = decoded<Frame>(hidden);
  EXPECT_EQ(frame.opacities, (std::vector{1.0f, 0.0f, 0.0f, 0.0f, 0.0f}));
  EXPECT_TRUE(std::get<pose::StrandPose>(frame.poses[1]).bend_east_rad.empty());
  EXPECT_TRUE(fits(frame, samples::all_kinds()));

  Frame seen = frame;
  seen.opacities[1] = 0.5f;
  EXPECT_FALSE(fits(seen, samples::all_kinds())) << "what is seen has a pose";
}

TEST(WireRoundTrip, ControlAndItsReplyComeBackAsTheyWere) {
  const Control control = decoded<Control>(encode(samples::control()));
  EXPECT_EQ(control.scene, "elm");
  EXPECT_TRUE(control.shown);
  EXPECT_TRUE(control.hide_others);
  EXPECT_EQ(control.over_s, 4.5);
  EXPECT_FALSE(decoded<Control>(encode(Control{.scene = "", .shown = false})).shown);

  const ControlReply reply = decoded<ControlReply>(encode(samples::control_reply()));
  EXPECT_TRUE(reply.done);
  EXPECT_EQ(reply.message, "elm is shown");
  ASSERT_EQ(reply.scenes.size(), 2u);
  EXPECT_EQ(reply.scenes[0].name, "elm");
  EXPECT_EQ(reply.scenes[1].kind, "ripple");
  EXPECT_TRUE(reply.scenes[0].shown);
  EXPECT_FALSE(reply.scenes[1].shown);
}

TEST(WireRoundTrip, ParametersAndWhatIsSetOfThemComeBackAsTheyWere) {
  EXPECT_FALSE(decoded<Control>(encode(samples::control())).parameters.has_value());
  EXPECT_FALSE(decoded<ControlReply>(encode(samples::control_reply())).parameters.has_value());
  const Control control = decoded<Control>(encode(samples::parameter_control()));
  ASSERT_TRUE(control.parameters.has_value());
  EXPECT_EQ(control.parameters->scene, "elm");
  EXPECT_TRUE(control.parameters->describe);
  EXPECT_EQ(control.parameters->number, 77u);
  ASSERT_EQ(control.parameters->edits.size(), 2u);
  EXPECT_EQ(control.parameters->edits[0].key, "height");
  EXPECT_EQ(control.parameters->edits[0].value, "7.5");
  EXPECT_EQ(control.parameters->edits[1].value, std::nullopt) << "back to the configuration's";

  const ControlReply reply = decoded<ControlReply>(encode(samples::parameter_reply()));
  ASSERT_TRUE(reply.parameters.has_value());
  EXPECT_EQ(reply.parameters->number, 77u);
  EXPECT_EQ(reply.parameters->refusal, "not from there");
  ASSERT_EQ(reply.parameters->groups.size(), 2u);
  EXPECT_EQ(reply.parameters->groups[1].scene, "elm");
  EXPECT_EQ(reply.parameters->groups[1].kind, "tree");
  const ParameterState& haze = reply.parameters->groups[0].parameters.at(0);
  EXPECT_EQ(haze.name, "haze");
  EXPECT_EQ(haze.unit, "EV");
  EXPECT_EQ(haze.kind, ParameterKind::kNumber);
  EXPECT_EQ(haze.min, 0.0);
  EXPECT_EQ(haze.max, 1.0);
  EXPECT_EQ(haze.help, "0: very clear air; 1: fog");
  EXPECT_EQ(haze.default_value, "0.15");
  EXPECT_EQ(haze.value, "0.4");
  EXPECT_EQ(haze.configured, "0.2");
  EXPECT_EQ(haze.change, KeyChange::kAtOnce);
  const ParameterState& species = reply.parameters->groups[1].parameters.at(0);
  EXPECT_EQ(species.kind, ParameterKind::kText);
  EXPECT_EQ(species.min, std::nullopt);
  EXPECT_EQ(species.choices, (std::vector<std::string>{"cherry", "zelkova"}));
  EXPECT_EQ(species.left_out, "as the season says");
  EXPECT_EQ(species.value, std::nullopt);
  EXPECT_EQ(species.change, KeyChange::kCrossFade);

  ControlReply newer = samples::parameter_reply();
  newer.parameters->groups[0].parameters[0].kind = static_cast<ParameterKind>(9);
  const ControlReply understood = decoded<ControlReply>(encode(newer));
  EXPECT_EQ(understood.parameters->groups[0].parameters[0].kind, ParameterKind::kText) << "of a newer server";
  EXPECT_EQ(understood.parameters->groups[0].parameters[0].change, KeyChange::kTakesRestart);
}

TEST(WireRoundTrip, AReloadAndWhatCameOfItComeBackAsTheyWere) {
  EXPECT_FALSE(decoded<Control>(encode(samples::control())).reload.has_value());
  EXPECT_FALSE(decoded<ControlReply>(encode(samples::control_reply())).reload.has_value());
  const Control control = decoded<Control>(encode(Control{.scene = "", .reload = ReloadCommand{"/etc/wall.toml"}}));
  ASSERT_TRUE(control.reload.has_value());
  EXPECT_EQ(control.reload->file, "/etc/wall.toml");

  const ControlReply sent = samples::reload_reply();
  const ControlReply reply = decoded<ControlReply>(encode(sent));
  ASSERT_TRUE(reply.reload.has_value());
  EXPECT_EQ(reply.reload->outcome, ReloadOutcome::kMistake);
  EXPECT_EQ(reply.reload->applied, sent.reload->applied);
  EXPECT_EQ(reply.reload->takes_restart, sent.reload->takes_restart);
  EXPECT_EQ(reply.reload->mistakes, sent.reload->mistakes);

  ControlReply much = sent;
  much.reload->mistakes.assign(kMaxReloadItems + 5, std::string(kMaxTextBytes + 5, 'x'));
  much.reload->outcome = static_cast<ReloadOutcome>(200);
  const ControlReply cut = decoded<ControlReply>(encode(much));
  EXPECT_EQ(cut.reload->mistakes, std::vector(kMaxReloadItems, std::string(kMaxTextBytes, 'x')));
  EXPECT_EQ(cut.reload->outcome, ReloadOutcome::kFailed) << "of a newer server";
}

TEST(WireRoundTrip, WhatPlayersAreToDoAndHowTheyDoComesBackAsItWas) {
  EXPECT_FALSE(decoded<Control>(encode(samples::control())).player.has_value());
  const Control control = decoded<Control>(encode(samples::player_control()));
  ASSERT_TRUE(control.player.has_value());
  EXPECT_EQ(control.player->action, PlayerAction::kSeek);
  EXPECT_EQ(control.player->sensor, "roof");
  EXPECT_EQ(control.player->count, 7U);
  EXPECT_EQ(control.player->place, "2018-07-20T14:05:00Z");
  EXPECT_EQ(control.player->rate, 2.5);

  const ControlReply reply = decoded<ControlReply>(encode(samples::control_reply()));
  ASSERT_EQ(reply.players.size(), 2U);
  const PlayerState& player = reply.players[0];
  EXPECT_EQ(player.sensor, "roof");
  EXPECT_EQ(player.file, "storm.windlog");
  EXPECT_TRUE(player.is_open);
  EXPECT_EQ(player.position_s, 90.5);
  EXPECT_EQ(player.length_s, 3600.0);
  EXPECT_EQ(player.recorded_utc_ns, 1'700'000'000'000'000'000);
  EXPECT_EQ(player.rate, 0.5);
  EXPECT_TRUE(player.is_paused);
  EXPECT_TRUE(player.is_finished);
  EXPECT_TRUE(player.loops);
  EXPECT_EQ(player.rounds, 3U);
  EXPECT_EQ(player.order, 5U);
  EXPECT_EQ(player.orders_done, 4U);
  EXPECT_EQ(player.refusal, "there is no reading from there on");
  EXPECT_FALSE(reply.players[1].is_open);
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
  EXPECT_EQ(gauge.link, wind::LinkState::kConnected);
  EXPECT_EQ(gauge.health, wind::SourceHealth::kStale);
  EXPECT_EQ(gauge.detail, "answers again");
  EXPECT_EQ(gauge.speed_m_s, 0.0);
  EXPECT_EQ(gauge.direction_deg, 359.5);
  EXPECT_EQ(gauge.gust_m_s, std::nullopt);
  EXPECT_TRUE(gauge.simulated);
  EXPECT_EQ(gauge.age_s, 0.25);
  EXPECT_EQ(gauge.interval_s, 1.0);
  EXPECT_EQ(gauge.readings, 1234u);
  EXPECT_EQ(gauge.refused, samples::sensors().sensors[0].refused);
  EXPECT_EQ(gauge.frames, 1250u);
  EXPECT_EQ(gauge.reconnects, 2u);
  EXPECT_TRUE(gauge.replayed);
  EXPECT_EQ(gauge.state, wind::judging::SensorState::kFrozen);
  EXPECT_EQ(gauge.state_reason, "the same 3.42 m/s 61 times");
  EXPECT_EQ(gauge.value, "mean over 3 s (its manual)");
  EXPECT_EQ(gauge.reads_times_group, 1.25);
  EXPECT_EQ(sensors.sensors[1].reads_times_group, 1.0) << "not known";
  EXPECT_EQ(sensors.sensors[1].state, wind::judging::SensorState::kConnecting);
  EXPECT_FALSE(sensors.sensors[1].replayed);
  EXPECT_EQ(gauge.raw_speed_m_s, 0.5);
  EXPECT_EQ(gauge.raw_direction_deg, 349.5);
  ASSERT_EQ(sensors.sensors[0].quantities.size(), 2U);
  EXPECT_EQ(sensors.sensors[0].quantities[0].quantity, wind::judging::Quantity::kDirection);
  EXPECT_EQ(sensors.sensors[0].quantities[0].age_s, 180.5);
  EXPECT_TRUE(sensors.sensors[0].quantities[0].is_missing);
  EXPECT_EQ(sensors.sensors[0].quantities[0].reason, "none for 3 min");
  EXPECT_EQ(sensors.sensors[0].quantities[1].quantity, wind::judging::Quantity::kGust);
  EXPECT_EQ(sensors.sensors[0].quantities[1].age_s, std::nullopt);
  EXPECT_FALSE(sensors.sensors[0].quantities[1].is_missing);
  EXPECT_EQ(sensors.sensors[1].raw_speed_m_s, std::nullopt);
  EXPECT_EQ(sensors.sensors[1].speed_m_s, std::nullopt);
  EXPECT_EQ(sensors.wind.wind.u_m_s, 3.25);
  EXPECT_EQ(sensors.wind.upwind_m, -12.5);
  EXPECT_EQ(sensors.wind.to_middle_s, 0.75);
  EXPECT_TRUE(sensors.wind.is_place_configured);
  EXPECT_EQ(sensors.late_ticks, 5u);
  EXPECT_EQ(sensors.clients, 2u);
}

TEST(WireRoundTrip, HowTheDaemonDoesComesBack) {
  const Sensors sensors = decoded<Sensors>(encode(samples::sensors()));
  EXPECT_EQ(sensors.refused_clients, 6U);
  EXPECT_EQ(sensors.stuck_clients, 7U);
  EXPECT_EQ(sensors.idle_clients, 8U);
  EXPECT_EQ(sensors.given_up, 3);
  EXPECT_EQ(sensors.gust_reach_across, 1.5);
  EXPECT_EQ(sensors.gust_reach_along, std::nullopt) << "not known";
  EXPECT_EQ(sensors.parameters_revision, 21U);
  ASSERT_TRUE(sensors.io_lateness && sensors.tick_lateness);
  EXPECT_EQ(sensors.io_lateness->p50_s, 0.0625);
  EXPECT_EQ(sensors.io_lateness->p99_s, 0.125);
  EXPECT_EQ(sensors.io_lateness->max_s, 1.5);
  EXPECT_EQ(sensors.tick_lateness->p50_s, 0.03125);
  EXPECT_EQ(sensors.tick_lateness->p99_s, 0.25);
  EXPECT_EQ(sensors.tick_lateness->max_s, 2.5);
  EXPECT_EQ(sensors.recent_ticks, 36'000U);
  EXPECT_EQ(sensors.recent_skipped_ticks, 40U);
  EXPECT_EQ(sensors.troubles, std::vector<std::string>{"the page cannot be served"});
  ASSERT_EQ(sensors.feeds.size(), 2U);
  EXPECT_EQ(sensors.feeds[0].target, "192.168.1.40:9000");
  EXPECT_EQ(sensors.feeds[0].bytes, 9000U);
  EXPECT_EQ(sensors.feeds[0].last_sent_age_s, 0.25);
  EXPECT_EQ(sensors.feeds[0].trouble, "nothing listens");
  EXPECT_EQ(sensors.feeds[1].last_sent_age_s, std::nullopt);
  ASSERT_TRUE(sensors.recorder);
  EXPECT_EQ(sensors.recorder->state, RecorderState::kRetrying);
  EXPECT_EQ(sensors.recorder->written, 9U);
  EXPECT_EQ(sensors.recorder->waiting, 10U);
  EXPECT_EQ(sensors.recorder->lost, 11U);
  EXPECT_EQ(sensors.recorder->free_bytes, 0U);
  EXPECT_EQ(sensors.recorder->error, "wall.windlog: the disk is full");
  EXPECT_EQ(sensors.recorder->clock_doubt, "the clock is doubted: it jumped");
  EXPECT_EQ(sensors.recorder->recorded_elsewhere, 12U);
  ASSERT_TRUE(sensors.animation);
  EXPECT_EQ(sensors.animation->running_s, 3600.5);
  EXPECT_EQ(sensors.animation->period_s, 0.015625);
  EXPECT_EQ(sensors.animation->tick_s, 0.00390625);
  ASSERT_EQ(sensors.animation->scenes.size(), 2U);
  EXPECT_EQ(sensors.animation->scenes[1].scene, "fire");
  EXPECT_EQ(sensors.animation->scenes[1].tick_s, 0.0009765625);
  const Sensors none = decoded<Sensors>(encode(Sensors{}));
  EXPECT_FALSE(none.io_lateness || none.tick_lateness || none.recorder || none.animation) << "not known";
  Sensors without_space;
  without_space.recorder.emplace();
  EXPECT_EQ(decoded<Sensors>(encode(without_space)).recorder->free_bytes, std::nullopt);
}

TEST(WireRoundTrip, ALatenessThatCannotBeIsRefused) {
  for (const double wrong_s :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (double Lateness::*member : {&Lateness::p50_s, &Lateness::p99_s, &Lateness::max_s}) {
      Sensors sensors = samples::sensors();
      (*sensors.tick_lateness).*member = wrong_s;
      EXPECT_EQ(decode(samples::body(encode(sensors))).error(), Error::kInconsistent);
    }
  }
}

TEST(WireRoundTrip, AnAnimationThatCannotBeIsRefused) {
  const auto is_refused = [](const AnimationStatus& animation) {
    const auto message = decode(samples::body(encode(Sensors{.sensors = {}, .wind = {}, .animation = animation})));
    return !message && message.error() == Error::kInconsistent;
  };
  for (const double wrong_s :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(is_refused({.running_s = wrong_s}));
    EXPECT_TRUE(is_refused({.period_s = wrong_s}));
    EXPECT_TRUE(is_refused({.tick_s = wrong_s}));
    EXPECT_TRUE(is_refused({.scenes = {{"grass", 0.001}, {"fire", wrong_s}}}));
  }
  EXPECT_FALSE(is_refused({.scenes = std::vector<SceneCost>(kMaxScenes)}));
  EXPECT_TRUE(is_refused({.scenes = std::vector<SceneCost>(kMaxScenes + 1)}));
}

TEST(WireRoundTrip, EveryStateOfASensorComesBack) {
  Sensors sensors = samples::sensors();
  for (std::size_t number = 0; number < wind::judging::kSensorStateNames.size(); ++number) {
    sensors.sensors[0].state = static_cast<wind::judging::SensorState>(number);
    EXPECT_EQ(decoded<Sensors>(encode(sensors)).sensors[0].state, sensors.sensors[0].state) << number;
  }
}

TEST(RoundTrip, KeepsTheLook) {
  EXPECT_EQ(decoded<Sensors>(encode(samples::sensors())).look, samples::sensors().look);
  EXPECT_EQ(decoded<Sensors>(encode(Sensors{})).look, look::Look{});
}

TEST(RoundTrip, BringsAHostileLookWithinItsLimits) {
  Sensors sensors;
  sensors.look = {.sun = static_cast<look::SunChoice>(200),
                  .latitude_deg = std::nan(""),
                  .solar_time_h = -1e300,
                  .clouds = 1e9,
                  .quality = static_cast<look::Quality>(99)};
  EXPECT_EQ(decoded<Sensors>(encode(sensors)).look, (look::Look{.solar_time_h = 0.0, .clouds = 1.0}));
}

TEST(RoundTrip, KeepsTheCameras) {
  const Sensors sensors = decoded<Sensors>(encode(samples::sensors()));
  EXPECT_EQ(sensors.cameras, samples::sensors().cameras);
  EXPECT_EQ(sensors.camera, 1U);
  EXPECT_TRUE(decoded<Sensors>(encode(Sensors{})).cameras.empty());
}

TEST(RoundTrip, BringsHostileCamerasWithinTheirLimits) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Sensors sensors;
  sensors.cameras.assign(
      look::kMaxCameras + 8,
      {.target_x_m = kNan, .pitch_deg = 1e300, .distance_m = kNan, .fov_deg = -1.0, .period_s = 0.0, .from_h = kNan});
  sensors.camera = 1'000'000;
  const Sensors read = decoded<Sensors>(encode(sensors));
  ASSERT_EQ(read.cameras.size(), look::kMaxCameras);
  EXPECT_EQ(read.cameras[0], (look::Camera{.pitch_deg = 89.0, .fov_deg = 5.0, .period_s = 10.0}));
  EXPECT_EQ(read.camera, 0U) << "there is no such camera";
}

TEST(WireRoundTrip, WhatShapesTheWindComesBack) {
  const Shaping shaping = decoded<Sensors>(encode(samples::sensors())).shaping;
  EXPECT_EQ(shaping.site_gain, 1.75);
  EXPECT_EQ(shaping.floor_gain, 2.5);
  EXPECT_EQ(shaping.breeze_m_s, 0.25);
  EXPECT_EQ(shaping.opening, 0.5);
  EXPECT_EQ(shaping.ceiling_gain, 0.875);
  EXPECT_EQ(shaping.mean_m_s, 0.75);
  EXPECT_EQ(shaping.shaped_mean_m_s, 1.5);
  EXPECT_EQ(shaping.site_median_m_s, 1.25);
  EXPECT_EQ(shaping.site_strong_m_s, 3.5);
  EXPECT_EQ(shaping.site_known_s, 86400.0);
  EXPECT_EQ(shaping.text, "floor: raised 0.8 to 1.5 m/s");
  EXPECT_EQ(shaping.gusts, 2.25);
  EXPECT_EQ(shaping.openness, 0.25);
}

TEST(WireRoundTrip, WhatIsSetByHandComesBackAsItWas) {
  const Control control = decoded<Control>(encode(samples::hand_control()));
  ASSERT_TRUE(control.hand);
  EXPECT_EQ(control.hand->part, HandPart::kCamera);
  EXPECT_TRUE(control.hand->is_release);
  EXPECT_EQ(control.hand->for_s, 90.5);
  EXPECT_EQ(control.hand->speed_m_s, 8.5);
  EXPECT_EQ(control.hand->direction_deg, 270.0);
  EXPECT_EQ(control.hand->camera, "gate");
  EXPECT_FALSE(decoded<Control>(encode(samples::control())).hand);
  EXPECT_EQ(decoded<Control>(encode(Control{.scene = "", .hand = HandCommand{}})).hand->for_s, std::nullopt);

  Sensors sensors = samples::sensors();
  EXPECT_EQ(decoded<Sensors>(encode(sensors)).by_hand, ByHand{});
  sensors.by_hand = samples::by_hand();
  EXPECT_EQ(decoded<Sensors>(encode(sensors)).by_hand, samples::by_hand());
  ControlReply reply = samples::control_reply();
  EXPECT_FALSE(decoded<ControlReply>(encode(reply)).by_hand);
  reply.by_hand = samples::by_hand();
  EXPECT_EQ(decoded<ControlReply>(encode(reply)).by_hand, samples::by_hand());
}

TEST(WireRoundTrip, ARawTraceComesBackByteForByte) {
  const RawTrace sent = samples::raw_trace();
  const RawTrace trace = decoded<RawTrace>(encode(sent));
  EXPECT_EQ(trace.sensor, "roof");
  EXPECT_EQ(trace.mono_ns, sent.mono_ns);
  EXPECT_EQ(trace.utc_ns, sent.utc_ns);
  EXPECT_TRUE(trace.received);
  EXPECT_EQ(trace.bytes, sent.bytes);
  EXPECT_EQ(trace.length, 7u);
  EXPECT_EQ(trace.lost, 3u);
  EXPECT_FALSE(decoded<RawTrace>(encode(RawTrace{.sensor = "roof", .received = false, .bytes = {}})).received);
}

TEST(WireRoundTrip, OfALongRawMessageTheBeginningTravelsAndItsLengthIsTold) {
  const RawTrace trace =
      decoded<RawTrace>(encode(RawTrace{.sensor = "roof", .bytes = Bytes(2000, 0x5A), .length = 2000}));
  EXPECT_EQ(trace.bytes, Bytes(kMaxRawBytes, 0x5A));
  EXPECT_EQ(trace.length, 2000u);
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

TEST(WireRoundTrip, WhatIsNotUtf8InATextIsDefused) {
  EXPECT_EQ(decoded<Subscribe>(encode(Subscribe{.client = "a\xff\xe3\x82 \xed\xa0\x80"})).client, "a??? ???");
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

TEST(WireRoundTrip, WhatAClientSendsIsWithinWhatTheServerReads) {
  EXPECT_LE(encode(Subscribe{.client = std::string(99999, 'x')}).size(), kSizePrefixBytes + kMaxClientMessageBytes);
  EXPECT_LE(
      encode(Subscribe{.client = std::string(99999, 'x'), .raw = true, .raw_sensor = std::string(99999, 'x')}).size(),
      kSizePrefixBytes + kMaxClientMessageBytes);
  EXPECT_LE(encode(Control{.scene = std::string(99999, 'x')}).size(), kSizePrefixBytes + kMaxClientMessageBytes);
}

}  // namespace
}  // namespace yuragi::wire
