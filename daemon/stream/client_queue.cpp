#include "daemon/stream/client_queue.hpp"

#include <utility>

namespace yuragi::daemon::stream {

std::string_view name_of(Overdue why) {
  switch (why) {
    case Overdue::kNeverSubscribed:
      return "it did not subscribe";
    case Overdue::kStuck:
      return "it stopped reading";
  }
  return "?";
}

ClientQueue::ClientQueue(const ClientLimits& limits, SharedBytes hello, MonoTime now)
    : limits_(limits), connected_(now), moved_(now) {
  setup_.push_back(std::move(hello));
}

void ClientQueue::subscribe(bool poses, bool sensors, SharedBytes scenes, SharedBytes newest_frame,
                            SharedBytes newest_sensors) {
  subscribed_ = true;
  wants_poses_ = poses;
  wants_sensors_ = sensors;
  if (poses && scenes) setup_.push_back(std::move(scenes));
  if (newest_frame) offer_frame(std::move(newest_frame));
  if (newest_sensors) offer_sensors(std::move(newest_sensors));
}

void ClientQueue::offer_frame(SharedBytes frame) {
  if (!wants_poses_) return;
  if (pending_frame_) ++frames_skipped_;
  pending_frame_ = std::move(frame);
}

void ClientQueue::offer_sensors(SharedBytes sensors) {
  if (wants_sensors_) pending_sensors_ = std::move(sensors);
}

bool ClientQueue::offer_reply(SharedBytes reply) {
  constexpr std::size_t kMostWaiting = 16;
  if (setup_.size() >= kMostWaiting) return false;
  setup_.push_back(std::move(reply));
  return true;
}

bool ClientQueue::offer_trace(SharedBytes trace) {
  constexpr std::size_t kMostWaiting = 256;
  if (traces_.size() >= kMostWaiting) return false;
  traces_.push_back(std::move(trace));
  return true;
}

std::span<const std::uint8_t> ClientQueue::to_write(MonoTime now) {
  if (!in_flight_) {
    // Sensors and traces take precedence over frames: they are small and rare, while frames are always waiting.
    if (!setup_.empty()) {
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
  if (!subscribed_ && now - connected_ >= limits_.subscribe_within) return Overdue::kNeverSubscribed;
  if (in_flight_ && now - moved_ >= limits_.stuck_after) return Overdue::kStuck;
  return std::nullopt;
}

}  // namespace yuragi::daemon::stream
