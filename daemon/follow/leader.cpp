#include "daemon/follow/leader.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::daemon::follow {
namespace {

/// A state is saved at most this often: it takes some ms of the animation's thread.
constexpr auto kSaveEvery = std::chrono::seconds(1);
/// A reply goes to the inbox of a link, and nowhere else: nobody has others' subjects flooded.
constexpr std::string_view kInbox = "_INBOX.";
constexpr std::size_t kSlack_bytes = 64UL * 1024;

}  // namespace

Leader::Leader(PictureMakeup makeup, double rate_hz, Nanoseconds delay, std::size_t state_bytes, Subjects subjects,
               animation::LedSteps& steps, Send send)
    : makeup_(std::move(makeup)),
      rate_hz_(rate_hz),
      delay_(delay),
      state_bytes_(state_bytes),
      subjects_(std::move(subjects)),
      steps_(steps),
      send_(std::move(send)) {}

void Leader::begin_epoch(UtcTime now, std::uint64_t after, std::uint64_t number) {
  const Nanoseconds since = now.time_since_epoch();
  epoch_ = std::max(static_cast<std::uint64_t>(std::max<Nanoseconds::rep>(since.count(), 1)), after + 1);
  const double by_clock = std::floor(std::max(0.0, seconds(since)) * rate_hz_);
  number_ = std::max({static_cast<std::uint64_t>(by_clock), number, number_}) + 1;
  kept_.clear();
  waiting_.clear();
  parts_.clear();
  is_saving_ = false;
}

bool Leader::cue(const animation::SceneCue& cue) {
  if (cues_.size() >= wire::lead::WindTick::kMaxCues) return false;
  cues_.push_back({.scene = static_cast<std::uint32_t>(cue.scene),
                   .shown = cue.shown,
                   .hide_others = cue.hide_others,
                   .over_s = cue.over_s});
  return true;
}

void Leader::make_ticks(const wind::ground::DrivingWind& wind, const Instant& at, std::uint32_t periods) {
  const Nanoseconds period = from_seconds(1.0 / rate_hz_);
  if (periods * period > delay_) return make_tick(wind, at, periods);
  for (std::uint32_t left = periods; left-- > 0;) {
    const Nanoseconds before = left * period;
    make_tick(wind, {.mono = at.mono - before, .utc = at.utc - before}, 1);
  }
}

void Leader::make_tick(const wind::ground::DrivingWind& wind, const Instant& at, std::uint32_t periods) {
  number_ += periods;
  reply_bytes_left_ = std::min(kMaxReplies_bytes_s, reply_bytes_left_ + kMaxReplies_bytes_s * periods / rate_hz_);
  wire::lead::WindTick tick{
      .epoch = epoch_, .number = number_, .periods = periods, .utc = at.utc, .wind = wind, .cue_count = cues_.size()};
  std::ranges::copy(cues_, tick.cues.begin());
  cues_.clear();
  steps_.push(at.mono + delay_, tick, true);
  Bytes bytes = encode(tick);
  send_(subjects_.ticks, bytes);
  if (!parts_.empty()) {
    send_(parts_.front().first, parts_.front().second);
    parts_.pop_front();
  }
  kept_.emplace_back(number_, std::move(bytes));
  const auto most = static_cast<std::uint64_t>(rate_hz_ * static_cast<double>(kKept.count()));
  while (kept_.front().first + most < number_) kept_.pop_front();
}

void Leader::answer(std::span<const std::uint8_t> bytes, const std::string& reply_to, MonoTime now) {
  ++counts_.questions;
  const auto question = decode_question(bytes);
  const bool is_too_much = question && question->about != Question::About::kState && reply_bytes_left_ <= 0.0;
  if (!question || !reply_to.starts_with(kInbox) || is_too_much) {
    ++counts_.refused;
    return;
  }
  if (question->about == Question::About::kLeader) {
    return reply(reply_to, encode(Introduction{.epoch = epoch_, .delay_s = seconds(delay_), .makeup = makeup_}));
  }
  if (question->about == Question::About::kFleet) {
    for (const NodeList& part : parts_of(fleet_.nodes(now))) reply(reply_to, encode(part));
    return;
  }
  if (question->epoch != epoch_) return;  // it hears the new one, and asks again
  if (question->about == Question::About::kTicks) return send_ticks(*question, reply_to);
  if (waiting_.size() < kMaxWaiting && std::ranges::find(waiting_, reply_to) == waiting_.end())
    waiting_.push_back(reply_to);
  advance(now);
}

void Leader::take_report(std::span<const std::uint8_t> bytes, MonoTime now) {
  auto report = decode_node_report(bytes);
  if (!report) {
    ++counts_.refused;
    return;
  }
  fleet_.take(std::move(*report), now);
}

void Leader::send_ticks(const Question& question, const std::string& reply_to) {
  auto first = std::ranges::lower_bound(kept_, question.from, {}, &std::pair<std::uint64_t, Bytes>::first);
  Ticks ticks;
  std::size_t size = 0;
  // The last one may begin before `to` and end after it.
  for (; first != kept_.end() && size + first->second.size() < kMostInMessage_bytes; ++first) {
    size += first->second.size();
    ticks.ticks.push_back(first->second);
    if (first->first >= question.to) break;
  }
  if (ticks.ticks.empty()) return;
  counts_.repaired_ticks += ticks.ticks.size();
  reply(reply_to, encode(ticks));
}

void Leader::reply(const std::string& reply_to, const Bytes& bytes) {
  reply_bytes_left_ -= static_cast<double>(bytes.size());
  send_(reply_to, bytes);
}

void Leader::advance(MonoTime now) {
  if (is_saving_) {
    const auto saved = steps_.take_finished();
    if (!saved) return;
    is_saving_ = false;
    if (saved->is_done) {
      queue_state(*saved);
      waiting_.clear();
    }
  }
  if (waiting_.empty() || !parts_.empty() || now - saved_ < kSaveEvery) return;
  auto order = std::make_unique<animation::StateOrder>();
  order->state.reserve(state_bytes_ + kSlack_bytes);
  if (!steps_.order(order)) return;
  saved_ = now;
  is_saving_ = true;
}

void Leader::queue_state(const animation::StateOrder& saved) {
  ++counts_.states;
  state_bytes_ = saved.state.size();
  const std::string& to = waiting_.size() == 1 ? waiting_.front() : subjects_.states;
  const std::span<const std::uint8_t> state(saved.state);
  for (std::size_t first = 0; first < state.size(); first += kMostInMessage_bytes) {
    const auto part = state.subspan(first, std::min(kMostInMessage_bytes, state.size() - first));
    parts_.emplace_back(to, encode(StatePart{.epoch = epoch_,
                                             .number = saved.number,
                                             .made_of = makeup_.hash(),
                                             .total_bytes = state.size(),
                                             .first_byte = first,
                                             .bytes = Bytes(part.begin(), part.end())}));
  }
}

}  // namespace yuragi::daemon::follow
