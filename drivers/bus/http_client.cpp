#include "drivers/bus/http_client.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <mutex>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

#include <curl/curl.h>

#include "engine/base/close_on_exec.hpp"
#include "engine/base/printable_text.hpp"
#include "engine/base/version.hpp"

namespace yuragi::drivers::bus {
namespace {

constexpr std::size_t kMaxHeader = 64UL * 1024;  ///< all lines of a reply's header
constexpr std::size_t kMaxEtag = 256;
constexpr int kLongestWait_ms = 1000;

using CurlUrl = std::unique_ptr<CURLU, decltype(&curl_url_cleanup)>;
using CurlText = std::unique_ptr<char, decltype(&curl_free)>;
using CurlHandle = std::unique_ptr<CURL, decltype(&curl_easy_cleanup)>;
using CurlMulti = std::unique_ptr<CURLM, decltype(&curl_multi_cleanup)>;
using CurlHeaders = std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)>;

template <class Pointer>
Pointer made(Pointer pointer) {
  if (!pointer) throw std::bad_alloc();
  return pointer;
}

/// A part of a URL; empty if it has none.
std::string part_of(CURLU* url, CURLUPart part, unsigned flags = 0) {
  char* text = nullptr;
  if (curl_url_get(url, part, &text, flags) != CURLUE_OK) return {};
  const CurlText owner(text, &curl_free);
  return text;
}

/// With the port that it is to have. Throws std::bad_alloc.
CurlUrl parsed(const std::string& text, std::uint16_t port = 0) {
  CurlUrl url = made(CurlUrl(curl_url(), &curl_url_cleanup));
  if (curl_url_set(url.get(), CURLUPART_URL, text.c_str(), 0) != CURLUE_OK) url.reset();
  if (url && port != 0) curl_url_set(url.get(), CURLUPART_PORT, std::to_string(port).c_str(), 0);
  return url;
}

std::string printable_host(const std::string& url_text) {
  const CurlUrl url = parsed(url_text);
  std::string host = url ? part_of(url.get(), CURLUPART_HOST) : std::string();
  make_printable(host);
  return shortened(host, 80);
}

void append_header(CurlHeaders& headers, const std::string& line) {
  curl_slist* const longer = curl_slist_append(headers.get(), line.c_str());
  if (longer == nullptr) throw std::bad_alloc();
  static_cast<void>(headers.release());
  headers.reset(longer);
}

int keep_from_programs(void* /*user*/, curl_socket_t socket, curlsocktype /*purpose*/) {
  close_on_exec(socket);
  return CURL_SOCKOPT_OK;
}

/// An entity tag (RFC 9110, 8.8.3) that can be sent back as it is; empty for anything else.
std::string entity_tag(std::string_view value) {
  const auto begin = value.find_first_not_of(" \t");
  const auto end = value.find_last_not_of(" \t\r\n");
  if (begin == std::string_view::npos || end - begin >= kMaxEtag) return {};
  value = value.substr(begin, end - begin + 1);
  const bool is_visible = std::ranges::all_of(value, [](char c) { return c > ' ' && c <= '~'; });
  const bool is_quoted =
      value.size() >= 2 && value.back() == '"' && (value.front() == '"' || value.starts_with("W/\""));
  return is_visible && is_quoted ? std::string(value) : std::string();
}

/// What comes in for one request. What libcurl calls must not throw.
struct Incoming {
  std::size_t max_body;
  HttpReply reply{};
  std::size_t header_bytes = 0;
  bool is_too_long = false;
  bool is_without_memory = false;

