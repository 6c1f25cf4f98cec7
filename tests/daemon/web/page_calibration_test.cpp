#include <array>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/settings/config.hpp"
#include "daemon/web/archive.hpp"
#include "daemon/web/page_setup.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kMast = "[http]\ntoken_file = \"token\"\n[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n";

class PageCalibrationTest : public testing::Test {
 protected:
  PageCalibrationTest() { write(config_, kMast); }

  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  PageSetup setup() {
    return {config_, page_, {.restart = [this] { ++restarts_; }, .reload = [] {}}};
  }
  http::Response keep(const std::string& sensor, const FoundCalibration& found) {
    return setup().calibrate(sensor, found);
  }
  /// As the daemon reads it.
  settings::Config installation() const {
    std::ifstream page(page_);
    const std::string text((std::istreambuf_iterator<char>(page)), {});
    return settings::with_page(settings::load_config(config_), text, "page.toml");
  }
  double gain_of(std::size_t sensor) const { return installation().sensors.at(sensor).calibration.gain; }

  test::TemporaryFolder folder_;
  std::filesystem::path config_ = folder_ / "wall.toml";
  std::filesystem::path page_ = folder_ / "page.toml";
  int restarts_ = 0;
};

TEST_F(PageCalibrationTest, ACalibrationIsKept_ForgottenAndUndone) {
  EXPECT_EQ(keep("mast", {.before = {{"gain", "1"}, {"offset", "0"}}, .after = {{"gain", "1.04"}, {"offset", "-0.3"}}})
                .status,
            200U);
  EXPECT_EQ(restarts_, 1);
  EXPECT_EQ(gain_of(0), 1.04);
  EXPECT_EQ(installation().sensors[0].calibration.offset_m_s, -0.3);
  EXPECT_THAT(setup().list().body, HasSubstr("\"calibrated\": [\n    \"mast\"\n  ]"));
  EXPECT_EQ(keep("mast", {.before = {{"north_offset", "0"}}, .after = {{"north_offset", "12"}}}).status, 200U);
  EXPECT_EQ(gain_of(0), 1.04) << "what was kept before counts, too";
  EXPECT_EQ(setup().undo().status, 200U);
  EXPECT_EQ(installation().sensors[0].calibration.north_offset_deg, 0.0);
  EXPECT_EQ(setup().forget_calibration("mast").status, 200U);
  EXPECT_EQ(gain_of(0), 1.0);
  EXPECT_EQ(setup().forget_calibration("mast").status, 404U);
  EXPECT_EQ(restarts_, 4);
}

TEST_F(PageCalibrationTest, ASensorOfThePageIsCalibratedInItsOwnEntry) {
  ASSERT_EQ(setup().add({.name = "roof", .driver = "synthetic"}).status, 200U);
  EXPECT_EQ(keep("roof", {.before = {{"gain", "1"}}, .after = {{"gain", "1.2"}}}).status, 200U);
  EXPECT_EQ(gain_of(1), 1.2);
  EXPECT_THAT(installation().page_calibrations, IsEmpty());
  EXPECT_EQ(setup().remove("roof").status, 200U);
  EXPECT_EQ(installation().sensors.size(), 1U);
}

TEST_F(PageCalibrationTest, ACalibrationThatBeganFromOtherValuesIsRefused) {
  write(config_, std::string(kMast) + "[sensor.calibration]\ngain = 1.1\n");
  const http::Response refusal = keep("mast", {.before = {{"gain", "1"}}, .after = {{"gain", "1.04"}}});
  EXPECT_EQ(refusal.status, 409U);
  EXPECT_THAT(refusal.body, HasSubstr("gain was changed while mast was calibrated"));
  EXPECT_FALSE(std::filesystem::exists(page_));
}

TEST_F(PageCalibrationTest, OnlyWhatACalibrationFindsIsKept_AndOnlyWithinItsLimits) {
  EXPECT_EQ(keep("roof", {.before = {{"gain", "1"}}, .after = {{"gain", "1.04"}}}).status, 404U);
  for (const auto& [key, before, after] :
       {std::array{"height", "0", "4"}, std::array{"gain", "1", "1000"}, std::array{"gain", "1", "strong"},
        std::array{"offset", "0", "nan"}, std::array{"curve", "", "5:3"}, std::array{"gain\n[http]", "1", "2"}}) {
    EXPECT_EQ(keep("mast", {.before = {{key, before}}, .after = {{key, after}}}).status, 409U) << key << after;
  }
  EXPECT_FALSE(std::filesystem::exists(page_));
  EXPECT_EQ(restarts_, 0);
}

TEST_F(PageCalibrationTest, WithoutATokenNothingIsCalibrated) {
  write(config_, "[[sensor]]\nname = \"mast\"\ndriver = \"synthetic\"\n");
  EXPECT_EQ(keep("mast", {.before = {{"gain", "1"}}, .after = {{"gain", "1.04"}}}).status, 409U);
  EXPECT_EQ(setup().calibration_refusal("mast", "")->status, 409U);
}

