#include "viewer/wall/outputs_file.hpp"

#include <algorithm>
#include <fstream>

#include "engine/base/result.hpp"
#include "engine/output/output_tables.hpp"

namespace yuragi::viewer::wall {
namespace {

constexpr std::size_t kMaxFile_bytes = 1 << 20;  // as the daemon's

std::string text_of(const std::filesystem::path& file) {
  const auto refuse = [&file](const char* why) {
    return FailureError({file.string() + ": " + why, FailureKind::kNoInput});
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) throw refuse("is no file that can be read");
  std::ifstream in(file, std::ios::binary);
  std::string text(kMaxFile_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in.eof())
    throw refuse(in.good() ? "is too large; allowed: up to 1 MB" : "cannot be read; check its permissions");
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace

std::optional<output::Output> load_output(const std::filesystem::path& file, const std::string& name) {
  const std::vector<output::Output> outputs = output::parse_outputs(text_of(file), file.string()).value();
  if (name.empty()) return outputs.empty() ? std::nullopt : std::optional(outputs.front());
  const auto found = std::ranges::find(outputs, name, &output::Output::name);
  if (found != outputs.end()) return *found;
  std::string names;
  for (const output::Output& output : outputs) names += (names.empty() ? "" : ", ") + output.name;
  throw FailureError({"--output: " + file.string() + " has no [[output]] of the name '" + name + "'; it has " +
                          (names.empty() ? "none" : names),
                      FailureKind::kUsage});
}

}  // namespace yuragi::viewer::wall
