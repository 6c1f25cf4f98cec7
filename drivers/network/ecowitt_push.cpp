// Weather stations that push their values to a server of the user's choosing: gateways and consoles by Fine Offset
// (Ecowitt, Froggit, Ambient Weather and their other names) with a "customized" upload, and all others that use the
// protocol of Weather Underground or WSLink (drivers/SOURCES.md S9.3). This is the server.
//
//   POST /data/report/                                      a form as the body                   Ecowitt
//   GET  /weatherstation/updateweatherstation.php?ID=...    a form behind the question mark      Weather Underground
//   GET  /data/report/?PASSKEY=...                          the same                             Ambient Weather
//   GET  /data/upload.php?wsid=...                          the same                             WSLink
//
// Both kinds are accepted at any path, unless one is set. An accepted push gets the answer 200; an answer from 400 on
// has one line about what is wrong. The user sets who may send, because nothing in a push proves its sender.
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <boost/asio/ip/host_name.hpp>
#include <fmt/format.h>

#include "drivers/bus/sender_filter.hpp"
#include "drivers/decode/network/station_push.hpp"
#include "drivers/network/followed_station.hpp"
#include "drivers/network/http_server.hpp"
#include "drivers/network/station_silence.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/reading_limit.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "engine/base/address.hpp"
#include "engine/base/fields.hpp"
#include "engine/base/known_host.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::drivers::network {
namespace {

/// The clock is checked at least this often.
constexpr Nanoseconds kPushWait = std::chrono::milliseconds(250);
/// So many of its usual pauses are silence.
constexpr int kSilentPushPauses = 5;
/// Of a host that a gateway names by mistake.
constexpr std::size_t kShownHostCharacters = 64;

struct EcowittPushKeys {
  Address address;
  std::string from;
  std::string host_name;
  std::string path;
  Nanoseconds silence{};
};

const Fields<EcowittPushKeys> kEcowittPushFields = {
    {{.name = "host",
      .default_value = std::string("127.0.0.1"),
      .help = "the local address to listen at: this machine's in the gateway's network; 127.0.0.1: for pushes of this "
              "machine only; 0.0.0.0: all addresses"},
     [](EcowittPushKeys& keys) -> std::string& { return keys.address.host; }},
    {{"port", "", std::int64_t{8090}, 1, 65535, "the TCP port to listen at; each sensor of this driver needs its own"},
     [](EcowittPushKeys& keys) -> std::uint16_t& { return keys.address.port; }},
    {{.name = "from",
      .default_value = std::string(""),
      .help = "who may push: addresses and networks separated by commas (192.168.1.30, 10.0.0.0/8); 0.0.0.0/0: any; "
              "can be empty only if host is an address such as 127.0.0.1"},
     &EcowittPushKeys::from},
    {{.name = "host_name",
      .default_value = std::string(""),
      .help = "what is set as Server IP/Hostname in the gateway, if it is neither an address of this machine nor its "
              "own name: pushes to other names are refused"},
     &EcowittPushKeys::host_name},
    {{.name = "path",
      .default_value = std::string(""),
      .help = "the path to accept, as set in the gateway: /data/report/; empty: any"},
     &EcowittPushKeys::path},
    Parameter{.name = "station_key",
              .default_value = Secret(),
              .help = "the station to accept: its PASSKEY (Ecowitt, Ambient Weather), ID (Wunderground) or wsid "
                      "(WSLink); empty: the "
                      "first one that pushes, until it is silent, with a warning if there are others; no log and no "
                      "recording shows it"},
    {{"silence", "s", 300.0, 0.1, 86400.0,
      "without wind for this long, and for five times its usual interval, the station counts as silent"},
     &EcowittPushKeys::silence,
     from_seconds},
};

constexpr std::string_view kEcowittPushSetup =
    "In the gateway's own web page (Weather Services, Customized), in the app (the gateway, Others, DIY Upload "
    "Servers,\n"
    "Customized), or in a console's menu of weather services:\n"
    "\n"
    "  Customized           Enable\n"
    "  Protocol Type        Ecowitt or Wunderground\n"
    "  Server IP/Hostname   this machine's address in the gateway's network, as in `host`\n"
    "  Path                 /data/report/\n"
    "                       Wunderground, Ambient Weather: with a question mark at its end, as in\n"
    "                       /weatherstation/updateweatherstation.php?\n"
    "  Station ID, Key      Wunderground: any text\n"
    "  Port                 8090, or what `port` is set to\n"
    "  Upload Interval      16 s, the interval of most anemometers, or the minimum that can be set: of the\n"
    "                       gusts between two pushes only the strongest is reported\n"
    "\n"
    "A console with WSLink (Bresser, Garni, Ventus): API type WSLink, server URL this machine's address and port\n"
    "without https, station ID and key any text. A console that pushes by https alone needs a proxy in between.\n"
    "\n"
    "Set `host` and `from`: no gateway can reach 127.0.0.1. Open the port in the firewall.\n";

struct EcowittPushSettings {
  Address address;
  bus::SenderFilter from;
  std::vector<std::string> host_names;
  std::string path;
  Secret station_key;
  Nanoseconds silence{};
  bool is_for_this_machine = true;
};

/// A refused push: why, and the answer to the station.
struct PushRefusal {
  decode::Refusal why;
  HttpAnswer answer;
};

class EcowittPushSensor final : public sensor::ReopeningSensor {
 public:
  explicit EcowittPushSensor(EcowittPushSettings settings)
      : sensor::ReopeningSensor(sensor::seed_of("ecowitt-push" + to_string(settings.address))),
        settings_(std::move(settings)),
        where_("http://" + to_string(settings_.address) + settings_.path),
        server_(settings_.address),
        station_(settings_.station_key.reveal()),
        silence_(settings_.silence, kSilentPushPauses) {}

