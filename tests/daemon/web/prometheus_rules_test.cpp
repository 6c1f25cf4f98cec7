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

TEST(PrometheusRules, AskForNothingThatThereIsNot) {
  wire::Sensors status;
  status.sensors.emplace_back();
  status.recorder.emplace().free_bytes = 1;
  status.io_lateness.emplace();
  status.tick_lateness.emplace();
  status.animation.emplace().scenes = {{"meadow", 0.001}};
  const std::set<std::string> all = names_in(metrics_text(status, "yuragi"));

  std::ostringstream rules;
  rules << std::ifstream(test::source_path("config/prometheus/yuragi.rules.yml")).rdbuf();
  const std::set<std::string> asked = names_in(std::regex_replace(rules.str(), std::regex("#[^\n]*"), ""));
  EXPECT_TRUE(all.contains("yuragi_scene_tick_seconds"));
  EXPECT_GE(asked.size(), 7U);
  EXPECT_THAT(all, testing::IsSupersetOf(asked));
}

}  // namespace
}  // namespace yuragi::daemon::web
