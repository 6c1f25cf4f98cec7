// Bodies of HTTP requests, which any client sends: what is taken is within the limits of the stream's own requests.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "daemon/web/request_body.hpp"
#include "engine/base/known_host.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace web = yuragi::daemon::web;
  namespace wire = yuragi::wire;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto control = web::scene_control_of(text)) {
    if (control->scene.empty() || control->scene.size() > wire::kMaxTextBytes) std::abort();
    if (!(control->over_s >= 0.0 && control->over_s <= wire::kMaxFade_s)) std::abort();
  }
  if (const auto command = web::player_command_of(text)) {
    if (command->count < 1 || command->count > wire::kMaxSteps) std::abort();
    if (!(command->rate >= wire::kMinPlayRate && command->rate <= wire::kMaxPlayRate)) std::abort();
  }
  if (const auto command = web::parameter_command_of(text)) {
    if (command->edits.empty() || command->edits.size() > wire::kMaxParameterEdits) std::abort();
  }
  for (const auto& command : {web::wind_by_hand_of(text), web::blackout_of(text), web::camera_of(text)}) {
    if (!command) continue;
    if (command->for_s && !(*command->for_s >= 1.0 && *command->for_s <= wire::kMaxHandHold_s)) std::abort();
    if (!(command->speed_m_s >= 0.0 && command->speed_m_s <= wire::kMaxHandWind_m_s)) std::abort();
    if (!(command->direction_deg >= 0.0 && command->direction_deg <= 360.0)) std::abort();
    if (command->part == wire::HandPart::kCamera && !command->is_release && command->camera.empty()) std::abort();
  }
  if (const auto wish = web::socket_wish_of(text)) {
    if (!(wish->wind_hz >= 0.0 && wish->wind_hz <= web::SocketWish::kMaxWindRate_hz)) std::abort();
    if (wish->stream && (wish->stream->thinning.every < 1 || wish->stream->thinning.every > wire::kMaxEvery))
      std::abort();
  }
  const std::array<std::string, 1> names = {"roof"};
  const std::size_t half = size / 2;
  static_cast<void>(yuragi::is_known_host(text, names));
  static_cast<void>(yuragi::is_same_origin(text.substr(0, half), text.substr(half), text.size() % 2 == 0));
  return 0;
}
