#include "drivers/windlog/windlog_rewrite.hpp"

#include <fstream>
#include <iterator>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "drivers/windlog/sqlite.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

constexpr std::string_view kPassword = "hunter2-correct-horse";

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The files of a folder with the password among their bytes.
std::vector<std::string> files_with_password(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (bytes_of(entry.path()).find(kPassword) != std::string::npos) files.push_back(entry.path().filename());
  }
  return files;
}

/// A configuration of some pages, so that SQLite has to move rows about.
std::string configuration_of(int session) {
  return "session = " + std::to_string(session) + "\npassword = '" + std::string(kPassword) + "'\n# " +
         std::string(static_cast<std::size_t>(700 * session), '-') + "\n";
}

std::optional<std::string> without_password(const std::string& text) {
  const std::size_t at = text.find(kPassword);
  if (at == std::string::npos) return std::nullopt;
  return std::string(text).replace(at, kPassword.size(),
                                   "(withheld, and so much longer than before that rows have to move to other pages)");
}

const TextRewrite kWithoutPassword{.configuration = without_password,
                                   .options = [](const std::string& driver, const std::string& text) {
                                     return driver == "mqtt" ? without_password(text) : std::nullopt;
                                   }};

constexpr int kSessions = 12;
constexpr int kSensorsWithPassword = 40;
constexpr std::size_t kTexts = std::size_t{kSessions} * (1 + kSensorsWithPassword);  // with the password in them
constexpr std::size_t kReadings = std::size_t{kSessions} * 600;

/// Twelve sessions with a configuration and many sensors each, in all but one of which is the password.
Result<void, Failure> write_twelve_sessions(Writer& writer) {
  const auto readings = test::numbered_readings(600);
  for (int session = 0; session < kSessions; ++session) {
    if (auto begun = writer.begin_session({readings[0].time, "yuragi test", configuration_of(session)}); !begun) {
      return begun;
    }
    if (const auto other = writer.add_sensor("mast", "synthetic", "speed = 4"); !other) return other.error();
    std::int64_t roof = 0;
    for (int sensor = 0; sensor < kSensorsWithPassword; ++sensor) {
      const auto added = writer.add_sensor("roof", "mqtt", "password = '" + std::string(kPassword) + "'");
      if (!added) return added.error();
      roof = *added;
    }
    for (const wind::Reading& reading : readings) {
      if (auto appended = writer.append(roof, reading); !appended) return appended;
    }
    if (auto committed = writer.commit(); !committed) return committed;
  }
  return {};
}

class WindlogRewrite : public testing::Test {
 protected:
  void write() {
    auto writer = Writer::open(file_);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(write_twelve_sessions(*writer));
    ASSERT_TRUE(writer->close());
  }

  FailureKind refusal_of(const fs::path& file) {
    const auto rewritten = rewrite_texts(file, kWithoutPassword);
    EXPECT_TRUE(rewritten.has_error());
    return rewritten.has_error() ? rewritten.error().kind : FailureKind::kOther;
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_ / "old.windlog";
};

TEST_F(WindlogRewrite, LeavesNoByteOfTheOldTextsAndEveryReading) {
  write();
  ASSERT_EQ(chmod(file_.c_str(), 0604), 0);
  const auto before = test::read_all(file_);
  ASSERT_EQ(files_with_password(folder_.path()), std::vector<std::string>{"old.windlog"});

  const auto rewritten = rewrite_texts(file_, kWithoutPassword);
  ASSERT_TRUE(rewritten) << rewritten.error().message;
  EXPECT_EQ(*rewritten, kTexts);
  EXPECT_THAT(files_with_password(folder_.path()), IsEmpty());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing stands beside it";
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms(0604));

  const auto after = test::read_all(file_);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(after[i].log_time, before[i].log_time);
    EXPECT_EQ(after[i].sensor, before[i].sensor);
    test::expect_same(after[i].reading, before[i].reading);
  }
  auto reader = Reader::open(file_);
  ASSERT_TRUE(reader);
  ASSERT_EQ(reader->sessions().size(), std::size_t{kSessions});
  for (int session = 0; session < kSessions; ++session) {
    EXPECT_EQ(reader->configuration(reader->sessions()[static_cast<std::size_t>(session)].id).value(),
              without_password(configuration_of(session)));
  }
  EXPECT_EQ(reader->sensors()[0].options, "speed = 4");
}

