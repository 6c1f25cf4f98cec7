// The token of other machines' clients, and what is made of it.
#include "daemon/web/access.hpp"

#include <array>

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
TEST(Access, APairingCodeIsValidForNearlyTenMinutes) {
  const Access access(kToken);
  const std::string code = access.pairing_code(kNow_s);
  EXPECT_THAT(code, MatchesRegex("[0-9A-HJKMNP-TV-Z]{4}-[0-9A-HJKMNP-TV-Z]{4}"));
  EXPECT_TRUE(access.pairing_step_of(code, kNow_s));
  EXPECT_TRUE(access.pairing_step_of(code, kNow_s + 569.0));
  EXPECT_FALSE(access.pairing_step_of(code, kNow_s + 600.0));
  EXPECT_FALSE(access.pairing_step_of(code, kNow_s - 30.0)) << "one of the future";
  EXPECT_FALSE(Access(Secret("another token entirely")).pairing_step_of(code, kNow_s));
  EXPECT_NE(code, access.pairing_code(kNow_s + 30.0)) << "for another browser";
}
TEST(Access, APairingCodeMayBeTypedAsPeopleDo) {
  const Access access(kToken);
  for (int step = 0; step < 200; ++step) {
    const double at_s = kNow_s + step * Access::kCodeStep_s;
    std::string typed = access.pairing_code(at_s);
    for (char& c : typed) c = c == '-' ? ' ' : c == '0' ? 'o' : c == '1' ? 'l' : static_cast<char>(std::tolower(c));
    EXPECT_TRUE(access.pairing_step_of(" " + typed, at_s)) << typed;
  }
  for (const std::string& other : {std::string(), std::string("--------"), std::string("K7QM"), std::string(5000, 'A')})
    EXPECT_FALSE(access.pairing_step_of(other, kNow_s));
}
TEST(Access, ASessionIsKnownByItsTokenAlone) {
  const Access access(kToken);
  const std::string id = Access::new_session_id();
  EXPECT_EQ(id.size(), Access::kSessionIdCharacters);
  EXPECT_NE(id, Access::new_session_id());
  const std::string session = access.session_of(id);
  EXPECT_THAT(session, Not(HasSubstr(kToken.reveal())));
  EXPECT_EQ(access.session_id_of(session), id);
  const Access other(Secret("another token entirely"));
  EXPECT_EQ(other.session_id_of(session), std::nullopt);
  EXPECT_NE(other.mark(), access.mark());
  EXPECT_THAT(access.mark(), Not(HasSubstr(kToken.reveal())));
}
TEST(Access, ASessionCannotBeMadeUp) {
  const Access access(kToken);
  const std::string session = access.session_of("0123456789");
  for (std::size_t at = 0; at < session.size(); ++at) {
    std::string other = session;
    other[at] = other[at] == '7' ? '8' : '7';
    EXPECT_FALSE(access.session_id_of(other)) << at;
    EXPECT_FALSE(access.session_id_of(session.substr(0, at))) << at;
  }
  for (const char* other : {"", ".", "x", "-1.", "0123456789", "0123456789."})
    EXPECT_FALSE(access.session_id_of(other)) << other;
}
TEST(PairingLimits, TenAtOnceOfAnAddressThenOneASecond) {
  PairingLimits limits;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(limits.take("10.0.0.1", 1000.0)) << i;
  EXPECT_FALSE(limits.take("10.0.0.1", 1000.0));
  EXPECT_FALSE(limits.take("10.0.0.1", 1000.9));
  EXPECT_TRUE(limits.take("10.0.0.2", 1000.9)) << "the owner is not locked out";
  EXPECT_TRUE(limits.take("10.0.0.1", 1001.1));
  EXPECT_FALSE(limits.take("10.0.0.1", 1001.2));
}
TEST(PairingLimits, AnyNumberOfAddressesTakesBoundedMemory) {
  PairingLimits limits;
  int allowed = 0;
  for (int i = 0; i < 100'000; ++i) allowed += limits.take("fd00::" + std::to_string(i), 1000.0) ? 1 : 0;
  EXPECT_EQ(allowed, static_cast<int>(PairingLimits::kMaxAddresses + PairingLimits::kBurst));
  EXPECT_TRUE(limits.take("10.0.0.1", 1020.0)) << "later";
}

http::Request from_elsewhere() {
  return {.method = "POST", .path = "/api/v1/scenes", .client = {.address = "192.168.1.30", .is_local = false}};
}

TEST(Permission, WithoutATokenFileThisMachineIsTrustedUnlessAProxySendsItForAnother) {
  http::Request request{.client = {.address = "127.0.0.1", .is_local = true}};
  EXPECT_TRUE(is_trusted(request, {}, kNow_s));
  request.is_forwarded = true;
  EXPECT_FALSE(is_trusted(request, {}, kNow_s));
  EXPECT_FALSE(is_trusted(from_elsewhere(), {}, kNow_s));
}
TEST(Permission, WithATokenFileRightsComeFromTheTokenAloneWhateverTheAddress) {
  const Access access(kToken);
  const Trust trust{.takes_token = true, .access = &access};
  for (const bool is_local : {true, false}) {
    http::Request request{.client = {.address = "127.0.0.1", .is_local = is_local}};
    EXPECT_FALSE(is_trusted(request, trust, kNow_s)) << "a plain proxy_pass looks like this machine";
    request.authorization = "Bearer " + kToken.reveal();
    EXPECT_TRUE(is_trusted(request, trust, kNow_s));
    EXPECT_FALSE(is_trusted(request, {.takes_token = true}, kNow_s)) << "the token cannot be read: nobody";
  }
}
TEST(Permission, OthersShowTheTokenOrASession) {
  const Access access(kToken);
  Pairings pairings;
  const Trust trust{.takes_token = true, .access = &access, .pairings = &pairings};
  http::Request request = from_elsewhere();
  EXPECT_FALSE(is_trusted(request, trust, kNow_s));
  request.authorization = "Bearer " + kToken.reveal();
  EXPECT_TRUE(is_trusted(request, trust, kNow_s));
  EXPECT_FALSE(is_trusted(request, {}, kNow_s)) << "no token is configured";
  for (const std::string& other : {std::string("Bearer "), "Basic " + kToken.reveal(), kToken.reveal()}) {
    request.authorization = other;
    EXPECT_FALSE(is_trusted(request, trust, kNow_s)) << other;
  }
  pairings.add("0123456789", "192.168.1.30", kNow_s);
  const std::string session = access.session_of("0123456789");
  for (const std::string& cookies : {"yuragi_session=" + session, "a=b; yuragi_session=" + session + "; c"}) {
    request.cookie = cookies;
    EXPECT_TRUE(is_trusted(request, trust, kNow_s)) << cookies;
  }
  for (const std::string& cookies :
       {"session=" + session, "xyuragi_session=" + session, std::string("yuragi_session"), std::string(";;=;")}) {
    request.cookie = cookies;
    EXPECT_FALSE(is_trusted(request, trust, kNow_s)) << cookies;
  }
}
TEST(Permission, ReadingIsFreeUnlessItTakesTheToken) {
  const Access access(kToken);
  const Trust trust{.takes_token = true, .access = &access};
  http::Request request = from_elsewhere();
  EXPECT_EQ(permission_refusal(request, false, trust, false)->status, 401U);
  EXPECT_THAT(permission_refusal(request, false, trust, false)->body, HasSubstr("yuragi token"));
  EXPECT_THAT(permission_refusal(request, false, {}, false)->body, HasSubstr("no [http] token_file"));
  EXPECT_THAT(permission_refusal(request, false, {.takes_token = true}, false)->body, HasSubstr("cannot be read"));
  EXPECT_FALSE(permission_refusal(request, true, trust, true));
  for (const char* method : {"GET", "HEAD"}) {
    request.method = method;
    EXPECT_FALSE(permission_refusal(request, false, trust, false));
    EXPECT_EQ(permission_refusal(request, false, trust, true)->status, 401U);
  }
}
TEST(Permission, APairedBrowserIsLetInByItsCookieAlone) {
  const Access access(kToken);
  Pairings pairings;
  const Trust trust{.takes_token = true, .access = &access, .pairings = &pairings};
  PairingLimits limits;
  http::Request request = from_elsewhere();
  const auto answer_to_code = [&](const std::string& code, const Trust& by = {}) {
    return pairing_answer(code, request, request.client.address, by, limits, pairings, kNow_s, 0.0);
  };
  EXPECT_EQ(answer_to_code("0000-0000", trust).status, 403U);
  EXPECT_EQ(answer_to_code("0000-0000").status, 409U);
  EXPECT_EQ(answer_to_code("0000-0000", {.takes_token = true}).status, 409U);
  request.is_https = true;
  const http::Response paired = answer_to_code(access.pairing_code(kNow_s), trust);
  ASSERT_EQ(paired.status, 200U);
  ASSERT_EQ(paired.fields.size(), 1U);
  const std::string& cookie = paired.fields[0].second;
  EXPECT_THAT(cookie, HasSubstr("; HttpOnly; SameSite=Strict; Secure"));
  EXPECT_THAT(answer_to_code(access.pairing_code(kNow_s), trust).body, HasSubstr("has been used"));
  while (answer_to_code("0000-0000", trust).status == 403U) {
  }
  EXPECT_EQ(answer_to_code(access.pairing_code(kNow_s), trust).status, 429U) << "a guesser does not get far";
  request.client.address = "192.168.1.31";
  EXPECT_EQ(answer_to_code(access.pairing_code(kNow_s - 30.0), trust).status, 200U) << "and locks nobody out";
  request.cookie = cookie.substr(0, cookie.find(';'));
  EXPECT_TRUE(is_trusted(request, trust, kNow_s + 3600.0));
  EXPECT_EQ(session_shown(request, {.takes_token = true, .access = &access}, kNow_s), std::nullopt);
  const std::string id = session_shown(request, trust, kNow_s).value();
  EXPECT_TRUE(pairings.revoke(id));
  EXPECT_FALSE(is_trusted(request, trust, kNow_s)) << "revoked, although its signature is valid";
}
TEST(Permission, OnlyProxiesAreBelievedForWhomTheySpeak) {
  const std::array<std::string, 2> proxies = {"127.0.0.1", "10.0.0.7"};
  http::Request request{.forwarded_for = "1.2.3.4, 192.168.1.30", .client = {.address = "127.0.0.1", .is_local = true}};
  EXPECT_EQ(client_address(request, {}), "127.0.0.1");
  EXPECT_EQ(client_address(request, proxies), "192.168.1.30") << "what stands before it anybody may have written";
  request.forwarded_for = "192.168.1.30,10.0.0.7";
  EXPECT_EQ(client_address(request, proxies), "192.168.1.30");
  for (const char* const none : {"", ",", " , "}) {
    request.forwarded_for = none;
    EXPECT_EQ(client_address(request, proxies), "127.0.0.1") << none;
  }
  request.forwarded_for = std::string(5000, 'x');
  EXPECT_EQ(client_address(request, proxies), "127.0.0.1");
  request.forwarded_for = "a\x1b[2J\xff";
  EXPECT_EQ(client_address(request, proxies), "a?[2J?");
}

}  // namespace
}  // namespace yuragi::daemon::web
