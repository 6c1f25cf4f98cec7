#include "daemon/web/web_server.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

#include "daemon/http/certificate_files.hpp"
#include "daemon/http/server.hpp"
#include "daemon/stream/client_log.hpp"
#include "daemon/web/cross_origin.hpp"
#include "daemon/web/installed_files.hpp"
#include "daemon/web/page.hpp"
#include "daemon/web/pairings_file.hpp"
#include "daemon/web/permission.hpp"
#include "daemon/web/problem.hpp"
#include "daemon/web/routes.hpp"
#include "daemon/web/site.hpp"
#include "daemon/web/sockets.hpp"
#include "daemon/web/wind_memory.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/known_host.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::web {
namespace {

namespace asio = boost::asio;
using std::chrono::steady_clock;

/// New scenes are made, and wait for those that still fade.
constexpr Nanoseconds kMaxChange = std::chrono::seconds(60);

/// Reading the list of recordings, or the configuration.
constexpr Nanoseconds kMaxArchive = std::chrono::seconds(60);

constexpr auto kCertificateAgainAfter = std::chrono::hours(1);

std::shared_ptr<http::CertificateFiles> certificate_of(const Settings& settings) {
  if (settings.certificate.empty()) return nullptr;
  return std::make_shared<http::CertificateFiles>(settings.certificate, settings.key);
}

/// The newest of what was published, decoded.
struct News {
  wire::Sensors sensors;
  steady_clock::time_point at;
};

std::optional<News> news_of(const stream::SharedBytes& bytes) {
  if (!bytes) return std::nullopt;
  auto message = wire::decode(std::span(*bytes).subspan(wire::kSizePrefixBytes));
  if (!message || !std::holds_alternative<wire::Sensors>(*message)) return std::nullopt;
  return News{std::get<wire::Sensors>(std::move(*message)), steady_clock::now()};
}

/// What the WebSockets are sent next; a newer one replaces it.
struct Newest {
  stream::SharedBytes scenes, frame;
  std::shared_ptr<const values::Moment> moment;
};

double mono_s() {
  return seconds(steady_clock::now().time_since_epoch());
}

/// A question that the daemon is carrying out: answered by its reply, or, if that does not come, when it is given
/// up.
struct Pending {
  Pending(asio::io_context& io, http::Reply to_client) : given_up(io), reply(std::move(to_client)) {}

  void answer(http::Response response) {
    given_up.cancel();
    if (reply) std::exchange(reply, nullptr)(std::move(response));
  }

  asio::steady_timer given_up;
  http::Reply reply;
};

http::Response nothing_recorded() {
  return problem(404, "Nothing is recorded",
                 "the daemon records nothing: name a file in [recording] file, or start it with --record FILE.windlog");
}

http::Response ask_again(const std::string& why) {
  http::Response response = problem(503, "Not yet", why);
  response.fields.push_back({"Retry-After", "5"});
  return response;
}

/// `is_trusted`: a failure may name the recording.
http::Response history_answer(const Result<std::string, Failure>& read, bool is_trusted) {
  if (read) return {.body = *read};
  const Failure& failure = read.error();
  if (failure.kind == FailureKind::kUnavailable) return ask_again(failure.message);
  const std::string why = is_trusted ? failure.message : "the reason is shown only on the machine of the daemon";
  return failure.kind == FailureKind::kNoInput ? problem(404, "Nothing is recorded", why)
                                               : problem(500, "The recording cannot be read", why);
}

/// Of a session that has ended.
http::Response revocation_answer(const Result<void, Failure>& saved) {
  if (saved) return {.body = "{\"message\": \"revoked\"}\n"};
  return problem(500, "Not saved",
                 "the session has ended, but it is valid again after a restart: " + saved.error().message +
                     "; fix this and revoke it again");
}

}  // namespace

