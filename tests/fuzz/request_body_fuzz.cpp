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
  if (const auto wish = web::socket_wish_of(text)) {
    if (!(wish->wind_hz >= 0.0 && wish->wind_hz <= web::SocketWish::kMaxWindRate_hz)) std::abort();
    if (wish->stream && (wish->stream->thinning.every < 1 || wish->stream->thinning.every > wire::kMaxEvery))
      std::abort();
  }
  const std::array<std::string, 1> names = {"roof"};
  const std::size_t half = size / 2;
  static_cast<void>(yuragi::is_known_host(text, names));
  static_cast<void>(yuragi::is_same_origin(text.substr(0, half), text.substr(half)));
  return 0;
}
