#include "daemon/feeds/osc_query_answer.hpp"

#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace yuragi::daemon::feeds {
namespace {

using nlohmann::json;
using values::Quantity;

const values::Names kNames{.sensors = {"roof mast"}, .places = {"door"}, .scenes = {"meadow"}};

values::Moment moment() {
  values::Moment made;
  made.shaped[Quantity::kSpeed] = 6.5;
  made.shaped[Quantity::kDirection] = 270.0;
  made.real[Quantity::kSpeed] = 12.0;
  made.source = wind::Source::kLive;
  made.sensors = {{.speed_m_s = 7.5, .age_s = 0.25, .state = wind::judging::SensorState::kStale}};
  made.shaped_places.resize(1);
  made.shaped_places[0][Quantity::kGust] = -1.25;
  made.opacities = {0.5};
  return made;
}

http::Response ask(std::string_view path, std::string_view query = "", values::Wind wind = values::Wind::kShaped) {
  return osc_query_answer(path, query, "hall", osc_addresses_of(kNames), moment(), wind);
}

json node(std::string_view path) {
  return json::parse(ask(path).body);
}

TEST(OscQueryAnswer, TheRootHasEveryAddressWhereItsPathSays) {
  const json root = node("/");
  EXPECT_EQ(root["FULL_PATH"], "/");
  EXPECT_EQ(root["ACCESS"], 0);
  for (const OscAddress& address : osc_addresses_of(kNames)) {
    const json* found = &root;
    for (std::size_t end = 0; end < address.path.size();) {
      const std::size_t begin = end + 1;
      end = std::min(address.path.find('/', begin), address.path.size());
      found = &found->at("CONTENTS").at(address.path.substr(begin, end - begin));
    }
    EXPECT_EQ(found->at("FULL_PATH"), address.path);
    EXPECT_EQ(found->at("ACCESS"), 1) << address.path << ": it can be read, and not be set";
    EXPECT_EQ(found->at("RANGE").size(), found->at("TYPE").get<std::string>().size()) << address.path;
    EXPECT_FALSE(found->at("DESCRIPTION").get<std::string>().empty()) << address.path;
  }
}

TEST(OscQueryAnswer, ANodeHasItsValueItsRangeAndItsUnit) {
  const json wind = node("/wind");
  EXPECT_EQ(wind["TYPE"], "ff");
  EXPECT_EQ(wind["VALUE"], json({6.5, 270.0}));
  EXPECT_EQ(wind["UNIT"], json({"speed.m/s", "angle.degree"}));
  EXPECT_EQ(wind["RANGE"][1], (json{{"MIN", 0.0}, {"MAX", 360.0}}));
  EXPECT_EQ(wind["CLIPMODE"], json({"none", "none"}));
  EXPECT_EQ(node("/place/door/gust")["VALUE"], json({-1.25}));
  EXPECT_EQ(node("/place/door/gust")["RANGE"][0]["MIN"], -10.0);
  EXPECT_EQ(node("/scene/meadow/opacity")["VALUE"], json({0.5}));
  EXPECT_FALSE(node("/wind/norm").contains("UNIT")) << "it has none";
  const json state = node("/sensor/roof_mast/state");
  EXPECT_EQ(state["TYPE"], "s");
  EXPECT_EQ(state["VALUE"], json({"stale"}));
  EXPECT_THAT(state["RANGE"][0]["VALS"].get<std::vector<std::string>>(), testing::Contains("live"));
}

TEST(OscQueryAnswer, TheRealWindIsReadIfItIsWanted) {
  EXPECT_EQ(json::parse(ask("/wind/speed", "VALUE", values::Wind::kReal).body), (json{{"VALUE", {12.0}}}));
}

TEST(OscQueryAnswer, WhatASensorDoesNotSendHasNoValue) {
  EXPECT_FALSE(node("/sensor/roof_mast/direction").contains("VALUE"));
  EXPECT_EQ(ask("/sensor/roof_mast/direction", "VALUE").status, 204U);
  EXPECT_EQ(json::parse(ask("/sensor/roof_mast/speed", "VALUE").body), (json{{"VALUE", {7.5}}}));
}

TEST(OscQueryAnswer, RefusesWithTheProposalsCodes) {
  EXPECT_EQ(ask("/wind/colour").status, 404U);
  EXPECT_EQ(ask("/win").status, 404U) << "a part of a name";
  EXPECT_EQ(ask("wind").status, 404U);
  EXPECT_EQ(ask("/wind/").status, 404U);
  EXPECT_EQ(ask("/wind", "COLOUR").status, 400U);
  EXPECT_EQ(ask("/place", "VALUE").status, 204U);
  EXPECT_EQ(json::parse(ask("/place", "ACCESS").body), (json{{"ACCESS", 0}}));
}

TEST(OscQueryAnswer, TheHostSaysWhatItCanDoAndTakesNothing) {
  const json host = json::parse(ask("/", "HOST_INFO").body);
  EXPECT_EQ(host["NAME"], "hall");
  for (const char* const extension : {"ACCESS", "VALUE", "RANGE", "DESCRIPTION", "CLIPMODE", "UNIT", "LISTEN"})
    EXPECT_EQ(host["EXTENSIONS"][extension], true) << extension;
  EXPECT_FALSE(host.contains("OSC_PORT"));
}

}  // namespace
}  // namespace yuragi::daemon::feeds
