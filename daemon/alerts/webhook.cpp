#include "daemon/alerts/webhook.hpp"

#include <memory>
#include <mutex>
#include <string_view>

#include <curl/curl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/base/close_on_exec.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/version.hpp"

namespace yuragi::daemon::alerts {
namespace {

constexpr long kConnect_s = 10;
constexpr long kWhole_s = 20;

using Handle = std::unique_ptr<CURL, decltype(&curl_easy_cleanup)>;
using Fields = std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)>;
using Url = std::unique_ptr<CURLU, decltype(&curl_url_cleanup)>;

std::string host_of(const Secret& webhook) {
  const Url url(curl_url(), &curl_url_cleanup);
  char* host = nullptr;
  if (!url || curl_url_set(url.get(), CURLUPART_URL, webhook.reveal().c_str(), 0) != CURLUE_OK ||
      curl_url_get(url.get(), CURLUPART_HOST, &host, 0) != CURLUE_OK)
    return "its URL";
  std::string text = host;
  curl_free(host);
  return text;
}

std::size_t ignore_answer(char* /*text*/, std::size_t size, std::size_t count, void* /*user*/) {
  return size * count;
}

int keep_from_children(void* /*user*/, curl_socket_t socket, curlsocktype /*purpose*/) {
  close_on_exec(socket);
  return CURL_SOCKOPT_OK;
}

int is_stopped(void* stop, curl_off_t /*of*/, curl_off_t /*received*/, curl_off_t /*to*/, curl_off_t /*sent*/) {
  return static_cast<const std::stop_token*>(stop)->stop_requested() ? 1 : 0;
}

}  // namespace

std::string webhook_body(const News& news, const std::string& host) {
  const auto time = std::chrono::floor<std::chrono::seconds>(news.time);
  const nlohmann::ordered_json body = {
      {"alert", news.alert},
      {"state", news.has_begun ? "began" : "ended"},
      {"message", news.message},
      {"host", host},
      {"time", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)))},
      {"text", fmt::format("Yuragi on {}: {}", host, news.message)}};
  return json_text(body);
}

Result<void, Failure> post_to_webhook(const News& news, const std::string& host, const std::stop_token& stop) {
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });

  const std::string body = webhook_body(news, host);
  const std::string agent = with_version("yuragi");
  const Handle handle(curl_easy_init(), &curl_easy_cleanup);
  const Fields fields(curl_slist_append(nullptr, "Content-Type: application/json"), &curl_slist_free_all);
  if (!handle || !fields) return Failure{"out of memory for a request"};
  CURL* const request = handle.get();
  curl_easy_setopt(request, CURLOPT_URL, news.webhook.reveal().c_str());
  curl_easy_setopt(request, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(request, CURLOPT_HTTPHEADER, fields.get());
  curl_easy_setopt(request, CURLOPT_USERAGENT, agent.c_str());
  curl_easy_setopt(request, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body.size()));
  curl_easy_setopt(request, CURLOPT_POSTFIELDS, body.c_str());
  curl_easy_setopt(request, CURLOPT_CONNECTTIMEOUT, kConnect_s);
  curl_easy_setopt(request, CURLOPT_TIMEOUT, kWhole_s);
  curl_easy_setopt(request, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(request, CURLOPT_QUICK_EXIT, 1L);  // does not wait for an abandoned look-up of a name
  curl_easy_setopt(request, CURLOPT_WRITEFUNCTION, &ignore_answer);
  curl_easy_setopt(request, CURLOPT_SOCKOPTFUNCTION, &keep_from_children);
  curl_easy_setopt(request, CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(request, CURLOPT_XFERINFOFUNCTION, &is_stopped);
  curl_easy_setopt(request, CURLOPT_XFERINFODATA, &stop);

  const CURLcode code = curl_easy_perform(request);
  if (code != CURLE_OK)
    return Failure{fmt::format("{} cannot be reached ({})", host_of(news.webhook), curl_easy_strerror(code))};
  long status = 0;
  curl_easy_getinfo(request, CURLINFO_RESPONSE_CODE, &status);
  if (status < 200 || status >= 300)
    return Failure{fmt::format("{} replies with HTTP {}: check the webhook", host_of(news.webhook), status)};
  return {};
}

}  // namespace yuragi::daemon::alerts
