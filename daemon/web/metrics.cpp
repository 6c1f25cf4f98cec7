#include "daemon/web/metrics.hpp"

#include <utility>
#include <vector>

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include "engine/wind/judging/sensor_state.hpp"

namespace yuragi::daemon::web {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

/// One name and its values.
class Family {
 public:
  Family(std::string name, std::string help, MetricType type) {
    family_.name = std::move(name);
    family_.help = std::move(help);
    family_.type = type;
  }
  Family& add(double value, Labels labels = {}) {
    ClientMetric metric;
    metric.label = std::move(labels);
    (family_.type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
    family_.metric.push_back(std::move(metric));
    return *this;
  }
  Family& add(std::uint64_t value, Labels labels = {}) { return add(static_cast<double>(value), std::move(labels)); }

  MetricFamily take() { return std::move(family_); }

 private:
  MetricFamily family_;
};

Family gauge(std::string name, std::string help) {
  return {std::move(name), std::move(help), MetricType::Gauge};
}
Family counter(std::string name, std::string help) {
  return {std::move(name), std::move(help), MetricType::Counter};
}

void add_wind(std::vector<MetricFamily>& all, const wire::Sensors& sensors) {
  all.push_back(
      gauge("yuragi_wind_speed_meters_per_second", "Wind of all sensors together, as it is blown to the scenes")
          .add(speed_of(sensors.wind.wind))
          .take());
  all.push_back(gauge("yuragi_wind_direction_degrees", "Where that wind comes from, clockwise from north")
                    .add(wind::direction_from_deg(sensors.wind.wind))
                    .take());
  all.push_back(gauge("yuragi_wind_live_ratio", "Share of the wind that is measured now: 0 none, 1 all")
                    .add(sensors.wind.live_weight)
                    .take());
}

void add_sensors(std::vector<MetricFamily>& all, const wire::Sensors& sensors) {
  Family speed = gauge("yuragi_sensor_speed_meters_per_second", "Last reading of each sensor, calibrated");
  Family direction = gauge("yuragi_sensor_direction_degrees", "Its direction, clockwise from north");
  Family gust = gauge("yuragi_sensor_gust_meters_per_second", "Its gust, if it reports one");
  Family age = gauge("yuragi_sensor_age_seconds", "Time since the last reading");
  Family believed = gauge("yuragi_sensor_believed", "1 if its readings are used for the wind");
  Family missing = gauge("yuragi_sensor_quantity_missing", "1 if readings come without what they should have");
  Family state = gauge("yuragi_sensor_state", "1 for the state that the sensor is in");
  Family readings = counter("yuragi_sensor_readings_total", "Readings since the daemon began");
  Family messages = counter("yuragi_sensor_messages_total", "Messages of its device, of use or not");
  Family refused = counter("yuragi_sensor_refused_total", "Messages and readings that were refused, by reason");
  Family reconnects = counter("yuragi_sensor_reconnects_total", "How often its device was found again");
  for (const wire::SensorStatus& sensor : sensors.sensors) {
    const Labels labels = {{"sensor", sensor.name}, {"driver", sensor.driver}};
    const auto with = [&labels](const char* name, std::string_view value) {
      Labels more = labels;
      more.push_back({name, std::string(value)});
      return more;
    };
    if (sensor.speed_m_s) speed.add(*sensor.speed_m_s, labels);
    if (sensor.direction_deg) direction.add(*sensor.direction_deg, labels);
    if (sensor.gust_m_s) gust.add(*sensor.gust_m_s, labels);
    if (sensor.readings > 0) age.add(sensor.age_s, labels);
    believed.add(is_believed(sensor.state) ? 1.0 : 0.0, labels);
    for (const wire::QuantityStatus& quantity : sensor.quantities)
      missing.add(quantity.is_missing ? 1.0 : 0.0, with("quantity", name_of(quantity.quantity)));
    for (const std::string_view each : wind::judging::kSensorStateNames)
      state.add(each == name_of(sensor.state) ? 1.0 : 0.0, with("state", each));
    readings.add(sensor.readings, labels);
    messages.add(sensor.frames, labels);
    for (const auto& [reason, count] : sensor.refused) refused.add(count, with("reason", reason));
    reconnects.add(sensor.reconnects, labels);
  }
  for (Family* family :
       {&speed, &direction, &gust, &age, &believed, &missing, &state, &readings, &messages, &refused, &reconnects})
    all.push_back(family->take());
}

void add_lateness(std::vector<MetricFamily>& all, const wire::Sensors& sensors) {
  Family lateness = gauge("yuragi_lateness_seconds",
                          "How late the steps of the last 10 minutes were, by thread: median, p99 and max");
  const auto add = [&lateness](const char* thread, const std::optional<wire::Lateness>& of) {
    if (!of) return;
    // Not "quantile", which is for metrics of type summary.
    lateness.add(of->p50_s, {{"thread", thread}, {"statistic", "median"}});
    lateness.add(of->p99_s, {{"thread", thread}, {"statistic", "p99"}});
    lateness.add(of->max_s, {{"thread", thread}, {"statistic", "max"}});
  };
  add("animation", sensors.tick_lateness);
  add("io", sensors.io_lateness);
  all.push_back(lateness.take());
  all.push_back(
      counter("yuragi_ticks_skipped_total", "Ticks that were too late to be run").add(sensors.late_ticks).take());
}

void add_animation(std::vector<MetricFamily>& all, const wire::AnimationStatus& animation) {
  all.push_back(
      gauge("yuragi_tick_period_seconds", "Time between the animation's ticks").add(animation.period_s).take());
  all.push_back(
      gauge("yuragi_tick_seconds", "Time that a tick works, mean of the last seconds").add(animation.tick_s).take());
  Family scenes = gauge("yuragi_scene_tick_seconds", "Part of it that a scene takes; 0: it is hidden");
  for (const wire::SceneCost& scene : animation.scenes) scenes.add(scene.tick_s, {{"scene", scene.scene}});
  all.push_back(scenes.take());
}

void add_feeds(std::vector<MetricFamily>& all, const std::vector<wire::FeedStatus>& feeds) {
  if (feeds.empty()) return;
  Family sending = gauge("yuragi_feed_sending", "1 if a feed to other programs can send");
  Family messages = counter("yuragi_feed_messages_total", "Messages that a feed has sent");
  Family bytes = counter("yuragi_feed_bytes_total", "Bytes that a feed has sent");
  for (const wire::FeedStatus& feed : feeds) {
    const Labels labels = {{"kind", feed.kind}, {"name", feed.name}};
    sending.add(feed.trouble.empty() ? 1.0 : 0.0, labels);
    messages.add(feed.messages, labels);
    bytes.add(feed.bytes, labels);
  }
  for (Family* const family : {&sending, &messages, &bytes}) all.push_back(family->take());
}

void add_clients(std::vector<MetricFamily>& all, const wire::Sensors& sensors) {
  all.push_back(gauge("yuragi_stream_clients", "Clients of the stream now").add(std::uint64_t{sensors.clients}).take());
  all.push_back(counter("yuragi_stream_clients_turned_away_total", "Clients that were refused or let go, by reason")
                    .add(sensors.refused_clients, {{"reason", "refused"}})
                    .add(sensors.stuck_clients, {{"reason", "stuck"}})
                    .add(sensors.idle_clients, {{"reason", "idle"}})
                    .take());
}

void add_by_hand(std::vector<MetricFamily>& all, const wire::ByHand& by_hand) {
  all.push_back(gauge("yuragi_by_hand", "1 for what somebody has set by hand, for a time")
                    .add(by_hand.wind ? 1.0 : 0.0, {{"part", "wind"}})
                    .add(by_hand.blackout ? 1.0 : 0.0, {{"part", "blackout"}})
                    .add(by_hand.camera ? 1.0 : 0.0, {{"part", "camera"}})
                    .take());
}

void add_web(std::vector<MetricFamily>& all, const Counts& counts) {
  all.push_back(counter("yuragi_http_pairings_total", "Attempts of browsers to pair, by result")
                    .add(counts.pairings, {{"result", "paired"}})
                    .add(counts.failed_pairings, {{"result", "refused"}})
                    .take());
  all.push_back(counter("yuragi_http_refused_tokens_total", "Requests with a token or session that is not valid")
                    .add(counts.refused_tokens)
                    .take());
  all.push_back(counter("yuragi_http_changes_total", "Requests that changed something").add(counts.changes).take());
}

void add_faults(std::vector<MetricFamily>& all, const FaultCounts& faults) {
  Family family =
      counter("yuragi_faults_total", "Requests, messages and steps that ended with an error of the program, by kind");
  for (const auto& [kind, count] : faults) family.add(count, {{"kind", kind}});
  all.push_back(family.take());
}

void add_recorder(std::vector<MetricFamily>& all, const wire::RecorderStatus& recorder) {
  all.push_back(gauge("yuragi_recorder_writing", "1 if the recording can be written")
                    .add(recorder.state == wire::RecorderState::kWriting ? 1.0 : 0.0)
                    .take());
  all.push_back(counter("yuragi_recorder_written_total", "Readings on the disk").add(recorder.written).take());
  all.push_back(counter("yuragi_recorder_lost_total", "Readings that were dropped").add(recorder.lost).take());
  all.push_back(counter("yuragi_recorder_elsewhere_total", "Readings recorded by another process")
                    .add(recorder.recorded_elsewhere)
                    .take());
  all.push_back(gauge("yuragi_recorder_waiting", "Readings that are not written yet").add(recorder.waiting).take());
  if (recorder.free_bytes)
    all.push_back(gauge("yuragi_recorder_free_bytes", "Free space on its disk").add(*recorder.free_bytes).take());
}

}  // namespace

std::string metrics_text(const wire::Sensors& sensors, const std::string& software, const Counts& counts,
                         const FaultCounts& faults) {
  std::vector<MetricFamily> all;
  all.push_back(gauge("yuragi_build_info", "The program").add(1.0, {{"software", software}}).take());
  add_wind(all, sensors);
  add_sensors(all, sensors);
  add_lateness(all, sensors);
  if (sensors.animation) add_animation(all, *sensors.animation);
  add_by_hand(all, sensors.by_hand);
  add_clients(all, sensors);
  add_feeds(all, sensors.feeds);
  add_web(all, counts);
  add_faults(all, faults);
  if (sensors.recorder) add_recorder(all, *sensors.recorder);
  return prometheus::TextSerializer().prometheus::Serializer::Serialize(all);
}

}  // namespace yuragi::daemon::web
