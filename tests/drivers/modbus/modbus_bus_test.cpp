// Several sensors on one line: who asks first is served first, the gap holds for all, a wait can be ended.
#include "drivers/modbus/modbus_bus.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/eventfd.h>

#include "daemon/sensing/system_clock.hpp"
#include "drivers/bus/interruption.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/fake_modbus_line.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::modbus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Kind = Trouble::Kind;

constexpr auto kHang = 60s;  // so long waits only who waits for something that hangs

/// A device that answers when the test lets it, and remembers when it was asked.
class HeldConnection final : public bus::ModbusConnection {
 public:
  Result<void, Failure> open(const bus::Interruption&) override {
    is_open_ = true;
    return {};
  }
  bool is_open() const noexcept override { return is_open_; }
  void close() noexcept override { is_open_ = false; }
  std::size_t settle(std::span<std::uint8_t, decode::modbus::kModbusMaxMessage>, const bus::ModbusPatience&,
                     const bus::Interruption&) override {
    return 0;
  }
  bool send(const decode::modbus::Request& request, const bus::ModbusPatience&) override {
    const std::lock_guard lock(mutex_);
    requested_.push_back(request);
    requested_at_.push_back(std::chrono::steady_clock::now());
    changed_.notify_all();
    return true;
  }
  bus::Message receive(std::span<std::uint8_t, decode::modbus::kModbusMaxMessage> buffer,
                       const bus::Interruption& interruption) override {
    if (interruption.wait(may_reply_.get(), bus::WaitFor::kReadable, kHang) != bus::WaitEnd::kReady) {
      return {bus::Status::kInterrupted};
    }
    eventfd_t one = 0;
    eventfd_read(may_reply_.get(), &one);
    const std::lock_guard lock(mutex_);
    const auto bytes = reply_with(requested_.back(), {86});
    std::ranges::copy(bytes, buffer.begin());
    return {bus::Status::kMessage, bytes.size()};
  }

  void let_reply(int count) { eventfd_write(may_reply_.get(), static_cast<eventfd_t>(count)); }
  bool wait_for_questions(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kHang, [&] { return requested_.size() >= count; });
  }
  std::vector<int> requested_units() {
    const std::lock_guard lock(mutex_);
    std::vector<int> units;
    for (const decode::modbus::Request& request : requested_) units.push_back(request.unit);
    return units;
  }
  std::vector<std::chrono::steady_clock::time_point> requested_at() {
    const std::lock_guard lock(mutex_);
    return requested_at_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = false;
  Descriptor may_reply_{eventfd(0, EFD_CLOEXEC | EFD_SEMAPHORE)};
  std::vector<decode::modbus::Request> requested_;
  std::vector<std::chrono::steady_clock::time_point> requested_at_;
};

bus::ModbusLine line_named(const std::string& host) {
  bus::ModbusLine line;
  line.host = host;
  return line;
}

/// Sensors as threads, each with its own unit, that ask once.
class ModbusBusTest : public testing::Test {
 protected:
  struct Caller {
    bus::Interruption interruption;
    RecordingSink sink;
    std::optional<Bus::Reply> reply;
    std::thread thread;
  };
  ModbusBusTest() {
    auto connection = std::make_unique<HeldConnection>();
    connection_ = connection.get();
    bus_ = std::make_unique<Bus>(line_named("held"), std::move(connection));
    const bus::Interruption interruption;
    EXPECT_TRUE(bus_->open(interruption, clock_));
  }
  ~ModbusBusTest() override {
    for (const auto& caller : callers_) {
      if (caller->thread.joinable()) caller->thread.join();
    }
  }
  Caller& exchange(std::uint8_t unit) {
    Caller& caller = *callers_.emplace_back(std::make_unique<Caller>());
    caller.thread = std::thread([this, unit, &caller] {
      caller.reply = bus_->exchange({.unit = unit}, {}, caller.interruption, clock_, caller.sink);
    });
    return caller;
  }
  /// Until `count` of them stand in the queue, or have the line.
  void wait_until_waiting(std::size_t count) {
    const auto deadline = std::chrono::steady_clock::now() + kHang;
    while (bus_->waiting_count() < count && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    ASSERT_EQ(bus_->waiting_count(), count);
  }

  daemon::sensing::SystemClock clock_;
  HeldConnection* connection_ = nullptr;
  std::unique_ptr<Bus> bus_;
  std::vector<std::unique_ptr<Caller>> callers_;
};

TEST_F(ModbusBusTest, ServesInTheOrderOfAsking) {
  std::vector<int> expected;
  for (std::uint8_t unit = 1; unit <= 8; ++unit) {
    exchange(unit);
    expected.push_back(unit);
    wait_until_waiting(unit);
  }
  connection_->let_reply(8);
  for (const auto& caller : callers_) {
    caller->thread.join();
    EXPECT_TRUE(caller->reply->has_value());
  }
  EXPECT_EQ(connection_->requested_units(), expected);
}

TEST_F(ModbusBusTest, KeepsTheLongestGapThatAnySensorAsksFor) {
  bus_->keep_gap(60ms);
  bus_->keep_gap(10ms);
  connection_->let_reply(3);
  for (std::uint8_t unit = 1; unit <= 3; ++unit) exchange(unit);
  for (const auto& caller : callers_) caller->thread.join();
  const auto at = connection_->requested_at();
  ASSERT_EQ(at.size(), 3U);
  EXPECT_GE(at[1] - at[0], 60ms);
  EXPECT_GE(at[2] - at[1], 60ms);
}

TEST_F(ModbusBusTest, EndsTheWaitOfTheOneWhoIsInterruptedAndOfNobodyElse) {
  Caller& first = exchange(1);
  ASSERT_TRUE(connection_->wait_for_questions(1));
  Caller& second = exchange(2);
  wait_until_waiting(2);
  Caller& third = exchange(3);
  wait_until_waiting(3);

  second.interruption.set();
  bus_->wake_waiters();
  second.thread.join();
  EXPECT_EQ(second.reply->error().kind, Kind::kInterrupted);

  first.interruption.set();
  first.thread.join();
  EXPECT_EQ(first.reply->error().kind, Kind::kInterrupted);
  connection_->let_reply(1);
  third.thread.join();
  EXPECT_TRUE(third.reply->has_value());
  EXPECT_THAT(connection_->requested_units(), testing::ElementsAre(1, 3));
}

TEST_F(ModbusBusTest, EndsAWaitForTheGapToo) {
  bus_->keep_gap(1h);
  connection_->let_reply(1);
  exchange(1).thread.join();
  Caller& second = exchange(2);
  wait_until_waiting(1);
  second.interruption.set();
  bus_->wake_waiters();
  second.thread.join();
  EXPECT_EQ(second.reply->error().kind, Kind::kInterrupted);
}

/// A bus on a fake line, one thread, time by hand.
class ModbusBusByHandTest : public testing::Test {
 protected:
  ModbusBusByHandTest() {
    line_.statuses = [this](const decode::modbus::Request&) { return std::deque{status_}; };
    line_.message = [](const decode::modbus::Request& request) { return reply_with(request, {86}); };
  }
  void make(decode::modbus::Framing framing) {
    bus::ModbusLine line = line_named("fake");
    line.framing = framing;
    line.device = "fake";
    bus_ = std::make_unique<Bus>(line, std::make_unique<FakeConnection>(line_));
    ASSERT_TRUE(bus_->open(interruption_, clock_));
  }
  Bus::Reply exchange(std::uint8_t unit) { return bus_->exchange({.unit = unit}, {}, interruption_, clock_, sink_); }

