// What the page calls (daemon/web/page/viewer.ts): C functions, which WebAssembly exports if they are marked as used.
// One picture a page.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/look/look.hpp"
#include "viewer/web/wall.hpp"

namespace yuragi::viewer::web {
namespace {

std::optional<Wall> wall;
std::string text;  // that was returned last

/// Calls `work`; returns its text, or that of what it throws; null if there is none. Valid until the next call.
template <class Work>
const char* text_of(Work&& work) {
  try {
    std::optional<std::string> result = work();
    if (!result) return nullptr;
    text = std::move(*result);
  } catch (const std::exception& error) {
    text = error.what();
    wall.reset();
  }
  return text.c_str();
}

/// The lines of a text.
std::vector<std::string> lines_of(std::string_view lines) {
  std::vector<std::string> all;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    all.emplace_back(line);
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
  }
  return all;
}

}  // namespace

extern "C" {

/// Begins on the current context, and forgets what was there before. `look`: "time=21:00", a line each.
/// `is_transparent`: where the sky would be. Returns null, or what is wrong with them.
[[gnu::used]] const char* wall_open(const char* camera, const char* scene, const char* look, int is_software,
                                    int is_transparent) {
  return text_of([&]() -> std::optional<std::string> {
    wall.reset();
    picture::ViewerOptions options;
    options.camera = camera;
    options.scene = scene;
    options.look = lines_of(look);
    if (const auto edited = look::edited({}, options.look); !edited) return edited.error().message;
    wall.emplace(std::move(options), is_software != 0, is_transparent == 0);
    return std::nullopt;
  });
}

/// Ends it. Its context may be lost.
[[gnu::used]] void wall_close() {
  wall.reset();
}

/// Takes a message of the stream. Returns null, or why the connection is of no use.
[[gnu::used]] const char* wall_take(const std::uint8_t* message, std::size_t size, double now_s) {
  return text_of([&]() -> std::optional<std::string> {
    if (!wall) return std::nullopt;
    return wall->take({message, size}, now_s);
  });
}

/// Draws a picture if it is time for one. Returns null, or what failed; then there is no wall any more.
[[gnu::used]] const char* wall_draw(double now_s, int width_px, int height_px) {
  return text_of([&]() -> std::optional<std::string> {
    if (wall) wall->draw(now_s, width_px, height_px);
    return std::nullopt;
  });
}

[[gnu::used]] int wall_is_drawing(double now_s) {
  return wall && wall->is_drawing(now_s) ? 1 : 0;
}

[[gnu::used]] double wall_pictures() {
  return wall ? static_cast<double>(wall->pictures()) : 0.0;
}

/// How the last picture was drawn.
[[gnu::used]] const char* wall_pace() {
  return text_of([]() -> std::optional<std::string> { return wall ? wall->pace_text() : std::string(); });
}

}  // extern "C"

}  // namespace yuragi::viewer::web
