#include "viewer/options.hpp"

#include <gtest/gtest.h>

namespace yuragi::viewer {
namespace {

ViewerOptions parsed(const std::string& words) {
  ViewerOptions options;
  CLI::App app;
  add_options(app, options);
  app.parse(words);
  return options;
}

TEST(Options, AnEmptyCommandLineKeepsEveryDefault) {
  EXPECT_EQ(parsed(""), ViewerOptions());
}

TEST(Options, TheOverlayIsOnOrOffOnlyIfAsked) {
  EXPECT_EQ(parsed("").overlay, std::nullopt);
  EXPECT_EQ(parsed("--overlay").overlay, true);
  EXPECT_EQ(parsed("--no-overlay").overlay, false);
}

}  // namespace
}  // namespace yuragi::viewer
