// Playing a recording: pace, pause, step, seek, the seam of a loop, and the time of day.
#include "drivers/windlog/windlog_player.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/wind/wind_vector.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using namespace std::chrono_literals;
using test::kSampleUtc_ms;
using test::numbered_readings;
using test::reading_at;
using test::write_session;
using ::testing::HasSubstr;

/// 600 readings in a minute, whose wind swings slowly between 2 and 10 m/s and comes from 350 to 10 degrees.
std::vector<wind::Reading> swinging_wind() {
  std::vector<wind::Reading> readings;
  for (int i = 0; i < 600; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / 450.0;
    wind::Reading reading = test::reading_at(100 * i, 6.0 - 4.0 * std::cos(phase));
    reading.direction_deg = std::fmod(360.0 + 10.0 * std::sin(phase), 360.0);
    readings.push_back(reading);
  }
  return readings;
}

wind::Vector vector_of(const wind::Reading& reading) {
  return wind::wind_from(reading.speed_m_s, reading.direction_deg.value_or(0.0));
}

/// A player with a clock of its own, and all that it has said.
class Playing {
 public:
  Playing(const std::vector<wind::Reading>& readings, PlayerOptions options) {
    test::write_session(folder_ / "a.windlog", readings);
    player_.emplace(Player::open(folder_ / "a.windlog", std::move(options), clock_.now()).value());
  }

  Player* operator->() { return &*player_; }
  Instant now() const { return clock_.now(); }

  /// Plays for a while, looking often.
  void run(Nanoseconds duration) {
    const MonoTime end = clock_.now().mono + duration;
    for (MonoTime next = look(); clock_.now().mono < end; next = look()) clock_.advance_to(std::min(next, end));
  }
  MonoTime look() {
    return player_->play(clock_.now(), [this](const wind::Reading& reading) { said.push_back(reading); }).value();
  }
  void halt(Nanoseconds duration) { clock_.advance(duration); }

  /// The largest step from one reading to the next.
  double largest_step_m_s() const {
    double largest = 0.0;
    for (std::size_t i = 1; i < said.size(); ++i) {
      largest = std::max(largest, speed_of(vector_of(said[i]) - vector_of(said[i - 1])));
    }
    return largest;
  }
  bool is_in_order() const {
    return std::ranges::is_sorted(said, {}, [](const wind::Reading& reading) { return reading.time.mono; });
  }
  double place_s() const { return seconds(player_->position(clock_.now().mono).log_time); }
  std::string refusal(const std::function<Result<void, Failure>(Player&)>& order) {
    const auto done = order(*player_);
    return done ? "" : done.error().message;
  }

  std::vector<wind::Reading> said;

 private:
  test::TemporaryFolder folder_;
  ManualClock clock_;
  std::optional<Player> player_;
};

// ---- pause and step ----

TEST(WindlogPlayer, PausedItSaysTheSameAgainAtItsUsualIntervalAndGoesOnWhereItStood) {
  Playing playing(test::numbered_readings(100), {});
  playing.run(2s);
  const std::size_t before = playing.said.size();
  const double held_m_s = playing.said.back().speed_m_s;
  const double place_s = playing.place_s();
  playing->pause(playing.now());
  playing.run(60s);
  ASSERT_NEAR(static_cast<double>(playing.said.size() - before), 600.0, 2.0);
  for (std::size_t i = before; i < playing.said.size(); ++i) {
    EXPECT_TRUE(playing.said[i].is_held);
    EXPECT_EQ(playing.said[i].speed_m_s, held_m_s);
    EXPECT_LE(playing.said[i].time.mono - playing.said[i - 1].time.mono, 101ms);
  }
  EXPECT_DOUBLE_EQ(playing.place_s(), place_s);
  EXPECT_TRUE(playing->position(playing.now().mono).is_paused);

  playing->resume(playing.now());
  const std::size_t resumed = playing.said.size();
  playing.run(500ms);
  ASSERT_GT(playing.said.size(), resumed);
  EXPECT_FALSE(playing.said[resumed].is_held);
  EXPECT_NEAR(playing.said[resumed].speed_m_s, held_m_s + 0.001, 1e-12) << "the next one, none left out";
  EXPECT_NEAR(playing.place_s(), place_s + 0.5, 1e-6);
  EXPECT_TRUE(playing.is_in_order());
}

