#include "daemon/alerts/alerts.hpp"

#include <chrono>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>

#include "tests/support/descriptor.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;
using settings::AlertCondition;
using settings::AlertConfig;

constexpr int kHang_ms = 60'000;  // so long waits only who waits for something that hangs
const Instant kNow{.mono = MonoTime(1h), .utc = UtcTime(1'700'000'000s)};

AlertConfig storm(std::string name, std::string command) {
  return {
      .name = std::move(name), .when = AlertCondition::kWindAbove, .speed_m_s = 15.0, .command = std::move(command)};
}

class AlertsTest : public testing::Test {
 protected:
  AlertsTest() {
    EXPECT_EQ(mkfifo(told_.c_str(), S_IRUSR | S_IWUSR), 0);
    reader_ = Descriptor(open(told_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  }
  std::string tell() const { return "echo told > " + told_; }
  bool is_told() const {
    pollfd wait{.fd = reader_.get(), .events = POLLIN, .revents = 0};
    return poll(&wait, 1, kHang_ms) == 1;
  }

  test::TemporaryFolder folder_;
  std::string told_ = (folder_.path() / "told").string();
  std::filesystem::path record_ = folder_.path() / "alerts.json";

 private:
  Descriptor reader_;
};

TEST_F(AlertsTest, ACommandThatHangsDelaysNoOtherAlert) {
  wire::Sensors status;
  status.wind.wind = wind::wind_from(20.0, 240.0);
  status.wind.live_weight = 1.0;
  Alerts alerts({storm("a", "sleep 1000"), storm("b", "sleep 1000"), storm("c", tell())}, "host", {}, kNow);
  alerts.judge(status, {}, kNow);
  EXPECT_TRUE(is_told());
}

TEST_F(AlertsTest, DeliversAfterARestartWhatTheConfigurationStillHas) {
  const News known{.alert = "known", .has_begun = true, .message = "wind", .command = "an older command"};
  News gone = known;
  gone.alert = "gone";
  Ledger(record_).set({}, {gone, known});
  {
    Alerts alerts({storm("known", tell())}, "host", record_, kNow);
    EXPECT_TRUE(is_told());
  }
  for (const auto& [way, news] : Ledger(record_).record().undelivered) EXPECT_EQ(news.alert, "known");
}

}  // namespace
}  // namespace yuragi::daemon::alerts
