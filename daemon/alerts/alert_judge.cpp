#include "daemon/alerts/alert_judge.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "daemon/settings/duration_text.hpp"
#include "engine/base/count_text.hpp"
#include "engine/wire/sensor_trouble.hpp"

namespace yuragi::daemon::alerts {
namespace {

using settings::AlertCondition;
using settings::AlertConfig;

constexpr double kMegabyte = 1e6;
constexpr Nanoseconds kMaxAge = std::chrono::hours(10 * 365 * 24);

}  // namespace

void Judge::change(const std::vector<AlertConfig>& alerts) {
  std::vector<Alert> next;
  for (const AlertConfig& config : alerts) {
    const auto before = std::ranges::find_if(alerts_, [&](const Alert& alert) {
      return alert.config.name == config.name && alert.config.when == config.when;
    });
    next.push_back(
        {config, before != alerts_.end() ? std::move(before->of_subject) : std::map<std::string, Progress>()});
  }
  alerts_ = std::move(next);
}

void Judge::resume(const std::vector<Active>& on, const Instant& now) {
  for (const Active& one : on) {
    const bool is_of_sensor = one.when == AlertCondition::kSensorSilent;
    for (Alert& alert : alerts_) {
      if (alert.config.name != one.alert || alert.config.when != one.when || one.subject.empty() == is_of_sensor)
        continue;
      // The clock may have been set meanwhile.
      const Nanoseconds age = std::clamp<Nanoseconds>(now.utc - one.begun, Nanoseconds::zero(), kMaxAge);
      alert.of_subject[one.subject] = {.has_begun = true, .begun = now.mono - age, .begun_utc = one.begun};
    }
  }
}

std::vector<Active> Judge::on() const {
  std::vector<Active> all;
  for (const Alert& alert : alerts_) {
    for (const auto& [subject, progress] : alert.of_subject) {
      if (progress.has_begun) all.push_back({alert.config.name, alert.config.when, subject, progress.begun_utc});
    }
  }
  return all;
}

std::vector<values::AlertState> Judge::states() const {
  std::vector<values::AlertState> all;
  for (const Alert& alert : alerts_) {
    const bool is_on =
        std::ranges::any_of(alert.of_subject, [](const auto& subject) { return subject.second.has_begun; });
    all.push_back({alert.config.name, is_on});
  }
  return all;
}

std::vector<Judge::Subject> Judge::subjects_of(const AlertConfig& alert, const wire::Sensors& status) const {
  switch (alert.when) {
    case AlertCondition::kSensorSilent: {
      std::vector<Subject> subjects;
      for (const wire::SensorStatus& sensor : status.sensors) {
        if (!alert.sensor.empty() && sensor.name != alert.sensor) continue;
        const std::string trouble = trouble_of(sensor);
        subjects.push_back({.name = sensor.name,
                            .holds = !trouble.empty(),
                            .begins = fmt::format("sensor {} {}", sensor.name, trouble),
                            .ends = fmt::format("sensor {} is {} again", sensor.name, name_of(sensor.state))});
      }
      return subjects;
    }
    case AlertCondition::kWindAbove: {
      if (status.wind.live_weight <= 0.5) return {};  // it is not measured
      const double speed_m_s = wind::speed_of(status.wind.wind);
      return {{.name = {},
               .holds = speed_m_s > alert.speed_m_s,
               .begins = fmt::format("the wind is {:.1f} m/s, above {:.1f} m/s", speed_m_s, alert.speed_m_s),
               .ends = fmt::format("the wind is below {:.1f} m/s again", alert.speed_m_s)}};
    }
    case AlertCondition::kDiskBelow: {
      if (!status.recorder || !status.recorder->free_bytes) return {};
      const auto free_bytes = static_cast<double>(*status.recorder->free_bytes);
      return {{.name = {},
               .holds = free_bytes < alert.free_bytes,
               .begins = fmt::format("the disk of the recording has {:.0f} MB free, less than {:.0f} MB",
                                     free_bytes / kMegabyte, alert.free_bytes / kMegabyte),
               .ends = fmt::format("the disk of the recording has {:.0f} MB free again", free_bytes / kMegabyte)}};
    }
    case AlertCondition::kNotRecording: {
      if (!status.recorder) return {};
      const std::string lost = fmt::format("{} lost", count_text(status.recorder->lost, "reading"));
      return {{.name = {},
               .holds = status.recorder->state != wire::RecorderState::kWriting,
               .begins = fmt::format("nothing is recorded: {}; {}", status.recorder->error, lost),
               .ends = fmt::format("readings are recorded again; {}", lost)}};
    }
    case AlertCondition::kNoFrame:
      if (!frames_) return {};
      return {{.name = {},
               .holds = !has_new_frame_,
               .begins = "the animation makes no frames",
               .ends = "the animation makes frames again"}};
  }
  return {};
}

std::vector<News> Judge::judge(const wire::Sensors& status, std::optional<std::uint64_t> frames, const Instant& now) {
  has_new_frame_ = frames != frames_;
  frames_ = frames;

  std::vector<News> all;
  for (Alert& alert : alerts_) {
    const std::vector<Subject> subjects = subjects_of(alert.config, status);
    if (alert.config.when == AlertCondition::kSensorSilent) {  // sensors come and go with the configuration
      std::erase_if(alert.of_subject, [&](const auto& known) {
        return std::ranges::find(subjects, known.first, &Subject::name) == subjects.end();
      });
    }
    for (const Subject& subject : subjects) {
      Progress& progress = alert.of_subject[subject.name];
      if (subject.holds == progress.has_begun) {
        progress.differs_since.reset();
        continue;
      }
      if (!progress.differs_since) progress.differs_since = now.mono;
      const double for_s = seconds(now.mono - *progress.differs_since);
      if (for_s < (progress.has_begun ? alert.config.end_after_s : alert.config.after_s)) continue;

      News news{.alert = alert.config.name,
                .has_begun = subject.holds,
                .time = now.utc,
                .command = alert.config.command,
                .webhook = alert.config.webhook};
      if (subject.holds) {
        news.message = subject.begins;
        if (for_s > 0.0) news.message += fmt::format(" (for {})", settings::duration_text(for_s));
        progress.begun = *progress.differs_since;
        progress.begun_utc = now.utc - (now.mono - progress.begun);
      } else {
        const double lasted_s = seconds(*progress.differs_since - progress.begun);
        news.message = fmt::format("{}, after {}", subject.ends, settings::duration_text(lasted_s));
      }
      if (news.message.size() > kMaxMessage_bytes) news.message.resize(kMaxMessage_bytes);
      progress.has_begun = subject.holds;
      progress.differs_since.reset();
      all.push_back(std::move(news));
    }
  }
  return all;
}

}  // namespace yuragi::daemon::alerts