TEST(WindlogPlayer, PausedFromTheBeginningItStandsAtItsFirstReading) {
  Playing playing(test::numbered_readings(10), {.is_paused = true});
  playing.run(1s);
  ASSERT_GT(playing.said.size(), 5U);
  EXPECT_FALSE(playing.said[0].is_held);
  EXPECT_TRUE(playing.said[1].is_held);
  EXPECT_EQ(playing.said.back().speed_m_s, 0.0);
  EXPECT_EQ(playing.said.back().time.mono, playing.now().mono);
}

TEST(WindlogPlayer, AStepPausesAndMovesSoManyReadingsOn) {
  Playing playing(test::numbered_readings(100), {});
  playing.run(1s);
  const double before_m_s = playing.said.back().speed_m_s;
  playing->step(playing.now(), 1);
  const std::size_t count = playing.said.size();
  playing.look();
  ASSERT_EQ(playing.said.size(), count + 1) << "at once";
  EXPECT_NEAR(playing.said.back().speed_m_s, before_m_s + 0.001, 1e-12);
  EXPECT_FALSE(playing.said.back().is_held);
  EXPECT_EQ(playing.said.back().time.mono, playing.now().mono);

  playing->step(playing.now(), 10);
  playing.look();
  EXPECT_EQ(playing.said.size(), count + 2) << "the last of them alone";
  EXPECT_NEAR(playing.said.back().speed_m_s, before_m_s + 0.011, 1e-12);
  playing.run(1s);
  EXPECT_TRUE(playing.said.back().is_held);
  EXPECT_NEAR(playing.place_s(), 0.1 * std::round(1000.0 * (before_m_s + 0.011)), 1e-9);
}

TEST(WindlogPlayer, StepsEndAtTheLastReadingAndInALoopBeginAgain) {
  Playing once(test::numbered_readings(10), {});
  once->step(once.now(), 500);
  once.look();
  EXPECT_DOUBLE_EQ(once.said.back().speed_m_s, 0.009);
  EXPECT_THAT(once.refusal([&](Player& player) { return player.step(once.now(), 1); }), HasSubstr("last reading"));
  once.run(1s);
  EXPECT_FALSE(once->is_finished()) << "it stands, and does not end";

  Playing looping(test::numbered_readings(10), {.playback = {.loop = true}, .seam_s = 0.0});
  looping->step(looping.now(), 13);
  looping.look();
  EXPECT_DOUBLE_EQ(looping.said.back().speed_m_s, 0.002);
  EXPECT_EQ(looping->position(looping.now().mono).rounds, 1U);
}

TEST(WindlogPlayer, AMachineThatWasSuspendedFindsAPausedPlayerAsItWas) {
  Playing playing(test::numbered_readings(100), {});
  playing.run(1s);
  playing->pause(playing.now());
  playing.halt(8h);
  playing.look();
  EXPECT_EQ(playing.said.back().time.mono, playing.now().mono);
  playing->resume(playing.now());
  playing.run(1s);
  EXPECT_NEAR(playing.place_s(), 2.0, 1e-6);
}

// ---- seek and rate ----

TEST(WindlogPlayer, SeeksToSecondsMomentsAndSoMuchFurther) {
  Playing playing(test::numbered_readings(1000), {.seam_s = 0.0});
  const auto at = [&](const std::string& place) {
    playing->seek(playing.now(), place);
    playing.look();
    return std::lround(1000.0 * playing.said.back().speed_m_s);
  };
  EXPECT_EQ(at("50"), 500);
  EXPECT_EQ(at("+30"), 800);
  EXPECT_EQ(at("-70.5"), 95);
  EXPECT_EQ(at("-70.5"), 0) << "no further back than the beginning";
  EXPECT_EQ(at("2018-07-20T14:00:31Z"), 300);
  EXPECT_EQ(at("2018-07-20T14:01:40.9Z"), 999);
  EXPECT_TRUE(playing.is_in_order());
}

TEST(WindlogPlayer, ASeekToNowhereIsRefusedAndChangesNothing) {
  Playing playing(test::numbered_readings(1000), {});
  playing.run(2s);
  for (const char* place : {"100", "+98", "2019-01-01", "soon", "", "+", "+x", "-nan", "+1e99", "nan", "--1"}) {
    const std::string refusal = playing.refusal([&](Player& player) { return player.seek(playing.now(), place); });
    if (std::string_view(place).empty()) continue;  // the beginning
    EXPECT_FALSE(refusal.empty()) << place;
  }
  EXPECT_THAT(playing.refusal([&](Player& player) { return player.seek(playing.now(), "100"); }), HasSubstr("99.9"));
}

