#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/tools/offline/npy.hpp"
#include "engine/noise/spectral_noise.hpp"

namespace yuragi::daemon::commands {

extern const Command kNoiseCommand;

namespace {

/// Runs in an empty directory of its own.
class NoiseCommand : public ::testing::Test {
 protected:
  NoiseCommand() {
    const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
    directory_ = std::filesystem::temp_directory_path() /
                 ("yuragi_noise_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(directory_);
  }
  ~NoiseCommand() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path path(const std::string& name) const { return directory_ / name; }

  static void run(std::vector<std::string> arguments) {
    CLI::App app;
    kNoiseCommand.add(app);
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    reversed.emplace_back("noise");
    app.parse(reversed);
  }

  /// The exit code of the failure that the arguments end in; 0 for none.
  static int code_of(const std::vector<std::string>& arguments) {
    try {
      run(arguments);
      return 0;
    } catch (const ExitError& error) {
      return error.code();
    } catch (const FailureError& error) {
      return exit_code_of(error.kind());
    }
  }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(directory_), {}));
  }

  static std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path directory_;
};

/// The little-endian float32 numbers after the header of an NPY file whose header says `shape`.
std::vector<float> values_of(const std::string& file, const std::string& shape) {
  EXPECT_EQ(file.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(file.at(i))); };
  const std::size_t start = 10 + (byte(8) | byte(9) << 8U);
  EXPECT_EQ(start % 64, 0U);
  EXPECT_EQ(file.at(start - 1), '\n');
  EXPECT_EQ(file.substr(10, file.find('}') - 9),
            "{'descr': '<f4', 'fortran_order': False, 'shape': (" + shape + "), }");
  std::vector<float> values;
  for (std::size_t i = start; i + 3 < file.size(); i += 4) {
    values.push_back(std::bit_cast<float>(byte(i) | byte(i + 1) << 8U | byte(i + 2) << 16U | byte(i + 3) << 24U));
  }
  return values;
}

TEST_F(NoiseCommand, WritesALineAsTheLibraryMakesIt) {
  const auto file = path("line.npy");
  run({"--dims", "1", "--size", "64", "--beta", "1.5", "--seed", "9", "--out", file});
  EXPECT_EQ(values_of(bytes_of(file), "64,"),
            noise::make_noise_1d({.size = 64, .beta = 1.5, .seed = 9}).value().values);
}

TEST_F(NoiseCommand, WritesASquareOfEitherMeaning) {
  for (const noise::BetaMeaning meaning : {noise::BetaMeaning::kRadial, noise::BetaMeaning::kTransect}) {
    const auto file = path("square.npy");
    run({"--dims", "2", "--size", "16", "--meaning",
         std::string(noise::kBetaMeaningNames.at(static_cast<std::size_t>(meaning))), "--seed", "3", "--out", file});
    EXPECT_EQ(values_of(bytes_of(file), "16,16,"),
              noise::make_noise_2d({.size = 16, .meaning = meaning, .seed = 3}).value().values);
  }
}

TEST_F(NoiseCommand, NeedsNothingButAFile) {
  run({"--out", path("tile.npy")});
  EXPECT_EQ(values_of(bytes_of(path("tile.npy")), "512,512,"), noise::make_noise_2d({.size = 512}).value().values);
}

TEST_F(NoiseCommand, RefusesWhatItCannotMakeAsAUsageErrorAndLeavesNoFile) {
  for (const char* size : {"0", "4", "100", "8192", "4194304"}) {
    EXPECT_EQ(code_of({"--size", size, "--out", path("x.npy")}), kExitUsage) << size;
  }
  EXPECT_EQ(code_of({"--dims", "1", "--size", "8388608", "--out", path("x.npy")}), kExitUsage);
  for (const char* beta : {"-1", "9", "nan", "inf"}) {
    EXPECT_EQ(code_of({"--beta", beta, "--out", path("x.npy")}), kExitUsage) << beta;
  }
  EXPECT_EQ(files(), 0U);
}

