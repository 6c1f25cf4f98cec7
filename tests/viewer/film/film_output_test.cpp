#include "viewer/film/film_output.hpp"

#include <fstream>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::film {
namespace {

namespace fs = std::filesystem;

class FilmOutputTest : public testing::Test {
 protected:
  std::unique_ptr<Output> begin(const fs::path& folder) const {
    return make_film_output(folder.string(), {.width_px = 2, .height_px = 2}, is_stopping_);
  }
  static void write_two(Output& output) {
    const std::vector<std::uint8_t> rgb(3U * 2U * 2U);
    output.write(rgb);
    output.write(rgb);
  }
  /// The names of all that is in the test's folder.
  std::vector<std::string> left() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(root())) {
      names.push_back(entry.path().lexically_relative(root()).string());
    }
    return names;
  }
  const fs::path& root() const { return folder_.path(); }

  const test::TemporaryFolder folder_;
  std::atomic<bool> is_stopping_{false};
};

TEST_F(FilmOutputTest, AWholeFilmStays) {
  const auto output = begin(root() / "takes" / "first");
  write_two(*output);
  output->finish();
  EXPECT_THAT(left(), testing::UnorderedElementsAre("takes", "takes/first", "takes/first/000001.png",
                                                    "takes/first/000002.png"));
}

TEST_F(FilmOutputTest, AFilmThatIsNotFinishedLeavesNoFolder) {
  for (const char* name : {"first", "takes/first", "takes/first/"}) {
    write_two(*begin(root() / name));
    EXPECT_THAT(left(), testing::IsEmpty()) << name;
    begin(root() / name);
    EXPECT_THAT(left(), testing::IsEmpty()) << name << ", without a picture";
  }
}

TEST_F(FilmOutputTest, AFilmThatIsNotFinishedKeepsWhatWasThereBefore) {
  fs::create_directories(root() / "takes" / "empty");
  std::ofstream(root() / "takes" / "note.txt") << "kept";
  write_two(*begin(root() / "takes"));
  write_two(*begin(root() / "takes" / "empty"));
  EXPECT_THAT(left(), testing::UnorderedElementsAre("takes", "takes/empty", "takes/note.txt"));
}

TEST_F(FilmOutputTest, AFolderThatCannotBeMadeLeavesNoneOfItsParents) {
  EXPECT_THROW(begin(root() / "takes" / std::string(300, 'a')), picture::ViewerExit);
  EXPECT_THAT(left(), testing::IsEmpty());
  std::ofstream(root() / "file") << "kept";
  EXPECT_THROW(begin(root() / "file" / "takes"), picture::ViewerExit);
  EXPECT_THAT(left(), testing::ElementsAre("file"));
}

TEST_F(FilmOutputTest, APictureOfAnotherFilmIsNeverOverwritten) {
  std::ofstream(root() / "000002.png") << "of another";
  EXPECT_THROW(begin(root()), picture::ViewerExit);
  std::ostringstream text;
  text << std::ifstream(root() / "000002.png").rdbuf();
  EXPECT_EQ(text.str(), "of another");
}

}  // namespace
}  // namespace yuragi::viewer::film
