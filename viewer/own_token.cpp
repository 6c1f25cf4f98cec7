#include "viewer/own_token.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "engine/base/secret_line.hpp"

namespace yuragi::viewer {
namespace {

constexpr const char* kVariable = "YURAGI_TOKEN_FILE";
constexpr std::size_t kMaxFile_bytes = 4096;  // as the daemon's

}  // namespace

Result<Secret, Failure> token_in_file(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& why) {
    return Failure{"\"" + file.string() + "\" " + why, FailureKind::kNoInput};
  };
  std::error_code error;
  // A pipe would be waited for.
  if (!std::filesystem::is_regular_file(file, error))
    return fail("is not a regular file that can be read; check its name and permissions");
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail("cannot be read; allow it to the user that the viewer runs as");
  std::string text(kMaxFile_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return fail("cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMaxFile_bytes) return fail("is too long (maximum 4096 bytes)");
  auto secret = secret_line(std::move(text));
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