TEST(WindlogPlayer, GoesOnAfterItsEndWhereItIsToldTo) {
  Playing playing(test::numbered_readings(20), {});
  playing.run(5s);
  EXPECT_TRUE(playing->is_finished());
  EXPECT_DOUBLE_EQ(playing.place_s(), 1.9);
  const std::size_t count = playing.said.size();
  playing->seek(playing.now(), "1");
  playing.run(500ms);
  EXPECT_FALSE(playing->is_finished());
  EXPECT_NEAR(static_cast<double>(playing.said.size() - count), 5.0, 1.0);
  EXPECT_TRUE(playing.is_in_order());
}

TEST(WindlogPlayer, ARateThatChangesKeepsThePlace) {
  Playing playing(test::numbered_readings(1000), {});
  playing.run(2s);
  playing->set_rate(playing.now(), 10.0);
  playing.run(3s);
  EXPECT_NEAR(playing.place_s(), 32.0, 1e-6);
  playing->set_rate(playing.now(), 0.1);
  playing.run(10s);
  EXPECT_NEAR(playing.place_s(), 33.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(playing.said.size()), 331.0, 1.0) << "none lost, none twice";
  EXPECT_TRUE(playing.is_in_order());
}

// ---- fades ----

TEST(WindlogPlayer, BetweenTwoWindsLiesTheirVector) {
  const auto blow = [](double speed_m_s, std::optional<double> from_deg) {
    wind::Reading reading = test::reading_at(0, speed_m_s);
    reading.direction_deg = from_deg;
    return reading;
  };
  const wind::Reading through_north = between(blow(5.0, 350.0), blow(5.0, 10.0), 0.5);
  EXPECT_NEAR(std::remainder(*through_north.direction_deg, 360.0), 0.0, 1e-9);
  EXPECT_NEAR(through_north.speed_m_s, 5.0 * std::cos(10.0 * std::numbers::pi / 180.0), 1e-9);
  EXPECT_NEAR(between(blow(2.0, 90.0), blow(6.0, 90.0), 0.25).speed_m_s, 3.0, 1e-12);
  EXPECT_NEAR(between(blow(2.0, {}), blow(6.0, 90.0), 0.25).speed_m_s, 3.0, 1e-12);
  EXPECT_EQ(between(blow(2.0, 80.0), blow(6.0, {}), 0.25).direction_deg, std::nullopt);
  EXPECT_TRUE(wind::is_plausible(between(blow(5.0, 0.0), blow(5.0, 180.0), 0.5)));
}

TEST(WindlogPlayer, TheSeamOfALoopIsNoStep) {
  // It ends at 8 m/s and begins at 2; the swing itself moves by 0.06 m/s from one reading to the next.
  Playing hard(swinging_wind(), {.playback = {.loop = true}, .seam_s = 0.0});
  hard.run(200s);
  EXPECT_GT(hard.largest_step_m_s(), 2.5);

  Playing soft(swinging_wind(), {.playback = {.loop = true}, .seam_s = 5.0});
  soft.run(200s);
  EXPECT_LT(soft.largest_step_m_s(), 0.4) << "6 m/s over 5 s, at most 1.5 times as fast in the middle, and the swing";
  EXPECT_EQ(soft->position(soft.now().mono).rounds, 3U) << "each round is 5 s shorter";
  EXPECT_TRUE(soft.is_in_order());
  for (std::size_t i = 1; i < soft.said.size(); ++i) {
    EXPECT_LE(soft.said[i].time.mono - soft.said[i - 1].time.mono, 201ms) << "no gap at the seam";
  }
}

