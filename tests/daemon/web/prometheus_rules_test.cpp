#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/web/metrics.hpp"
#include "tests/support/places.hpp"

namespace yuragi::daemon::web {
namespace {

/// The names of metrics in a text.
std::set<std::string> names_in(const std::string& text) {
  const std::regex name("yuragi_[a-z_]+");
  std::set<std::string> names;
  for (std::sregex_iterator i(text.begin(), text.end(), name); i != std::sregex_iterator(); ++i) names.insert(i->str());
  return names;
}

/// A status in which every metric has a value.
wire::Sensors full_status() {
  wire::Sensors status;
  status.sensors.emplace_back();
  status.recorder.emplace().free_bytes = 1;
  status.io_lateness.emplace();
  status.tick_lateness.emplace();
  status.animation.emplace().scenes = {{"meadow", 0.001}};
  return status;
}

/// The rules of `promtool check metrics` for counters and gauges, which are all types that there are.
TEST(Metrics, KeepTheRulesOfPrometheus) {
  std::istringstream lines(metrics_text(full_status(), "yuragi"));
  const std::regex type_line("# TYPE ([a-z_]+) (counter|gauge)");
  const std::regex help_line("# HELP ([a-z_]+) \\S.*");
  const std::regex value_line(R"(([a-z_]+)(\{[a-z_]+="[^"]*"(,[a-z_]+="[^"]*")*\})? \S+)");
  const std::regex reserved_label(R"([{,](quantile|le)=)");
  std::set<std::string> helped, typed;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, help_line)) {
      EXPECT_TRUE(helped.insert(found[1]).second) << "twice: " << line;
    } else if (std::regex_match(line, found, type_line)) {
      const std::string name = found[1];
      EXPECT_TRUE(typed.insert(name).second) << "twice: " << line;
      EXPECT_EQ(name.ends_with("_total"), found[2] == "counter") << line;
      for (const char* const suffix : {"_count", "_sum", "_bucket"}) EXPECT_FALSE(name.ends_with(suffix)) << line;
    } else {
      ASSERT_TRUE(std::regex_match(line, found, value_line)) << line;
      EXPECT_TRUE(helped.contains(found[1]) && typed.contains(found[1])) << line;
      EXPECT_FALSE(std::regex_search(line, reserved_label)) << "this label is for summaries and histograms: " << line;
    }
  }
  EXPECT_GE(typed.size(), 25U);
}

TEST(PrometheusRules, AskForNothingThatThereIsNot) {
  const std::set<std::string> all = names_in(metrics_text(full_status(), "yuragi"));

  std::ostringstream rules;
  rules << std::ifstream(test::source_path("config/prometheus/yuragi.rules.yml")).rdbuf();
  const std::set<std::string> asked = names_in(std::regex_replace(rules.str(), std::regex("#[^\n]*"), ""));
  EXPECT_TRUE(all.contains("yuragi_scene_tick_seconds"));
  EXPECT_GE(asked.size(), 7U);
  EXPECT_THAT(all, testing::IsSupersetOf(asked));
}

}  // namespace
}  // namespace yuragi::daemon::web
