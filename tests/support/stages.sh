# Stages of a test run, shared by tests/run.sh and .ci/run, which source it from the project's root.
# A stage is something that passes or fails tests; its figures add up, and finish() prints the sum as the last line.

passed=0
failed=0
skipped=0
without_record=0 # of those that were skipped: for want of the real recordings in ../shared/data
again=0          # of those that passed: only by themselves, after they had failed among all (tests/support/run_again.py)
stage_times=()
complaints=()
configuration=() # options of cmake besides those of a preset
built_ahead=()   # presets that build_ahead() builds

# Nothing here asks a question: no test may wait for a keyboard.
exec </dev/null

# stage NAME COMMAND...: runs the command, says how long it took, and goes on whatever came of it.
stage() {
  echo "== $1"
  timed "$@" || true
}

# timed NAME COMMAND...: runs the command; finish() shows how long it took, and the time of its processes on the processors.
timed() {
  local name=$1 started=$SECONDS cpu_before status=0
  shift
  read_cpu_s
  cpu_before=$cpu_s
  "$@" || status=$?
  read_cpu_s
  stage_times+=("$(printf '%-16s %5d s %6d s of processors' "$name" $((SECONDS - started)) $((cpu_s - cpu_before)))")
  return "$status"
}

# read_cpu_s: sets cpu_s to what all processes that this shell has begun and that have ended have used, user and system, in seconds.
read_cpu_s() {
  local file
  file=$(mktemp)
  times >"$file" # of this shell, then of its children; in a pipe it would tell of another shell
  cpu_s=$(awk -F '[ms ]+' 'NR == 2 { printf "%d", 60 * ($1 + $3) + $2 + $4 }' "$file")
  rm "$file"
}

# add PASSED FAILED [SKIPPED [OF THESE WITHOUT THE RECORD [OF THE PASSED BY THEMSELVES ONLY]]]
add() {
  passed=$((passed + $1))
  failed=$((failed + $2))
  skipped=$((skipped + ${3:-0}))
  without_record=$((without_record + ${4:-0}))
  again=$((again + ${5:-0}))
}

# check WHAT COMMAND...: a stage's step that counts as one failed test if it fails, and is otherwise not counted.
check() {
  local what=$1
  shift
  "$@" && return
  echo "FAILED: $what" >&2
  complaints+=("FAILED: $what")
  add 0 1 0
  return 1
}

# count_results FILE: prints the counts and the failures in CTest's JUnit file, as tests/support/count_results.py describes.
count_results() {
  /usr/bin/python3 tests/support/count_results.py "$1"
}

# collect WHAT RESULTS STATUS: adds up CTest's results, given its exit code.
collect() {
  local what=$1 results=$2 status=$3 counts line failed_before=$failed
  if ! counts=$(count_results "$results"); then
    check "$what left no results" false
    return
  fi
  while IFS= read -r line; do
    [ -z "$line" ] || complaints+=("$line")
  done < <(tail -n +2 <<<"$counts")
  # shellcheck disable=SC2046  # five words
  add $(head -n 1 <<<"$counts")
  # A complaint that stands in no test's result: no test matched, say.
  if [ "$status" -ne 0 ] && [ "$failed" -eq "$failed_before" ]; then
    check "$what ended with exit code $status" false
  fi
}

# build_preset PRESET: configures and builds a preset of CMakePresets.json. Returns 77 where what it is built of cannot be had: the
# libraries for arm64 come from the network.
build_preset() {
  if [ "$1" = arm64 ]; then config/arm64_sysroot.sh || return 77; fi
  check "configuring $1" cmake --preset "$1" --log-level=WARNING "${configuration[@]}" || return
  check "building $1" timed "$1: build" cmake --build --preset "$1" || return
  /usr/bin/python3 tests/support/build_times.py "build/$1" || true
}

# build_ahead PRESET...: builds presets in the background, one after the other, at the lowest priority: it takes the time of the
# processors that tests leave while they wait for devices and windows. test_preset() then waits for the build, and prints its output.
build_ahead() {
  local preset
  built_ahead=("$@")
  mkdir -p build
  for preset in "$@"; do
    rm -f "build/$preset-ahead.status"
  done
  # Not a child of this shell: its time on the processors would count as that of the tests that run meanwhile.
  (
    (
      renice -n 19 -p "$BASHPID" >/dev/null
      for preset in "$@"; do
        status=0
        stage_times=("") # in its place the build's, if it was configured
        build_preset "$preset" >"build/$preset-ahead.log" 2>&1 || status=$?
        printf '%s\n' "$status" "${stage_times[-1]}" >"build/$preset-ahead.partial"
        mv "build/$preset-ahead.partial" "build/$preset-ahead.status"
      done
    ) &
    echo $! >build/ahead.pid
  )
}

# await_build PRESET: waits for what build_ahead() builds. Fails if that failed or was killed.
await_build() {
  local status_file=build/$1-ahead.status lines
  while [ ! -e "$status_file" ] && kill -0 "$(cat build/ahead.pid)" 2>/dev/null; do
    sleep 1
  done
  cat "build/$1-ahead.log"
  mapfile -t lines <"$status_file" || return
  [ -z "${lines[1]}" ] || stage_times+=("${lines[1]}")
  return "${lines[0]}"
}

# test_preset PRESET [CTEST ARGUMENT...]: configures, builds and tests a preset.
test_preset() {
  local preset=$1 results=$PWD/build/$1/results.xml status=0 failed_now
  shift
  rm -f "$results"
  if [[ " ${built_ahead[*]-} " == *" $preset "* ]]; then
    await_build "$preset" || status=$?
  else
    build_preset "$preset" || status=$?
  fi
  if [ "$status" -eq 77 ]; then
    complaints+=("SKIPPED: $preset, since what it is built of cannot be had (above)")
    add 0 0 1
    return
  elif [ "$status" -ne 0 ]; then
    check "building $preset" false
    return
  fi
  # Three times as many at once as there are cores: tests that talk to simulated devices mostly wait. A long output is cut at its
  # beginning: what failed stands at the end.
  timed "$preset: tests" ctest --preset "$preset" --parallel "$((3 * $(nproc)))" --output-junit "$results" --test-output-truncation head \
    --test-output-size-passed 1000000 --test-output-size-failed 1000000 "$@" || status=$?
  if [ "$status" -ne 0 ] && [ -e "$results" ]; then
    /usr/bin/python3 tests/support/run_again.py "$preset" "$results" || true
    read -r _ failed_now _ <<<"$(count_results "$results")"
    if [ "$failed_now" = 0 ]; then status=0; fi
  fi
  collect "ctest of $preset" "$results" "$status"
}

# finish: the times where there were several stages, what failed, and the closing line. Fails if anything failed or
# nothing ran.
finish() {
  local line="$passed passed, $failed failed"
  [ "$again" -eq 0 ] || line+=", $again of the passed only by themselves"
  [ "$without_record" -eq 0 ] || line+=", $without_record skipped: ../shared/data is not there"
  [ "$skipped" -eq "$without_record" ] || line+=", $((skipped - without_record)) skipped for other reasons"
  if [ ${#stage_times[@]} -gt 1 ]; then
    printf '%s\n' "${stage_times[@]}"
    printf '%-16s %5d s\n' total "$SECONDS"
  fi
  [ ${#complaints[@]} -eq 0 ] || printf '%s\n' "${complaints[@]}"
  [ "$((passed + failed))" -gt 0 ] || echo "no test ran" >&2
  echo "$line"
  [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
}
