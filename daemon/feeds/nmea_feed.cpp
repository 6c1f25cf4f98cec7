#include "daemon/feeds/nmea_feed.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/feeds/datagram_target.hpp"
#include "daemon/feeds/interval.hpp"
#include "daemon/feeds/line_server.hpp"
#include "daemon/feeds/nmea_sentences.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::Nmea;
using values::Quantity;

class NmeaFeed final : public Feed {
 public:
  explicit NmeaFeed(const Nmea& config) : config_(config), rate_(1.0 / config.rate_hz) {
    if (!config.to.empty()) target_.emplace(config.name, config.to);
    if (!config.listen.empty()) server_.emplace(config.name, config.listen);
  }

  void send(const values::Moment& moment) override {
    if (!rate_.is_due(moment.time_s)) return;
    const values::Readout& readout = moment.wind(config_.wind);
    const bool is_measured = readout[Quantity::kLive] > 0.0;
    const NmeaWind wind{.speed_m_s = readout[Quantity::kSpeed],
                        .direction_deg = readout[Quantity::kDirection],
                        .is_valid = is_measured || config_.wind == values::Wind::kShaped};
    const std::string sentences = mwv_sentence(wind) + mwd_sentence(wind);
    if (target_) target_->send(std::vector<std::uint8_t>(sentences.begin(), sentences.end()), moment.mono);
    if (server_) server_->send(sentences, moment.mono);
  }

  Status status() const override {
    Status status{.kind = "nmea",
                  .name = config_.name,
                  .target = target_ ? target_->address() : server_->address(),
                  .sends = "MWV, MWD",
                  .last_sent = std::nullopt,
                  .trouble = {}};
    if (target_) add(status, *target_);
    if (!server_) return status;
    add(status, *server_);
    if (target_) status.target += ", " + server_->address();
    status.sends += " (" + count_text(server_->clients(), "client") + ")";
    return status;
  }

 private:
  template <class Way>
  static void add(Status& status, const Way& way) {
    status.messages += way.messages();
    status.bytes += way.bytes();
    status.last_sent = std::max(status.last_sent, way.last_sent());
    if (status.trouble.empty()) status.trouble = way.trouble();
  }

  Nmea config_;
  Interval rate_;
  std::optional<DatagramTarget> target_;
  std::optional<LineServer> server_;
};

}  // namespace

std::unique_ptr<Feed> make_nmea_feed(const Nmea& config) {
  return std::make_unique<NmeaFeed>(config);
}

}  // namespace yuragi::daemon::feeds
