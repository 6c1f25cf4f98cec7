#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tests/hurt/trial.hpp"

// yuragi-hurt: what becomes of hurt messages, protocol by protocol, as a table.

namespace yuragi::hurt {
namespace {

constexpr std::array<std::string_view, 5> kChecksumNames = {"none", "xor 8", "sum 8", "sum 16", "CRC 16"};

std::vector<Protocol> all_protocols() {
  std::vector<Protocol> all;
  for (const auto protocols : {byte_protocols(), text_protocols(), json_protocols()})
    all.insert(all.end(), protocols.begin(), protocols.end());
  return all;
}

constexpr std::string_view kRow = "| {:21} | {:8} | {:8} | {:8} | {:8} | {:7} | {:6} | {:6} |\n";

void print_head() {
  fmt::print(kRow, "protocol", "checksum", "messages", "refused", "unharmed", "other's", "false", "bound");
  fmt::print("| {0:-<21} | {0:-<8} | {0:-<8} | {0:-<8} | {0:-<8} | {0:-<7} | {0:-<6} | {0:-<6} |\n", "");
}

void print_row(const Protocol& protocol, const Tally& tally) {
  fmt::print(kRow, protocol.name, kChecksumNames[static_cast<std::size_t>(protocol.checksum)], tally.messages,
             tally.refused, tally.unharmed, tally.others, tally.wrong, most_false(protocol, tally.messages));
  std::fflush(stdout);
}

int run(std::int64_t messages, const std::string& wanted, std::uint64_t seed, bool shows_examples) {
  print_head();
  std::vector<std::string> wrong;
  bool is_known = false;
  for (const Protocol& protocol : all_protocols()) {
    if (!wanted.empty() && protocol.name != wanted) continue;
    is_known = true;
    const Tally tally = try_protocol(protocol, messages, seed);
    print_row(protocol, tally);
    if (shows_examples) {
      for (const std::string& message : tally.wrong_examples) fmt::print("  {}\n", message);
    }
    if (const auto said = verdict(protocol, tally)) wrong.push_back(*said);
  }
  if (!is_known) wrong.push_back("no protocol is called " + wanted);
  for (const std::string& each : wrong) fmt::print(stderr, "{}\n", each);
  return wrong.empty() ? 0 : 1;
}

}  // namespace
}  // namespace yuragi::hurt

int main(int argc, char** argv) try {
  CLI::App app(
      "Hurts messages of every protocol at random, and tells what is read from them. Fails where more false "
      "winds come through than the protocol's checksum explains.");
  std::int64_t messages = 20'000;
  std::string protocol;
  std::uint64_t seed = 1;
  bool shows_examples = false;
  app.add_option("--messages", messages, "how many of each protocol")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--protocol", protocol, "this one alone");
  app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
  app.add_flag("--examples", shows_examples, "show the first messages of each that gave a false wind");
  CLI11_PARSE(app, argc, argv);
  return yuragi::hurt::run(messages, protocol, seed, shows_examples);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