TEST_F(PageCalibrationTest, ASensorWhoseSettingsWereChangedSinceTheStartIsNotCalibrated) {
  const std::vector<settings::SensorConfig> open = settings::load_config(config_).sensors;
  const PageSetup setup(config_, page_, {.restart = [] {}, .reload = [] {}}, open);
  EXPECT_FALSE(setup.calibration_refusal("mast", ""));
  write(config_,
        std::string(kMast) + "[sensor.calibration]\ngain = 1.1\n[[sensor]]\nname = \"roof\"\ndriver = \"nmea\"\n");
  EXPECT_FALSE(setup.calibration_refusal("mast", "roof")) << "a calibration counts at once, and roof is not open";
  write(config_, std::string(kMast) + "speed = 4.5\n");
  const auto refusal = setup.calibration_refusal("mast", "");
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, 409U);
  EXPECT_THAT(refusal->body, HasSubstr("mast was changed since the daemon was started"));
}

TEST_F(PageCalibrationTest, AMicrophonesOwnCalibrationIsKept_AndRefusedWhereItsDriverWouldRefuseIt) {
  write(config_, "[http]\ntoken_file = \"token\"\n[[sensor]]\nname = \"mic\"\ndriver = \"microphone\"\n");
  for (const auto& [key, before, after] :
       {std::array{"level_curve", "", "loud"}, std::array{"level_exponent", "2", "99"},
        std::array{"level_gain", "0", "x"}, std::array{"device", "", "other"}, std::array{"exponent", "2", "1.6"}}) {
    EXPECT_EQ(keep("mic", {.before = {{key, before}}, .after = {{key, after}}}).status, 409U) << key << after;
  }
  EXPECT_FALSE(std::filesystem::exists(page_));
  EXPECT_EQ(keep("mic", {.before = {{"level_curve", ""}}, .after = {{"level_curve", "-62:0 -50:1.2"}}}).status, 200U);
  EXPECT_EQ(installation().sensors[0].values.text("curve"), "-62:0 -50:1.2");
  EXPECT_EQ(restarts_, 1);
}

class CalibrationJobTest : public PageCalibrationTest {
 protected:
  /// What would be called, a word a line.
  std::string command_of(const std::string& sensor, const CalibrationOrder& order) {
    Archive archive({.configuration = config_,
                     .stream = "127.0.0.1:7410",
                     .page = page_,
                     .taking_over = {.restart = [] {}, .reload = [] {}},
                     .program = {"/bin/sh", "-c", "printf '%s\\n' \"$@\" >&2; exit 1", "sh"}});
    const auto ask = [&archive](ArchiveRequest request) {
      std::promise<http::Response> answered;
      archive.answer(std::move(request), [&](http::Response response) { answered.set_value(std::move(response)); });
      return answered.get_future().get();
    };
    const http::Response started =
        ask({.what = ArchiveRequest::What::kCalibrate, .name = sensor, .calibration = order});
    if (started.status != 202) return std::to_string(started.status);
    const std::string id = nlohmann::json::parse(started.body)["id"];
    while (true) {
      const auto job = nlohmann::json::parse(ask({.what = ArchiveRequest::What::kJob, .name = id}).body);
      if (job["state"] != "running") return job["message"];
      std::this_thread::yield();
    }
  }
};

TEST_F(CalibrationJobTest, NothingReachesTheCommandButNumbersAndNamesOfSensors) {
  write(config_, std::string(kMast) + "[[sensor]]\nname = \"--help\"\ndriver = \"synthetic\"\n");
  EXPECT_EQ(command_of("mast", {.calibration = "north", .duration_s = 4.0, .bearing_deg = 214.5}),
            "calibrate\nnorth\n--json\n--sensor=mast\n--for=4\n--bearing=214.5\n--config=" + config_.string() +
                "\n--connect=127.0.0.1:7410");
  EXPECT_THAT(command_of("--help", {.calibration = "span", .reference = "mast"}),
              HasSubstr("span\n--json\n--sensor=--help\n--reference=mast\n"));
  EXPECT_THAT(command_of("mast", {.calibration = "span", .points = {{3.1, 3.0}, {10.4, 11.0}}}),
              HasSubstr("--points=3.1:3 10.4:11\n"));
  EXPECT_THAT(command_of("mast", {.calibration = "microphone", .speed_m_s = 4.0}),
              HasSubstr("microphone\n--json\n--sensor=mast\n--unchanged\n--speed=4\n"));
  EXPECT_EQ(command_of("roof", {.calibration = "zero"}), "404");
  EXPECT_EQ(command_of("mast", {.calibration = "north", .reference = "roof"}), "404");
  EXPECT_EQ(command_of("mast\n--yes", {.calibration = "zero"}), "404");
}

}  // namespace
}  // namespace yuragi::daemon::web
