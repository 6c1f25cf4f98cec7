#include "daemon/stream/client_admission.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::stream {
namespace {

using testing::HasSubstr;

class ClientAdmissionTest : public testing::Test {
 protected:
  std::optional<std::string> refusal(const Peer& newcomer) const {
    return admission_refusal(limits_, connected_, newcomer);
  }
  /// Admits newcomers like this one until one is refused. How many there were.
  std::size_t fill(const Peer& peer) {
    std::size_t count = 0;
    for (; !refusal(peer); ++count) connected_.push_back(peer);
    return count;
  }
  static Peer machine(int number) { return {"10.0.0." + std::to_string(number), false}; }

  const Peer local_{"127.0.0.1", true};
  AdmissionLimits limits_{.max_clients = 32, .max_clients_per_address = 8};
  std::vector<Peer> connected_;
};

TEST_F(ClientAdmissionTest, AnotherMachineGetsSoManyPlaces) {
  EXPECT_EQ(fill(machine(1)), 8U);
  EXPECT_THAT(refusal(machine(1)).value(), HasSubstr("from 10.0.0.1 is connected: 8"));
  EXPECT_EQ(refusal(machine(2)), std::nullopt);
  connected_.pop_back();
  EXPECT_EQ(refusal(machine(1)), std::nullopt) << "one of them has left";
}

TEST_F(ClientAdmissionTest, TheLastPlacesAreForThisMachine) {
  for (int number = 1; number <= 40; ++number) fill(machine(number));
  EXPECT_EQ(connected_.size(), 28U);
  EXPECT_THAT(refusal(machine(50)).value(), HasSubstr("the last 4 of 32 places"));
  EXPECT_EQ(fill(local_), 4U);
  EXPECT_THAT(refusal(local_).value(), HasSubstr("32"));
}

TEST_F(ClientAdmissionTest, QuestionsOfThisMachineHavePlacesThatCountForNobodyElse) {
  EXPECT_EQ(fill(local_), 32U);
  const Peer asking{.address = "127.0.0.1", .is_local = true, .only_asks_because = refusal(local_)};
  for (std::size_t i = 0; i < kPlacesForQuestions; ++i) {
    EXPECT_TRUE(may_ask(connected_, local_)) << i;
    connected_.push_back(asking);
  }
  EXPECT_FALSE(may_ask(connected_, local_));
  EXPECT_FALSE(may_ask({}, machine(1)));
  EXPECT_THAT(refusal(local_).value(), HasSubstr("32"));
  connected_.erase(connected_.begin());
  EXPECT_EQ(refusal(local_), std::nullopt);
}

TEST_F(ClientAdmissionTest, ThisMachineMayHaveAllOfThem) {
  EXPECT_EQ(fill(local_), 32U);
  EXPECT_TRUE(refusal(machine(1)).has_value());
}

TEST_F(ClientAdmissionTest, ItsOwnClientsLeaveTheLastPlacesFree) {
  for (int i = 0; i < 4; ++i) connected_.push_back(local_);
  for (int number = 1; number <= 40; ++number) fill(machine(number));
  EXPECT_EQ(connected_.size(), 28U);
  EXPECT_EQ(refusal(local_), std::nullopt);
}

TEST_F(ClientAdmissionTest, OfFewPlacesHalfAreForThisMachine) {
  for (const auto& [places, kept] :
       std::vector<std::pair<std::size_t, std::size_t>>{{1, 0}, {2, 1}, {3, 1}, {6, 3}, {8, 4}, {1000, 4}}) {
    limits_.max_clients = places;
    limits_.max_clients_per_address = 1000;
    EXPECT_EQ(places_kept_for_this_machine(limits_), kept);
    connected_.clear();
    EXPECT_EQ(fill(machine(1)), places - kept);
    EXPECT_EQ(fill(local_), kept);
  }
}

}  // namespace
}  // namespace yuragi::daemon::stream
