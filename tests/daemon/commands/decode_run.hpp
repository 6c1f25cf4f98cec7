#pragma once

#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::commands {

extern const Command kDecodeCommand;

/// What came of a run of `yuragi decode` in this process.
struct DecodeRun {
  std::vector<nlohmann::json> objects;  ///< one a line of its output
  std::string text;                     ///< all of it
  std::string error;                    ///< what went to standard error, or the message that it ended with
  int code = 0;
};

class DecodeCommand : public ::testing::Test {
 protected:
  DecodeRun run_file(const std::string& file, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, file);
    DecodeRun done;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      CLI::App app;
      kDecodeCommand.add(app);
      std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
      reversed.emplace_back("decode");
      app.parse(reversed);
    } catch (const ExitError& error) {
      done.code = error.code();
      done.error = error.what();
    } catch (const FailureError& error) {
      done.code = exit_code_of(error.kind());
      done.error = error.what();
    } catch (const CLI::ParseError& error) {
      done.code = kExitUsage;
      done.error = error.what();
    }
    done.text = testing::internal::GetCapturedStdout();
    done.error += testing::internal::GetCapturedStderr();
    std::istringstream lines(done.text);
    for (std::string line; std::getline(lines, line);) done.objects.push_back(nlohmann::json::parse(line));
    return done;
  }

  DecodeRun run(const std::string& input, const std::vector<std::string>& arguments) {
    const auto file = folder_ / "input";
    std::ofstream(file, std::ios::binary) << input;
    return run_file(file.string(), arguments);
  }

  /// The one object that comes out of one message.
  nlohmann::json one(const std::string& input, const std::vector<std::string>& arguments) {
    const DecodeRun done = run(input, arguments);
    EXPECT_EQ(done.code, 0) << done.error;
    EXPECT_EQ(done.objects.size(), 1U) << done.text << done.error;
    return done.objects.empty() ? nlohmann::json::object() : done.objects.front();
  }

  test::TemporaryFolder folder_;
};

/// A number as expected, or null where none is.
inline testing::AssertionResult is_value(const nlohmann::json& value, std::optional<double> expected,
                                         double tolerance = 6e-3) {
  const bool agrees =
      expected ? value.is_number() && std::abs(value.get<double>() - *expected) <= tolerance : value.is_null();
  return agrees ? testing::AssertionSuccess()
                : testing::AssertionFailure() << value << ", not " << testing::PrintToString(expected);
}

}  // namespace yuragi::daemon::commands
