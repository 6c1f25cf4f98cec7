#include "tests/viewer/stream/simulated_playback.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "viewer/stream/scene_timeline.hpp"

namespace yuragi::viewer::stream {
namespace {

constexpr double kSenderBegins_s = 40.0;  // of the sender's clock
constexpr double kViewerBegins_s = 1000.0;
constexpr double kRepeated = 0.05;  // of a display interval: less is the same picture again

double swing(double sender_s) {
  return std::sin(2.0 * std::numbers::pi * sender_s);
}

wire::SceneModel one_strand() {
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = 1;
  skeleton.links_per_strand = 2;
  skeleton.root_x_m.resize(skeleton.padded_count());
  return {"meadow", "grass", skeleton};
}

wire::Frame frame_at(double sender_s) {
  wire::Frame frame;
  frame.info.time_s = sender_s;
  const std::vector<float> bends(pose::padded_to_blocks(1), static_cast<float>(swing(sender_s)));
  frame.poses.emplace_back(pose::StrandPose{bends, bends});
  frame.opacities.push_back(1.0F);
  return frame;
}

/// Which frames arrive, and when.
class Sender {
 public:
  Sender(const Network& network, double stream_hz, std::uint64_t seed)
      : network_(network), interval_s_(1.0 / stream_hz), random_(seed) {
    schedule();
  }

  /// The viewer's time at the sender's, without any delay.
  double viewer_s(double sender_s) const {
    return kViewerBegins_s + (sender_s - kSenderBegins_s) / (1.0 + 1e-6 * network_.drift_ppm);
  }
  double sender_s(double viewer_s) const {
    return kSenderBegins_s + (viewer_s - kViewerBegins_s) * (1.0 + 1e-6 * network_.drift_ppm);
  }

  /// Hands over what has arrived by now_s.
  void deliver(double now_s, SceneTimeline& to) {
    for (; arrival_s_ <= now_s; schedule()) {
      if (is_lost_) continue;
      wire::Frame frame = frame_at(frame_s_);
      to.accept(frame, arrival_s_);
    }
  }

 private:
  void schedule() {
    frame_s_ = kSenderBegins_s + static_cast<double>(number_++) * interval_s_;
    std::uniform_real_distribution<double> share(0.0, 1.0);
    double ready_s = viewer_s(frame_s_) + network_.latency_s + network_.jitter_s * share(random_);
    if (network_.silence_every_s > 0.0) {
      const double into_s = std::fmod(viewer_s(frame_s_) - kViewerBegins_s, network_.silence_every_s);
      const double begins_s = network_.silence_every_s - network_.silence_s;
      if (into_s > begins_s) ready_s += network_.silence_every_s - into_s;
    }
    arrival_s_ = std::max(arrival_s_, ready_s);
    is_lost_ = share(random_) < network_.lost_share;
  }

  const Network network_;
  const double interval_s_;
  std::mt19937_64 random_;
  std::uint64_t number_ = 0;
  double frame_s_ = 0.0;
  double arrival_s_ = 0.0;
  bool is_lost_ = false;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

PlaybackFigures simulate_playback(const Network& network, double stream_hz, double display_hz, double settling_s,
                                  double duration_s, std::uint64_t seed) {
  struct Seen {
    double now_s;    // the sender's clock, when the picture was shown
    double shown_s;  // the moment that it is of
    double pose;
  };
  SceneTimeline timeline;
  timeline.set_scenes({{one_strand()}});
  Sender sender(network, stream_hz, seed);
  std::vector<Seen> seen;
  const double interval_s = 1.0 / display_hz;
  const auto pictures = static_cast<std::uint64_t>((settling_s + duration_s) * display_hz);
  for (std::uint64_t picture = 0; picture < pictures; ++picture) {
    const double since_s = static_cast<double>(picture) * interval_s;
    const double now_s = kViewerBegins_s + since_s;
    sender.deliver(now_s, timeline);
    const PoseMoment& moment = timeline.advance(now_s);
    if (since_s < settling_s) continue;
    const auto& strand = std::get<pose::StrandPose>(moment.poses.at(0));
    seen.push_back({sender.sender_s(now_s), moment.time_s, static_cast<double>(strand.bend_east_rad.at(0))});
  }

  PlaybackFigures figures{.pictures = seen.size()};
  std::vector<double> delays_s;
  std::vector<double> step_errors;
  for (const Seen& one : seen) delays_s.push_back(one.now_s - one.shown_s);
  figures.median_delay_s = percentile(delays_s, 0.5);
  figures.longest_delay_s = percentile(delays_s, 1.0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double true_pose = swing(seen[i].now_s - figures.median_delay_s);
    figures.largest_pose_error = std::max(figures.largest_pose_error, std::abs(seen[i].pose - true_pose));
    if (i == 0) continue;
    const double step = (seen[i].shown_s - seen[i - 1].shown_s) / interval_s;
    step_errors.push_back(std::abs(step - 1.0));
    if (std::abs(step) < kRepeated) ++figures.repeated;
    if (step < 0.0) ++figures.backward;
  }
  figures.typical_step_error = percentile(step_errors, 0.99);
  figures.largest_step_error = percentile(step_errors, 1.0);
  return figures;
}

}  // namespace yuragi::viewer::stream