  std::size_t take(std::size_t size, std::size_t& taken, std::size_t most, auto&& use) noexcept {
    taken += size;
    is_too_long = is_too_long || taken > most;
    if (is_too_long) return 0;
    try {
      use();
    } catch (const std::bad_alloc&) {
      is_without_memory = true;
      return 0;
    }
    return size;
  }
};

std::size_t take_body(char* text, std::size_t size, std::size_t count, void* user) {
  auto& incoming = *static_cast<Incoming*>(user);
  std::size_t taken = incoming.reply.body.size();
  return incoming.take(size * count, taken, incoming.max_body, [&] { incoming.reply.body.append(text, size * count); });
}

std::size_t take_header(char* text, std::size_t size, std::size_t count, void* user) {
  constexpr std::string_view kEtag = "etag:";
  auto& incoming = *static_cast<Incoming*>(user);
  const std::string_view line(text, size * count);
  return incoming.take(line.size(), incoming.header_bytes, kMaxHeader, [&] {
    const bool is_etag = line.size() > kEtag.size() &&
                         std::ranges::equal(line.substr(0, kEtag.size()), kEtag, {}, [](char c) { return c | ' '; });
    if (is_etag) incoming.reply.etag = entity_tag(line.substr(kEtag.size()));
  });
}

HttpTrouble trouble_of(CURLcode code, const Incoming& incoming) {
  // It is out of memory for a line of a header that is longer than it takes.
  if (incoming.is_too_long || code == CURLE_FILESIZE_EXCEEDED || code == CURLE_OUT_OF_MEMORY)
    return HttpTrouble::kTooLong;
  switch (code) {
    case CURLE_OPERATION_TIMEDOUT:
      return HttpTrouble::kTimeout;
    case CURLE_PEER_FAILED_VERIFICATION:
    case CURLE_SSL_CACERT_BADFILE:
    case CURLE_SSL_ISSUER_ERROR:
      return HttpTrouble::kCertificate;
    case CURLE_PARTIAL_FILE:
    case CURLE_RECV_ERROR:
    case CURLE_GOT_NOTHING:
      return HttpTrouble::kCut;
    case CURLE_UNSUPPORTED_PROTOCOL:
    case CURLE_WEIRD_SERVER_REPLY:
    case CURLE_BAD_CONTENT_ENCODING:
      return HttpTrouble::kNotHttp;
    default:
      return HttpTrouble::kUnreachable;
  }
}

class CurlClient final : public HttpClient {
 public:
  explicit CurlClient(HttpResource resource) : resource_(std::move(resource)), agent_(with_version("yuragi")) {
    static std::once_flag once;
    std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
    multi_ = made(CurlMulti(curl_multi_init(), &curl_multi_cleanup));
    url_ = parsed(resource_.url.reveal(), resource_.port);
  }

  Result<HttpReply, HttpFailure> get(const std::string& known_etag) override {
    if (!url_) return HttpFailure{HttpTrouble::kUnreachable, "the URL is not valid"};
    Incoming incoming{.max_body = resource_.max_body};
    std::array<char, CURL_ERROR_SIZE> text{};
    const CurlHeaders headers = request_headers(known_etag);
    const CurlHandle handle = made(CurlHandle(curl_easy_init(), &curl_easy_cleanup));
    set_up(handle.get(), headers.get(), incoming, text);

    const auto code = perform(handle.get());
    if (incoming.is_without_memory) throw std::bad_alloc();
    if (!code) return HttpFailure{HttpTrouble::kInterrupted, "interrupted"};
    if (*code != CURLE_OK) return failure_of(handle.get(), *code, incoming, text.data());
    return finished(handle.get(), incoming);
  }

  void interrupt() noexcept override {
    is_interrupted_ = true;
    curl_multi_wakeup(multi_.get());
  }

 private:
  CurlHeaders request_headers(const std::string& known_etag) const {
    CurlHeaders headers(nullptr, &curl_slist_free_all);
    append_header(headers, "Accept: application/json");
    for (const Secret& line : resource_.headers) append_header(headers, line.reveal());
    if (!known_etag.empty()) append_header(headers, "If-None-Match: " + known_etag);
    return headers;
  }

