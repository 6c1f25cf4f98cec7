#include "daemon/web/page.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::web {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

http::Request request_for(std::string_view path, std::string_view etag = "") {
  return {.method = "GET", .path = std::string(path), .if_none_match = std::string(etag)};
}

TEST(Page, EachFileIsServed_WithItsTypeAndAStrictPolicy) {
  std::set<std::string_view> paths;
  for (const PageFile& file : page_files()) {
    paths.insert(file.path);
    const auto response = page_answer(request_for(file.path));
    ASSERT_TRUE(response) << file.path;
    EXPECT_EQ(response->status, 200U);
    EXPECT_EQ(response->body, file.text);
    EXPECT_EQ(response->content_type, file.content_type);
    EXPECT_FALSE(file.text.empty()) << file.path;
    EXPECT_THAT(response->fields, Contains(Pair("Cache-Control", "no-cache")));
    const bool compiles = file.path == "/wall";  // the picture, which is WebAssembly
    EXPECT_THAT(response->fields,
                Contains(Pair("Content-Security-Policy",
                              std::string("default-src 'none'; style-src 'self'; script-src 'self'") +
                                  (compiles ? " 'wasm-unsafe-eval'" : "") +
                                  "; connect-src 'self'; img-src 'self'; manifest-src 'self'; base-uri 'none'; "
                                  "form-action 'none'; frame-ancestors 'none'")));
  }
  EXPECT_EQ(paths, (std::set<std::string_view>{"/", "/icon.svg", "/manifest.webmanifest", "/page.css", "/page.js",
                                               "/wall", "/wall.css", "/wall.js"}));
}
TEST(Page, AFileThatTheBrowserHas_IsNotSentAgain) {
  for (const PageFile& file : page_files()) {
    const auto known = page_answer(request_for(file.path, file.entity_tag));
    ASSERT_TRUE(known);
    EXPECT_EQ(known->status, 304U);
    EXPECT_TRUE(known->body.empty());
    EXPECT_EQ(page_answer(request_for(file.path, "\"of an older program\""))->status, 200U);
  }
}
TEST(Page, WhatIsNoneOfItsFiles_IsLeftToOthers) {
  EXPECT_FALSE(page_answer(request_for("/healthz")));
  EXPECT_FALSE(page_answer(request_for("/page.js/")));
  EXPECT_FALSE(page_answer({.method = "POST", .path = "/"}));
  EXPECT_TRUE(page_answer({.method = "HEAD", .path = "/"}));
}
/// The policy forbids both; the browser would say so on its console, and leave them out.
TEST(Page, HasNoScriptOrStyleWithinItsText) {
  for (const char* const path : {"/", "/wall"}) {
    const auto page = page_answer(request_for(path));
    ASSERT_TRUE(page) << path;
    EXPECT_THAT(page->body, Not(HasSubstr("<style"))) << path;
    EXPECT_THAT(page->body, Not(HasSubstr("style="))) << path;
    EXPECT_THAT(page->body, Not(HasSubstr("<script>"))) << path;
  }
}

}  // namespace
}  // namespace yuragi::daemon::web
