#include "daemon/stream/client_queue.hpp"

#include <utility>

#include <fmt/core.h>

namespace yuragi::daemon::stream {

std::string reason_text(Overdue why, const ClientLimits& limits) {
  switch (why) {
    case Overdue::kNeverSubscribed:
      return fmt::format("it did not subscribe within {:g} s", seconds(limits.subscribe_within));
    case Overdue::kStuck:
      return fmt::format("it stopped reading for {:g} s", seconds(limits.stuck_after));
    case Overdue::kIdle:
      return fmt::format("it subscribed to nothing and requested nothing for {:g} min",
                         seconds(limits.idle_after) / 60.0);
    case Overdue::kStayed:
      return fmt::format("its place, besides those of the other clients, is for {:g} s",
                         seconds(limits.stays_for.value_or(Nanoseconds{0})));
  }
  return "?";
}

ClientQueue::ClientQueue(const ClientLimits& limits, SharedBytes hello, MonoTime now)
    : limits_(limits), connected_(now), asked_(now), moved_(now) {
  is_greeted_ = hello == nullptr;
  if (hello) setup_.push_back(std::move(hello));
}

void ClientQueue::subscribe(const Wanted& wanted, SharedBytes scenes, SharedBytes newest_frame,
                            SharedBytes newest_sensors, MonoTime now) {
  subscribed_ = true;
  asked_ = now;
  wanted_ = wanted;
  if (scenes) offer_scenes(std::move(scenes));
  if (newest_frame) offer_frame(std::move(newest_frame));
  if (newest_sensors) offer_sensors(std::move(newest_sensors));
}

void ClientQueue::dismiss(SharedBytes last) {
  dismissed_ = true;
  wanted_ = {};
  setup_.clear();
  traces_.clear();
  pending_scenes_.reset();
  pending_sensors_.reset();
  pending_frame_.reset();
  setup_.push_back(std::move(last));
}

void ClientQueue::offer_scenes(SharedBytes scenes) {
  if (!wanted_.poses) return;
  if (pending_frame_) ++frames_skipped_;
  pending_frame_.reset();
  pending_scenes_ = std::move(scenes);
}

void ClientQueue::offer_frame(SharedBytes frame) {
  if (!wants_frames()) return;
  if (pending_frame_) ++frames_skipped_;
  pending_frame_ = std::move(frame);
}

void ClientQueue::offer_sensors(SharedBytes sensors) {
  if (wanted_.sensors) pending_sensors_ = std::move(sensors);
}

bool ClientQueue::offer_reply(SharedBytes reply) {
  constexpr std::size_t kMaxWaiting = 16;
  if (dismissed_ || setup_.size() >= kMaxWaiting) return false;
  setup_.push_back(std::move(reply));
  return true;
}

bool ClientQueue::offer_trace(SharedBytes trace) {
  constexpr std::size_t kMaxWaiting = 256;
  if (dismissed_ || traces_.size() >= kMaxWaiting) return false;
  traces_.push_back(std::move(trace));
  return true;
}

std::span<const std::uint8_t> ClientQueue::to_write(MonoTime now) {
  if (!in_flight_) {
    // Scenes come before everything that may be about them. Sensors and traces take precedence over frames: they are
    // small and rare, while frames are always waiting.
    if (is_greeted_ && pending_scenes_) {
      in_flight_ = std::exchange(pending_scenes_, nullptr);
    } else if (!setup_.empty()) {
      is_greeted_ = true;
      in_flight_ = std::move(setup_.front());
      setup_.pop_front();
    } else if (pending_sensors_) {
      in_flight_ = std::exchange(pending_sensors_, nullptr);
    } else if (!traces_.empty()) {
      in_flight_ = std::move(traces_.front());
      traces_.pop_front();
    } else if (pending_frame_) {
      in_flight_ = std::exchange(pending_frame_, nullptr);
      in_flight_is_frame_ = true;
    } else {
      return {};
    }
    moved_ = now;
  }
  return std::span<const std::uint8_t>(*in_flight_).subspan(in_flight_written_);
}

void ClientQueue::written(std::size_t bytes, MonoTime now) {
  if (bytes == 0) return;
  moved_ = now;
  in_flight_written_ += bytes;
  if (in_flight_written_ < in_flight_->size()) return;

  // The whole message has been written.
  if (in_flight_is_frame_) ++frames_sent_;
  in_flight_is_frame_ = false;
  in_flight_written_ = 0;
  in_flight_.reset();
}

std::optional<Overdue> ClientQueue::overdue(MonoTime now) const {
  if (in_flight_ && now - moved_ >= limits_.stuck_after) return Overdue::kStuck;
  if (dismissed_) return std::nullopt;
  if (limits_.stays_for && now - connected_ >= *limits_.stays_for) return Overdue::kStayed;
  if (!subscribed_ && now - connected_ >= limits_.subscribe_within) return Overdue::kNeverSubscribed;
  const bool wants_nothing = !wants_frames() && !wanted_.sensors && !wanted_.traces;
  if (subscribed_ && wants_nothing && now - asked_ >= limits_.idle_after) return Overdue::kIdle;
  return std::nullopt;
}

}  // namespace yuragi::daemon::stream
