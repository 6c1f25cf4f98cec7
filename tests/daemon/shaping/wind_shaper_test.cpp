#include "daemon/shaping/wind_shaper.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/settings/config.hpp"
#include "tests/support/gusty_wind.hpp"

namespace yuragi::daemon::shaping {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kShaperTick_s = 1.0 / 60.0;

/// What the log is told while this lives.
class CapturedLog {
 public:
  CapturedLog() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(text_)));
  }
  ~CapturedLog() { spdlog::set_default_logger(before_); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  /// How many lines hold this.
  int count(const std::string& words) const {
    std::istringstream lines(text_.str());
    int found = 0;
    for (std::string line; std::getline(lines, line);) found += line.find(words) != std::string::npos ? 1 : 0;
    return found;
  }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

/// An installation with this [shaping], its steady wind, and both clocks, moved by hand.
class ShaperBench {
 public:
  explicit ShaperBench(const std::string& shaping)
      : config_(settings::parse_config("[shaping]\n" + shaping, "wall.toml")), shaper(config_, shared_gusts()) {}

  /// The speed that moves the scenes, after so long of this wind.
  double after(double speed_m_s, double duration_s = kShaperTick_s, double step_s = kShaperTick_s) {
    double shaped_m_s = 0.0;
    for (double left_s = duration_s; left_s > 0.5 * step_s; left_s -= step_s) {
      mono += from_seconds(step_s);
      utc += from_seconds(step_s);
      wind::ground::DrivingWind wind{.state = {.time = mono, .wind = {speed_m_s, 0.0}, .live_weight = 1.0},
                                     .ground = wind::Vector{speed_m_s, 0.0}};
      shaper.shape(wind, utc, is_any_live);
      shaped_m_s = speed_of(wind.state.wind);
      largest_step_m_s = std::max(largest_step_m_s, has_begun_ ? std::abs(shaped_m_s - last_m_s_) : 0.0);
      has_begun_ = true;
      last_m_s_ = shaped_m_s;
    }
    return shaped_m_s;
  }
  std::string text() const { return shaper.status().text; }

 private:
  settings::Config config_;
  bool has_begun_ = false;
  double last_m_s_ = 0.0;

 public:
  MonoTime mono{std::chrono::hours(1)};
  UtcTime utc = std::chrono::sys_days(std::chrono::year(2026) / 11 / 17) + 9h + 58min;  // a Tuesday
  double largest_step_m_s = 0.0;
  bool is_any_live = true;
  WindShaper shaper;
};

TEST(WindShaper, NothingButTheCeilingIsOnByDefault) {
  ShaperBench wall("");
  for (const double speed_m_s : {0.0, 0.4, 5.0, 16.9}) EXPECT_EQ(wall.after(speed_m_s, 2.0), speed_m_s);
  EXPECT_EQ(wall.text(), "");
  EXPECT_LT(wall.after(40.0), 25.0);
  EXPECT_THAT(wall.text(), HasSubstr("ceiling: 40.0 limited to 22."));
}

TEST(WindShaper, TellsHowStrongGustsAreWhereTheyAreNotTheRealOnes) {
  EXPECT_EQ(settings::parse_config("", "wall.toml").shaping.settings.gusts, 1.0);
  const wind::shaping::WindShapingSettings settings =
      settings::parse_config("[shaping]\ngusts = 1.5\n", "wall.toml").shaping.settings;
  EXPECT_EQ(settings.gusts, 1.5);
  EXPECT_EQ(shaping_text({.gusts = 1.5}, settings, {}), "gusts 1.50 times the real ones");
  EXPECT_EQ(shaping_text({.gusts = 1.0}, settings, {}), "");
  EXPECT_EQ(shaping_text({.breeze_m_s = 0.0, .gusts = 0.0}, settings, {.has_hours = true, .until = "until 18:00"}),
            "gusts 0.00 times the real ones; open until 18:00");
}

TEST(WindShaper, OpensAndClosesByTheWallAndSaysSo) {
  const CapturedLog log;
  ShaperBench wall("hours = \"10:00-18:00\"\nzone = \"Etc/UTC\"\nfade = 20\n");
  EXPECT_EQ(wall.after(6.0, 60.0), 0.0);
  EXPECT_EQ(wall.text(), "closed until 10:00");
  const double soon_m_s = wall.after(6.0, 65.0);
  EXPECT_GT(soon_m_s, 0.0);
  EXPECT_LT(soon_m_s, 6.0);
  EXPECT_THAT(wall.text(), HasSubstr("open until 18:00, fading in: "));
  EXPECT_EQ(wall.after(6.0, 120.0), 6.0);
  EXPECT_EQ(wall.text(), "open until 18:00");
  EXPECT_EQ(log.count("closed until 10:00"), 1);
  EXPECT_EQ(log.count("open until 18:00; the wind fades in over 20 s"), 1);
}

TEST(WindShaper, NoJumpOfTheClockIsOneOfTheWind) {
  ShaperBench wall("hours = \"10:00-18:00\"\nzone = \"Europe/Berlin\"\nfade = 30\n");
  std::int64_t jump = 0;
  for (const auto hours : {5h, -5h, 87600h, -175200h, 87600h, 1h, 12h}) {
    wall.utc += hours;
    wall.after(6.0, 20.0 + static_cast<double>(++jump % 3) * 20.0);
  }
  // Critically damped: a step of the target by 1 moves it at most 0.37 times its rate.
  EXPECT_GT(wall.largest_step_m_s, 0.0);
  EXPECT_LE(wall.largest_step_m_s, 6.0 / std::numbers::e * (4.75 / 30.0) * kShaperTick_s * 1.001);
}

settings::ShapingConfig shaping_of(const std::string& shaping) {
  return settings::parse_config("[shaping]\n" + shaping, "wall.toml").shaping;
}

TEST(WindShaper, OtherSettingsTakeEffectWithinSecondsAndWithoutAJump) {
  ShaperBench wall("floor = 4\ngusts = 2\nover = 10\n");
  EXPECT_NEAR(wall.after(2.0, 120.0), 4.0, 1e-3);
  wall.largest_step_m_s = 0.0;
  wall.shaper.change(shaping_of("floor = 0\ngusts = 0.5\nover = 10\n"));
  double gusts = 2.0;
  for (int tick = 0; tick < 120; ++tick) {
    EXPECT_GT(wall.after(2.0), 2.0) << "not at once";
    EXPECT_NEAR(wall.shaper.status().gusts, gusts, 0.02);
    gusts = wall.shaper.status().gusts;
  }
  wall.shaper.change(shaping_of("floor = 3\ngusts = 1\nover = 10\n"));  // while the first change is under way
  EXPECT_NEAR(wall.after(2.0), wall.after(2.0), 0.05);
  EXPECT_NEAR(wall.after(2.0, 60.0), 3.0, 1e-3);
  EXPECT_EQ(wall.shaper.status().gusts, 1.0) << "exactly, so that the wind is left as it is";
  EXPECT_LT(wall.largest_step_m_s, 0.05) << "in a sixtieth of a second";
}

TEST(WindShaper, ABreezeThatIsTakenAwayDiesDownGently) {
  ShaperBench wall("floor = 4\nover = 10\n");
  wall.after(0.2, 120.0);
  const double normal_step_m_s = std::exchange(wall.largest_step_m_s, 0.0);
  wall.shaper.change(shaping_of("floor = 0\nover = 10\n"));
  EXPECT_NEAR(wall.after(0.2, 60.0), 0.2, 1e-3);
  EXPECT_LT(wall.largest_step_m_s, 1.5 * normal_step_m_s + 0.03);
}

TEST(WindShaper, ACeilingThatComesOrGoesLowersAStormGently) {
  ShaperBench wall("ceiling = 0\n");
  EXPECT_EQ(wall.after(40.0, 10.0), 40.0);
  wall.largest_step_m_s = 0.0;
  wall.shaper.change(shaping_of("ceiling = 10\nceiling_most = 20\n"));
  EXPECT_NEAR(wall.after(40.0, 30.0), 17.5, 1e-9) << "10 + 10 x/(1 + x), x = 3";
  wall.shaper.change(shaping_of("ceiling = 0\n"));
  EXPECT_EQ(wall.after(40.0, 30.0), 40.0);
  EXPECT_LT(wall.largest_step_m_s, 0.5);
}

TEST(WindShaper, NewHoursCloseAndOpenWithTheirOwnFade) {
  ShaperBench wall("");
  EXPECT_EQ(wall.after(6.0, 5.0), 6.0);
  wall.largest_step_m_s = 0.0;
  wall.shaper.change(shaping_of("hours = \"12:00-18:00\"\nzone = \"Etc/UTC\"\nfade = 20\n"));
  EXPECT_LT(wall.after(6.0, 60.0), 0.1);
  EXPECT_EQ(wall.text(), "closed until 12:00");
  wall.shaper.change(shaping_of(""));
  EXPECT_GT(wall.after(6.0, 900.0), 5.9);
  EXPECT_EQ(wall.text(), "");
  EXPECT_LE(wall.largest_step_m_s, 6.0 / std::numbers::e * (4.75 / 20.0) * kShaperTick_s * 1.001);
}

TEST(WindShaper, TheFloorIsToldOnceHoweverTheWindFlickers) {
  const CapturedLog log;
  ShaperBench wall("floor = 2\nover = 10\n");
  for (int i = 0; i < 50; ++i) wall.after(i % 2 == 0 ? 1.0 : 1.4, 5.0);
  EXPECT_THAT(wall.text(), ::testing::MatchesRegex("floor: raised 1\\.[0-9] to 2\\.[01] m/s"));
  EXPECT_EQ(log.count("raised toward the floor of 2.0 m/s"), 1);
  for (int i = 0; i < 20; ++i) wall.after(i % 2 == 0 ? 5.0 : 4.0, 5.0);
  EXPECT_EQ(log.count("is above the floor again"), 1);
  EXPECT_EQ(wall.text(), "");
}

TEST(WindShaper, AStormIsToldOnceHoweverManyGustsItHas) {
  const CapturedLog log;
  ShaperBench wall("");
  for (int i = 0; i < 100; ++i) wall.after(i % 2 == 0 ? 12.0 : 30.0, 2.0);
  EXPECT_EQ(log.count("storm: 30.0 m/s is limited to"), 1);
  EXPECT_EQ(log.count("the storm is over"), 0);
  wall.after(12.0, 70.0);
  EXPECT_EQ(log.count("the storm is over; the strongest was 30.0 m/s"), 1);
}

/// Two sensors, and what they have learnt from each other.
struct KeptPair {
  wind::judging::GroupGains gains{2};
  wind::blend::GustReachFit reach{2};
  KeptOfSensors kept() {
    return {
        .gains = {.learnt =
                      [this] {
                        return wind::judging::LearntByName{{"roof", gains.learnt()[0]}, {"yard", gains.learnt()[1]}};
                      },
                  .restore =
                      [this](const wind::judging::LearntByName& learnt) {
                        std::vector<wind::judging::GroupGains::Learnt> all(2);
                        if (learnt.contains("roof")) all[0] = learnt.at("roof");
                        if (learnt.contains("yard")) all[1] = learnt.at("yard");
                        return gains.restore(all);
                      }},
        .reach = {.learnt = [this] { return reach.reach(); },
                  .restore = [this](const wind::blend::GustReach& learnt) { return reach.restore(learnt); }}};
  }
};

class SiteFileTest : public ::testing::Test {
 protected:
  SiteFileTest() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~SiteFileTest() override { std::filesystem::remove_all(folder_); }

  std::string with_file(const std::string& more = "") const {
    return "site_median = 4\nsite_memory = 0.2\nover = 10\nsite_file = \"" + file_.string() + "\"\n" + more;
  }

  /// As a run of the daemon leaves it.
  void write_file(KeptPair& pair) const {
    ShaperBench wall(with_file());
    wall.shaper.keep_site_file({}, pair.kept());
    wall.after(2.0);
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("site_file_test." + std::to_string(getpid()));
  std::filesystem::path file_ = folder_ / "site.json";
};

TEST_F(SiteFileTest, TheSiteIsRememberedOverAChangeOfTheSettings) {
  ShaperBench wall("site_median = 4\nsite_memory = 0.2\nover = 10\n");
  wall.after(2.0, 6.0 * 3600.0, 1.0);
  const double known_s = wall.shaper.status().site_known_s;
  EXPECT_NEAR(wall.after(2.0), 4.0, 0.1);
  wall.largest_step_m_s = 0.0;
  wall.shaper.change(shaping_of("site_median = 6\nsite_memory = 0.1\nover = 10\n"));
  EXPECT_NEAR(wall.after(2.0, 60.0), 6.0, 0.1);
  EXPECT_LT(wall.largest_step_m_s, 0.02);
  EXPECT_NEAR(wall.shaper.status().site_median_m_s, 2.0, 0.1);
  EXPECT_LE(wall.shaper.status().site_known_s, 8640.0 + 1.0);
  wall.shaper.change(shaping_of("site_median = 6\nsite_memory = 7\nover = 10\n"));
  wall.after(2.0, 10.0);
  EXPECT_GT(wall.shaper.status().site_known_s, 0.5 * known_s) << "a longer memory keeps what there is";
}

TEST_F(SiteFileTest, TheSiteIsRememberedOverARestart) {
  {
    ShaperBench wall(with_file());
    wall.shaper.keep_site_file();
    wall.after(2.0, 6.0 * 3600.0, 1.0);
    EXPECT_NEAR(wall.after(2.0), 4.0, 0.1);
    // Once an hour, not at the end only; on a thread of its own.
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (!std::filesystem::exists(file_) && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    EXPECT_TRUE(std::filesystem::exists(file_));
  }
  const CapturedLog log;
  ShaperBench wall(with_file());
  wall.shaper.keep_site_file();
  EXPECT_NEAR(wall.after(2.0), 4.0, 0.1);
  EXPECT_THAT(wall.text(), HasSubstr("site gain 2.0"));
  EXPECT_EQ(log.count("holds 3 h"), 1);
}

TEST_F(SiteFileTest, TheSitesGustsAreRememberedOverARestart) {
  const auto learnt = std::make_shared<wind::turbulence::SiteSpectrum>();
  for (int i = 0; i < 1000; ++i) learnt->learn(1, 3.0, 14.0);
  {
    // A gain is not needed for that.
    ShaperBench wall("site_file = \"" + file_.string() + "\"\n");
    wall.shaper.keep_site_file(learnt);
    wall.after(2.0);
  }
  const CapturedLog log;
  const auto known = std::make_shared<wind::turbulence::SiteSpectrum>();
  ShaperBench wall("site_file = \"" + file_.string() + "\"\n");
  wall.shaper.keep_site_file(known);
  EXPECT_EQ(known->octaves_db(), learnt->octaves_db());
  EXPECT_EQ(log.count("of the site's gusts"), 1);
}

TEST_F(SiteFileTest, AFileFromBeforeGustsWereLearntIsStillRead) {
  std::string times;
  for (std::size_t bin = 0; bin < wind::shaping::SpeedMemory::kBins; ++bin) times += bin == 0 ? "0" : ",100";
  std::ofstream(file_) << "{\"seconds_at_each_speed\": [" << times << "]}";
  const CapturedLog log;
  const auto gusts = std::make_shared<wind::turbulence::SiteSpectrum>();
  ShaperBench wall(with_file());
  wall.shaper.keep_site_file(gusts);
  EXPECT_EQ(log.count("of the site's wind"), 1);
  EXPECT_EQ(gusts->octaves_db(), wind::turbulence::SiteSpectrum::Decibels{});
}

TEST_F(SiteFileTest, HowTheSensorsDifferIsRememberedOverARestart) {
  KeptPair before;
  ASSERT_TRUE(before.gains.restore(std::vector<wind::judging::GroupGains::Learnt>{{0.2, 7200.0}, {-0.2, 7200.0}}));
  write_file(before);
  const CapturedLog log;
  KeptPair after;
  ShaperBench wall(with_file());
  wall.shaper.keep_site_file({}, after.kept());
  EXPECT_NEAR(after.gains.gain(0), before.gains.gain(0), 1e-9);
  EXPECT_NEAR(after.gains.gain(1), before.gains.gain(1), 1e-9);
  EXPECT_EQ(after.gains.learnt()[0].learnt_s, 7200.0);
  EXPECT_EQ(log.count("holds how 2 sensors differ"), 1);
  EXPECT_EQ(log.count("how far gusts are alike"), 0) << "nothing is known of it";
}

TEST_F(SiteFileTest, HowFarGustsAreAlikeIsRememberedOverARestart) {
  KeptPair before;
  ASSERT_TRUE(
      before.reach.restore({.across_ln = 0.4, .along_ln = -0.2, .across_variance = 0.01, .along_variance = 0.02}));
  write_file(before);
  const CapturedLog log;
  KeptPair after;
  ShaperBench wall(with_file());
  wall.shaper.keep_site_file({}, after.kept());
  EXPECT_NEAR(after.reach.reach().across_ln, 0.4, 1e-9);
  EXPECT_NEAR(after.reach.reach().along_ln, -0.2, 1e-9);
  EXPECT_NEAR(after.reach.reach().across_variance, 0.01, 1e-9);
  EXPECT_NEAR(after.reach.reach().along_variance, 0.02, 1e-9);
  EXPECT_EQ(log.count("holds how far gusts are alike here"), 1);
}

/// A JSON list of the times of a site's wind.
std::string some_times() {
  std::string times;
  for (std::size_t bin = 0; bin < wind::shaping::SpeedMemory::kBins; ++bin) times += bin == 0 ? "0" : ",100";
  return '[' + times + ']';
}

TEST_F(SiteFileTest, AWrongReachIsToldAndTheRestOfTheFileIsUsed) {
  const auto reach = [](const char* across, const char* deviation) {
    return fmt::format(R"({{"across":{},"across_deviation":{},"along":1,"along_deviation":0.1}})", across, deviation);
  };
  for (const std::string& wrong : {std::string("3"), std::string("[]"), std::string("null"), std::string("{}"),
                                   reach("1e9", "0.1"), reach("0", "0.1"), reach("-1", "0.1"), reach("null", "0.1"),
                                   reach("\"1\"", "0.1"), reach("1", "0"), reach("1", "9")}) {
    std::ofstream(file_) << R"({"seconds_at_each_speed": )" << some_times() << R"(, "gust_reach": )" << wrong << "}";
    const CapturedLog log;
    KeptPair pair;
    ShaperBench wall(with_file());
    wall.shaper.keep_site_file({}, pair.kept());
    EXPECT_EQ(log.count("how far gusts are alike is learnt anew"), 1) << wrong;
    EXPECT_EQ(log.count("of the site's wind"), 1) << wrong;
    EXPECT_EQ(pair.reach.reach(), wind::blend::GustReach{}) << wrong;
  }
}

TEST_F(SiteFileTest, WrongGainsAreToldAndTheRestOfTheFileIsUsed) {
  std::string many;
  for (int i = 0; i < 1000; ++i) many += (i == 0 ? "\"" : ",\"") + std::to_string(i) + R"(":{"reads":1,"seconds":1})";
  const std::string good = R"("yard":{"reads":0.9,"seconds":60})";
  for (const std::string& wrong :
       {std::string("3"), std::string("[]"), std::string("null"), std::string(R"({"roof":1.2})"),
        std::string(R"({"roof":{"reads":null,"seconds":60}})"), std::string(R"({"roof":{"reads":1.2}})"),
        "{" + good + R"(,"roof":{"reads":1e9,"seconds":60}})", "{" + good + R"(,"roof":{"reads":0,"seconds":60}})",
        "{" + good + R"(,"roof":{"reads":-1.2,"seconds":60}})", "{" + good + R"(,"roof":{"reads":1.2,"seconds":-1}})",
        "{" + good + R"(,"roof":{"reads":"1.2","seconds":60}})", "{" + good + "," + good + "}", "{" + many + "}"}) {
    std::ofstream(file_) << R"({"seconds_at_each_speed": )" << some_times() << R"(, "relative_gains": )" << wrong
                         << "}";
    const CapturedLog log;
    KeptPair pair;
    ShaperBench wall(with_file());
    wall.shaper.keep_site_file({}, pair.kept());
    EXPECT_EQ(log.count("how the sensors differ is learnt anew"), 1) << wrong;
    EXPECT_EQ(log.count("of the site's wind"), 1) << wrong;
    EXPECT_EQ(pair.gains.gain(0), 1.0) << wrong;
    EXPECT_EQ(pair.gains.gain(1), 1.0) << wrong;
  }
}

TEST_F(SiteFileTest, AFileOfAnotherKindIsToldAndBegunAnew) {
  for (const char* wrong : {"", "{", "[]", "{\"seconds_at_each_speed\": 3}", "{\"seconds_at_each_speed\": [1, \"x\"]}",
                            "{\"seconds_at_each_speed\": [1, 2]}", "{\"seconds_at_each_speed\": [-1e999]}"}) {
    std::ofstream(file_) << wrong;
    const CapturedLog log;
    {
      ShaperBench wall(with_file());
      wall.shaper.keep_site_file();
      EXPECT_EQ(wall.after(2.0), 2.0) << wrong;
    }
    EXPECT_EQ(log.count("site gain begins at 1; starting a new file"), 1) << wrong;
    EXPECT_EQ(log.count("it is kept as "), 1) << wrong;
    EXPECT_TRUE(SiteFile(file_).read().has_value()) << wrong;
  }
  std::string kept;
  std::getline(std::ifstream(file_.string() + ".unreadable-2"), kept);
  EXPECT_EQ(kept, "{") << "the second one";
}

TEST_F(SiteFileTest, AFolderThatIsNotThereIsToldAndNoReasonToStop) {
  const CapturedLog log;
  {
    ShaperBench wall("site_median = 4\nsite_file = \"" + (folder_ / "not" / "there.json").string() + "\"\n");
    wall.shaper.keep_site_file();
    EXPECT_EQ(wall.after(2.0), 2.0);
  }
  EXPECT_EQ(log.count("the site's wind could not be saved: "), 1);
}

TEST_F(SiteFileTest, ARecordingIsNotTheSite) {
  {
    ShaperBench wall(with_file("[[sensor]]\ndriver = \"windlog\"\nfile = \"storm.windlog\"\n"));
    wall.shaper.keep_site_file();
    wall.after(2.0);
  }
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST(WindShaper, NothingIsLearntOfTheSiteFromAFallBack) {
  ShaperBench wall("site_median = 4\nover = 10\n");
  wall.is_any_live = false;
  EXPECT_EQ(wall.after(2.0, 3.0 * 3600.0, 1.0), 2.0);
  EXPECT_EQ(wall.shaper.status().site_known_s, 0.0);
  wall.is_any_live = true;
  wall.after(2.0, 600.0, 1.0);
  EXPECT_NEAR(wall.shaper.status().site_known_s, 590.0, 5.0);
}

TEST(ShapingText, SaysEverythingThatIsAtWork) {
  const wind::shaping::WindShapingSettings settings{.floor_m_s = 1.5, .site = {.median_m_s = 3.0}, .closed_level = 0.2};
  const wind::shaping::WindShapingReport report{.mean_m_s = 0.4,
                                                .shaped_mean_m_s = 1.5,
                                                .site_gain = 1.5,
                                                .floor_gain = 2.5,
                                                .opening = 0.6,
                                                .speed_m_s = 30.0,
                                                .ceiling_gain = 0.75,
                                                .median_m_s = 1.2,
                                                .strong_m_s = 3.9,
                                                .known_s = 450'000.0};
  EXPECT_EQ(shaping_text(report, settings, {.has_hours = true, .is_open = false, .until = "until Tue 10:00"}),
            "site gain 1.50 (in 5 days 5 h median 1.2, strong 3.9 m/s); floor: raised 0.6 to 1.5 m/s; "
            "closed until Tue 10:00, fading out: 60 % of the wind; ceiling: 30.0 limited to 22.5 m/s");
  EXPECT_EQ(shaping_text({}, {}, {}), "");
  const OpeningNews closed{.has_hours = true, .is_open = false, .until = "until 10:00"};
  EXPECT_EQ(shaping_text({.opening = 0.2}, settings, closed),
            "site gain 1.00 (nothing is known of the site yet); closed until 10:00: 20 % of the wind");
}

}  // namespace
}  // namespace yuragi::daemon::shaping
