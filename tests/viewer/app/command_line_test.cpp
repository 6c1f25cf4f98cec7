#include "viewer/app/command_line.hpp"

#include <gtest/gtest.h>

namespace yuragi::viewer::app {
namespace {

picture::ViewerOptions parsed(const std::string& words) {
  picture::ViewerOptions options;
  CLI::App app;
  add_options(app, options);
  app.parse(words);
  return options;
}

TEST(Options, AnEmptyCommandLineKeepsEveryDefault) {
  EXPECT_EQ(parsed(""), picture::ViewerOptions());
}

TEST(Options, TheOverlayIsOnOrOffOnlyIfAsked) {
  EXPECT_EQ(parsed("").overlay, std::nullopt);
  EXPECT_EQ(parsed("--overlay").overlay, true);
  EXPECT_EQ(parsed("--no-overlay").overlay, false);
}

}  // namespace
}  // namespace yuragi::viewer::app
