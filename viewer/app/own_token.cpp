#include "viewer/app/own_token.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "engine/platform/secret_file.hpp"

namespace yuragi::viewer::app {
namespace {

constexpr const char* kVariable = "YURAGI_TOKEN_FILE";

}  // namespace

Secret own_token() {
  const char* const file = std::getenv(kVariable);  // NOLINT(concurrency-mt-unsafe): nobody changes it
  if (file == nullptr || *file == '\0') return {};
  auto token = platform::secret_in_file(file);
  if (token) return std::move(*token);
  std::fprintf(stderr, "yuragi-viewer: %s: %s; the panel cannot change values of a daemon with a token_file\n",
               kVariable, token.error().message.c_str());
  return {};
}

}  // namespace yuragi::viewer::app