class Server::Thread {
 public:
  explicit Thread(Settings settings)
      : settings_(std::move(settings)),
        certificate_(certificate_of(settings_)),
        guide_({.path = "/guide/", .what = "the guide", .remedy = "read config/guide in the sources"}, settings_.guide),
        viewer_({.path = "/wall/",
                 .what = "the viewer for browsers",
                 .remedy = "config/package.sh builds it where emscripten is installed"},
                settings_.viewer),
        pairings_file_(settings_.pairings_file),
        site_(settings_.folder),
        archive_(settings_.archive),
        sockets_(*io_, {.limits = settings_.sockets,
                        .hello = settings_.hello,
                        .is_token = [this](const std::string& token) { return access_ && access_->is_token(token); }}),
        server_(std::make_unique<http::Server>(
            *io_, settings_.listen, http::Limits{.clients = settings_.clients},
            [this](const http::Request& request, const http::Reply& reply) { answer(request, reply); }, certificate_)),
        endpoint_(server_->local_endpoint()) {
    if (!settings_.token.is_empty()) trust(settings_.token);
    if (certificate_) renew_certificate_later();
    thread_ = std::thread([this] { run(); });
  }
  ~Thread() {
    try {
      close();
    } catch (...) {
      // A destructor cannot report errors; the thread, which has been joined or never begun, holds nothing else.
    }
  }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  const std::string& endpoint() const { return endpoint_; }
  const http::CertificateFiles* certificate() const { return certificate_.get(); }
  void renew_certificate() {
    if (certificate_) certificate_->read_again();
  }
  std::size_t client_count() const { return clients_ + sockets_.client_count(); }

  void publish_frame(stream::SharedBytes frame) {
    if (sockets_.wants_frames()) hand_over([&](Newest& newest) { newest.frame = std::move(frame); });
  }
  void publish_scenes(stream::SharedBytes scenes) {
    hand_over([&](Newest& newest) {
      newest.scenes = std::move(scenes);
      newest.frame.reset();  // of the scenes before
    });
  }
  void publish_moment(std::shared_ptr<const values::Moment> moment) {
    if (sockets_.wants_wind()) hand_over([&](Newest& newest) { newest.moment = std::move(moment); });
  }
  void publish_sensors(stream::SharedBytes here, stream::SharedBytes elsewhere) {
    asio::post(*io_, [this, here = std::move(here), elsewhere = std::move(elsewhere)] {
      sockets_.publish_sensors(here, elsewhere);
      if (auto news = news_of(here)) {
        wind_.add(mono_s(), news->sensors);
        here_ = std::move(news);
      }
      if (auto news = news_of(elsewhere)) elsewhere_ = std::move(news);
      clients_ = server_ ? server_->client_count() : 0;
      const bool is_wanted = sockets_.wants_status();
      sockets_.publish_status(is_wanted ? status_text(true) : nullptr, is_wanted ? status_text(false) : nullptr);
    });
  }

  void publish_fleet(std::shared_ptr<const std::string> nodes) {
    asio::post(*io_, [this, nodes = std::move(nodes)]() mutable { fleet_ = std::move(nodes); });
  }

  void set_token(const Secret& token) {
    asio::post(*io_, [this, token] { trust(token); });
  }

  void close() {
    if (!thread_.joinable()) return;
    asio::post(*io_, [this] {
      server_.reset();
      sockets_.close();
      work_.reset();
      io_->stop();
    });
    thread_.join();
  }

