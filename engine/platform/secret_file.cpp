#include "engine/platform/secret_file.hpp"

#include <string>
#include <utility>

#include "engine/base/secret_line.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::platform {

Result<Secret, Failure> secret_in_file(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& why) { return Failure{"\"" + file.string() + "\" " + why}; };
  auto text = read_whole(file, kMaxSecretFile);
  if (!text) return fail(text.error().message);
  auto secret = secret_line(std::move(*text));
  return secret ? std::move(secret) : fail(secret.error().message);
}

}  // namespace yuragi::platform
