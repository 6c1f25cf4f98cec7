#include "engine/base/json_text.hpp"

#include <gtest/gtest.h>

namespace yuragi {
namespace {

TEST(JsonText, AnyBytesBecomeJson) {
  std::string all_bytes;
  for (int byte = 0; byte < 256; ++byte) all_bytes += static_cast<char>(byte);
  const nlohmann::ordered_json json = {{"said", all_bytes}, {all_bytes, 1}};
  for (const std::string& text : {json_text(json), json_text(json, 2), ascii_json_text(json)}) {
    EXPECT_TRUE(nlohmann::json::accept(text));
  }
  EXPECT_EQ(json_text(nlohmann::json("a\xFF")), "\"a\xEF\xBF\xBD\"");
  EXPECT_EQ(ascii_json_text(nlohmann::json("\xC3\xA9\xFF")), "\"\\u00e9\\ufffd\"");
}

TEST(JsonText, IsIndentedWhenAsked) {
  EXPECT_EQ(json_text(nlohmann::json{{"a", 1}}), "{\"a\":1}");
  EXPECT_EQ(json_text(nlohmann::json{{"a", 1}}, 2), "{\n  \"a\": 1\n}");
}

}  // namespace
}  // namespace yuragi
