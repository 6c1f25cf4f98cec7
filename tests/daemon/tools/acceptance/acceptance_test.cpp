#include "daemon/tools/acceptance/acceptance.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/acceptance/sensor_measurement.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using wind::judging::SensorState;

/// A sensor for which everything is as it should be.
SensorMeasured good() {
  SensorMeasured sensor;
  sensor.status.name = "roof";
  sensor.status.driver = "modbus";
  sensor.status.state = SensorState::kLive;
  sensor.status.readings = 200;
  sensor.status.interval_s = 0.1;
  sensor.measured_s = 20.0;
  sensor.first_reading_s = 0.4;
  sensor.least_speed_m_s = 2.0;
  sensor.mean_speed_m_s = 4.0;
  sensor.largest_speed_m_s = 6.0;
  sensor.delays = 199;
  sensor.median_delay_s = 0.02;
  sensor.longest_delay_s = 0.3;
  sensor.frames = 1200;
  sensor.moved_frames = 1199;
  sensor.largest_live_weight = 1.0;
  return sensor;
}

SensorVerdict verdict_of(const SensorMeasured& sensor) {
  return judge(sensor, {});
}

TEST(JudgeSensor, PassesOneThatWorks) {
  EXPECT_EQ(verdict_of(good()).outcome, Outcome::kPassed);
  EXPECT_THAT(verdict_of(good()).remarks, IsEmpty());
}

TEST(JudgeSensor, FailsOneWithoutAReading) {
  SensorMeasured sensor = good();
  sensor.first_reading_s.reset();
  sensor.status.detail = "Connection refused";
  EXPECT_EQ(verdict_of(sensor).outcome, Outcome::kFailed);
  EXPECT_THAT(verdict_of(sensor).remarks, ElementsAre(HasSubstr("no reading in 20 s: Connection refused")));
}

TEST(JudgeSensor, FailsOneWhoseReadingsAreNotUsed) {
  SensorMeasured sensor = good();
  sensor.status.state = SensorState::kStale;
  sensor.status.state_reason = "silent for 5 s";
  EXPECT_EQ(verdict_of(sensor).outcome, Outcome::kFailed);
  EXPECT_THAT(verdict_of(sensor).remarks, ElementsAre(HasSubstr("stale: silent for 5 s")));
}

TEST(JudgeSensor, FailsOneThatMovesNothing) {
  SensorMeasured sensor = good();
  sensor.frames = 0;
  EXPECT_THAT(verdict_of(sensor).remarks, ElementsAre(HasSubstr("no frame came")));
  sensor = good();
  sensor.moved_frames = 0;
  EXPECT_THAT(verdict_of(sensor).remarks, ElementsAre("no pose moved"));
  sensor = good();
  sensor.largest_live_weight = 0.3;
  EXPECT_THAT(verdict_of(sensor).remarks, ElementsAre(HasSubstr("its part reached 30 %")));
  EXPECT_EQ(verdict_of(sensor).outcome, Outcome::kFailed);
}

TEST(JudgeSensor, RemarksWhatIsToBeLookedAt) {
  const auto remark_where = [](auto change) {
    SensorMeasured sensor = good();
    change(sensor);
    const SensorVerdict verdict = verdict_of(sensor);
    EXPECT_EQ(verdict.outcome, Outcome::kRemark);
    return verdict.remarks.size() == 1 ? verdict.remarks.front() : "not one remark";
  };
  EXPECT_THAT(remark_where([](SensorMeasured& s) { s.status.simulated = true; }), HasSubstr("synthetic"));
  EXPECT_THAT(remark_where([](SensorMeasured& s) { s.status.replayed = true; }), HasSubstr("recording"));
  EXPECT_THAT(remark_where([](SensorMeasured& s) { s.status.reconnects = 2; }), HasSubstr("found again 2 times"));
  EXPECT_THAT(remark_where([](SensorMeasured& s) { s.status.refused = {{"timeout", 11}}; }), HasSubstr("were refused"));
  EXPECT_THAT(remark_where([](SensorMeasured& s) { s.median_delay_s = 0.25; }), HasSubstr("250 ms"));
  EXPECT_THAT(remark_where([](SensorMeasured& s) { s.median_delay_s.reset(); }), HasSubstr("could not be measured"));
  EXPECT_THAT(remark_where([](SensorMeasured& s) { s.least_speed_m_s = s.largest_speed_m_s = 0.0; }),
              HasSubstr("0.00 m/s all the time"));
  SensorMeasured few = good();
  few.status.refused = {{"timeout", 10}, {"not mine", 5000}};
  EXPECT_EQ(verdict_of(few).outcome, Outcome::kPassed) << "less than 5 %";
}

