#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "engine/wire/message_reader.hpp"
#include "engine/wire/thinner.hpp"
#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/engine/wire/soundness.hpp"

// Hostile bytes for the stream's decoder and its reader. The first byte of the input chooses: raw bytes, or damage to a
// good message, which gets behind the verifier without any corpus.

namespace {

using namespace yuragi;

/// A good message with bytes replaced: each three bytes of `damage` are a place (little-endian) and a value.
wire::Bytes damaged(wire::Bytes message, std::span<const std::uint8_t> damage) {
  for (; damage.size() >= 3; damage = damage.subspan(3)) {
    const std::size_t place = damage[0] + (std::size_t{damage[1]} << 8);
    message[place % message.size()] = damage[2];
  }
  return message;
}

void demand_place(const wind::State& wind) {
  if (!(std::abs(wind.upwind_m) <= 1e6) || !(wind.to_middle_s >= 0.0 && wind.to_middle_s <= 1e12)) std::abort();
}

void demand_lateness(const std::optional<wire::Lateness>& lateness) {
  if (!lateness) return;
  for (const double value_s : {lateness->p50_s, lateness->p99_s, lateness->max_s})
    if (!(value_s >= 0.0 && value_s <= 1e12)) std::abort();
}

void demand_parameters(const wire::ParameterReport& report) {
  if (report.groups.size() > wire::kMaxScenes + 1) std::abort();
  for (const wire::ParameterGroup& group : report.groups) {
    if (group.parameters.size() > wire::kMaxParameters) std::abort();
    for (const wire::ParameterState& parameter : group.parameters) {
      if (parameter.choices.size() > wire::kMaxParameterChoices) std::abort();
      if (!std::isfinite(parameter.min.value_or(0.0)) || !std::isfinite(parameter.max.value_or(0.0))) std::abort();
      if (parameter.min && parameter.max && !(*parameter.min <= *parameter.max)) std::abort();
    }
  }
}

/// What decode() promises of everything that it lets through.
void demand_consistency(const wire::Message& message) {
  if (const auto* scenes = std::get_if<wire::Scenes>(&message)) {
    std::size_t pixels = 0;
    for (const auto& scene : scenes->scenes) {
      if (!samples::is_sound(scene.skeleton)) std::abort();
      const auto& image = scene.cloth.image;
      if (image == nullptr) continue;
      if (image->rgb.size() != std::size_t{3} * image->width_px * image->height_px || image->rgb.empty()) std::abort();
      pixels += image->rgb.size() / 3;
    }
    if (pixels > wire::kMaxPixels) std::abort();
    for (const std::uint32_t every : {1U, 2U, 7U, wire::kMaxEvery}) {
      const wire::Thinner thinner(*scenes, {.every = every});
      for (const auto& scene : thinner.scenes().scenes)
        if (!samples::is_sound(scene.skeleton)) std::abort();
      // The frame is of other scenes than these, mostly.
      static const wire::Bytes frame = samples::frame_of_all_kinds();
      if (!wire::decode(samples::body(thinner.frame(frame)))) std::abort();
    }
    if (wire::scene_names(wire::encode(*scenes)).size() != scenes->scenes.size()) std::abort();
  }
  if (const auto* wish = std::get_if<wire::Subscribe>(&message)) {
    if (wish->thinning.scenes.size() > wire::kMaxScenes) std::abort();
    if (wish->thinning.every < 1 || wish->thinning.every > wire::kMaxEvery) std::abort();
    if (!(wish->rate_hz >= 0.0 && wish->rate_hz <= wire::kMaxRate_hz)) std::abort();
    if (wish->frame_thinning().is_wind_alone == wish->poses) std::abort();
  }
  if (const auto* trace = std::get_if<wire::RawTrace>(&message)) {
    if (trace->bytes.size() > wire::kMaxRawBytes || trace->bytes.size() > trace->length) std::abort();
  }
  if (const auto* control = std::get_if<wire::Control>(&message); control != nullptr && control->player) {
    const wire::PlayerCommand& wish = *control->player;
    if (!(wish.rate >= wire::kMinPlayRate && wish.rate <= wire::kMaxPlayRate)) std::abort();
    if (wish.count < 1 || wish.count > wire::kMaxSteps) std::abort();
  }
  if (const auto* control = std::get_if<wire::Control>(&message); control != nullptr && control->parameters) {
    if (control->parameters->edits.size() > wire::kMaxParameterEdits) std::abort();
  }
  if (const auto* reply = std::get_if<wire::ControlReply>(&message); reply != nullptr && reply->parameters) {
    demand_parameters(*reply->parameters);
  }
  if (const auto* sensors = std::get_if<wire::Sensors>(&message)) {
    demand_place(sensors->wind);
    demand_lateness(sensors->io_lateness);
    demand_lateness(sensors->tick_lateness);
    if (sensors->animation && sensors->animation->scenes.size() > wire::kMaxScenes) std::abort();
  }
  if (const auto* frame = std::get_if<wire::Frame>(&message)) {
    if (frame->opacities.size() != frame->poses.size()) std::abort();
    demand_place(frame->info.wind);
    for (const auto& pose : frame->poses)
      if (!samples::is_sound(pose)) std::abort();
    for (const float opacity : frame->opacities)
      if (!(opacity >= 0.0f && opacity <= 1.0f)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<wire::Bytes> messages = samples::one_of_each();
  if (size == 0) return 0;
  const auto rest = std::span(data, size).subspan(1);
  const std::size_t choice = data[0] % (messages.size() + 1);
  const wire::Bytes stream =
      choice == messages.size() ? wire::Bytes(rest.begin(), rest.end()) : damaged(messages[choice], rest);

  // As one message.
  if (stream.size() > wire::kSizePrefixBytes) {
    const auto message = wire::decode(samples::body(stream));
    if (message) demand_consistency(*message);
  }

  // As a stream, in two pieces.
  wire::MessageReader reader(1 << 16);
  const std::size_t split = stream.empty() ? 0 : (data[0] * std::size_t{7}) % stream.size();
  for (const auto piece : {std::span(stream).first(split), std::span(stream).subspan(split)}) {
    reader.feed(piece);
    for (int i = 0; i < 100; ++i) {
      const auto message = reader.next();
      if (!message) break;
      if (*message) demand_consistency(**message);
    }
  }
  return 0;
}