  void interrupt() noexcept override { server_.interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override {
    if (const auto opened = server_.open(); !opened) return opened.error();
    is_silent_ = true;
    trouble_.clear();
    stranger_.clear();
    const MonoTime now = clock.now().mono;
    silence_.begin(now);
    return now;
  }

  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override {
    Visits visits(*this, clock, sink);
    if (const auto served = server_.serve(kPushWait, visits); !served) return served.error();
    const MonoTime now = clock.now().mono;
    if (silence_.is_long(now)) {
      is_silent_ = true;
      station_.lose();
    }
    if (is_silent_) report_unusable(sink, trouble(now));
    return now;
  }

  void close() noexcept override { server_.close(); }

 private:
  /// The pushes during one work().
  class Visits final : public HttpService {
   public:
    Visits(EcowittPushSensor& sensor, const sensor::Clock& clock, sensor::Sink& sink)
        : sensor_(sensor), clock_(clock), sink_(sink) {}

    bool admits(const boost::asio::ip::address& sender) override {
      if (sensor_.settings_.from.takes(sender)) return true;
      sink_.refused(decode::Refusal::kNotMine);
      // The first one is named, so that a flood does not change the status without end.
      if (sensor_.stranger_.empty()) sensor_.stranger_ = bus::plain_address(sender).to_string();
      return false;
    }
    HttpAnswer answer(const HttpRequest& request) override {
      const std::optional<PushRefusal> refusal = sensor_.take(request, clock_.now(), sink_);
      if (!refusal) return {.status = 200, .text = "success"};
      sink_.refused(refusal->why);
      return refusal->answer;
    }
    void failed(HttpFailure why, const boost::asio::ip::address& sender) override {
      const auto [refusal, what] = meaning_of(why);
      sink_.refused(refusal);
      sensor_.trouble_ = bus::plain_address(sender).to_string() + " " + std::string(what);
    }

   private:
    static std::pair<decode::Refusal, std::string_view> meaning_of(HttpFailure why) {
      switch (why) {
        case HttpFailure::kTooSlow:
          return {decode::Refusal::kTimeout, "connects, but does not push in time"};
        case HttpFailure::kCutOff:
          return {decode::Refusal::kTooShort, "ends the connection before its push is complete: check the network"};
        case HttpFailure::kTooMany:
          return {decode::Refusal::kTooFrequent, "connects too often without a push"};
        case HttpFailure::kTooLong:
          return {decode::Refusal::kMalformed, "pushes more data than a station sends"};
        case HttpFailure::kMalformed:
          break;
      }
      return {decode::Refusal::kMalformed, "does not use HTTP: check which device it is"};
    }

    EcowittPushSensor& sensor_;
    const sensor::Clock& clock_;
    sensor::Sink& sink_;
  };

  /// Returns nullopt if it is accepted.
  std::optional<PushRefusal> take(const HttpRequest& request, const Instant& now, sensor::Sink& sink) {
    using decode::Refusal;
    if (!limit_.admits(now.mono)) return PushRefusal{Refusal::kTooFrequent, {429, "too many pushes"}};
    const bool is_post = request.method == "POST";
    if (!is_post && request.method != "GET")
      return PushRefusal{Refusal::kNotMine, {405, "only GET and POST are accepted"}};

    const auto target = decode::network::split_push_target(request.target);
    const std::string_view form = is_post ? request.body : target.form;
    const std::string shown = decode::network::without_push_secrets(form);
    sink.raw(sensor::RawDirection::kReceived, {reinterpret_cast<const std::uint8_t*>(shown.data()), shown.size()});
    const std::string sender = bus::plain_address(request.sender).to_string();
    // Any web page that is open in a browser of this network can make the browser push.
    if (request.is_of_browser) {
      trouble_ = "refuses pushes of a web browser at " + sender;
      return PushRefusal{Refusal::kNotMine, {403, "browsers are refused"}};
    }
    if (!request.host.empty() && !is_known_host(request.host, settings_.host_names)) {
      std::string host(request.host);
      make_printable(host);
      trouble_ = fmt::format(
          "{} pushes to the host \"{}\": set this machine's address in the gateway, or that name as host_name here",
          sender, shortened(host, kShownHostCharacters));
      return PushRefusal{Refusal::kNotMine, {421, "this machine has another name"}};
    }
    if (!settings_.path.empty() && target.path != settings_.path) {
      trouble_ = sender + " pushes to another path: set Path in the gateway to " + settings_.path + "/, or path here";
      return PushRefusal{Refusal::kNotMine, {404, "wrong path"}};
    }
    const auto push = decode::network::decode_station_push(form);
    if (!push) {
      trouble_ = fmt::format(
          "the push of {} cannot be used ({}): choose the protocol Ecowitt or WSLink; or Wunderground, with a question "
          "mark at the end of its path",
          sender, name_of(push.error()));
      return PushRefusal{push.error(), {400, fmt::format("no values of a station ({})", name_of(push.error()))}};
    }

    const std::string kind = push->kind.empty() ? "a station" : decode::network::push_text(push->kind);
    const std::string station = kind + " at " + sender;
    if (!station_.hears(std::string(push->identity), station, now.mono)) {
      if (!settings_.station_key.is_empty()) trouble_ = station + " pushes, but `station_key` selects another station";
      return PushRefusal{Refusal::kNotMine, {403, "wrong station"}};
    }
    wind::StationQuantities said = push->quantities;
    said.time = now;
    sink.quantities(said);
    if (push->wind) {
      publish(*push, station, now, sink);
    } else {
      is_silent_ = true;
      trouble_ =
          push->wind.error() == Refusal::kInvalid
              ? station + " pushes no wind: check the anemometer's battery, and that it is registered in the gateway"
              : fmt::format("the wind that {} pushes cannot be used ({})", station, name_of(push->wind.error()));
      sink.refused(push->wind.error());
    }
    return std::nullopt;
  }

  void publish(const decode::network::StationPush& push, const std::string& station, const Instant& now,
               sensor::Sink& sink) {
    silence_.end(std::string(push.identity), now.mono);
    is_silent_ = false;
    trouble_.clear();
    const std::string rival = station_.rival(now.mono);
    const std::string warning =
        rival.empty() ? ""
                      : fmt::format("; {} pushes, too, but is not used: select one with station_key or path", rival);
    report_connected(sink, fmt::format("{} pushes to {}{}", station, where_, warning));
    sink.reading({.time = now,
                  .speed_m_s = *push.wind->speed_m_s,
                  .direction_deg = push.wind->direction_deg,
                  .gust_m_s = push.wind->gust_m_s,
                  .quality = wind::ReadingQuality::kGood});
  }

  /// Why there is no wind.
  std::string trouble(MonoTime now) const {
    if (!trouble_.empty()) return trouble_;
    const std::string stranger =
        stranger_.empty() ? "" : fmt::format("; refuses {}, which is not in `from`", stranger_);
    if (settings_.is_for_this_machine)
      return fmt::format("waits for pushes to {}, from this machine only: for a gateway, set host and from", where_);
    if (silence_.length(now) < settings_.silence) return fmt::format("waits for pushes to {}{}", where_, stranger);
    return fmt::format(
        "no push has arrived at {} for {:g} s: check that the gateway is on, its page Customized (`yuragi sensors "
        "describe ecowitt-push` shows what to enter), and that no firewall blocks TCP port {}{}",
        where_, seconds(settings_.silence), settings_.address.port, stranger);
  }

  EcowittPushSettings settings_;
  std::string where_;
  HttpServer server_;
  FollowedStation station_;
  StationSilence silence_;
  sensor::ReadingLimit limit_;
  std::string trouble_;   // of the last push without wind, since the last wind; empty: none
  std::string stranger_;  // the first refused sender; empty: none
  bool is_silent_ = true;
};

/// Throws, naming the setting, if they cannot work together.
EcowittPushSettings ecowitt_push_settings_of(const ParameterValues& values) {
  const EcowittPushKeys keys = kEcowittPushFields.of(values);
  EcowittPushSettings settings;
  settings.address = keys.address;
  settings.station_key = values.secret("station_key");
  settings.silence = keys.silence;
  settings.host_names = {boost::asio::ip::host_name(), keys.host_name};

  if (!keys.path.empty() && !keys.path.starts_with('/'))
    throw std::runtime_error("path: must begin with a slash, as in /data/report/");
  settings.path = decode::network::split_push_target(keys.path).path;

  const std::string& host = settings.address.host;
  const auto is_loopback = bus::is_loopback(host);
  if (!is_loopback) throw std::runtime_error("host: " + is_loopback.error().message);
  settings.is_for_this_machine = *is_loopback;
  auto from = bus::SenderFilter::parse(keys.from);
  if (!from) throw std::runtime_error("from: " + from.error().message);
  if (keys.from.empty() && !*is_loopback) {
    throw std::runtime_error("from: is missing; host " + host +
                             " accepts other machines: give the gateway (192.168.1.30) or its network "
                             "(192.168.1.0/24), or 0.0.0.0/0 for any");
  }
  settings.from = std::move(*from);
  return settings;
}

std::unique_ptr<sensor::Sensor> open_ecowitt_push(const ParameterValues& values) {
  return std::make_unique<EcowittPushSensor>(ecowitt_push_settings_of(values));
}

std::vector<sensor::Endpoint> ecowitt_push_endpoints(const ParameterValues& values) {
  const auto& address = kEcowittPushFields.of(values).address;
  return {{.kind = sensor::EndpointKind::kTcpPort,
           .name = to_string(address),
           .claim = fmt::format("TCP port {}", address.port)}};
}

Result<sensor::SimulatedDevice, Failure> ecowitt_push_simulated(const ParameterValues& values) {
  std::vector<std::string> options = {"--interval", "1"};
  const std::string path = kEcowittPushFields.of(values).path;
  if (!path.empty()) options.insert(options.end(), {"--path", path});
  sensor::SimulatedDevice simulated = sensor::simulated_sender("ecowitt-push", "--to", values, options);
  simulated.values.set("station_key", Secret());  // no key on a command line, which others can see
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kEcowittPushDriver;
const sensor::DriverDescription kEcowittPushDriver{
    .name = "ecowitt-push",
    .summary =
        "stations that push their values to this machine by HTTP: Ecowitt, Ambient Weather, Wunderground, WSLink",
    .parameters = kEcowittPushFields.parameters(),
    .open = open_ecowitt_push,
    .endpoints = ecowitt_push_endpoints,
    .selection =
        [](const ParameterValues& values) {
          return sensor::ValueSelection{
              .device = fmt::format("pushes to TCP port {}", kEcowittPushFields.of(values).address.port),
              .device_keys = "port"};
        },
    .simulated = ecowitt_push_simulated,
    .device_setup = kEcowittPushSetup,
    .formats = "ecowitt-push"};

}  // namespace yuragi::drivers::network