 private:
  void renew_certificate_later() {
    certificate_timer_.expires_after(kCertificateAgainAfter);
    certificate_timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      contain("renewing the certificate", [this] { renew_certificate(); });
      renew_certificate_later();
    });
  }

  /// Sets what is next; the thread takes it when it comes to it, so that nothing piles up if it is late.
  template <class Set>
  void hand_over(Set&& set) {
    {
      const std::lock_guard lock(newest_mutex_);
      std::forward<Set>(set)(newest_);
      if (!std::exchange(is_taken_, false)) return;
    }
    asio::post(*io_, [this] { take_newest(); });
  }
  void take_newest() {
    Newest newest;
    {
      const std::lock_guard lock(newest_mutex_);
      newest = std::exchange(newest_, {});
      is_taken_ = true;
    }
    if (newest.scenes) sockets_.publish_scenes(std::move(newest.scenes));
    if (newest.moment) sockets_.publish_moment(std::move(newest.moment));
    if (newest.frame) sockets_.publish_frame(std::move(newest.frame));
  }

  void run() {
    while (!contain("a task of the web server", [this] { io_->run(); })) {
    }
  }

  void trust(const Secret& token) {
    access_.emplace(token);
    pairings_ = pairings_file_.read(access_->mark());
  }

  void answer(const http::Request& request, const http::Reply& reply) {
    answer_here(request, [this, request, reply](http::Response response) {
      share_answer(response, request, settings_.origins);
      reply(std::move(response));
    });
  }

  void answer_here(const http::Request& request, http::Reply reply) {
    if (!is_known_host(request.host, settings_.hosts)) {
      return reply(problem(421, "Not this machine's name",
                           "\"" + request.host +
                               "\" is not a name of this machine: use its address, or add that "
                               "name to [http] hosts"));
    }
    if (auto preflight = preflight_answer(request, settings_.origins)) return reply(std::move(*preflight));
    if (auto refusal = other_site_refusal(request, settings_.origins)) return reply(std::move(*refusal));
    if (auto refusal = method_refusal(request)) return reply(std::move(*refusal));
    // Before who asks is looked at: those who are to be paired need it.
    if (auto page = page_answer(request)) return reply(std::move(*page));
    for (const InstalledFiles* const files : {&guide_, &viewer_}) {
      if (auto file = files->answer(request)) return reply(std::move(*file));
    }
    const bool only_reads = request.method == "GET" || request.method == "HEAD";
    if (!only_reads && !is_own_origin(request))
      return reply(problem(403, "Another page's request", "only pages of this daemon may change something"));
    // A form of somebody else's page cannot send this type without being asked first.
    if (!only_reads && !request.content_type.starts_with("application/json"))
      return reply(problem(415, "Not JSON", "the body must be JSON: Content-Type: application/json"));

    const double utc_s = seconds(std::chrono::system_clock::now().time_since_epoch());
    const Trust trust{
        .takes_token = settings_.takes_token, .access = access_ ? &*access_ : nullptr, .pairings = &pairings_};
    // A page of another origin may read, but being on this machine does not make it trusted.
    const bool trusted = is_trusted(request, trust, utc_s) && (trust.takes_token || is_own_origin(request));
    const std::string address = client_address(request, settings_.proxies);
    if (trust.takes_token && !trusted && shows_credentials(request)) {
      ++counts_.refused_tokens;
      log_.warn("http: {} sent a token or session that is not valid", address);
    }
    if (const auto session = session_shown(request, trust, utc_s);
        session && pairings_.note_use(*session, address, utc_s))
      pairings_file_.save(pairings_);
    const bool is_own_health = request.path == kHealthPath && request.client.is_local && !request.is_forwarded;
    if (request.path != kPairPath && !(is_own_health && only_reads)) {
      const bool takes_token = settings_.reading_takes_token || is_private(request.path);
      auto refusal = permission_refusal(request, trusted, trust, takes_token);
      if (refusal) return reply(std::move(*refusal));
    }

    if (only_reads && is_of_site(request.path)) return read_site(request, std::move(reply));
    Answer answer = answer_to(request, facts_for(trusted, utc_s));
    if (auto* const response = std::get_if<http::Response>(&answer)) return reply(std::move(*response));
    if (std::holds_alternative<SocketOpening>(answer)) {
      return open_socket(
          request, {.is_trusted = trusted, .session = session_shown(request, trust, utc_s), .address = address}, reply);
    }
    if (const auto* const pairing = std::get_if<Pairing>(&answer)) {
      return reply(pair(pairing->code, request, address, trust, utc_s));
    }
    if (const auto* const revocation = std::get_if<Revocation>(&answer))
      return revoke(revocation->id, address, std::move(reply));
    if (const auto* const question = std::get_if<HistoryQuestion>(&answer))
      return read_history(question->hours, trusted, std::move(reply));
    if (auto* const wanted = std::get_if<ArchiveRequest>(&answer)) {
      if (!only_reads) log_.info("http: {} asks for {}", address, request.path);
      return ask_archive(std::move(*wanted), std::move(reply));
    }
    if (!only_reads) {
      reply = [this, address, path = request.path, to_client = std::move(reply)](http::Response response) {
        if (response.status < 300) ++counts_.changes;
        log_.info("http: {} changes {}: {}", address, path, response.status < 300 ? "done" : "refused");
        to_client(std::move(response));
      };
    }
    ask(std::get<Question>(std::move(answer)), trusted, std::move(reply));
  }

  /// `is_trusted`: gets what clients of this machine get.
  Facts facts_for(bool is_trusted, double utc_s) const {
    const auto& news = is_trusted ? here_ : elsewhere_;
    return {.software = settings_.hello.software,
            .address = endpoint_,
            .tick_rate_hz = settings_.hello.tick_rate_hz,
            .sensors = news ? &news->sensors : nullptr,
            .age_s = news ? seconds(steady_clock::now() - news->at) : 0.0,
            .patience_s = seconds(settings_.patience),
            .log = settings_.log,
            .faults = settings_.faults,
            .counts = counts_,
            .pairings = &pairings_,
            .fleet = fleet_.get(),
            .wind = &wind_,
            .mono_s = mono_s(),
            .utc_s = utc_s};
  }

  /// Null: nothing is known.
  SharedText status_text(bool is_trusted) const {
    auto text = status_message(facts_for(is_trusted, seconds(std::chrono::system_clock::now().time_since_epoch())));
    return text ? std::make_shared<const std::string>(std::move(*text)) : nullptr;
  }

  void open_socket(const http::Request& request, Sockets::Visitor visitor, const http::Reply& reply) {
    // A browser lets any page open a WebSocket, and sends it this machine's cookies.
    if (!may_read(request, settings_.origins)) {
      return reply(problem(403, "Another page's request",
                           "only pages of this daemon and those of [http] origins may open a WebSocket"));
    }
    if (const auto why = sockets_.refusal(request.client)) {
      http::Response refusal = problem(503, "No place", *why);
      refusal.fields.push_back({"Retry-After", "10"});
      return reply(std::move(refusal));
    }
    http::Response opening{.status = 101};
    opening.take_over = [this, visitor = std::move(visitor)](http::Upgrade& upgrade) {
      sockets_.open(upgrade, visitor);
    };
    reply(std::move(opening));
  }

  http::Response pair(const std::string& code, const http::Request& request, const std::string& address,
                      const Trust& trust, double utc_s) {
    http::Response response =
        pairing_answer(code, request, address, trust, pairing_limits_, pairings_, utc_s, mono_s());
    const bool is_paired = response.status == 200;
    ++(is_paired ? counts_.pairings : counts_.failed_pairings);
    if (is_paired) {
      pairings_file_.save(pairings_);
      log_.info("http: a browser at {} was paired", address);
    } else {
      log_.warn("http: a browser at {} was not paired ({})", address, response.status);
    }
    return response;
  }

  void revoke(const std::string& id, const std::string& address, http::Reply reply) {
    if (!pairings_.revoke(id))
      return reply(problem(404, "Not known", "there is no session with this id: `yuragi token --sessions` lists all"));
    ++counts_.changes;
    sockets_.end_session(id);
    log_.info("http: {} revokes the session {}", address, id);
    const auto pending = wait_for_reply(
        std::move(reply),
        problem(503, "Not saved yet",
                "the session has ended, but the disk does not respond: the session is valid again if the "
                "daemon restarts before this is saved"));
    pairings_file_.save(pairings_,
                        [io = std::weak_ptr(io_), asked = std::weak_ptr(pending)](const Result<void, Failure>& saved) {
                          const auto alive = io.lock();
                          if (!alive) return;
                          asio::post(*alive, [asked, saved] {
                            if (const auto still = asked.lock()) still->answer(revocation_answer(saved));
                          });
                        });
  }

  void ask(Question question, bool is_local, http::Reply reply) {
    if (!settings_.ask) return reply(problem(503, "Not here", "this daemon accepts no requests"));
    const auto pending = wait_for_reply(
        std::move(reply), problem(503, "No reply", "the daemon does not reply: it hangs, or its machine is overloaded"),
        question.takes_long ? std::max(settings_.patience, kMaxChange) : settings_.patience);
    // The reply comes on another thread, perhaps when the question has been given up or this object is gone.
    settings_.ask(question.control, is_local,
                  [io = std::weak_ptr(io_), asked = std::weak_ptr(pending),
                   make = std::move(question.answer)](wire::ControlReply given) {
                    const auto alive = io.lock();
                    if (!alive) return;
                    asio::post(*alive, [asked, make, given = std::move(given)] {
                      if (const auto still = asked.lock()) still->answer(make(given));
                    });
                  });
  }

  void read_history(unsigned hours, bool is_trusted, http::Reply reply) {
    if (!settings_.history) return reply(nothing_recorded());
    const auto pending =
        wait_for_reply(std::move(reply), ask_again("the recording is still being read; ask again in some seconds"));
    settings_.history(hours, [io = std::weak_ptr(io_), asked = std::weak_ptr(pending),
                              is_trusted](Result<std::string, Failure> read) {
      const auto alive = io.lock();
      if (!alive) return;
      asio::post(*alive, [asked, is_trusted, read = std::move(read)] {
        if (const auto still = asked.lock()) still->answer(history_answer(read, is_trusted));
      });
    });
  }

  void read_site(const http::Request& request, http::Reply reply) {
    const auto pending = wait_for_reply(std::move(reply), ask_again("the disk of [http] folder does not respond"));
    site_.answer(request, [io = std::weak_ptr(io_), asked = std::weak_ptr(pending)](http::Response response) {
      const auto alive = io.lock();
      if (!alive) return;
      asio::post(*alive, [asked, response = std::move(response)]() mutable {
        if (const auto still = asked.lock()) still->answer(std::move(response));
      });
    });
  }

  void ask_archive(ArchiveRequest request, http::Reply reply) {
    const auto pending = wait_for_reply(std::move(reply), ask_again("the disk of the recordings does not respond"),
                                        std::max(settings_.patience, kMaxArchive));
    archive_.answer(std::move(request),
                    [io = std::weak_ptr(io_), asked = std::weak_ptr(pending)](http::Response response) {
                      const auto alive = io.lock();
                      if (!alive) return;
                      asio::post(*alive, [asked, response = std::move(response)]() mutable {
                        if (const auto still = asked.lock()) still->answer(std::move(response));
                      });
                    });
  }

  /// What is waited for, with the answer if it does not come in time.
  std::shared_ptr<Pending> wait_for_reply(http::Reply reply, http::Response otherwise) {
    return wait_for_reply(std::move(reply), std::move(otherwise), settings_.patience);
  }
  std::shared_ptr<Pending> wait_for_reply(http::Reply reply, http::Response otherwise, Nanoseconds patience) {
    auto pending = std::make_shared<Pending>(*io_, std::move(reply));
    pending->given_up.expires_after(patience);
    pending->given_up.async_wait([pending, otherwise = std::move(otherwise)](const boost::system::error_code& error) {
      if (!error) pending->answer(otherwise);
    });
    return pending;
  }

  Settings settings_;
  const std::shared_ptr<http::CertificateFiles> certificate_;  ///< null: in the clear
  InstalledFiles guide_, viewer_;
  PairingsFile pairings_file_;
  std::optional<Access> access_;  ///< of the thread, as all below
  Pairings pairings_;             ///< of the token
  PairingLimits pairing_limits_;
  Counts counts_;
  stream::ClientLog log_{{}, [] { return MonoTime(steady_clock::now()); }};
  std::shared_ptr<asio::io_context> io_ = std::make_shared<asio::io_context>(1);
  asio::executor_work_guard<asio::io_context::executor_type> work_{io_->get_executor()};
  asio::steady_timer certificate_timer_{*io_};
  std::optional<News> here_, elsewhere_;
  std::shared_ptr<const std::string> fleet_;  ///< null: this daemon does not lead
  WindMemory wind_;
  std::mutex newest_mutex_;
  Newest newest_;         ///< of newest_mutex_
  bool is_taken_ = true;  ///< of newest_mutex_; false: the thread will take it
  Site site_;
  Archive archive_;
  Sockets sockets_;
  std::unique_ptr<http::Server> server_;
  const std::string endpoint_;
  std::atomic<std::size_t> clients_ = 0;
  std::thread thread_;  // the last: it uses all of the above
};