TEST(WindlogPlayer, ASeekFadesFromWhatTheOldPlaceGoesOnToSay) {
  Playing playing(swinging_wind(), {.seam_s = 4.0});
  playing.run(1s);  // about 2 m/s
  const std::size_t begun = playing.said.size();
  playing->seek(playing.now(), "20");  // about 10 m/s
  playing.run(6s);
  EXPECT_LT(playing.largest_step_m_s(), 0.4);
  EXPECT_LT(playing.said[begun].speed_m_s, 2.5);
  // In the middle both count half: at 3 s of the old place, and 22 s of the new.
  const std::vector<wind::Reading> recorded = swinging_wind();
  const wind::Vector middle = 0.5 * (vector_of(recorded[30]) + vector_of(recorded[220]));
  EXPECT_LT(speed_of(vector_of(playing.said[begun + 20]) - middle), 0.15);
  // After it the new place alone.
  EXPECT_NEAR(playing.said.back().speed_m_s, recorded[260].speed_m_s, 0.1);
}

TEST(WindlogPlayer, PausedASeekFadesTooAndThenHolds) {
  Playing playing(swinging_wind(), {.seam_s = 4.0});
  playing.run(1s);
  playing->pause(playing.now());
  playing->seek(playing.now(), "22.5");
  playing.run(6s);
  EXPECT_LT(playing.largest_step_m_s(), 0.4);
  EXPECT_DOUBLE_EQ(playing.said.back().speed_m_s, 10.0);
  EXPECT_TRUE(playing.said.back().is_held);
}

TEST(WindlogPlayer, AShortRecordingLoopsWithAShortSeamAndOneReadingWithNone) {
  Playing few(test::numbered_readings(4), {.playback = {.loop = true}, .seam_s = 600.0});
  few.run(10s);
  EXPECT_GT(few.said.size(), 60U);
  EXPECT_TRUE(few.is_in_order());
  Playing one({test::reading_at(0, 3.0)}, {.playback = {.loop = true}});
  one.run(10s);
  EXPECT_NEAR(static_cast<double>(one.said.size()), 11.0, 1.0);
}

TEST(WindlogPlayer, WhateverIsDoneTimeNeverGoesBackAndTheWindNeverJumps) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned bound) { return random() % bound; };
    Playing playing(swinging_wind(), {.playback = {.loop = true}, .seam_s = 3.0});
    for (int action = 0; action < 150; ++action) {
      const Instant now = playing.now();
      switch (below(5)) {
        case 0:
          playing->pause(now);
          break;
        case 1:
          playing->resume(now);
          break;
        case 2:
          playing->step(now, 1);
          break;
        case 3:
          playing->seek(now, std::to_string(below(60)));
          break;
        case 4:
          playing->set_rate(now, std::array{0.5, 1.0, 2.0}[below(3)]);
          break;
      }
      playing.run(std::chrono::milliseconds(below(3000)));
    }
    EXPECT_TRUE(playing.is_in_order()) << "seed " << seed;
    EXPECT_LT(playing.said.back().time.mono - playing.now().mono, 1ms);
    EXPECT_TRUE(std::ranges::all_of(playing.said, wind::is_plausible)) << "seed " << seed;
    // A fade of 3 s from one end of the swing to the other: 8 m/s, 1.5 times as fast in the middle; at 5 readings a
    // second (rate 0.5), and twice that interval where it was paused between two: 1.6 m/s, and the swing of both.
    EXPECT_LT(playing.largest_step_m_s(), 1.8) << "seed " << seed;
  }
}

// ---- the time of day ----

/// Sessions as the reader tells of them: begin and end in UTC hours.
std::vector<LoggedSession> sessions_of(const std::vector<std::pair<double, double>>& hours) {
  std::vector<LoggedSession> sessions;
  for (const auto& [from_h, to_h] : hours) {
    LoggedSession session;
    session.first = {MonoTime(5h), UtcTime(from_seconds(3600.0 * from_h))};
    session.last = {MonoTime(5h) + from_seconds(3600.0 * (to_h - from_h)), UtcTime(from_seconds(3600.0 * to_h))};
    session.log_begin = from_seconds(3600.0 * (from_h - hours.front().first));
    sessions.push_back(session);
  }
  return sessions;
}

double place_of(const std::vector<LoggedSession>& sessions, double wanted_h, double from_h = 0.0, double offset_h = 0) {
  const auto place = find_time_of_day(sessions, from_seconds(3600.0 * from_h), from_seconds(3600.0 * wanted_h),
                                      [offset_h](UtcTime) { return from_seconds(3600.0 * offset_h); });
  return place ? seconds(*place) / 3600.0 : -1.0;
}

