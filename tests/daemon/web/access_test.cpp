// The token of other machines' clients, and what is made of it.
#include "daemon/web/access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/web/permission.hpp"

namespace yuragi::daemon::web {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

constexpr double kNow_s = 1.8e9;
const Secret kToken("correct horse battery staple");

TEST(Access, ANewTokenCannotBeGuessed) {
  const std::string token = Access::new_token().reveal();
  EXPECT_THAT(token, MatchesRegex("[A-Za-z0-9_-]+"));
  EXPECT_EQ(token.size(), 43U);
  EXPECT_NE(token, Access::new_token().reveal());
}
TEST(Access, TheTokenAndNothingElse) {
  const Access access(kToken);
  EXPECT_TRUE(access.is_token(kToken.reveal()));
  for (const char* other :
       {"", "correct horse battery stapl", "correct horse battery stapleX", "Correct horse battery staple"})
    EXPECT_FALSE(access.is_token(other)) << other;
}
TEST(Access, APairingCodeIsTakenForTenMinutesAtLeastAndTwentyAtMost) {
  const Access access(kToken);
  const std::string code = access.pairing_code(kNow_s);
  EXPECT_THAT(code, MatchesRegex("[0-9A-HJKMNP-TV-Z]{4}-[0-9A-HJKMNP-TV-Z]{4}"));
  EXPECT_TRUE(access.is_pairing_code(code, kNow_s));
  EXPECT_TRUE(access.is_pairing_code(code, kNow_s + 600.0));
  EXPECT_FALSE(access.is_pairing_code(code, kNow_s + 1200.0));
  EXPECT_FALSE(access.is_pairing_code(code, kNow_s - 600.0)) << "one of the future";
  EXPECT_FALSE(Access(Secret("another token entirely")).is_pairing_code(code, kNow_s));
  EXPECT_NE(code, access.pairing_code(kNow_s + 600.0));
}
TEST(Access, APairingCodeMayBeTypedAsPeopleDo) {
  const Access access(kToken);
  for (int step = 0; step < 200; ++step) {
    const double at_s = kNow_s + step * Access::kCodeStep_s;
    std::string typed = access.pairing_code(at_s);
    for (char& c : typed) c = c == '-' ? ' ' : c == '0' ? 'o' : c == '1' ? 'l' : static_cast<char>(std::tolower(c));
    EXPECT_TRUE(access.is_pairing_code(" " + typed, at_s)) << typed;
  }
  for (const std::string& other : {std::string(), std::string("--------"), std::string("K7QM"), std::string(5000, 'A')})
    EXPECT_FALSE(access.is_pairing_code(other, kNow_s));
}
TEST(Access, ASessionLastsAYearAndEndsWithItsToken) {
  const Access access(kToken);
  const std::string session = access.new_session(kNow_s);
  EXPECT_THAT(session, Not(HasSubstr(kToken.reveal())));
  EXPECT_TRUE(access.is_session(session, kNow_s));
  EXPECT_TRUE(access.is_session(session, kNow_s - 86400.0)) << "the clock was set back";
  EXPECT_TRUE(access.is_session(session, kNow_s + 364.0 * 86400.0));
  EXPECT_FALSE(access.is_session(session, kNow_s + 366.0 * 86400.0));
  EXPECT_FALSE(Access(Secret("another token entirely")).is_session(session, kNow_s));
}
TEST(Access, ASessionCannotBeMadeUpOrProlonged) {
  const Access access(kToken);
  const std::string session = access.new_session(kNow_s);
  for (std::size_t at = 0; at < session.size(); ++at) {
    std::string other = session;
    other[at] = other[at] == '7' ? '8' : '7';
    EXPECT_FALSE(access.is_session(other, kNow_s)) << at;
    EXPECT_FALSE(access.is_session(session.substr(0, at), kNow_s)) << at;
  }
  for (const char* other : {"", ".", "x", "-1.", "99999999999999999999.00", "1800000000", "1800000000."})
    EXPECT_FALSE(access.is_session(other, kNow_s)) << other;
}
TEST(PairingTries, TenAtOnceThenOneASecond) {
  PairingTries tries;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(tries.take(1000.0)) << i;
  EXPECT_FALSE(tries.take(1000.0));
  EXPECT_FALSE(tries.take(1000.9));
  EXPECT_TRUE(tries.take(1001.1));
  EXPECT_FALSE(tries.take(1001.2));
}

HttpRequest from_elsewhere() {
  return {.method = "POST", .path = "/api/v1/scenes", .client = {.address = "192.168.1.30", .is_local = false}};
}

TEST(Permission, ThisMachineIsTrustedUnlessAProxySendsItForAnother) {
  const Access access(kToken);
  HttpRequest request{.client = {.address = "127.0.0.1", .is_local = true}};
  EXPECT_TRUE(is_trusted(request, nullptr, kNow_s));
  request.is_forwarded = true;
  EXPECT_FALSE(is_trusted(request, nullptr, kNow_s));
  EXPECT_FALSE(is_trusted(request, &access, kNow_s));
  request.authorization = "Bearer " + kToken.reveal();
  EXPECT_TRUE(is_trusted(request, &access, kNow_s));
}
TEST(Permission, OthersShowTheTokenOrASession) {
  const Access access(kToken);
  HttpRequest request = from_elsewhere();
  EXPECT_FALSE(is_trusted(request, &access, kNow_s));
  request.authorization = "Bearer " + kToken.reveal();
  EXPECT_TRUE(is_trusted(request, &access, kNow_s));
  EXPECT_FALSE(is_trusted(request, nullptr, kNow_s)) << "no token is configured";
  for (const std::string& other : {std::string("Bearer "), "Basic " + kToken.reveal(), kToken.reveal()}) {
    request.authorization = other;
    EXPECT_FALSE(is_trusted(request, &access, kNow_s)) << other;
  }
  const std::string session = access.new_session(kNow_s);
  for (const std::string& cookies : {"yuragi_session=" + session, "a=b; yuragi_session=" + session + "; c"}) {
    request.cookie = cookies;
    EXPECT_TRUE(is_trusted(request, &access, kNow_s)) << cookies;
  }
  for (const std::string& cookies :
       {"session=" + session, "xyuragi_session=" + session, std::string("yuragi_session"), std::string(";;=;")}) {
    request.cookie = cookies;
    EXPECT_FALSE(is_trusted(request, &access, kNow_s)) << cookies;
  }
}
TEST(Permission, ReadingIsFreeUnlessItTakesTheToken) {
  HttpRequest request = from_elsewhere();
  EXPECT_EQ(permission_refusal(request, false, true, false)->status, 401U);
  EXPECT_THAT(permission_refusal(request, false, true, false)->body, HasSubstr("yuragi token"));
  EXPECT_THAT(permission_refusal(request, false, false, false)->body, HasSubstr("token_file"));
  EXPECT_FALSE(permission_refusal(request, true, true, true));
  for (const char* method : {"GET", "HEAD"}) {
    request.method = method;
    EXPECT_FALSE(permission_refusal(request, false, true, false));
    EXPECT_EQ(permission_refusal(request, false, true, true)->status, 401U);
  }
}
TEST(Permission, APairedBrowserIsLetInByItsCookieAlone) {
  const Access access(kToken);
  PairingTries tries;
  HttpRequest request = from_elsewhere();
  EXPECT_EQ(pairing_answer("0000-0000", request, &access, tries, kNow_s, 0.0).status, 403U);
  EXPECT_EQ(pairing_answer("0000-0000", request, nullptr, tries, kNow_s, 0.0).status, 409U);
  request.is_https = true;
  const HttpResponse paired = pairing_answer(access.pairing_code(kNow_s), request, &access, tries, kNow_s, 0.0);
  ASSERT_EQ(paired.status, 200U);
  ASSERT_EQ(paired.fields.size(), 1U);
  const std::string& cookie = paired.fields[0].second;
  EXPECT_THAT(cookie, HasSubstr("; HttpOnly; SameSite=Strict; Secure"));
  request.cookie = cookie.substr(0, cookie.find(';'));
  EXPECT_TRUE(is_trusted(request, &access, kNow_s + 3600.0));
  while (pairing_answer("0000-0000", request, &access, tries, kNow_s, 0.0).status == 403U) {
  }
  EXPECT_EQ(pairing_answer(access.pairing_code(kNow_s), request, &access, tries, kNow_s, 0.0).status, 429U)
      << "who guesses does not come far";
}

}  // namespace
}  // namespace yuragi::daemon::web
