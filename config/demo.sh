#!/usr/bin/env bash
# Yuragi with no hardware: installs what is needed, builds, and runs the main job on a simulated wind.
#
#   config/demo.sh            opens the viewer where there is a display; elsewhere shows 30 s of live status in the
#                             terminal (without one: the last status) and writes a picture to demo.png in the present folder
#   config/demo.sh SECONDS    the same for another time
#
# It touches nothing outside this folder but Debian packages. Stop it with Ctrl-C.
set -euo pipefail
duration_s=${1:-30}
[[ "$duration_s" =~ ^[0-9]+$ && "$duration_s" -ge 5 ]] || { echo "usage: config/demo.sh [SECONDS, at least 5]" >&2; exit 64; }
picture=$PWD/demo.png
cd "$(dirname "$0")/.."
project=$PWD

config/setup.sh

# ---- Build what the demo runs ----

log=$project/build/demo.log
mkdir -p build

# Shows ninja's lines "@ DONE ALL SECONDS ..." as one line with the time that is left; without a terminal, as a line
# now and then. The part of a build from nothing that is done is about that of its steps (measured; at times 0.2 more or
# less), but for the first fifth, in which the largest files are begun.
show_progress() {
  local mark done all elapsed_s line left shown_s=-30
  while read -r mark done all elapsed_s line; do
    [ "$mark" = @ ] || continue
    elapsed_s=${elapsed_s%.*}
    left=$(awk -v done="$done" -v all="$all" -v s="$elapsed_s" 'BEGIN {
      if (s < 10 || all < 50 || 5 * done < all) exit
      left_s = s * (all - done) / done
      printf left_s < 90 ? ", about %d s left" : ", about %.0f minutes left", left_s < 90 ? left_s : left_s / 60 }')
    line="demo: building, step $done of $all$left"
    if [ -t 1 ]; then
      printf '\r\033[K%s' "$line"
    elif [ "$elapsed_s" -ge $((shown_s + 30)) ]; then
      shown_s=$elapsed_s
      echo "$line"
    fi
  done
  [ ! -t 1 ] || printf '\r\033[K'
}

build() {
  cmake --preset release >"$log" 2>&1 &&
    NINJA_STATUS='@ %f %t %e ' cmake --build --preset release --target yuragi yuragi-sim yuragi-viewer 2>&1 |
    tee -a "$log" | show_progress
}
echo "demo: building; its output goes to $log"
began=$SECONDS
if ! build; then
  tail -n 30 "$log" >&2
  echo "demo: the build failed; all that it said is in $log" >&2
  exit 1
fi
echo "demo: built in $((SECONDS - began)) s"
config/examples.sh

# ---- Run it ----

# A Modbus anemometer that is not there: the simulator plays its wind on the real protocol. Each part takes a free port and
# prints it.
work=$(mktemp -d)
children=()
finish() {
  for child in "${children[@]}"; do kill "$child" 2>/dev/null || true; done
  wait
  rm -rf "$work"
}
trap finish EXIT

wait_for_address() { # FILE PATTERN: the address that a program prints once it listens
  for _ in $(seq 100); do
    sed -n "s/.*listening on \([^ ]*\).*/\1/p" "$1" 2>/dev/null | grep -m1 . && return 0
    sleep 0.1
  done
  echo "demo: nothing listens; it said:" >&2
  cat "$1" >&2
  return 1
}

bin=build/release/bin
"$bin/yuragi-sim" modbus --tcp 127.0.0.1:0 --profile renke-rs-fsjt-rs-fxjt-n01 --wind synthetic --speed 7 --direction 250 \
  >"$work/sim.log" 2>&1 &
children+=($!)
sensor=$(wait_for_address "$work/sim.log")
cat >"$work/demo.toml" <<TOML
[[sensor]]
name = "simulated roof"
driver = "modbus"
profile = "renke-rs-fsjt-rs-fxjt-n01"
host = "${sensor%:*}"
port = ${sensor##*:}

[[scene]]
kind = "grass"

[[scene]]
kind = "ground"
TOML
"$bin/yuragi" run --config "$work/demo.toml" --listen 127.0.0.1:0 >"$work/daemon.log" 2>&1 &
children+=($!)
stream=$(wait_for_address "$work/daemon.log")
echo "demo: anemometer simulated at $sensor (Modbus TCP), daemon at $stream"

if [ -n "${DISPLAY:-}" ]; then
  echo "demo: close the window to end"
  "$bin/yuragi-viewer" --connect "$stream"
else
  echo "demo: no display; $duration_s s of status, and a picture in $picture"
  "$bin/yuragi-viewer" --connect "$stream" --at 4 --screenshot "$picture" >"$work/viewer.log" 2>&1 &
  viewer=$!
  if [ -t 1 ]; then
    "$bin/yuragi" sensors watch --connect "$stream" --duration "$duration_s"
  else # one table at the end, not one each second
    sleep "$duration_s"
    "$bin/yuragi" sensors watch --connect "$stream" --once
  fi
  wait "$viewer" || { cat "$work/viewer.log" >&2; exit 1; }
  echo "demo: picture written to $picture"
fi

cat <<TEXT

demo: what to try next. The programs on PATH, and recordings, a log and configurations to play with:
  source $project/config/env.sh
  cd $project/build/examples
  yuragi replay storm.windlog
and in a second terminal, after the same two lines, what moves in that storm:
  yuragi-viewer
The guide has a page for each task: $project/config/guide/README.md
TEXT
