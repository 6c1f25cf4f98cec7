#include "daemon/web/media_type.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace yuragi::daemon::web {
namespace {

struct MediaType {
  std::string_view extension, type;
};
constexpr std::array kMediaTypes = {
    MediaType{".html", "text/html; charset=utf-8"},
    MediaType{".htm", "text/html; charset=utf-8"},
    MediaType{".js", "text/javascript; charset=utf-8"},
    MediaType{".mjs", "text/javascript; charset=utf-8"},
    MediaType{".css", "text/css; charset=utf-8"},
    MediaType{".json", "application/json"},
    MediaType{".map", "application/json"},
    MediaType{".webmanifest", "application/manifest+json"},
    MediaType{".txt", "text/plain; charset=utf-8"},
    MediaType{".md", "text/plain; charset=utf-8"},
    MediaType{".csv", "text/csv; charset=utf-8"},
    MediaType{".frag", "text/plain; charset=utf-8"},
    MediaType{".vert", "text/plain; charset=utf-8"},
    MediaType{".glsl", "text/plain; charset=utf-8"},
    MediaType{".svg", "image/svg+xml"},
    MediaType{".png", "image/png"},
    MediaType{".jpg", "image/jpeg"},
    MediaType{".jpeg", "image/jpeg"},
    MediaType{".gif", "image/gif"},
    MediaType{".webp", "image/webp"},
    MediaType{".ico", "image/x-icon"},
    MediaType{".woff", "font/woff"},
    MediaType{".woff2", "font/woff2"},
    MediaType{".ttf", "font/ttf"},
    MediaType{".otf", "font/otf"},
    MediaType{".wasm", "application/wasm"},
    MediaType{".glb", "model/gltf-binary"},
    MediaType{".gltf", "model/gltf+json"},
    MediaType{".mp3", "audio/mpeg"},
    MediaType{".ogg", "audio/ogg"},
    MediaType{".wav", "audio/wav"},
    MediaType{".mp4", "video/mp4"},
    MediaType{".webm", "video/webm"},
};

}  // namespace

std::optional<std::string_view> media_type_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  const auto* const found = std::ranges::find(kMediaTypes, extension, &MediaType::extension);
  return found == kMediaTypes.end() ? std::nullopt : std::optional(found->type);
}

}  // namespace yuragi::daemon::web
