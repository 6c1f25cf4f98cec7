#include "viewer/own_token.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "engine/base/secret_line.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::viewer {
namespace {

constexpr const char* kVariable = "YURAGI_TOKEN_FILE";
constexpr std::size_t kMaxFile_bytes = 4096;  // as the daemon's

}  // namespace

Result<Secret, Failure> token_in_file(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& why) {
    return Failure{"\"" + file.string() + "\" " + why, FailureKind::kNoInput};
  };
  auto text = platform::read_whole(file, kMaxFile_bytes);
  if (!text) return fail(text.error().message);
  auto secret = secret_line(std::move(*text));
  return secret ? std::move(secret) : fail(secret.error().message);
}

Secret own_token() {
  const char* const file = std::getenv(kVariable);  // NOLINT(concurrency-mt-unsafe): nobody changes it
  if (file == nullptr || *file == '\0') return {};
  auto token = token_in_file(file);
  if (token) return std::move(*token);
  std::fprintf(stderr, "yuragi-viewer: %s: %s; the panel cannot change values of a daemon with a token_file\n",
               kVariable, token.error().message.c_str());
  return {};
}

}  // namespace yuragi::viewer
