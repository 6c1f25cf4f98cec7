// JetStream's API: https://docs.nats.io/reference/reference-protocols/nats_api_reference, seen with nats-server 2.9.10.
#include "daemon/follow/history_stream.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "daemon/follow/small_json.hpp"

namespace yuragi::daemon::follow {
namespace {

constexpr std::size_t kMaxName_bytes = 300, kMaxTrouble_bytes = 1000;
constexpr int kReplicas = 3;
constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr std::int64_t kMaxAge_ns = std::int64_t{25} * 3600 * kNanoseconds;
constexpr std::int64_t kMaxStream_bytes = std::int64_t{64} << 20U;
/// A reader that is gone is forgotten by the server after this long.
constexpr std::int64_t kReaderGone_ns = 5 * kNanoseconds;

// JetStream's errors (err_code).
constexpr std::uint64_t kNoReplicas = 10074;     ///< the server is not in a cluster
constexpr std::uint64_t kOtherSettings = 10058;  ///< the stream exists with other settings
constexpr std::uint64_t kSomeError = 1;          ///< without a number

constexpr std::string_view kTypeOfMade = "io.nats.jetstream.api.v1.stream_create_response";
constexpr std::string_view kTypeOfReads = "io.nats.jetstream.api.v1.consumer_create_response";

/// A reader's name becomes a part of a subject.
bool is_word(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char character) {
    return std::isalnum(character) != 0 || character == '_' || character == '-';
  });
}

}  // namespace

std::string history_stream_of(const std::string& channel) {
  std::string name = "yuragi_" + channel;
  std::ranges::replace_if(
      name, [](char character) { return !is_word(std::string(1, character)); }, '_');
  return name;
}

std::string history_subject_of(const std::string& channel) {
  return channel + ".history";
}

StreamRequest make_stream(const std::string& channel, int replicas) {
  const std::string name = history_stream_of(channel);
  return {.subject = "$JS.API.STREAM.CREATE." + name,
          .bytes = bytes_of({{"name", name},
                             {"subjects", {history_subject_of(channel)}},
                             {"num_replicas", replicas},
                             {"max_age", kMaxAge_ns},
                             {"max_bytes", kMaxStream_bytes},
                             {"discard", "old"},
                             {"storage", "file"}})};
}

StreamRequest read_stream(const std::string& channel, const std::string& inbox, std::uint64_t rate_bit_s) {
  const std::string name = history_stream_of(channel);
  nlohmann::ordered_json config = {{"deliver_subject", inbox},
                                   {"deliver_policy", "all"},
                                   {"ack_policy", "none"},
                                   {"replay_policy", "instant"},
                                   {"inactive_threshold", kReaderGone_ns}};
  if (rate_bit_s > 0) config["rate_limit_bps"] = rate_bit_s;
  return {.subject = "$JS.API.CONSUMER.CREATE." + name,
          .bytes = bytes_of({{"stream_name", name}, {"config", std::move(config)}})};
}

Result<StreamReply, Failure> decode_stream_reply(std::span<const std::uint8_t> bytes) {
  const nlohmann::json json = small_json(bytes);
  if (!json.is_object()) return bad_data("is no reply of JetStream");
  StreamReply reply;
  if (json.contains("type")) {
    const auto type = text_at(json, "type", kMaxName_bytes);
    if (type != kTypeOfMade && type != kTypeOfReads) return bad_data("is a reply of another kind");
    reply.kind = type == kTypeOfMade ? StreamReply::Kind::kMade : StreamReply::Kind::kReads;
  }
  if (const auto error = json.find("error"); error != json.end()) {
    if (!error->is_object()) return bad_data("has an error that is none");
    reply.error = std::max(kSomeError, count_at(*error, "err_code").value_or(count_at(*error, "code").value_or(0)));
    reply.trouble = text_at(*error, "description", kMaxTrouble_bytes).value_or("an error without a description");
    return reply;
  }
  if (reply.kind == StreamReply::Kind::kStored) {
    const auto stream = text_at(json, "stream", kMaxName_bytes);
    if (!stream || stream->empty() || count_at(json, "seq").value_or(0) == 0) return bad_data("stores nothing");
  } else if (reply.kind == StreamReply::Kind::kReads) {
    auto name = text_at(json, "name", kMaxName_bytes);
    const auto messages = count_at(json, "num_pending");
    if (!name || !is_word(*name) || !messages) return bad_data("has no reader");
    reply.reader = std::move(*name);
    reply.messages = *messages;
  }
  return reply;
}

void HistoryStream::begin(std::string inbox, MonoTime now) {
  if (step_ == Step::kReads) end_reading();
  inbox_ = std::move(inbox);
  replicas_ = kReplicas;
  go_on(Step::kMakes, now);
}

void HistoryStream::go_on(Step step, MonoTime now) {
  step_ = step;
  wait_ = kMinWait;
  next_ = heard_ = now;
  come_ = 0;
}

void HistoryStream::advance(MonoTime now) {
  if (step_ == Step::kNone) return;
  if (step_ == Step::kReads) {
    if (now - heard_ > kMaxSilence) end_reading();
    return;
  }
  if (now < next_) return;
  next_ = now + wait_;
  wait_ = std::min<Nanoseconds>(2 * wait_, kMaxWait);
  send_(step_ == Step::kMakes ? make_stream(channel_, replicas_) : read_stream(channel_, inbox_, kMaxRate_bit_s));
}

void HistoryStream::take_reply(const StreamReply& reply, MonoTime now) {
  const bool is_made = reply.kind == StreamReply::Kind::kMade && step_ == Step::kMakes;
  const bool is_read = reply.kind == StreamReply::Kind::kReads && step_ == Step::kAsksToRead;
  if (!is_made && !is_read) return;
  if (is_made && reply.error == kNoReplicas && replicas_ > 1) {
    replicas_ = 1;
    return go_on(Step::kMakes, now);
  }
  if (!reply.is_success() && reply.trouble != trouble_) {
    trouble_ = reply.trouble;
    spdlog::warn("company: the stream {} of the history: {}", history_stream_of(channel_), trouble_);
  }
  if (is_made && (reply.is_success() || reply.error == kOtherSettings)) return go_on(Step::kAsksToRead, now);
  if (!is_read || !reply.is_success()) return;
  // Some messages may have come before this reply.
  step_ = Step::kReads;
  heard_ = now;
  reader_ = reply.reader;
  expected_ = reply.messages;
  if (come_ >= expected_) end_reading();
}

void HistoryStream::note_message(MonoTime now) {
  heard_ = now;
  ++come_;
  if (step_ == Step::kReads && come_ >= expected_) end_reading();
}

/// Later entries would come, too: the list of nodes needs none of them.
void HistoryStream::end_reading() {
  step_ = Step::kNone;
  send_({.subject = "$JS.API.CONSUMER.DELETE." + history_stream_of(channel_) + "." + reader_, .bytes = {}});
}

}  // namespace yuragi::daemon::follow
