// The simulated HID stations, as a USB host sees them. The expected bytes are the examples of the protocols' sources.
#include "simulators/usb/hid_stations.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/usb/fineoffset.hpp"

namespace yuragi::simulators::usb {
namespace {

using testing::ElementsAre;

constexpr SetupPacket kSetOutputReport = {0x21, 0x09, 0x0200, 0, 8};
constexpr SetupPacket kGetInputReport1 = {0xA1, 0x01, 0x0101, 0, 10};

/// A station and the host that polls it every 10 ms.
class HostOf {
 public:
  explicit HostOf(std::string_view name, double pace = 1.0) : device_(make_hid_station(name, pace)) {}
  explicit HostOf(std::unique_ptr<Device> device) : device_(std::move(device)) {}

  Device& device() { return *device_; }
  core::PlayedMoment wind = {8.6, 225.0};
  std::optional<core::FaultKind> fault;

  /// From now on.
  void suffer(core::FaultKind kind) {
    fault = kind;
    listen(0.01);
  }

  /// The reports of the next `duration_s`.
  std::vector<Bytes> listen(double duration_s) {
    std::vector<Bytes> reports;
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s; now_s_ += 0.01) {
      device_->advance(now_s_, wind, fault);
      while (auto report = device_->in(1, 64)) reports.push_back(*report);
    }
    return reports;
  }

  std::optional<Bytes> set_report(const Bytes& report) { return device_->control(kSetOutputReport, report); }

 private:
  std::unique_ptr<Device> device_;
  double now_s_ = 0.0;
};

Bytes stream_of(const std::vector<Bytes>& reports) {
  Bytes stream;
  for (const Bytes& report : reports) stream.insert(stream.end(), report.begin() + 1, report.begin() + 1 + report[0]);
  return stream;
}

bool holds(const Bytes& stream, const Bytes& wanted) {
  return std::search(stream.begin(), stream.end(), wanted.begin(), wanted.end()) != stream.end();
}

// --- all of them

class EveryHidStation : public testing::TestWithParam<std::string_view> {};

TEST_P(EveryHidStation, ShowsDescriptorsThatAreInThemselvesConsistent) {
  const auto device = make_hid_station(GetParam());
  const Descriptors& shown = device->descriptors();
  ASSERT_EQ(shown.device.size(), 18U);
  EXPECT_EQ(shown.device[0], 18);
  EXPECT_EQ(shown.strings.size(), 2U);
  ASSERT_GT(shown.configuration.size(), 25U);
  EXPECT_EQ(shown.configuration[2] | (shown.configuration[3] << 8), static_cast<int>(shown.configuration.size()));

  // Walks from descriptor to descriptor.
  std::map<int, int> seen;
  std::size_t at = 0;
  while (at < shown.configuration.size()) {
    const std::size_t length = shown.configuration[at];
    ASSERT_GE(length, 7U);
    ++seen[shown.configuration[at + 1]];
    if (shown.configuration[at + 1] == 0x21) {
      EXPECT_EQ(shown.configuration[at + 7] | (shown.configuration[at + 8] << 8),
                static_cast<int>(shown.hid_report.size()));
    }
    at += length;
  }
  EXPECT_EQ(at, shown.configuration.size());
  EXPECT_EQ(seen[0x05], shown.configuration[9 + 4]) << "end points";
  EXPECT_EQ(shown.hid_report.back(), 0xC0) << "the collection is closed";
}

TEST_P(EveryHidStation, OutlivesAHostileHost) {
  const auto device = make_hid_station(GetParam());
  std::mt19937_64 random(5);
  for (int round = 0; round < 5000; ++round) {
    Bytes data(random() % 70);
    std::ranges::generate(data, [&random] { return static_cast<std::uint8_t>(random()); });
    const SetupPacket setup = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random() % 12),
                               static_cast<std::uint16_t>(random()), static_cast<std::uint16_t>(random()),
                               static_cast<std::uint16_t>(random() % 80)};
    device->advance(0.01 * round, {10.0, 359.9}, std::nullopt);
    const auto answer = device->control(setup, data);
    EXPECT_LE(answer.value_or(Bytes{}).size(), setup.length);
    device->out(static_cast<std::uint8_t>(random() % 3), data);
    device->control(kSetOutputReport, data);
    const auto report = device->in(static_cast<std::uint8_t>(random() % 3), 8);
    EXPECT_LE(report.value_or(Bytes{}).size(), 8U);
  }
}

