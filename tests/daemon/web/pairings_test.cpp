#include "daemon/web/pairings.hpp"

#include <filesystem>
#include <fstream>
#include <future>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/web/access.hpp"
#include "daemon/web/pairings_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

constexpr double kNow_s = 1.8e9;
constexpr double kDay_s = 86400.0;

std::string id_of(int number) {
  std::string id = std::to_string(number);
  return std::string(Access::kSessionIdCharacters - id.size(), '0') + id;
}

TEST(Pairings, ACodeWorksOnce) {
  Pairings pairings;
  EXPECT_TRUE(pairings.use_code(7));
  EXPECT_FALSE(pairings.use_code(7));
  EXPECT_TRUE(pairings.use_code(6));
  EXPECT_TRUE(pairings.use_code(7 + Access::kCodeSteps));
  EXPECT_FALSE(pairings.use_code(7 + Access::kCodeSteps));
}
TEST(Pairings, UsedCodesTakeBoundedMemoryWhateverTheClockDoes) {
  Pairings pairings;
  for (std::int64_t step = 100'000; step > 1000; --step) EXPECT_TRUE(pairings.use_code(step));
  EXPECT_FALSE(pairings.use_code(1001)) << "the newest is kept";
  EXPECT_LT(pairings.text().size(), 2000U);
}
TEST(Pairings, ABrowserIsLetInForAYearUnlessItIsRevoked) {
  Pairings pairings;
  pairings.add(id_of(1), "192.168.1.30", kNow_s);
  pairings.add(id_of(2), "192.168.1.31", kNow_s + 1.0);
  EXPECT_TRUE(pairings.is_valid(id_of(1), kNow_s));
  EXPECT_TRUE(pairings.is_valid(id_of(1), kNow_s - kDay_s)) << "the clock was set back";
  EXPECT_TRUE(pairings.is_valid(id_of(1), kNow_s + 364.0 * kDay_s));
  EXPECT_FALSE(pairings.is_valid(id_of(1), kNow_s + 366.0 * kDay_s));
  EXPECT_FALSE(pairings.is_valid(id_of(3), kNow_s));
  EXPECT_EQ(pairings.browsers(kNow_s).size(), 2U);
  EXPECT_TRUE(pairings.browsers(kNow_s + 366.0 * kDay_s).empty());

  EXPECT_FALSE(pairings.revoke(id_of(3)));
  EXPECT_TRUE(pairings.revoke(id_of(1)));
  EXPECT_FALSE(pairings.is_valid(id_of(1), kNow_s));
  EXPECT_TRUE(pairings.is_valid(id_of(2), kNow_s));
}
TEST(Pairings, TheLastUseIsAccurateToAnHour) {
  Pairings pairings;
  pairings.add(id_of(1), "192.168.1.30", kNow_s);
  EXPECT_FALSE(pairings.note_use(id_of(1), "192.168.1.31", kNow_s + 3599.0)) << "nothing to write";
  EXPECT_TRUE(pairings.note_use(id_of(1), "192.168.1.31", kNow_s + 3600.0));
  EXPECT_FALSE(pairings.note_use(id_of(2), "192.168.1.31", kNow_s + 3600.0));
  const PairedBrowser used{id_of(1), 1'800'000'000, 1'800'003'600, "192.168.1.31"};
  EXPECT_THAT(pairings.browsers(kNow_s), testing::ElementsAre(used));
}
TEST(Pairings, AFurtherBrowserReplacesTheOneThatWasNotUsedForLongest) {
  Pairings pairings;
  for (int i = 0; i < static_cast<int>(Pairings::kMaxBrowsers); ++i) pairings.add(id_of(i), "", kNow_s + i);
  EXPECT_TRUE(pairings.note_use(id_of(0), "", kNow_s + kDay_s));
  pairings.add(id_of(999), "", kNow_s + kDay_s);
  EXPECT_EQ(pairings.browsers(kNow_s).size(), Pairings::kMaxBrowsers);
  EXPECT_TRUE(pairings.is_valid(id_of(0), kNow_s));
  EXPECT_FALSE(pairings.is_valid(id_of(1), kNow_s));
  EXPECT_TRUE(pairings.is_valid(id_of(999), kNow_s));
}
TEST(Pairings, TheirTextIsReadAgain_AndNothingElse) {
  Pairings pairings("a mark");
  for (int i = 0; i < 100; ++i) {
    pairings.add(id_of(i), "fe80::1%eth0", kNow_s + i);
    pairings.use_code(60'000'000 + i);
  }
  const std::string text = pairings.text();
  EXPECT_LT(text.size(), Pairings::kMaxText_bytes);
  EXPECT_EQ(Pairings::parse(text).value(), pairings);
  EXPECT_EQ(Pairings::parse(Pairings("a mark").text()).value(), Pairings("a mark"));
  for (std::size_t size = 0; size + 2 < text.size(); size += 7)
    EXPECT_FALSE(Pairings::parse(text.substr(0, size))) << size;
  const auto with = [](const std::string& codes, const std::string& browsers) {
    return Pairings::parse(R"({"token_mark":"","used_codes":[)" + codes + R"(],"browsers":[)" + browsers + "]}");
  };
  const std::string browser = R"({"id":"0123456789","since_s":1,"last_use_s":2,"address":"a"})";
  EXPECT_TRUE(with("1,2", browser));
  EXPECT_FALSE(with("", browser + "," + browser)) << "the same id twice";
  EXPECT_FALSE(with("", R"({"id":"0123","since_s":1,"last_use_s":2,"address":"a"})"));
  EXPECT_FALSE(with("", R"({"id":"0123456789","since_s":-1,"last_use_s":2,"address":"a"})"));
  EXPECT_FALSE(with("", R"({"id":"0123456789","since_s":1e300,"last_use_s":2,"address":"a"})"));
  EXPECT_FALSE(with("", R"({"id":"0123456789","since_s":1,"last_use_s":2,"address":")" + std::string(99, 'a') + "\"}"));
  EXPECT_FALSE(with("", std::string(5000, '[') + std::string(5000, ']')));
  for (const char* codes : {"-1", "\"1\"", "1.5", "18446744073709551615", "null", "[]"})
    EXPECT_FALSE(with(codes, "")) << codes;
}