Server::Server(Settings settings) : thread_(std::make_unique<Thread>(std::move(settings))) {}
Server::~Server() = default;

std::string Server::local_endpoint() const {
  return thread_->endpoint();
}
std::string Server::address() const {
  return (thread_->certificate() != nullptr ? "https://" : "http://") + thread_->endpoint();
}
void Server::renew_certificate() {
  thread_->renew_certificate();
}
std::optional<std::string> Server::certificate_trouble() const {
  const http::CertificateFiles* const files = thread_->certificate();
  return files != nullptr ? files->trouble(std::chrono::system_clock::now()) : std::nullopt;
}
void Server::publish(stream::SharedBytes frame) {
  thread_->publish_frame(std::move(frame));
}
void Server::publish_scenes(stream::SharedBytes scenes) {
  thread_->publish_scenes(std::move(scenes));
}
void Server::publish_moment(std::shared_ptr<const values::Moment> moment) {
  thread_->publish_moment(std::move(moment));
}
void Server::publish_sensors(stream::SharedBytes here, stream::SharedBytes elsewhere) {
  thread_->publish_sensors(std::move(here), std::move(elsewhere));
}
void Server::publish_fleet(std::shared_ptr<const std::string> nodes) {
  thread_->publish_fleet(std::move(nodes));
}
std::size_t Server::client_count() const {
  return thread_->client_count();
}
bool Server::has_untrusted_clients() const {
  return true;
}
void Server::set_token(const Secret& token) {
  thread_->set_token(token);
}
void Server::close() {
  thread_->close();
}

}  // namespace yuragi::daemon::web
