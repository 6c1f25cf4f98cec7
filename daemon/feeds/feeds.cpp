#include "daemon/feeds/feeds.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "daemon/feeds/dmx_feed.hpp"
#include "daemon/feeds/mqtt_feed.hpp"
#include "daemon/feeds/nmea_feed.hpp"
#include "daemon/feeds/osc_feed.hpp"
#include "daemon/feeds/osc_query_feed.hpp"
#include "engine/base/contain.hpp"

namespace yuragi::daemon::feeds {
namespace {

constexpr auto kStatusInterval = std::chrono::milliseconds(500);
constexpr auto kLongestFarewell = std::chrono::seconds(1);

/// The configuration of one feed.
using AnyConfig = std::variant<settings::feeds::Osc, settings::feeds::Dmx, settings::feeds::Nmea, settings::feeds::Mqtt,
                               settings::feeds::OscQuery>;

std::vector<AnyConfig> all_of(const settings::feeds::Config& config) {
  std::vector<AnyConfig> all(config.osc.begin(), config.osc.end());
  all.insert(all.end(), config.dmx.begin(), config.dmx.end());
  if (!config.mqtt.host.empty()) all.emplace_back(config.mqtt);
  if (!config.osc_query.listen.empty()) all.emplace_back(config.osc_query);
  all.insert(all.end(), config.nmea.begin(), config.nmea.end());
  return all;
}

std::unique_ptr<Feed> make_feed(const settings::feeds::Osc& osc, const Surroundings&) {
  return make_osc_feed(osc);
}
std::unique_ptr<Feed> make_feed(const settings::feeds::Dmx& dmx, const Surroundings&) {
  return make_dmx_feed(dmx);
}
std::unique_ptr<Feed> make_feed(const settings::feeds::Mqtt& mqtt, const Surroundings& around) {
  return make_mqtt_feed(mqtt, around);
}
std::unique_ptr<Feed> make_feed(const settings::feeds::OscQuery& osc_query, const Surroundings& around) {
  return make_osc_query_feed(osc_query, around);
}
std::unique_ptr<Feed> make_feed(const settings::feeds::Nmea& nmea, const Surroundings&) {
  return make_nmea_feed(nmea);
}

/// A feed that runs, with the configuration that it was made of.
struct Running {
  AnyConfig config;
  std::unique_ptr<Feed> feed;
};

/// Keeps the feeds whose configuration is the same, ends the others, and makes new ones.
std::vector<Running> renewed(std::vector<Running> running, const settings::feeds::Config& config,
                             const Surroundings& around) {
  std::vector<Running> next;
  for (AnyConfig& wanted : all_of(config)) {
    const auto same =
        std::ranges::find_if(running, [&wanted](const Running& one) { return one.feed && one.config == wanted; });
    next.push_back({std::move(wanted), same != running.end() ? std::move(same->feed) : nullptr});
  }
  // Before others begin, which may need the same port.
  for (Running& ended : running) {
    if (ended.feed) contain("the end of a feed", [&ended] { ended.feed->finish(); });
    ended.feed.reset();
  }
  for (Running& begun : next) {
    if (!begun.feed)
      begun.feed = std::visit([&](const auto& made_of) { return make_feed(made_of, around); }, begun.config);
  }
  return next;
}

}  // namespace

/// The thread, and what it shares with its owner. Detached if a feed does not end in time.
class Feeds::Thread {
 public:
  Thread(const settings::feeds::Config& config, Surroundings around) : shared_(std::make_shared<Shared>()) {
    shared_->config = config;
    shared_->around = std::move(around);
    std::thread([shared = shared_] {
      contain("the feeds", [&shared] { run(*shared); });
      leave(*shared);
    }).detach();
  }

  ~Thread() {
    std::unique_lock lock(shared_->mutex);
    shared_->is_ending = true;
    shared_->changed.notify_all();
    shared_->changed.wait_for(lock, kLongestFarewell, [this] { return shared_->is_over; });
  }

  void publish(std::shared_ptr<const values::Moment> moment) {
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->moment = std::move(moment);
    }
    shared_->changed.notify_all();
  }

  void change(const settings::feeds::Config& config) {
    const std::lock_guard lock(shared_->mutex);
    shared_->config = config;
    shared_->changed.notify_all();
  }

  std::vector<Status> status() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->status;
  }

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::shared_ptr<const values::Moment> moment;   ///< null: sent already
    std::optional<settings::feeds::Config> config;  ///< nullopt: in use already
    std::vector<Status> status;
    Surroundings around;  ///< never changes
    bool is_ending = false, is_over = false;
  };

  static void leave(Shared& shared) noexcept {
    const std::lock_guard lock(shared.mutex);
    shared.is_over = true;
    shared.changed.notify_all();
  }

  static void run(Shared& shared) {
    std::vector<Running> feeds;
    std::optional<MonoTime> reported;
    while (true) {
      std::unique_lock lock(shared.mutex);
      shared.changed.wait(lock, [&shared] { return shared.moment || shared.config || shared.is_ending; });
      const std::shared_ptr<const values::Moment> moment = std::exchange(shared.moment, nullptr);
      const std::optional<settings::feeds::Config> config = std::exchange(shared.config, std::nullopt);
      const bool is_ending = shared.is_ending;
      lock.unlock();

      if (config) feeds = renewed(std::move(feeds), *config, shared.around);
      for (const Running& running : feeds) {
        if (moment) contain("a feed", [&] { running.feed->send(*moment); });
      }
      if (moment && (config || !reported || moment->mono - *reported >= kStatusInterval)) {
        reported = moment->mono;
        std::vector<Status> status;
        status.reserve(feeds.size());
        for (const Running& running : feeds) status.push_back(running.feed->status());
        const std::lock_guard guard(shared.mutex);
        shared.status = std::move(status);
      }
      if (is_ending) {
        feeds = renewed(std::move(feeds), {}, shared.around);
        return;
      }
    }
  }

  std::shared_ptr<Shared> shared_;
};

/// Ends the calls of a thread that is left to itself.
struct Feeds::Gate {
  std::mutex mutex;
  std::function<void(const std::string& scene, bool shown)> show_scene;
};

Feeds::Feeds(const settings::feeds::Config& config, Surroundings around)
    : around_(std::move(around)), gate_(std::make_shared<Gate>()) {
  gate_->show_scene = std::exchange(around_.show_scene, [gate = gate_](const std::string& scene, bool shown) {
    const std::lock_guard lock(gate->mutex);
    if (gate->show_scene) gate->show_scene(scene, shown);
  });
  change(config);
}
Feeds::~Feeds() {
  const std::lock_guard lock(gate_->mutex);
  gate_->show_scene = nullptr;
}

bool Feeds::is_empty() const noexcept {
  return thread_ == nullptr;
}

void Feeds::publish(std::shared_ptr<const values::Moment> moment) {
  if (thread_) thread_->publish(std::move(moment));
}

void Feeds::change(const settings::feeds::Config& config) {
  if (all_of(config).empty()) {
    thread_.reset();
  } else if (thread_) {
    thread_->change(config);
  } else {
    thread_ = std::make_unique<Thread>(config, around_);
  }
}

std::vector<Status> Feeds::status() const {
  return thread_ ? thread_->status() : std::vector<Status>();
}

}  // namespace yuragi::daemon::feeds