  void set_up(CURL* request, curl_slist* headers, Incoming& incoming, std::array<char, CURL_ERROR_SIZE>& text) {
    const auto timeout_ms =
        static_cast<long>(std::chrono::duration_cast<std::chrono::milliseconds>(resource_.timeout).count());
    curl_easy_setopt(request, CURLOPT_CURLU, url_.get());
    curl_easy_setopt(request, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(request, CURLOPT_FOLLOWLOCATION, 0L);
    curl_easy_setopt(request, CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
    curl_easy_setopt(request, CURLOPT_SSLVERSION, static_cast<long>(CURL_SSLVERSION_TLSv1_2));
    curl_easy_setopt(request, CURLOPT_SSL_VERIFYPEER, 1L);
    curl_easy_setopt(request, CURLOPT_SSL_VERIFYHOST, 2L);
    if (!resource_.ca_file.empty()) {
      curl_easy_setopt(request, CURLOPT_CAINFO, resource_.ca_file.c_str());
      curl_easy_setopt(request, CURLOPT_CAPATH, nullptr);
    }
    curl_easy_setopt(request, CURLOPT_HTTPHEADER, headers);
    curl_easy_setopt(request, CURLOPT_USERAGENT, agent_.c_str());
    curl_easy_setopt(request, CURLOPT_TIMEOUT_MS, timeout_ms);
    curl_easy_setopt(request, CURLOPT_CONNECTTIMEOUT_MS, timeout_ms);
    curl_easy_setopt(request, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(request, CURLOPT_QUICK_EXIT, 1L);  // does not wait for an abandoned look-up of a name
    curl_easy_setopt(request, CURLOPT_MAXFILESIZE_LARGE, static_cast<curl_off_t>(resource_.max_body));
    curl_easy_setopt(request, CURLOPT_WRITEFUNCTION, &take_body);
    curl_easy_setopt(request, CURLOPT_WRITEDATA, &incoming);
    curl_easy_setopt(request, CURLOPT_HEADERFUNCTION, &take_header);
    curl_easy_setopt(request, CURLOPT_HEADERDATA, &incoming);
    curl_easy_setopt(request, CURLOPT_ERRORBUFFER, text.data());
    curl_easy_setopt(request, CURLOPT_SOCKOPTFUNCTION, &keep_from_programs);
  }

  /// Returns libcurl's result; nullopt if it was interrupted.
  std::optional<CURLcode> perform(CURL* request) {
    if (curl_multi_add_handle(multi_.get(), request) != CURLM_OK) return CURLE_FAILED_INIT;
    std::optional<CURLcode> code = CURLE_FAILED_INIT;
    for (int running = 1;;) {
      if (is_interrupted_) {
        code.reset();
        break;
      }
      if (curl_multi_perform(multi_.get(), &running) != CURLM_OK) break;
      if (running == 0) {
        int left = 0;
        const CURLMsg* const message = curl_multi_info_read(multi_.get(), &left);
        if (message != nullptr) code = message->data.result;
        break;
      }
      if (curl_multi_poll(multi_.get(), nullptr, 0, kLongestWait_ms, nullptr) != CURLM_OK) break;
    }
    curl_multi_remove_handle(multi_.get(), request);
    return code;
  }

  HttpFailure failure_of(CURL* request, CURLcode code, const Incoming& incoming, const char* text) const {
    HttpFailure failure{trouble_of(code, incoming), curl_easy_strerror(code)};
    // libcurl's own text has the reason why a certificate is refused; of a connection it has times that differ.
    if (failure.trouble == HttpTrouble::kCertificate && *text != '\0') failure.reason = text;
    long error = 0;
    if (code == CURLE_COULDNT_CONNECT && curl_easy_getinfo(request, CURLINFO_OS_ERRNO, &error) == CURLE_OK && error > 0)
      failure.reason = std::error_code(static_cast<int>(error), std::generic_category()).message();
    make_printable(failure.reason);
    failure.reason = shortened(failure.reason, 160);
    return failure;
  }

  static HttpReply finished(CURL* request, Incoming& incoming) {
    long status = 0;
    curl_off_t retry_s = 0;
    char* redirect = nullptr;
    curl_easy_getinfo(request, CURLINFO_RESPONSE_CODE, &status);
    curl_easy_getinfo(request, CURLINFO_RETRY_AFTER, &retry_s);
    curl_easy_getinfo(request, CURLINFO_REDIRECT_URL, &redirect);
    HttpReply reply = std::move(incoming.reply);
    reply.status = static_cast<int>(status);
    constexpr curl_off_t kDay_s = 86400;
    if (retry_s > 0) reply.retry_after = std::chrono::seconds(std::min(retry_s, kDay_s));
    if (redirect != nullptr) reply.redirect_host = printable_host(redirect);
    return reply;
  }

  HttpResource resource_;
  std::string agent_;
  CurlUrl url_{nullptr, &curl_url_cleanup};
  CurlMulti multi_{nullptr, &curl_multi_cleanup};
  std::atomic<bool> is_interrupted_ = false;
};

}  // namespace

Result<UrlParts, Failure> url_parts(const std::string& text) {
  const CurlUrl url = parsed(text);
  const std::string scheme = url ? part_of(url.get(), CURLUPART_SCHEME) : std::string();
  if (scheme != "http" && scheme != "https") return Failure{"must be a URL that begins with http:// or https://"};
  UrlParts parts{.is_https = scheme == "https", .host = part_of(url.get(), CURLUPART_HOST)};
  if (parts.host.starts_with('[') && parts.host.ends_with(']'))
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  const std::string port = part_of(url.get(), CURLUPART_PORT, CURLU_DEFAULT_PORT);
  std::from_chars(port.data(), port.data() + port.size(), parts.port);
  parts.path_and_query = part_of(url.get(), CURLUPART_PATH) + "?" + part_of(url.get(), CURLUPART_QUERY);
  if (parts.host.empty() || parts.port == 0) return Failure{"names no server"};
  return parts;
}

std::unique_ptr<HttpClient> make_http_client(HttpResource resource) {
  return std::make_unique<CurlClient>(std::move(resource));
}

}  // namespace yuragi::drivers::bus
