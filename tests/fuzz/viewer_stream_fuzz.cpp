#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <variant>
#include <vector>

#include "engine/wire/message_reader.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/engine/wire/soundness.hpp"
#include "viewer/stream/lockstep_timeline.hpp"
#include "viewer/stream/scene_timeline.hpp"

// A hostile daemon for the viewer: any order of good messages, hurt ones and garbage, at any times. Whatever comes,
// what is to be drawn is a sound pose of each scene that is shown.
//
// The input is a list of steps of four bytes: which message, a place in it, what stands there instead, and how long it
// is until the next.

namespace {

using namespace yuragi;

void demand_that_it_can_be_drawn(const viewer::stream::PoseMoment& moment, std::span<const wire::SceneModel> scenes) {
  if (moment.poses.size() != scenes.size() || moment.opacities.size() != scenes.size()) std::abort();
  if (!viewer::stream::has_same_layout(moment.poses, viewer::stream::rest_moment(scenes).poses)) std::abort();
  for (const pose::Pose& pose : moment.poses) {
    if (!samples::is_sound(pose)) std::abort();
  }
  for (const float opacity : moment.opacities) {
    if (!(opacity >= 0.0F && opacity <= 1.0F)) std::abort();
  }
}

/// Both ways to show a stream: as it arrives, and in lock-step.
class Shown {
 public:
  void take(wire::Message message, double now_s) {
    if (auto* scenes = std::get_if<wire::Scenes>(&message)) {
      film_scenes_ = scenes->scenes;
      film_.set_scenes(film_scenes_);
      live_.set_scenes(std::move(*scenes));
    } else if (auto* frame = std::get_if<wire::Frame>(&message)) {
      wire::Frame other = *frame;
      if (film_.accept(other)) demand_that_it_can_be_drawn(film_.at(film_.newest_s()), film_scenes_);
      live_.accept(*frame, now_s);
    }
  }

  void show(double now_s) {
    const viewer::stream::PoseMoment& moment = live_.advance(now_s);
    if (auto scenes = live_.take_new_scenes()) live_scenes_ = std::move(*scenes);
    demand_that_it_can_be_drawn(moment, live_scenes_);
  }

 private:
  viewer::stream::SceneTimeline live_;
  viewer::stream::LockstepTimeline film_;
  std::vector<wire::SceneModel> live_scenes_, film_scenes_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<wire::Bytes> messages = samples::one_of_each();
  wire::MessageReader reader(1 << 20);
  Shown shown;
  double now_s = 0.0;
  for (auto steps = std::span(data, size); steps.size() >= 4; steps = steps.subspan(4)) {
    const std::size_t choice = steps[0] % (messages.size() + 1);
    if (choice == messages.size()) {
      reader.feed(steps.first(4));
    } else {
      wire::Bytes message = messages[choice];
      if (steps[1] != 0) message[steps[1] * std::size_t{37} % message.size()] = steps[2];
      reader.feed(message);
    }
    while (auto message = reader.next()) {
      if (*message) {
        shown.take(std::move(**message), now_s);
      } else if (message->error() == wire::Error::kTooLong) {
        reader = wire::MessageReader(1 << 20);  // as a viewer that connects again
        break;
      }
    }
    now_s += 1e-3 * steps[3] * steps[3];
    shown.show(now_s);
  }
  return 0;
}