/// When a player of one sensor says a speed, after its beginning.
double told_after_s(const std::filesystem::path& file, const std::string& sensor, bool stays_with_others,
                    double speed_m_s) {
  ManualClock clock;
  const MonoTime begin = clock.now().mono;
  auto player =
      Player::open(file, {.playback = {.sensor = sensor}, .stays_with_others = stays_with_others}, clock.now()).value();
  double told_s = 0.0;
  while (!player.is_finished() && told_s == 0.0) {
    const MonoTime next = player
                              .play(clock.now(),
                                    [&](const wind::Reading& reading) {
                                      if (reading.speed_m_s == speed_m_s) told_s = seconds(reading.time.mono - begin);
                                    })
                              .value();
    clock.advance_to(next);
  }
  return told_s;
}

TEST(WindlogPlayer, PlayersOfSeveralSensorsStayTogetherOverDaysWithoutASession) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  constexpr std::int64_t kHour_ms = 3'600'000;
  {
    auto writer = Writer::open(file).value();
    ASSERT_TRUE(writer.begin_session({test::at_ms(0, kSampleUtc_ms), "yuragi test", ""}));
    const auto mast = writer.add_sensor("mast", "line", "").value();
    const auto yard = writer.add_sensor("yard", "line", "").value();
    ASSERT_TRUE(writer.append(yard, reading_at(0, 1.0)));
    for (int minute = 0; minute <= 60; ++minute) ASSERT_TRUE(writer.append(mast, reading_at(60'000 * minute, 2.0)));
    // A gap of 47.5 hours for the mast, and of 48.5 hours for the yard.
    const std::int64_t later_ms = kHour_ms + 47 * kHour_ms + kHour_ms / 2;
    ASSERT_TRUE(writer.begin_session({test::at_ms(0, kSampleUtc_ms + later_ms), "yuragi test", ""}));
    for (const char* const name : {"mast", "yard"}) {
      const auto id = writer.add_sensor(name, "line", "").value();
      wind::Reading reading = reading_at(0, 9.0);
      reading.time.utc += std::chrono::milliseconds(later_ms);
      ASSERT_TRUE(writer.append(id, reading));
    }
    ASSERT_TRUE(writer.close());
  }
  const double together_s = told_after_s(file, "mast", true, 9.0);
  EXPECT_DOUBLE_EQ(together_s, 3600.0 * (1.0 + 23.5));
  EXPECT_DOUBLE_EQ(told_after_s(file, "yard", true, 9.0), together_s);
  EXPECT_DOUBLE_EQ(told_after_s(file, "yard", false, 9.0), 3600.0 * 0.5) << "by itself it leaves out two days";
}

TEST(TimeOfDay, IsFoundInTheFirstDayThatHasItAndOverMidnight) {
  const auto week = sessions_of({{14.0, 14.0 + 7 * 24.0}});
  EXPECT_NEAR(place_of(week, 15.0), 1.0, 1e-9);
  EXPECT_NEAR(place_of(week, 2.0), 12.0, 1e-9) << "after midnight";
  EXPECT_NEAR(place_of(week, 13.0), 23.0, 1e-9);
  EXPECT_NEAR(place_of(week, 15.0, 2.0), 25.0, 1e-9) << "the next day, from there on";
  EXPECT_NEAR(place_of(week, 15.0, 0.0, 1.0), 0.0, 1e-9) << "an hour ahead of UTC";
}

TEST(TimeOfDay, ThatNoSessionHasBeginsWhereTheNextComes) {
  const auto mornings = sessions_of({{20.0, 21.0}, {32.0, 33.0}});  // 20 to 21 and 8 to 9
  EXPECT_NEAR(place_of(mornings, 8.5), 12.5, 1e-9) << "the second session has it";
  EXPECT_NEAR(place_of(mornings, 12.0), 0.0, 1e-9) << "20 comes next";
  EXPECT_NEAR(place_of(mornings, 22.0), 12.0, 1e-9) << "8 comes next";
  EXPECT_EQ(place_of(mornings, 8.5, 99.0), -1.0) << "nothing from there on";
}

TEST(TimeOfDay, BelievesTheClockOfASessionsEnd) {
  auto sessions = sessions_of({{14.0, 20.0}});
  sessions[0].first.utc = UtcTime{};  // 1970, until the network told
  EXPECT_NEAR(place_of(sessions, 15.0), 1.0, 1e-9);
}

TEST(TimeOfDay, TakesHoursAheadOfUtc) {
  const UtcTime noon(12h);
  EXPECT_EQ((*parse_utc_offset("2"))(noon), 2h);
  EXPECT_EQ((*parse_utc_offset("-3.5"))(noon), -210min);
  EXPECT_EQ(time_of_day(noon, *parse_utc_offset("-14")), 22h);
  EXPECT_EQ((*parse_utc_offset(""))(noon), machine_utc_offset(noon));
  for (const char* text : {"15", "-15", "UTC", "1h", "nan", " 1", "+1", "1e9"}) {
    EXPECT_FALSE(parse_utc_offset(text)) << text;
  }
}

TEST(WindlogPlayer, BeginsAndLoopsAtTheTimeOfDay) {
  // A day and a half from 14:00 UTC on, a reading a minute that tells its minute of the day; the wall's clock shows
  // midnight UTC (tests/support/manual_clock.hpp), which is 10 h after the beginning.
  std::vector<wind::Reading> readings;
  for (int minute = 0; minute < 36 * 60; ++minute) {
    readings.push_back(test::reading_at(60'000LL * minute, 0.01 * ((14 * 60 + minute) % 1440)));
  }
  const UtcOffset utc = *parse_utc_offset("0");
  Playing playing(
      readings,
      {.playback = {.loop = true}, .seam_s = 0.0, .at_time_of_day = true, .recorded_offset = utc, .offset_here = utc});
  EXPECT_DOUBLE_EQ(playing.place_s(), 36'000.0);
  playing.run(std::chrono::hours(24 * 4));
  EXPECT_GE(playing->position(playing.now().mono).rounds, 2U);
  for (const wind::Reading& reading : playing.said) {
    const double minute = seconds(time_of_day(reading.time.utc, utc)) / 60.0;
    const double apart = std::remainder(100.0 * reading.speed_m_s - minute, 1440.0);
    EXPECT_LT(std::abs(apart), 1.1) << "at minute " << minute;
  }
}

// ---- a lead-in ----

TEST(WindlogPlayerLead, BeginsEarlierAndIsWhereItWasToBeginWhenThatIsOver) {
  Playing playing(numbered_readings(600), {.playback = {.start = "20"}, .lead_s = 15.0});
  playing.run(15s);
  EXPECT_NEAR(playing.place_s(), 20.0, 1e-6);
  ASSERT_EQ(playing.said.size(), 151U);
  EXPECT_EQ(playing.said.front().speed_m_s, 0.050);
  EXPECT_EQ(playing.said.back().speed_m_s, 0.200);
}

TEST(WindlogPlayerLead, BeforeTheRecordingItsFirstReadingIsHeld) {
  Playing playing(swinging_wind(), {.playback = {.start = "5"}, .lead_s = 15.0});
  playing.run(9900ms);
  ASSERT_EQ(playing.said.size(), 100U);
  EXPECT_FALSE(playing.said.front().is_held);
  for (const auto& reading : playing.said) EXPECT_EQ(reading.speed_m_s, playing.said.front().speed_m_s);
  EXPECT_TRUE(std::all_of(playing.said.begin() + 1, playing.said.end(), [](const auto& said) { return said.is_held; }));
  const PlayerPosition before = playing->position(playing.now().mono);
  EXPECT_EQ(before.held_for, -100ms);
  playing.run(5100ms);
  EXPECT_NEAR(playing.place_s(), 5.0, 1e-6);
  EXPECT_TRUE(playing.is_in_order());
  EXPECT_FALSE(playing.said.back().is_held);
}

TEST(WindlogPlayerLead, ASilenceAtThePlaceStaysSilent) {
  auto readings = numbered_readings(10);
  readings.push_back(test::reading_at(100'000, 7.0));
  Playing playing(readings, {.playback = {.start = "50"}, .lead_s = 15.0});
  playing.run(60s);
  EXPECT_TRUE(playing.said.empty());
}

TEST(WindlogPlayerLead, APausedRecordingStandsAtItsPlace) {
  Playing playing(numbered_readings(600), {.playback = {.start = "20"}, .is_paused = true, .lead_s = 15.0});
  playing.run(1s);
  EXPECT_NEAR(playing.place_s(), 20.0, 1e-6);
  EXPECT_EQ(playing.said.front().speed_m_s, 0.200);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
