// The Kestrel's sentences, unasked: "$K,003.4,231.0*hh" CR LF; hh: the exclusive or of what stands between '$' and '*'.
#include <array>
#include <memory>

#include <fmt/format.h>

#include "simulators/core/command.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::text {
namespace {

class Kestrel final : public Device {
 public:
  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kBadChecksum};
    return kKnown;
  }
  std::vector<std::string> send_messages(const core::PlayedMoment& now, std::optional<core::FaultKind> fault) override {
    const std::string body = fmt::format("K,{:05.1f},{:05.1f}", now.speed_m_s, now.direction_deg);
    unsigned sum = fault == core::FaultKind::kBadChecksum ? 1 : 0;
    for (const char c : body) sum ^= static_cast<unsigned char>(c);
    return {fmt::format("${}*{:02X}\r\n", body, sum)};
  }
  bool is_request(std::string_view /*line*/) const override { return false; }
};

}  // namespace

std::unique_ptr<Device> make_kestrel() {
  return std::make_unique<Kestrel>();
}

extern const core::Command kKestrelCommand;
const core::Command kKestrelCommand{[](CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("kestrel", "the Kestrel, of CONTRIBUTING.md");
  options->add_to(*command);
  command->callback([options] { options->run(make_kestrel()); });
}};

}  // namespace yuragi::simulators::text
