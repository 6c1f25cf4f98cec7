#!/usr/bin/env python3
"""Does CI find mistakes? Makes twelve of them, one after the other, in a copy of the project, and runs the stage that is to find each.

usage: try_mistakes.py COPY [NAME...]

COPY is a git worktree whose changes may be lost. Prints a row a mistake: the stage and the test that are to find it, and what came
of it. Fails where one was not found. It takes long: each preset that is named is built.
"""
import dataclasses
import pathlib
import subprocess
import sys


@dataclasses.dataclass
class Mistake:
    name: str
    edits: tuple   # of (file, what stands there, what is put in its place)
    preset: str    # the stage
    target: str    # what is built
    tests: str     # the tests that are run, as ctest's --tests-regex


MISTAKES = (
    Mistake("a sign in the blend of the wind", (
        ("engine/wind/blend/blended_estimator.cpp", "state_.live_weight = measured.trust;", "state_.live_weight = -measured.trust;"),),
        "test", "wind_test", "^Blended"),
    Mistake("an index that is not checked", (
        ("daemon/animation/animation.cpp", "if (cue.scene >= roster.scenes.size()) return;", ""),),
        "asan", "daemon_tests", "^daemon_tests"),
    Mistake("an off-by-one in a decoder", (
        ("drivers/decode/hid/wmr100.cpp", "const std::size_t body = frame.size() - kWmr100Sum;",
         "const std::size_t body = frame.size() - kWmr100Sum - 1;"),),
        "asan", "drivers_tests_threadless", "^drivers_tests_threadless"),
    Mistake("a constant in a shader", (
        ("viewer/gl/shaders/sky/clouds.frag.glsl", "const float kDensity = 26.0;", "const float kDensity = 2.6;"),),
        "test", "pictures_test", "GoldenPictureTest"),
    Mistake("a bound that is missing in the stream's decoder", (
        ("engine/wire/decode.cpp", "  if (count > kMaxScenes) return false;\n  for (std::size_t i = 0; i < count; ++i) {\n"
         "    const fb::SceneCost&", "  for (std::size_t i = 0; i < count; ++i) {\n    const fb::SceneCost&"),),
        "test", "wire_test", "^WireRoundTrip"),
    Mistake("an exit code that monitoring reads", (
        ("daemon/commands/status.cpp", 'throw ExitError(kExitAttention, "");', 'throw ExitError(kExitNoDaemon, "");'),),
        "test", "yuragi yuragi-sim", "^json.the_exit_code_of_status_says_how_it_is$"),
    Mistake("a leak in the viewer", (
        ("viewer/app/wind_place_text.cpp", '  const std::string where =', '  (new std::string("lost"))->append("for ever");\n  const std::string where ='),),
        "asan", "viewer_test", "^viewer_test"),
    Mistake("an overrun in a room that is compiled as one file", (
        ("drivers/decode/hid/wmr100.cpp", "std::min({std::size_t{report[0]}, report.size() - 1, std::size_t{7}})",
         "std::min({std::size_t{report[0]}, std::size_t{7}})"),),
        "asan", "fuzz_byte_decoders", "^fuzz_byte_decoders$"),
    Mistake("a use of what has been freed", (
        ("engine/wire/decode.cpp", "    if (!read_text(cost.scene(), read.scene)", "    to->scenes.shrink_to_fit();\n    to->scenes.reserve(64);\n"
         "    if (!read_text(cost.scene(), read.scene)"),),
        "asan", "wire_test", "^wire_test"),
    Mistake("a load from an odd address", (
        ("drivers/decode/byte_order.hpp", "constexpr std::uint16_t little_endian_16(ByteSpan bytes, std::size_t at) noexcept {\n"
         "  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8U));",
         "inline std::uint16_t little_endian_16(ByteSpan bytes, std::size_t at) noexcept {\n"
         "  return *reinterpret_cast<const std::uint16_t*>(bytes.data() + at);"),
        ("drivers/decode/byte_order.hpp", "constexpr std::uint32_t little_endian_32", "inline std::uint32_t little_endian_32")),
        "asan", "drivers_tests_threadless", "^drivers_tests_threadless"),
    Mistake("an order of initialisation", (
        ("engine/base/printable_text.cpp", "namespace yuragi {\n", "namespace yuragi {\nstd::string first_of_two(3, 'a');\n"),
        ("viewer/app/wind_place_text.cpp", "namespace yuragi::viewer::app {\n",
         "namespace yuragi {\nextern std::string first_of_two;\n}\nnamespace yuragi::viewer::app {\nstd::string second_of_two = first_of_two;\n")),
        "asan", "viewer_test", "^viewer_test"),
    Mistake("a race", (
        ("engine/base/latest.hpp", "middle_.exchange(static_cast<std::uint8_t>(write_ | kFresh), std::memory_order_acq_rel)",
         "middle_.exchange(static_cast<std::uint8_t>(write_ | kFresh), std::memory_order_relaxed)"),),
        "tsan", "engine_tests", "^engine_tests"),
)


def is_found(mistake, copy):
    """True: a test failed, or did not build."""
    def run(*command):
        return subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)

    run("git", "checkout", "--", ".")
    for name, old, new in mistake.edits:
        path = pathlib.Path(copy, name)
        text = path.read_text(encoding="utf-8")
        if text.count(old) != 1:
            sys.exit(f"{mistake.name}: {name} has {text.count(old)} times: {old}")
        path.write_text(text.replace(old, new), encoding="utf-8")
    try:
        if not pathlib.Path(copy, "build", mistake.preset, "build.ninja").exists():
            run("cmake", "--preset", mistake.preset, "--log-level=WARNING")
        built = run("cmake", "--build", f"build/{mistake.preset}", "--target", *mistake.target.split())
        if built.returncode != 0:
            return "does not build", built.stdout[-1500:]
        tested = run("ctest", "--preset", mistake.preset, "--tests-regex", mistake.tests, "--parallel", "4")
        if "No tests were found" in tested.stdout + tested.stderr:
            sys.exit(f"{mistake.name}: no test is called {mistake.tests}")
        return ("found" if tested.returncode != 0 else "NOT FOUND"), tested.stdout[-3000:]
    finally:
        run("git", "checkout", "--", ".")


def main():
    copy, names = sys.argv[1], sys.argv[2:]
    missed = 0
    print("| mistake | stage | tests | |\n| --- | --- | --- | --- |")
    for mistake in MISTAKES:
        if names and mistake.name not in names:
            continue
        result, text = is_found(mistake, copy)
        print(f"| {mistake.name} | {mistake.preset} | {mistake.tests} | {result} |", flush=True)
        if result != "found":
            missed += 1
            print(text, file=sys.stderr)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
