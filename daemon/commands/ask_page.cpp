#include "daemon/commands/ask_page.hpp"

#include <memory>
#include <string_view>

#include <curl/curl.h>
#include <fmt/format.h>

#include "daemon/commands/exit.hpp"
#include "engine/base/address.hpp"
#include "engine/base/printable_text.hpp"
#include "engine/base/version.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr long kTimeout_s = 10;
constexpr std::size_t kMaxAnswer_bytes = 1U << 20U;
constexpr long kHttpUnauthorized = 401;

using Handle = std::unique_ptr<CURL, decltype(&curl_easy_cleanup)>;
using Fields = std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)>;

/// Called by libcurl with each part of the answer; another number than the part's size ends the request.
std::size_t append(char* part, std::size_t size, std::size_t count, void* answer) noexcept {
  try {
    auto& text = *static_cast<std::string*>(answer);
    if (text.size() + size * count > kMaxAnswer_bytes) return 0;
    text.append(part, size * count);
    return size * count;
  } catch (...) {
    return 0;
  }
}

/// Returns the address at which a daemon that listens there is reached from this machine.
Address address_of(const std::string& listen) {
  Address address = parse_address(listen).value();
  if (address.host == "0.0.0.0") address.host = "127.0.0.1";
  if (address.host == "::") address.host = "::1";
  return address;
}

}  // namespace

nlohmann::json ask_page(const PageRequest& request) {
  const bool is_tls = !request.certificate.empty();
  const std::string place = (is_tls ? "https://" : "http://") + to_string(address_of(request.listen));
  const std::string url = place + request.path;
  const std::string agent = with_version("yuragi");
  std::string answer;
  const Handle handle(curl_easy_init(), &curl_easy_cleanup);
  const Fields fields(curl_slist_append(nullptr, "Content-Type: application/json"), &curl_slist_free_all);
  if (!handle || !fields) throw FailureError({"out of memory for a request"});
  CURL* const curl = handle.get();
  curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, is_tls ? "https" : "http");
  if (is_tls) {
    curl_easy_setopt(curl, CURLOPT_CAINFO, request.certificate.c_str());
    curl_easy_setopt(curl, CURLOPT_SSL_VERIFYHOST, 0L);  // it is for a name, and this machine is asked by address
  }
  curl_easy_setopt(curl, CURLOPT_NOPROXY, "*");  // the token is for this machine only
  curl_easy_setopt(curl, CURLOPT_USERAGENT, agent.c_str());
  curl_easy_setopt(curl, CURLOPT_HTTPAUTH, CURLAUTH_BEARER);
  curl_easy_setopt(curl, CURLOPT_XOAUTH2_BEARER, request.token.reveal().c_str());
  curl_easy_setopt(curl, CURLOPT_TIMEOUT, kTimeout_s);
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, &append);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer);
  if (!request.body.empty()) {
    curl_easy_setopt(curl, CURLOPT_HTTPHEADER, fields.get());
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body.size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, request.body.c_str());
  }

  if (const CURLcode code = curl_easy_perform(curl); code != CURLE_OK) {
    throw FailureError(
        {fmt::format("no daemon replies at {} ({}): is `yuragi run` running?", place, curl_easy_strerror(code)),
         FailureKind::kUnavailable});
  }
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  nlohmann::json json = nlohmann::json::parse(answer, nullptr, false);
  if (!json.is_object()) {
    throw FailureError(
        {fmt::format("{} replies with something other than JSON (HTTP {}): it is not the daemon", place, status),
         FailureKind::kUnavailable});
  }
  if (status >= 200 && status < 300) return json;
  const auto detail = json.find("detail");
  std::string why = detail != json.end() && detail->is_string() ? detail->get<std::string>() : "no reason is given";
  make_printable(why);
  throw ExitError(status == kHttpUnauthorized ? kExitNoPermission : kExitSoftware,
                  fmt::format("the daemon at {} refuses this (HTTP {}): {}", place, status, why));
}

}  // namespace yuragi::daemon::commands