TEST(JudgeSensor, ComparesMeanSpeeds) {
  const auto outcome_beside = [](double own_m_s, std::vector<double> others_m_s) {
    SensorMeasured sensor = good();
    sensor.mean_speed_m_s = own_m_s;
    return judge(sensor, others_m_s).outcome;
  };
  EXPECT_EQ(outcome_beside(4.0, {2.1, 2.1}), Outcome::kPassed);
  EXPECT_EQ(outcome_beside(4.0, {1.9}), Outcome::kRemark);
  EXPECT_EQ(outcome_beside(1.9, {4.0}), Outcome::kRemark);
  EXPECT_EQ(outcome_beside(0.1, {1.0}), Outcome::kPassed) << "nearly calm";
}

TEST(NorthCheck, IsByTheSmallerAngle) {
  EXPECT_TRUE(is_passed({"roof", 350.0}));
  EXPECT_TRUE(is_passed({"roof", 15.0}));
  EXPECT_FALSE(is_passed({"roof", 16.0}));
  EXPECT_FALSE(is_passed({"roof", 180.0}));
}

/// Messages of a daemon with the sensor "roof", by a clock that is moved by hand.
class MeasuredSensor : public testing::Test {
 protected:
  void frame(double reading_age_s, float bend_rad, Nanoseconds on_the_way = 0ms) {
    now_ += 16ms;
    wire::Frame frame;
    frame.info.utc_ns = std::chrono::nanoseconds(now_).count();
    frame.info.wind.reading_age_s = reading_age_s;
    frame.info.wind.live_weight = 0.9;
    pose::StrandPose pose;
    pose.bend_east_rad = {bend_rad};
    pose.bend_south_rad = {0.0F};
    frame.poses = {pose};
    measurement_.take(frame, instant(on_the_way));
  }
  void status(std::uint64_t readings, std::optional<double> speed_m_s) {
    wire::SensorStatus sensor;
    sensor.name = "roof";
    sensor.readings = readings;
    sensor.speed_m_s = speed_m_s;
    measurement_.take(wire::Sensors{.sensors = {wire::SensorStatus{}, sensor}, .wind = {}}, instant());
  }
  Instant instant(Nanoseconds later = 0ms) const { return {MonoTime(now_ + later), UtcTime(now_ + later)}; }

  Nanoseconds now_ = 1000s;
  SensorMeasurement measurement_{"roof"};
};

TEST_F(MeasuredSensor, DelaysAreTakenWhereANewReadingTakesPart) {
  frame(0.050, 0.1F);
  frame(0.066, 0.2F);
  frame(0.010, 0.3F, 2ms);  // new: 10 ms old, 2 ms on its way
  frame(0.010, 0.3F);       // the same wind once more
  frame(0.026, 0.4F);
  frame(0.020, 0.4F, 4ms);  // new
  frame(0.004, 0.5F, 1ms);  // new
  const SensorMeasured measured = measurement_.result(instant());
  EXPECT_EQ(measured.delays, 3U);
  EXPECT_NEAR(measured.median_delay_s.value(), 0.012, 1e-9);
  EXPECT_NEAR(measured.longest_delay_s.value(), 0.024, 1e-9);
  EXPECT_EQ(measured.frames, 7U);
  EXPECT_EQ(measured.moved_frames, 4U);
  EXPECT_EQ(measured.largest_live_weight, 0.9);
}

TEST_F(MeasuredSensor, SpeedsAndTimesAreThoseSinceTheFirstReading) {
  status(0, std::nullopt);
  EXPECT_FALSE(measurement_.has_reading());
  now_ += 500ms;
  status(1, 2.0);
  now_ += 500ms;
  status(2, 3.0);
  now_ += 1000ms;
  status(5, 7.0);
  const SensorMeasured measured = measurement_.result(instant());
  EXPECT_NEAR(measured.first_reading_s.value(), 0.5, 1e-9);
  EXPECT_NEAR(measured.measured_s, 1.5, 1e-9);
  EXPECT_EQ(measured.least_speed_m_s, 2.0);
  EXPECT_EQ(measured.mean_speed_m_s, 4.0);
  EXPECT_EQ(measured.largest_speed_m_s, 7.0);
  EXPECT_EQ(measured.status.readings, 5U);
  EXPECT_FALSE(measured.median_delay_s.has_value());
}

TEST_F(MeasuredSensor, OneThatSaysNothingHasOnlyItsTime) {
  status(0, std::nullopt);
  now_ += 3s;
  const SensorMeasured measured = measurement_.result(instant());
  EXPECT_NEAR(measured.measured_s, 3.0, 1e-9);
  EXPECT_FALSE(measured.first_reading_s.has_value());
  EXPECT_FALSE(measured.mean_speed_m_s.has_value());
}