  FakeLine line_;
  bus::Status status_ = bus::Status::kMessage;
  ManualClock clock_;
  bus::Interruption interruption_;
  RecordingSink sink_;
  std::unique_ptr<Bus> bus_;
};

TEST_F(ModbusBusByHandTest, LetsASilentSlaveOfASerialLineBeForOneTimeOutMore) {
  make(decode::modbus::Framing::kRtu);
  status_ = bus::Status::kSilence;
  exchange(5);
  EXPECT_EQ(bus_->ready_at(5), clock_.now().mono + 500ms);
  EXPECT_LE(bus_->ready_at(6), clock_.now().mono);
}

TEST_F(ModbusBusByHandTest, NeedNotWaitOverTcpWhereALateAnswerIsKnownByItsNumber) {
  make(decode::modbus::Framing::kTcp);
  status_ = bus::Status::kSilence;
  exchange(5);
  EXPECT_LE(bus_->ready_at(5), clock_.now().mono);
}

TEST_F(ModbusBusByHandTest, LetsTheLineSettleAfterTroubleAndNotAfterAnAnswer) {
  make(decode::modbus::Framing::kTcp);
  exchange(1);
  EXPECT_EQ(line_.settled, 1);  // it had just been opened
  exchange(1);
  EXPECT_EQ(line_.settled, 1);
  status_ = bus::Status::kSilence;
  exchange(1);
  EXPECT_EQ(line_.settled, 1);
  exchange(1);
  EXPECT_EQ(line_.settled, 2);
}

TEST_F(ModbusBusByHandTest, IsNotClosedForOneDeadSlaveWhileAnotherAnswers) {
  make(decode::modbus::Framing::kTcp);
  line_.statuses = [](const decode::modbus::Request& request) {
    return std::deque{request.unit == 1 ? bus::Status::kMessage : bus::Status::kSilence};
  };
  for (int i = 0; i < 10; ++i) {
    exchange(1);
    exchange(9);
  }
  ASSERT_TRUE(bus_->open(interruption_, clock_));
  EXPECT_EQ(line_.opened, 1);
}

TEST_F(ModbusBusByHandTest, ShowsEachMessageThatWentOrCame) {
  make(decode::modbus::Framing::kTcp);
  exchange(7);
  ASSERT_EQ(sink_.raws.size(), 2U);
  EXPECT_EQ(sink_.raws[0].direction, sensor::RawDirection::kSent);
  EXPECT_THAT(sink_.raws[0].message, testing::ElementsAre(0, 1, 0, 0, 0, 6, 7, 3, 0, 0, 0, 1));
  EXPECT_EQ(sink_.raws[1].direction, sensor::RawDirection::kReceived);
  EXPECT_THAT(sink_.raws[1].message, testing::ElementsAre(0, 1, 0, 0, 0, 5, 7, 3, 2, 0, 86));
}

TEST(SharedModbusBus, IsOneForAllNamesOfALineForAsLongAsSomebodyHoldsIt) {
  const test::TemporaryFolder folder;
  const std::string link = folder / "stable-name";
  std::filesystem::create_symlink("/dev/null", link);
  bus::ModbusLine by_link;
  by_link.framing = decode::modbus::Framing::kRtu;
  by_link.device = link;
  bus::ModbusLine by_node = by_link;
  by_node.device = "/dev/null";

  auto one = shared_modbus_bus(by_link);
  EXPECT_EQ(shared_modbus_bus(by_node), one);
  EXPECT_NE(shared_modbus_bus(line_named("a")), shared_modbus_bus(line_named("b")));

  by_node.baud = 4800;
  try {
    shared_modbus_bus(by_node);
    FAIL() << "shared";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("is used with 9600 8N1 by another sensor, and cannot have 4800 8N1"));
  }
  one.reset();
  EXPECT_NO_THROW(shared_modbus_bus(by_node));
}

}  // namespace
}  // namespace yuragi::drivers::modbus
