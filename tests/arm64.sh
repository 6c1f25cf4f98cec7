#!/usr/bin/env bash
# Tests what is built for arm64, in an emulator: the golden hashes, the pure tests (the engine's, and those of the drivers'
# decoders), that a replay's poses have the hash that they have on this machine, and that a follower has its leader's poses. Tests
# that talk to other programs are left out: what they start would not run. The last line shows how many tests passed and failed.
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/support/stages.sh

# Those of tests/engine, joined and alone, and tests/drivers/decode.
tests=(
  engine/scenes/golden_test engine/scenes/scene_snapshot_test engine/wind/wind_snapshot_test engine_tests engine_tests_threadless
  engine/scenes/scene_allocation_test engine/wind/blend_allocation_test engine/wire/frame_encoder_test
  drivers/drivers_decode_modbus_test drivers/drivers_decode_text_test drivers/drivers_decode_marine_test
  drivers/drivers_decode_bytes_test drivers/drivers_decode_mic_test drivers/drivers_decode_network_test
)
# The emulator computes vectors a hundred times slower and more: what simulates minutes of cloth or megabytes of noise is left out. The
# golden hashes have the same code.
quick_enough='-NoiseSlope.*:*ClothDynamics*:LineCutTest.*:Scenes/SceneSnapshot.*'
on_arm64=(qemu-aarch64-static -L "$PWD/build/arm64-sysroot")

build() {
  check "making the tree of libraries for arm64" config/arm64_sysroot.sh || return
  check "configuring arm64" cmake --preset arm64 -D YURAGI_NATS=ON --log-level=WARNING || return
  check "building arm64" cmake --build build/arm64 --target "${tests[@]##*/}" yuragi || return
  # The recording is made, and replayed for comparison, by this machine's own programs.
  check "configuring test" cmake --preset test --log-level=WARNING || return
  check "building test" cmake --build build/test --target yuragi yuragi-sim
}

# run_program TEST: runs a GoogleTest program and adds its results up.
run_program() {
  local output=build/arm64/${1##*/}.log status=0 passed_now failed_now skipped_now
  "${on_arm64[@]}" "build/arm64/tests/$1" --gtest_filter="$quick_enough" >"$output" 2>&1 || status=$?
  passed_now=$(sed -nE 's/^\[  PASSED  \] ([0-9]+) tests?\.$/\1/p' "$output")
  failed_now=$(sed -nE 's/^\[  FAILED  \] ([0-9]+) tests?, listed below:$/\1/p' "$output")
  skipped_now=$(sed -nE 's/^\[  SKIPPED \] ([0-9]+) tests?, listed below:$/\1/p' "$output")
  add "${passed_now:-0}" "${failed_now:-0}" "${skipped_now:-0}"
  if [ "$status" -ne 0 ]; then
    complaints+=("FAILED: ${1##*/} on arm64 (exit code $status): see $output")
    [ "${failed_now:-0}" -gt 0 ] || add 0 1
  fi
}

# pose_hash COMMAND...: of a replay's poses.
pose_hash() {
  "$@" replay "$recording" --rate max | grep 'pose hash'
}

replay() {
  local folder here there
  folder=$(mktemp -d)
  recording=$folder/gale.windlog
  build/test/bin/yuragi-sim recording -o "$recording" --interval 0.25 --duration 20 --speed 14 >"$folder/log"
  here=$(pose_hash build/test/bin/yuragi) || true
  there=$(pose_hash "${on_arm64[@]}" build/arm64/bin/yuragi) || true
  rm -r "$folder"
  echo "this machine: $here"
  echo "arm64:        $there"
  check "a replay gave no hash" [ -n "$here" ] && check "a replay's poses differ on arm64" [ "$here" = "$there" ] && add 1 0
}

follower() {
  check "a follower on arm64" /usr/bin/python3 tests/fleet/arm64_follower.py build/test/bin "${on_arm64[@]}" build/arm64/bin/yuragi \
    && add 1 0
}

config/setup.sh --test
if stage build build && [ "$failed" -eq 0 ]; then
  for test in "${tests[@]}"; do
    stage "${test##*/}" run_program "$test"
  done
  stage replay replay
  stage follower follower
fi
finish