class PairingsFileTest : public testing::Test {
 protected:
  std::string content() const {
    std::ostringstream text;
    text << std::ifstream(file_).rdbuf();
    return text.str();
  }
  static Pairings one_browser(const std::string& mark) {
    Pairings pairings(mark);
    pairings.add(id_of(1), "192.168.1.30", kNow_s);
    pairings.use_code(7);
    return pairings;
  }
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "pairings.json";
};

TEST_F(PairingsFileTest, OutlivesARestart_NotAnotherToken) {
  EXPECT_EQ(PairingsFile(file_).read("a"), Pairings("a"));
  PairingsFile(file_).save(one_browser("a"));
  EXPECT_EQ(PairingsFile(file_).read("a"), one_browser("a"));
  EXPECT_EQ(PairingsFile(file_).read("b"), Pairings("b"));
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(file_).permissions(), perms::owner_read | perms::owner_write);
}
TEST_F(PairingsFileTest, ADamagedFileIsKeptAsideAndLetsNobodyIn) {
  for (const std::string& damaged : {std::string("{"), std::string(), std::string(1U << 20U, '[')}) {
    std::ofstream(file_) << damaged;
    EXPECT_EQ(PairingsFile(file_).read("a"), Pairings("a"));
    EXPECT_FALSE(std::filesystem::exists(file_));
    EXPECT_EQ(std::filesystem::file_size(file_.string() + ".damaged"), damaged.size());
  }
}
TEST_F(PairingsFileTest, ReportsWhatCannotBeSaved) {
  const auto saved = [](PairingsFile& file) {
    std::promise<Result<void, Failure>> done;
    file.save(one_browser("a"), [&done](const auto& result) { done.set_value(result); });
    return done.get_future().get();
  };
  PairingsFile here(file_);
  EXPECT_TRUE(saved(here));
  EXPECT_EQ(content(), one_browser("a").text());
  PairingsFile nowhere(folder_.path() / "nowhere" / "pairings.json");
  EXPECT_THAT(saved(nowhere).error().message, testing::HasSubstr("nowhere"));
  PairingsFile none({});
  EXPECT_TRUE(saved(none)) << "nothing is to be kept";
}

}  // namespace
}  // namespace yuragi::daemon::web
