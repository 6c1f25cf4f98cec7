#include "daemon/follow/questions.hpp"

#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/follow/small_json.hpp"
#include "engine/base/snapshot.hpp"
#include "engine/wire/lead/wind_tick.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::follow {
namespace {

/// The first byte of a reply.
enum class Kind : std::uint8_t { kIntroduction = 'I', kTicks = 'T', kStatePart = 'S', kNodes = 'N' };

constexpr std::string_view kLeader = "leader", kTicks = "ticks", kState = "state", kFleet = "fleet";
constexpr std::size_t kMaxName_bytes = 200;
/// In the place of what a snapshot is made of.
constexpr std::uint64_t kPartMark = 0x7374'6174'6570'6172;
constexpr std::size_t kLength_bytes = 2;

Result<Reply, Failure> decode_introduction(std::span<const std::uint8_t> bytes) {
  const nlohmann::json object = small_json(bytes);
  if (!object.is_object()) return bad_data("is no introduction of a leader");
  const auto epoch = count_at(object, "epoch"), motion = count_at(object, "motion"), wind = count_at(object, "wind");
  const auto delay_s = number_at(object, "delay", 60.0), rate_hz = number_at(object, "rate", 1000.0);
  const auto software = text_at(object, "software", kMaxName_bytes);
  const auto scenes = object.find("scenes");
  if (!epoch || !motion || *motion > ~0U || !wind || !delay_s || *delay_s <= 0.0 || !rate_hz || *rate_hz <= 0.0 ||
      !software || scenes == object.end() || !scenes->is_array() || scenes->size() > wire::kMaxScenes) {
    return bad_data("is an introduction of a leader with a key that is missing or has no such value");
  }
  Introduction introduction{.epoch = *epoch,
                            .delay_s = *delay_s,
                            .makeup = {.software = *software,
                                       .motion = static_cast<std::uint32_t>(*motion),
                                       .rate_hz = *rate_hz,
                                       .wind = *wind,
                                       .scenes = {}}};
  for (const nlohmann::json& scene : *scenes) {
    if (!scene.is_array() || scene.size() != 2 || !scene[1].is_number_unsigned())
      return bad_data("has a scene that is none");
    auto name = short_text(scene[0], kMaxName_bytes);
    if (!name) return bad_data("has a scene without a name");
    introduction.makeup.scenes.emplace_back(std::move(*name), scene[1].get<std::uint64_t>());
  }
  return Reply(std::move(introduction));
}

Result<Reply, Failure> decode_ticks(std::span<const std::uint8_t> bytes) {
  Ticks ticks;
  while (!bytes.empty()) {
    if (bytes.size() < kLength_bytes) return bad_data("ends within a tick");
    const std::size_t size = bytes[0] + (std::size_t{bytes[1]} << 8U);
    bytes = bytes.subspan(kLength_bytes);
    if (size == 0 || size > wire::lead::kMaxWindTick_bytes || size > bytes.size())
      return bad_data("ends within a tick");
    ticks.ticks.emplace_back(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    bytes = bytes.subspan(size);
  }
  return Reply(std::move(ticks));
}

struct PartHead {
  std::uint64_t epoch = 0, number = 0, made_of = 0, total_bytes = 0, first_byte = 0;
  void list_state(StatePass& pass) { pass(epoch, number, made_of, total_bytes, first_byte); }
};
constexpr std::size_t kPartHead_bytes = 5 * sizeof(std::uint64_t);

Result<Reply, Failure> decode_part(std::span<const std::uint8_t> bytes) {
  const auto opened = opened_snapshot(bytes, kPartMark);
  if (!opened) return opened.error();
  if (opened->size() <= kPartHead_bytes) return bad_data("is too short for a part of a state");
  PartHead head;
  StatePass::loading(opened->first(kPartHead_bytes))(head);
  const auto part = opened->subspan(kPartHead_bytes);
  if (head.total_bytes > kMaxState_bytes || head.first_byte > head.total_bytes ||
      part.size() > head.total_bytes - head.first_byte) {
    return bad_data("is a part that exceeds its state");
  }
  return Reply(StatePart{.epoch = head.epoch,
                         .number = head.number,
                         .made_of = head.made_of,
                         .total_bytes = head.total_bytes,
                         .first_byte = head.first_byte,
                         .bytes = Bytes(part.begin(), part.end())});
}

std::string_view word_of(Question::About about) {
  switch (about) {
    case Question::About::kLeader:
      return kLeader;
    case Question::About::kTicks:
      return kTicks;
    case Question::About::kState:
      return kState;
    case Question::About::kFleet:
      return kFleet;
  }
  return {};
}

Bytes with_kind(Kind kind, const Bytes& bytes) {
  Bytes reply = {static_cast<std::uint8_t>(kind)};
  reply.insert(reply.end(), bytes.begin(), bytes.end());
  return reply;
}

}  // namespace

Bytes encode(const Question& question) {
  nlohmann::ordered_json json = {{"ask", word_of(question.about)}};
  if (question.epoch != 0) json["epoch"] = question.epoch;
  if (question.about == Question::About::kTicks) {
    json["from"] = question.from;
    json["to"] = question.to;
  }
  return bytes_of(json);
}

Bytes encode(const Introduction& introduction) {
  const PictureMakeup& makeup = introduction.makeup;
  return with_kind(Kind::kIntroduction, bytes_of({{"epoch", introduction.epoch},
                                                  {"delay", introduction.delay_s},
                                                  {"software", makeup.software},
                                                  {"motion", makeup.motion},
                                                  {"rate", makeup.rate_hz},
                                                  {"wind", makeup.wind},
                                                  {"scenes", makeup.scenes}}));
}

Bytes encode(const Ticks& ticks) {
  Bytes all;
  for (const Bytes& tick : ticks.ticks) {
    all.push_back(static_cast<std::uint8_t>(tick.size() & 0xFFU));
    all.push_back(static_cast<std::uint8_t>(tick.size() >> 8U));
    all.insert(all.end(), tick.begin(), tick.end());
  }
  return with_kind(Kind::kTicks, all);
}

Bytes encode(const NodeList& list) {
  return with_kind(Kind::kNodes, list_bytes(list));
}

Bytes encode(const StatePart& part) {
  PartHead head{part.epoch, part.number, part.made_of, part.total_bytes, part.first_byte};
  Bytes bytes;
  StatePass::saving(bytes)(head);
  bytes.insert(bytes.end(), part.bytes.begin(), part.bytes.end());
  return with_kind(Kind::kStatePart, closed_snapshot(bytes, kPartMark));
}

Result<Question, Failure> decode_question(std::span<const std::uint8_t> bytes) {
  const nlohmann::json object = small_json(bytes);
  if (!object.is_object()) return bad_data("is no question");
  const auto ask = object.find("ask");
  if (ask == object.end() || !ask->is_string()) return bad_data("asks for nothing");
  const auto& word = ask->get_ref<const std::string&>();
  if (word == kLeader) return Question{};
  if (word == kFleet) return Question{.about = Question::About::kFleet};
  const auto epoch = count_at(object, "epoch");
  if (!epoch) return bad_data("asks without an epoch");
  if (word == kState) return Question{.about = Question::About::kState, .epoch = *epoch};
  const auto from = count_at(object, "from"), to = count_at(object, "to");
  if (word != kTicks || !from || !to || *from > *to) return bad_data("asks for what is not known");
  return Question{.about = Question::About::kTicks, .epoch = *epoch, .from = *from, .to = *to};
}

Result<Reply, Failure> decode_reply(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return bad_data("is empty");
  const auto rest = bytes.subspan(1);
  switch (static_cast<Kind>(bytes[0])) {
    case Kind::kIntroduction:
      return decode_introduction(rest);
    case Kind::kTicks:
      return decode_ticks(rest);
    case Kind::kStatePart:
      return decode_part(rest);
    case Kind::kNodes:
      if (auto list = decode_node_list(rest)) return Reply(std::move(*list));
      return bad_data("is no list of nodes");
  }
  return bad_data("is of no known kind");
}

}  // namespace yuragi::daemon::follow