TEST_F(WindlogRewrite, LeavesNoneInThePartsOfTheFileThatAreNotUsed) {
  write();
  {
    auto database = sqlite::Database::open(file_, sqlite::Access::kReadWrite);
    ASSERT_TRUE(database);
    ASSERT_TRUE(database->run("PRAGMA secure_delete = OFF; DELETE FROM sensor WHERE session > 1"));
    ASSERT_TRUE(database->run("UPDATE session SET configuration = '' WHERE id > 1"));
  }
  EXPECT_EQ(rewrite_texts(file_, kWithoutPassword).value(), std::size_t{1 + kSensorsWithPassword});
  EXPECT_THAT(files_with_password(folder_.path()), IsEmpty());
}

TEST_F(WindlogRewrite, ChangesNothingTheSecondTime) {
  write();
  ASSERT_TRUE(rewrite_texts(file_, kWithoutPassword));
  const std::string bytes = bytes_of(file_);
  EXPECT_EQ(rewrite_texts(file_, kWithoutPassword).value(), 0U);
  EXPECT_EQ(bytes_of(file_), bytes);
}

TEST_F(WindlogRewrite, CleansWhatAKilledRecorderLeft) {
  // What is on the disk while the recorder runs is what it leaves where it is killed.
  const test::TemporaryFolder running;
  auto writer = Writer::open(running / "old.windlog");
  ASSERT_TRUE(writer);
  ASSERT_TRUE(write_twelve_sessions(*writer));
  for (const char* suffix : {"", "-wal", "-shm"}) {
    fs::copy_file(running.path() / ("old.windlog" + std::string(suffix)), file_.string() + suffix);
  }
  ASSERT_THAT(files_with_password(folder_.path()), testing::Contains("old.windlog-wal"));
  EXPECT_EQ(rewrite_texts(file_, kWithoutPassword).value(), kTexts);
  EXPECT_THAT(files_with_password(folder_.path()), IsEmpty());
  EXPECT_EQ(test::read_all(file_).size(), kReadings);
}

TEST_F(WindlogRewrite, RefusesARecordingThatIsBeingWritten) {
  auto writer = Writer::open(file_);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(write_twelve_sessions(*writer));
  const auto rewritten = rewrite_texts(file_, kWithoutPassword);
  ASSERT_TRUE(rewritten.has_error());
  EXPECT_EQ(rewritten.error().kind, FailureKind::kUnavailable);
  EXPECT_THAT(rewritten.error().message, HasSubstr("old.windlog: is being recorded"));

  const auto id = writer->add_sensor("later", "synthetic", "");
  ASSERT_TRUE(id) << "the recorder can go on";
  ASSERT_TRUE(writer->append(*id, test::reading_at(100'000, 1.0)));
  ASSERT_TRUE(writer->close());
  EXPECT_EQ(test::read_all(file_).size(), kReadings + 1);
  EXPECT_EQ(rewrite_texts(file_, kWithoutPassword).value(), kTexts);
}

TEST_F(WindlogRewrite, ChangesAllTextsOrNone) {
  write();
  const std::string bytes = bytes_of(file_);
  int calls = 0;
  const TextRewrite grows{.configuration = [&calls](const std::string& text) { return text + std::to_string(++calls); },
                          .options =
                              [](const std::string&, const std::string&) {
                                return std::optional(std::string(20 << 20, 'x'));  // longer than any text may be
                              }};
  ASSERT_TRUE(rewrite_texts(file_, grows).has_error());
  EXPECT_EQ(calls, kSessions);
  EXPECT_EQ(bytes_of(file_), bytes);
}

TEST_F(WindlogRewrite, RefusesWhatIsNoRecording) {
  EXPECT_EQ(refusal_of(folder_ / "nothing.windlog"), FailureKind::kNoInput);
  EXPECT_FALSE(fs::exists(folder_ / "nothing.windlog")) << "it is not created";
  EXPECT_EQ(refusal_of(folder_.path()), FailureKind::kBadData);
  const std::string text(5000, 'a');
  std::ofstream(folder_ / "text.windlog") << text;
  EXPECT_EQ(refusal_of(folder_ / "text.windlog"), FailureKind::kBadData);
  EXPECT_EQ(bytes_of(folder_ / "text.windlog"), text);
  std::ofstream(folder_ / "empty.windlog").close();
  EXPECT_EQ(refusal_of(folder_ / "empty.windlog"), FailureKind::kBadData);
  EXPECT_EQ(bytes_of(folder_ / "empty.windlog"), "");
}

}  // namespace
}  // namespace yuragi::drivers::windlog