TEST_P(EveryHidStation, AcceptsWhatEveryHostAsksAndRefusesWhatNoneDoes) {
  const auto device = make_hid_station(GetParam());
  device->advance(0.0, {}, std::nullopt);
  EXPECT_EQ(device->control({0x21, 0x0A, 0, 0, 0}, {}), Bytes{}) << "SET_IDLE, which Linux sends to each HID device";
  EXPECT_EQ(device->control({0xC0, 0x20, 0, 0, 4}, {}), std::nullopt) << "a vendor's request of another device";
  EXPECT_EQ(device->in(2, 8), std::nullopt);
}

std::string suffix_of(const testing::TestParamInfo<std::string_view>& parameter) {
  std::string name(parameter.param);
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(HidStations, EveryHidStation, testing::ValuesIn(hid_station_names()), suffix_of);

TEST(HidStationFactory, RefusesANameThatItDoesNotKnow) {
  EXPECT_THROW(make_hid_station("wmr200"), std::runtime_error);
}

// --- WMR100

const Bytes kWmr100StartReport = {0x20, 0x00, 0x08, 0x01, 0, 0, 0, 0};

TEST(SimulatedWmr100, SpeaksAfterTheStartReportOnly) {
  HostOf host("wmr100");
  EXPECT_TRUE(host.listen(60.0).empty());
  EXPECT_TRUE(host.set_report(kWmr100StartReport).has_value());
  const auto reports = host.listen(60.0);
  ASSERT_FALSE(reports.empty());
  for (const Bytes& report : reports) {
    ASSERT_EQ(report.size(), 8U);
    EXPECT_GE(report[0], 1);
    EXPECT_LE(report[0], 7);
  }
}

TEST(SimulatedWmr100, SendsTheWindEvery14SecondsBetweenTwoFf) {
  HostOf host("wmr100");
  host.wind = {4.6, 225.0};
  host.set_report(kWmr100StartReport);
  const auto reports = host.listen(140.0);
  // 225 degrees, 4.6 m/s twice: 00 48 0a 0c, 2e, e0 02, and the sum.
  const Bytes frame = {0xFF, 0xFF, 0x00, 0x48, 0x0A, 0x0C, 0x2E, 0xE0, 0x02, 0x00, 0x20, 0x8E, 0x01};
  const Bytes stream = stream_of(reports);
  EXPECT_TRUE(holds(stream, frame));
  int winds = 0;
  for (std::size_t i = 0; i + 1 < stream.size(); ++i) winds += stream[i] == 0x00 && stream[i + 1] == 0x48;
  EXPECT_EQ(winds, 10);
}

TEST(SimulatedWmr100, SpoilsItsFramesAsItIsTold) {
  HostOf host("wmr100");
  host.wind = {4.6, 225.0};
  host.set_report(kWmr100StartReport);
  const Bytes whole = {0x2E, 0xE0, 0x02, 0x00, 0x20, 0x8E, 0x01};
  const auto with = [&](core::FaultKind fault) {
    host.suffer(fault);
    return stream_of(host.listen(70.0));
  };
  EXPECT_TRUE(holds(with(core::FaultKind::kSplit), whole));
  EXPECT_FALSE(holds(with(core::FaultKind::kBadChecksum), whole));
  EXPECT_FALSE(holds(with(core::FaultKind::kPartial), whole));
  EXPECT_TRUE(with(core::FaultKind::kSilence).empty());
  host.suffer(core::FaultKind::kGarbage);
  EXPECT_FALSE(host.listen(70.0).empty());
}

// --- WMR300

const Bytes kWmr300HeartbeatPacket = {0xA6, 0x91, 0xCA, 0x45, 0x52};
const Bytes kWmr300BeginPacket = {0x73, 0xE5, 0x0A, 0x26, 0x0E, 0xC1};

int winds_in(const std::vector<Bytes>& reports) {
  return static_cast<int>(std::ranges::count_if(reports, [](const Bytes& report) { return report[0] == 0xD4; }));
}

TEST(SimulatedWmr300, AnswersTheHeartbeatAndSendsTheWindEvery2750Milliseconds) {
  HostOf host("wmr300");
  host.wind = {2.9, 13.0};
  EXPECT_TRUE(host.listen(10.0).empty());
  EXPECT_TRUE(host.device().out(1, kWmr300HeartbeatPacket));
  EXPECT_EQ(winds_in(host.listen(10.0)), 0) << "not before it is told to begin";
  EXPECT_TRUE(host.device().out(1, kWmr300HeartbeatPacket));
  EXPECT_TRUE(host.device().out(1, kWmr300BeginPacket));
  const auto reports = host.listen(27.5);
  ASSERT_FALSE(reports.empty());
  EXPECT_THAT(Bytes(reports[0].begin(), reports[0].begin() + 6), ElementsAre('W', 'M', 'R', '3', '0', '0'));
  EXPECT_THAT(Bytes(reports[1].begin(), reports[1].begin() + 4), ElementsAre('A', 'C', 'K', 0x73));
  EXPECT_EQ(winds_in(reports), 10);

  const auto wind = std::ranges::find_if(reports, [](const Bytes& report) { return report[0] == 0xD4; });
  ASSERT_EQ(wind->size(), 64U);
  EXPECT_EQ((*wind)[1], 54);
  EXPECT_THAT(Bytes(wind->begin() + 12, wind->begin() + 16), ElementsAre(0x00, 0x1D, 0x00, 0x0D));
  const int sum = std::accumulate(wind->begin(), wind->begin() + 52, 0);
  EXPECT_EQ((*wind)[52] * 256 + (*wind)[53], sum);
}

TEST(SimulatedWmr300, StopsAHundredSecondsAfterTheLastWordOfTheHost) {
  HostOf host("wmr300");
  host.listen(0.1);
  host.device().out(1, kWmr300HeartbeatPacket);
  host.device().out(1, kWmr300BeginPacket);
  EXPECT_GT(winds_in(host.listen(95.0)), 30);
  host.device().out(1, Bytes{'A', 'C', 'K', 0xD4, 1, 0});
  EXPECT_GT(winds_in(host.listen(95.0)), 30) << "an acknowledgement keeps it talking";
  host.listen(10.0);
  EXPECT_EQ(winds_in(host.listen(60.0)), 0);
}

// --- Fine Offset

Bytes read_request(std::uint16_t address) {
  const auto high = static_cast<std::uint8_t>(address >> 8U);
  const auto low = static_cast<std::uint8_t>(address & 0xFFU);
  return {0xA1, high, low, 0x20, 0xA1, high, low, 0x20};
}

Bytes read_memory(HostOf& host, std::uint16_t address, double wait_s = 0.2) {
  host.set_report(read_request(address));
  Bytes block;
  for (const Bytes& report : host.listen(wait_s)) block.insert(block.end(), report.begin(), report.end());
  return block;
}

TEST(SimulatedFineOffset, KeepsTheWindInTheCurrentRecord) {
  HostOf host("fineoffset");
  host.wind = {25.7, 337.5};
  host.listen(20.0);
  const Bytes fixed = read_memory(host, 0);
  ASSERT_EQ(fixed.size(), 32U);
  EXPECT_THAT(Bytes(fixed.begin(), fixed.begin() + 2), ElementsAre(0x55, 0xAA));
  EXPECT_THAT(Bytes(fixed.begin() + 30, fixed.end()), ElementsAre(0x00, 0x01));
  const Bytes record = read_memory(host, 0x100);
  EXPECT_THAT(Bytes(record.begin() + 9, record.begin() + 13), ElementsAre(0x01, 0x01, 0x11, 15));
}

TEST(SimulatedFineOffset, WritesEvery48SecondsAndGoesOnEveryFewMinutes) {
  HostOf host("fineoffset");
  host.wind = {1.0, 0.0};
  host.listen(8.0);
  host.wind = {2.0, 0.0};
  host.listen(40.0);
  EXPECT_EQ(read_memory(host, 0x100)[9], 10) << "what it measured 41 s ago";
  host.listen(10.0);
  EXPECT_EQ(read_memory(host, 0x100)[9], 20);
  EXPECT_EQ(read_memory(host, 0x100)[0], 1) << "minutes";
  host.listen(300.0);
  EXPECT_EQ(read_memory(host, 0x000)[30], 0x10) << "the next record";
}

TEST(SimulatedFineOffset, OfTheLongRecordsKeepsThem20BytesApart) {
  HostOf host("fineoffset-wh3080");
  host.listen(310.0);
  EXPECT_EQ(read_memory(host, 0x000)[30], 0x14);
}

TEST(SimulatedFineOffset, CanBeCaughtInTheMiddleOfItsWriting) {
  HostOf host("fineoffset");
  host.wind = {1.0, 0.0};
  host.listen(54.0);
  host.wind = {30.0, 270.0};
  bool was_torn = false;
  for (int i = 0; i < 40; ++i) {
    const Bytes record = read_memory(host, 0x100, 0.07);
    was_torn = was_torn || (record[9] == (300 & 0xFF) && record[12] == 0);
  }
  EXPECT_TRUE(was_torn) << "the new speed with the old direction";
}

TEST(SimulatedFineOffset, CountsReadsNearItsWriting) {
  auto console = std::make_unique<FineOffset>(FineOffsetRecord::kWh1080, HidModelOptions{});
  const FineOffset& counted = *console;
  HostOf host(std::move(console));
  host.listen(20.0);
  read_memory(host, 0);
  EXPECT_EQ(counted.reads_near_writing(), 0);
  host.listen(33.0);
  read_memory(host, 0);
  EXPECT_EQ(counted.reads_near_writing(), 1);
  EXPECT_EQ(counted.blocks_read(), 2);
}

TEST(SimulatedFineOffset, WritesAByteAndSaysSo) {
  HostOf host("fineoffset");
  host.listen(10.0);
  host.set_report({0xA2, 0x00, 0x1A, 0x20, 0xA2, 0xAA, 0x00, 0x20});
  EXPECT_THAT(host.listen(0.2), ElementsAre(Bytes(8, 0xA5)));
  EXPECT_EQ(read_memory(host, 0)[0x1A], 0xAA);
}

TEST(SimulatedFineOffset, FailsAsItIsTold) {
  HostOf host("fineoffset");
  host.listen(20.0);
  host.suffer(core::FaultKind::kSilence);
  EXPECT_TRUE(read_memory(host, 0, 3.0).empty());
  host.suffer(core::FaultKind::kPartial);
  EXPECT_EQ(read_memory(host, 0).size(), 16U);
  host.suffer(core::FaultKind::kLate);
  EXPECT_TRUE(read_memory(host, 0, 2.0).empty());
  EXPECT_EQ(host.listen(1.0).size(), 4U);
  host.suffer(core::FaultKind::kSplit);
  EXPECT_LT(read_memory(host, 0, 0.5).size(), 32U);
  EXPECT_FALSE(host.listen(1.0).empty());
  host.suffer(core::FaultKind::kGarbage);
  EXPECT_NE(read_memory(host, 0), read_memory(host, 0));
}

// --- AcuRite

TEST(SimulatedAcurite, ChangesItsReportEvery18SecondsByTurns) {
  HostOf host("acurite");
  host.wind = {2.8072, 135.0};  // the example 01 cd ff 71 01 39 39 71 03 ff: 10.1058 km/h, 135 degrees
  host.listen(1.0);
  const auto first = host.device().control(kGetInputReport1, {});
  ASSERT_TRUE(first.has_value());
  EXPECT_THAT(*first, ElementsAre(0x01, 0xC0, 0x5C, 0x71, 0x01, 0x39, 0x00, 0x0C, 0x03, 0xFF));
  host.listen(16.0);
  EXPECT_EQ(host.device().control(kGetInputReport1, {}), first);
  host.listen(2.0);
  const auto second = host.device().control(kGetInputReport1, {});
  EXPECT_EQ((*second)[3], 0x78);
  EXPECT_EQ((*second)[4], 0x01);
  EXPECT_EQ((*second)[5] & 0x70, 0x30);
  host.wind = {0.2, 0.0};
  host.listen(18.0);
  EXPECT_THAT(*host.device().control(kGetInputReport1, {}),
              ElementsAre(0x01, 0xC0, 0x5C, 0x71, 0x00, 0x06, 0x00, 0x0C, 0x03, 0xFF));
}

TEST(SimulatedAcurite, FailsAsItIsTold) {
  HostOf host("acurite");
  host.suffer(core::FaultKind::kPartial);
  EXPECT_EQ(host.device().control(kGetInputReport1, {})->size(), 5U);
  host.suffer(core::FaultKind::kGarbage);
  EXPECT_NE(host.device().control(kGetInputReport1, {}), host.device().control(kGetInputReport1, {}));
  host.suffer(core::FaultKind::kSilence);
  EXPECT_EQ(host.device().control(kGetInputReport1, {}), std::nullopt);
  EXPECT_EQ(host.device().control({0xA1, 0x01, 0x0104, 0, 10}, {}), std::nullopt) << "no such report";
}

// --- TE923

const Bytes kTe923Request = {0x05, 0xAF, 0x01, 0x00, 0x02, 0xAC, 0x00, 0x00};

TEST(SimulatedTe923, AnswersWithABlockInDecimalDigitsOfMilesAnHour) {
  HostOf host("te923");
  host.wind = {8.7 * 0.44704, 270.0};
  host.listen(1.0);
  host.set_report(kTe923Request);
  const auto reports = host.listen(0.5);
  ASSERT_EQ(reports.size(), 5U);
  const Bytes block = stream_of(reports);
  ASSERT_EQ(block.size(), 34U);
  EXPECT_EQ(block[0], 0x5A);
  EXPECT_THAT(Bytes(block.begin() + 26, block.begin() + 31), ElementsAre(0x87, 0x00, 0x87, 0x00, 12));
  EXPECT_EQ(std::accumulate(block.begin(), block.end(), 0, [](int all, int byte) { return all ^ byte; }), 0);
}

TEST(SimulatedTe923, DoesNotAnswerARequestWithAWrongCheckByte) {
  HostOf host("te923");
  Bytes request = kTe923Request;
  request[5] ^= 1U;
  host.set_report(request);
  EXPECT_TRUE(host.listen(1.0).empty());
}

TEST(SimulatedTe923, FailsAsItIsTold) {
  HostOf host("te923");
  const auto with = [&host](core::FaultKind fault, double wait_s) {
    host.suffer(fault);
    host.set_report(kTe923Request);
    return stream_of(host.listen(wait_s));
  };
  EXPECT_TRUE(with(core::FaultKind::kSilence, 2.0).empty());
  EXPECT_EQ(with(core::FaultKind::kPartial, 1.0).size(), 17U);
  EXPECT_LT(with(core::FaultKind::kSplit, 0.5).size(), 34U);
  EXPECT_TRUE(with(core::FaultKind::kLate, 5.0).empty());
  const Bytes bad = with(core::FaultKind::kBadChecksum, 1.0);
  EXPECT_NE(std::accumulate(bad.begin(), bad.end(), 0, [](int all, int byte) { return all ^ byte; }), 0);
}

}  // namespace
}  // namespace yuragi::simulators::usb