TEST_F(NoiseCommand, RefusesATransectThatATileCannotHaveAndSaysWhichItCan) {
  EXPECT_EQ(code_of({"--size", "16", "--beta", "0", "--out", path("x.npy")}), kExitUsage);
  EXPECT_EQ(code_of({"--size", "16", "--beta", "0.59", "--out", path("x.npy")}), kExitUsage);
  EXPECT_EQ(code_of({"--dims", "3", "--size", "16", "--beta", "0.99", "--out", path("x.npy")}), kExitUsage);
  EXPECT_EQ(files(), 0U);
  try {
    run({"--meaning", "transect", "--beta", "0", "--out", path("x.npy")});
    FAIL() << "should have thrown";
  } catch (const ExitError& error) {
    EXPECT_STREQ(error.what(),
                 "--dims 2 --meaning transect --beta 0: along a line, noise of two dimensions falls as 1/f^0.6 or more "
                 "steeply, of three as 1/f or more steeply; flatter noise is made with beta as the exponent of each "
                 "mode (radial), or in one dimension");
  }

  EXPECT_EQ(code_of({"--size", "16", "--beta", "0.6", "--out", path("square.npy")}), 0);
  EXPECT_EQ(code_of({"--dims", "3", "--size", "16", "--beta", "1", "--out", path("cube.npy")}), 0);
  EXPECT_EQ(code_of({"--size", "16", "--beta", "0", "--meaning", "radial", "--out", path("white.npy")}), 0);
  EXPECT_EQ(code_of({"--dims", "1", "--size", "16", "--beta", "0", "--out", path("line.npy")}), 0);
}

TEST_F(NoiseCommand, RefusesWordsThatItDoesNotKnow) {
  const std::string out = path("x.npy");
  EXPECT_THROW(run({"--dims", "4", "--out", out}), CLI::ValidationError);
  EXPECT_THROW(run({"--meaning", "both", "--out", out}), CLI::ValidationError);
  EXPECT_THROW(run({"--seed", "-1", "--out", out}), CLI::ValidationError);
  EXPECT_THROW(run({"--seed", "18446744073709551616", "--out", out}), CLI::ValidationError);
  EXPECT_THROW(run({"--size", "-8", "--out", out}), CLI::ValidationError);
  EXPECT_THROW(run({"--size", "8"}), CLI::RequiredError);
  EXPECT_EQ(files(), 0U);
}

TEST_F(NoiseCommand, SaysWhatASizeMayBe) {
  try {
    run({"--size", "100", "--out", path("x.npy")});
    FAIL() << "should have thrown";
  } catch (const ExitError& error) {
    EXPECT_STREQ(error.what(),
                 "--size 100: the size must be a power of two: 8 to 4194304 in one dimension, 8 to 4096 in two, 8 to "
                 "256 in three");
  }
}

TEST_F(NoiseCommand, AFileThatCannotBeWrittenIsAnErrorAndLeavesNothing) {
  EXPECT_EQ(code_of({"--size", "8", "--out", path("no such folder") / "x.npy"}), kExitCannotCreate);
  EXPECT_EQ(code_of({"--size", "8", "--out", path("")}), kExitCannotCreate);
  EXPECT_EQ(code_of({"--size", "8", "--out", "/dev/null"}), kExitCannotCreate);
  EXPECT_EQ(files(), 0U);
}

TEST_F(NoiseCommand, ReplacesAFileThroughALinkAndLeavesNoPartBesideIt) {
  std::ofstream(path("tile.npy")) << "old";
  std::filesystem::create_symlink("tile.npy", path("link.npy"));
  run({"--dims", "1", "--size", "8", "--out", path("link.npy")});
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.npy")));
  EXPECT_EQ(values_of(bytes_of(path("tile.npy")), "8,").size(), 8U);
  EXPECT_EQ(files(), 2U);
}

TEST_F(NoiseCommand, AShapeThatDoesNotFitIsAProgrammingError) {
  const std::vector<std::size_t> shape{3};
  const std::vector<float> values(2);
  EXPECT_THROW(tools::offline::write_npy(path("x.npy"), shape, values), std::logic_error);
  EXPECT_EQ(files(), 0U);
}

}  // namespace
}  // namespace yuragi::daemon::commands
