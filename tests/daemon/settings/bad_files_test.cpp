// What a person reads about configurations that are wrong in many ways. Beside each of them in bad_files/ stands what
// parse_config() says of it, as it has been since 0.3: a message that gets better is written there, too.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/settings/config.hpp"
#include "tests/support/places.hpp"

namespace yuragi::daemon::settings {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(BadFiles, AreRefusedInTheWordsBesideThem) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("tests/daemon/settings/bad_files")))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  EXPECT_GE(files.size(), 15U);
  std::ranges::sort(files);
  for (const std::filesystem::path& file : files) {
    std::string said = "nothing";
    try {
      parse_config(text_of(file), file.filename().string());
    } catch (const ConfigError& error) {
      said = error.what();
    }
    EXPECT_EQ(said + "\n", text_of(std::filesystem::path(file).replace_extension(".txt"))) << file;
  }
}

}  // namespace
}  // namespace yuragi::daemon::settings
