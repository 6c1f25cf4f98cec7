#include "daemon/feeds/osc_query_feed.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/feeds/announcement.hpp"
#include "daemon/feeds/osc_addresses.hpp"
#include "daemon/feeds/osc_query_answer.hpp"
#include "daemon/feeds/osc_query_sockets.hpp"
#include "daemon/http/server.hpp"
#include "drivers/bus/sender_filter.hpp"
#include "engine/base/address.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/known_host.hpp"

namespace yuragi::daemon::feeds {
namespace {

constexpr auto kOpenAgainAfter = std::chrono::seconds(5);
/// For requests, of a tick; the others wait for the next one.
constexpr auto kMaxTime = std::chrono::milliseconds(4);

std::string host_name() {
  boost::system::error_code ignored;
  return boost::asio::ip::host_name(ignored);
}

/// The port at which other machines reach what listens at an address; 0: they do not.
std::uint16_t port_for_others(const std::string& listen) {
  const auto address = parse_address(listen.starts_with(':') ? "0.0.0.0" + listen : listen);
  if (!address) return 0;
  const auto is_here = drivers::bus::is_loopback(address->host);
  return address->host == "localhost" || (is_here && *is_here) ? std::uint16_t{0} : address->port;
}

class OscQueryFeed final : public Feed {
 public:
  OscQueryFeed(settings::feeds::OscQuery config, const Surroundings& around)
      : config_(std::move(config)), page_listen_(around.page_listen) {}

  void send(const values::Moment& moment) override {
    moment_ = &moment;
    rename();
    if (!server_) open();
    if (server_) {
      sockets_.send(moment, config_.wind);
      serve();
      for (Announcement& announcement : announcements_) announcement.check(moment.mono);
    }
    moment_ = nullptr;
  }

  Status status() const override {
    return {.kind = "osc_query",
            .name = config_.name,
            .target = server_ ? server_->local_endpoint() : config_.listen,
            .sends = fmt::format("{} to {}", count_text(addresses_->size(), "value"),
                                 count_text(sockets_.clients(), "listener")),
            .messages = sockets_.messages(),
            .bytes = sockets_.bytes(),
            .last_sent = sockets_.last_sent(),
            .trouble = trouble_.empty() ? announcement_trouble() : trouble_};
  }

 private:
  std::string announcement_trouble() const {
    const auto found = std::ranges::find_if(announcements_, [](const auto& one) { return !one.trouble().empty(); });
    return found != announcements_.end() ? found->trouble() : std::string();
  }

  /// It, the page and the sensors, if other machines reach them.
  void announce() {
    if (!config_.announces) return;
    std::vector<settings::feeds::NetworkService> services = config_.sensors;
    services.push_back({.type = "_oscjson._tcp", .address = server_->local_endpoint()});
    if (!page_listen_.empty()) services.push_back({.type = "_http._tcp", .address = page_listen_});
    for (const auto& [type, address] : services) {
      if (const std::uint16_t port = port_for_others(address); port != 0)
        announcements_.emplace_back(config_.name, type, port);
    }
  }

  void rename() {
    if (moment_->names == names_) return;
    names_ = moment_->names;
    addresses_ = std::make_shared<const std::vector<OscAddress>>(osc_addresses_of(*names_));
    sockets_.set_addresses(addresses_);
  }

  void open() {
    if (tried_ && moment_->mono - *tried_ < kOpenAgainAfter) return;
    tried_ = moment_->mono;
    try {
      server_.emplace(io_, config_.listen, http::Limits{},
                      [this](const http::Request& request, const http::Reply& reply) { reply(answer(request)); });
      if (!trouble_.empty()) spdlog::info("feed osc_query: listens at {} again", config_.listen);
      trouble_.clear();
      announce();
    } catch (const FailureError& error) {
      if (trouble_.empty()) spdlog::warn("feed osc_query: {}; it is tried again", error.what());
      trouble_ = error.what();
    }
  }

  void serve() {
    const auto begun = std::chrono::steady_clock::now();
    io_.restart();
    while (io_.poll_one() > 0 && std::chrono::steady_clock::now() - begun < kMaxTime) {
    }
  }

  http::Response answer(const http::Request& request) {
    constexpr const char* kText = "text/plain; charset=utf-8";
    if (!is_known_host(request.host, hosts_))
      return {.status = 421, .content_type = kText, .body = "this is not a name of this machine: use its address\n"};
    if (!is_same_origin(request.origin, request.host, request.is_https))
      return {.status = 403, .content_type = kText, .body = "pages of other servers may not read this\n"};
    if (request.is_websocket) {
      if (auto why = sockets_.refusal(request.client))
        return {.status = 503, .content_type = kText, .body = std::move(*why) + "\n"};
      return {.take_over = [this](http::Upgrade& upgrade) { sockets_.open(upgrade); }};
    }
    if (request.method != "GET" && request.method != "HEAD")
      return {.status = 405, .content_type = kText, .body = "nothing can be set here\n", .fields = {{"Allow", "GET"}}};
    return osc_query_answer(request.path, request.query, config_.name, *addresses_, *moment_, config_.wind);
  }

  settings::feeds::OscQuery config_;
  const std::array<std::string, 1> hosts_ = {host_name()};
  boost::asio::io_context io_{1};
  OscQuerySockets sockets_;
  std::optional<http::Server> server_;  ///< nullopt: it cannot listen
  std::optional<MonoTime> tried_;
  std::string trouble_;
  std::string page_listen_;
  std::vector<Announcement> announcements_;  ///< since it listens
  std::shared_ptr<const values::Names> names_;
  std::shared_ptr<const std::vector<OscAddress>> addresses_ = std::make_shared<const std::vector<OscAddress>>();
  const values::Moment* moment_ = nullptr;  ///< during send()
};

}  // namespace

std::unique_ptr<Feed> make_osc_query_feed(const settings::feeds::OscQuery& config, const Surroundings& around) {
  return std::make_unique<OscQueryFeed>(config, around);
}

}  // namespace yuragi::daemon::feeds
