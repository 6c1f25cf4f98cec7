#include "daemon/web/pairings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/web/access.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::web {
namespace {

using nlohmann::json;

/// Codes of the future, which were used before the clock was set back, count, too.
constexpr std::size_t kMaxUsedCodes = 64;
/// Of an IPv6 address with its zone.
constexpr std::size_t kMaxAddressCharacters = 64;
/// Until the year 5138; also a limit of steps.
constexpr std::int64_t kMaxTime_s = 100'000'000'000;

bool is_too_old(const PairedBrowser& browser, double utc_s) {
  // A date in the future means that the clock was set after the pairing.
  return utc_s - static_cast<double>(browser.since_utc_s) > static_cast<double>(Pairings::kSession_s);
}

std::int64_t whole_seconds(double utc_s) {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(utc_s)), 0, kMaxTime_s);
}

// These throw json::exception if a value is missing, of another type or out of range.

[[noreturn]] void fail() {
  throw json::other_error::create(0, "out of range", nullptr);
}

std::int64_t whole_number(const json& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::uint64_t{kMaxTime_s}) fail();
  return value.get<std::int64_t>();
}

std::string text_at(const json& object, const char* key, std::size_t max_characters) {
  std::string text = object.at(key).get<std::string>();
  if (text.size() > max_characters) fail();
  make_printable(text);
  return text;
}

PairedBrowser browser_of(const json& object) {
  PairedBrowser browser{.id = text_at(object, "id", Access::kSessionIdCharacters),
                        .since_utc_s = whole_number(object.at("since_s")),
                        .last_use_utc_s = whole_number(object.at("last_use_s")),
                        .address = text_at(object, "address", kMaxAddressCharacters)};
  if (browser.id.size() != Access::kSessionIdCharacters) fail();
  return browser;
}

}  // namespace

bool Pairings::use_code(std::int64_t step) {
  std::erase_if(used_codes_, [step](std::int64_t used) { return used <= step - Access::kCodeSteps; });
  if (!used_codes_.insert(step).second) return false;
  if (used_codes_.size() > kMaxUsedCodes) used_codes_.erase(std::prev(used_codes_.end()));
  return true;
}

void Pairings::add(std::string id, std::string address, double utc_s) {
  std::erase_if(browsers_, [utc_s](const PairedBrowser& browser) { return is_too_old(browser, utc_s); });
  if (browsers_.size() >= kMaxBrowsers)
    browsers_.erase(std::ranges::min_element(browsers_, {}, &PairedBrowser::last_use_utc_s));
  const std::int64_t now_s = whole_seconds(utc_s);
  address.resize(std::min(address.size(), kMaxAddressCharacters));
  browsers_.push_back(
      {.id = std::move(id), .since_utc_s = now_s, .last_use_utc_s = now_s, .address = std::move(address)});
}

bool Pairings::is_valid(std::string_view id, double utc_s) const {
  const auto found = std::ranges::find(browsers_, id, &PairedBrowser::id);
  return found != browsers_.end() && !is_too_old(*found, utc_s);
}

bool Pairings::note_use(std::string_view id, std::string_view address, double utc_s) {
  const auto found = std::ranges::find(browsers_, id, &PairedBrowser::id);
  const std::int64_t now_s = whole_seconds(utc_s);
  if (found == browsers_.end() || std::abs(now_s - found->last_use_utc_s) < kUseAccuracy_s) return false;
  found->last_use_utc_s = now_s;
  found->address = address.substr(0, kMaxAddressCharacters);
  return true;
}

bool Pairings::revoke(std::string_view id) {
  return std::erase_if(browsers_, [id](const PairedBrowser& browser) { return browser.id == id; }) > 0;
}

std::vector<PairedBrowser> Pairings::browsers(double utc_s) const {
  std::vector<PairedBrowser> valid;
  std::ranges::copy_if(browsers_, std::back_inserter(valid),
                       [utc_s](const PairedBrowser& browser) { return !is_too_old(browser, utc_s); });
  return valid;
}

std::string Pairings::text() const {
  json browsers = json::array();
  for (const PairedBrowser& browser : browsers_) {
    browsers.push_back({{"id", browser.id},
                        {"since_s", browser.since_utc_s},
                        {"last_use_s", browser.last_use_utc_s},
                        {"address", browser.address}});
  }
  return json_text(json{{"token_mark", token_mark_}, {"used_codes", used_codes_}, {"browsers", browsers}}, 1) + '\n';
}

Result<Pairings, Failure> Pairings::parse(std::string_view text) {
  constexpr int kMaxDepth = 3;
  Pairings pairings;
  try {
    const json all = json::parse(text, [](int depth, json::parse_event_t /*event*/, json& /*parsed*/) {
      if (depth > kMaxDepth) fail();
      return true;
    });
    pairings.token_mark_ = text_at(all, "token_mark", kMaxAddressCharacters);
    for (const json& code : all.at("used_codes").get_ref<const json::array_t&>())
      pairings.used_codes_.insert(whole_number(code));
    for (const json& one : all.at("browsers").get_ref<const json::array_t&>()) {
      PairedBrowser browser = browser_of(one);
      if (std::ranges::find(pairings.browsers_, browser.id, &PairedBrowser::id) != pairings.browsers_.end()) fail();
      pairings.browsers_.push_back(std::move(browser));
      if (pairings.browsers_.size() > kMaxBrowsers) fail();
    }
    if (pairings.used_codes_.size() > kMaxUsedCodes) fail();
  } catch (const json::exception&) {
    return Failure{"is damaged"};
  }
  return pairings;
}

}  // namespace yuragi::daemon::web
