#include "tests/answer/verdicts.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace yuragi::answer {
namespace {

using ::testing::HasSubstr;

constexpr std::array<bool, kBeauforts> kAll = {true, true, true, true};

SceneTable table_of_two_rows() {
  SceneTable table;
  table.name = "flag";
  table.scene = "flag";
  table.bounds = {Bound{"lift", "deg", 1, {{{4, 20}, {54, 72}, at_least(78), kAny}}}, Bound{"speed", "m/s", 2, {}},
                  Bound{"speed / the number before", "", 2, {{kAny, at_least(2), at_least(2), at_least(2)}}}};
  return table;
}

const JudgedRow& row_of(const std::vector<JudgedRow>& rows, std::string_view name) {
  for (const JudgedRow& row : rows) {
    if (row.bound.figure == name) return row;
  }
  throw std::out_of_range("no such row");
}

TEST(Verdicts, SayOnWhichSideAFigureIsOut) {
  const MeasuredScene measured = {Figures{{"lift", 3.9}}, Figures{{"lift", 72.1}}, Figures{{"lift", 80.0}},
                                  Figures{{"lift", 1.0}}};
  const auto rows = judge(table_of_two_rows(), measured, kAll);
  const JudgedRow& lift = row_of(rows, "lift");
  EXPECT_EQ(lift.cells[0].verdict, Verdict::kLow);
  EXPECT_EQ(lift.cells[1].verdict, Verdict::kHigh);
  EXPECT_EQ(lift.cells[2].verdict, Verdict::kOk);
  EXPECT_EQ(lift.cells[3].verdict, Verdict::kNotJudged);
}

TEST(Verdicts, WhatCouldNotBeMeasuredFails) {
  const MeasuredScene measured = {Figures{{"lift", std::numeric_limits<double>::quiet_NaN()}}, Figures{},
                                  Figures{{"lift", std::numeric_limits<double>::infinity()}}, std::nullopt};
  const auto rows = judge(table_of_two_rows(), measured, kAll);
  const JudgedRow& lift = row_of(rows, "lift");
  EXPECT_EQ(lift.cells[0].verdict, Verdict::kMissing);
  EXPECT_EQ(lift.cells[1].verdict, Verdict::kMissing);
  EXPECT_EQ(lift.cells[2].verdict, Verdict::kOk);  // no upper limit
  EXPECT_EQ(lift.cells[3].verdict, Verdict::kNotJudged);
}

TEST(Verdicts, AQuotientIsOfTwoBeaufortNumbers) {
  const MeasuredScene measured = {Figures{{"speed", 1.0}}, Figures{{"speed", 3.0}}, Figures{{"speed", 4.5}},
                                  std::nullopt};
  const auto rows = judge(table_of_two_rows(), measured, kAll);
  const JudgedRow& quotient = row_of(rows, "speed / the number before");
  EXPECT_EQ(quotient.cells[0].verdict, Verdict::kNotJudged);
  EXPECT_EQ(quotient.cells[1].verdict, Verdict::kOk);
  EXPECT_DOUBLE_EQ(quotient.cells[1].value.value(), 3.0);
  EXPECT_EQ(quotient.cells[2].verdict, Verdict::kLow);
  EXPECT_EQ(quotient.cells[3].verdict, Verdict::kNotJudged);
}

TEST(Verdicts, OnlyWhatIsAskedForIsJudged) {
  const MeasuredScene measured = {Figures{{"lift", 0.0}}, Figures{{"lift", 60.0}}, std::nullopt, std::nullopt};
  const auto rows = judge(table_of_two_rows(), measured, {false, true, false, false});
  EXPECT_EQ(row_of(rows, "lift").cells[0].verdict, Verdict::kNotJudged);
  EXPECT_EQ(row_of(rows, "lift").cells[1].verdict, Verdict::kOk);
}

TEST(Verdicts, ATableSaysValueBoundAndVerdict) {
  const MeasuredScene measured = {std::nullopt, Figures{{"lift", 80.0}}, std::nullopt, std::nullopt};
  const std::array<bool, kBeauforts> asked = {false, true, false, false};
  const SceneTable table = table_of_two_rows();
  const std::string text = table_text(table, judge(table, measured, asked), asked);
  EXPECT_THAT(text, HasSubstr("Beaufort 3"));
  EXPECT_THAT(text, HasSubstr("lift, deg"));
  EXPECT_THAT(text, HasSubstr("80.0 54..72        HIGH"));
}

TEST(Verdicts, FiguresAreKeptAsJson) {
  const MeasuredScene measured = {std::nullopt, Figures{{"lift", 80.5}}, std::nullopt,
                                  Figures{{"lift", std::numeric_limits<double>::infinity()}}};
  const MeasuredScene kept = measured_of(nlohmann::json::parse(to_json(table_of_two_rows(), measured, {}).dump()));
  EXPECT_FALSE(kept[0].has_value());
  ASSERT_TRUE(kept[1].has_value());
  EXPECT_EQ(kept[1]->front().name, "lift");
  EXPECT_EQ(kept[1]->front().value, 80.5);
  EXPECT_TRUE(std::isinf(kept[3]->front().value));
}

}  // namespace
}  // namespace yuragi::answer