Acceptance two_sensors() {
  Acceptance acceptance{.site = "Hall <2>",
                        .configuration = "wall.toml",
                        .software = "yuragi 9",
                        .system = "Debian",
                        .begun = UtcTime(1'700'000'000s),
                        .duration_s = 20.0,
                        .simulated = {{.name = "roof", .driver = "modbus", .measured = good()},
                                      {.name = "mast", .driver = "usb", .why_not = "needs <USB>"}},
                        .sensors = {good(), good()},
                        .verdicts = {{}, {Outcome::kFailed, {"no reading & no <link>"}}}};
  acceptance.sensors[1].status.name = "mast";
  acceptance.sensors[1].mean_speed_m_s.reset();
  return acceptance;
}

TEST(AcceptancePage, HasVerdictsFiguresAndLinesToSign) {
  Acceptance acceptance = two_sensors();
  acceptance.north_checks = {{"roof", 182.0}};
  const std::string page = acceptance_page(acceptance);
  EXPECT_THAT(page, testing::StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr("Hall &lt;2&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("Hall <2>")));
  EXPECT_THAT(page, HasSubstr("no reading &amp; no &lt;link&gt;"));
  EXPECT_THAT(page, HasSubstr("2023-11-14 22:13:20 UTC"));
  EXPECT_THAT(page, HasSubstr("<td>mast</td><td>modbus</td><td>–</td><td><span class=\"failed\">failed</span></td>"));
  EXPECT_THAT(page,
              HasSubstr("<td><span class=\"passed\">passed</span></td><td><span class=\"passed\">passed</span></td>"));
  EXPECT_THAT(page, HasSubstr("not simulated: needs &lt;USB&gt;<br>real: no reading"));
  EXPECT_THAT(page, HasSubstr("<h3>roof, simulated</h3>"));
  EXPECT_THAT(page, HasSubstr("20.00 ms, 300.00 ms (199 timed)"));
  EXPECT_THAT(page, HasSubstr("read 182°: <span class=\"failed\">failed"));
  EXPECT_THAT(page, HasSubstr("taken over by (name)"));
  for (const char* const outside : {"http://", "https://", "src=", "<script", "url("})
    EXPECT_THAT(page, Not(HasSubstr(outside))) << "it is to be self-contained";
}

TEST(Acceptance, CountsWhatWasSimulatedAndNothingElse) {
  Acceptance acceptance = two_sensors();
  acceptance.sensors.clear();
  acceptance.verdicts.clear();
  EXPECT_EQ(outcome_of(acceptance), Outcome::kPassed) << "one passed, one was not simulated";
  const std::string page = acceptance_page(acceptance);
  EXPECT_THAT(page, HasSubstr("The real devices were not measured."));
  EXPECT_THAT(page, HasSubstr("<h1>Rehearsal"));
  EXPECT_THAT(page, HasSubstr("This is not a hand-over: <span class=\"passed\">passed"));
  EXPECT_THAT(page, Not(HasSubstr("taken over by"))) << "there is nothing to sign";
  EXPECT_THAT(acceptance_text(acceptance), HasSubstr("not a hand-over: no real device was measured): passed\n"));
  acceptance.simulated[0].verdict.outcome = Outcome::kFailed;
  EXPECT_EQ(outcome_of(acceptance), Outcome::kFailed);
  acceptance.simulated[0].measured.reset();
  EXPECT_EQ(outcome_of(acceptance), Outcome::kRemark) << "nothing was measured";
}

TEST(AcceptanceText, TellsTheSameAsTheJson) {
  const Acceptance acceptance = two_sensors();
  EXPECT_EQ(outcome_of(acceptance), Outcome::kFailed);
  const std::string text = acceptance_text(acceptance);
  EXPECT_THAT(text, HasSubstr("roof           passed"));
  EXPECT_THAT(text, HasSubstr("mast           failed"));
  EXPECT_THAT(text, HasSubstr("  - no reading & no <link>\n"));
  EXPECT_THAT(text, testing::EndsWith("hand-over: failed\n"));
  const auto json = nlohmann::ordered_json::parse(acceptance_json(acceptance).dump());
  EXPECT_EQ(json["verdict"], "failed");
  EXPECT_EQ(json["sensors"][0]["median_delay_s"], 0.02);
  EXPECT_TRUE(json["sensors"][1]["mean_speed_m_s"].is_null());
  EXPECT_EQ(json["sensors"][1]["remarks"][0], "no reading & no <link>");
  EXPECT_THAT(text, HasSubstr("roof           passed   simulated"));
  EXPECT_THAT(text, HasSubstr("  - not simulated: needs <USB>\n"));
  EXPECT_EQ(json["simulated"][0]["verdict"], "passed");
  EXPECT_TRUE(json["simulated"][1]["verdict"].is_null());
  EXPECT_EQ(json["simulated"][1]["remarks"][0], "not simulated: needs <USB>");
}

}  // namespace
}  // namespace yuragi::daemon::tools::acceptance
