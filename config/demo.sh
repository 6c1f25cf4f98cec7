#!/usr/bin/env bash
# Yuragi with no hardware: installs what is needed, builds, and runs the main job on a simulated wind.
#
#   config/demo.sh            opens the viewer where there is a display; elsewhere shows 30 s of live status in the
#                             terminal and writes a picture to demo.png in the present folder
#   config/demo.sh SECONDS    the same for another time
#
# It touches nothing outside this folder but Debian packages. Stop it with Ctrl-C.
set -euo pipefail
duration_s=${1:-30}
[[ "$duration_s" =~ ^[0-9]+$ && "$duration_s" -ge 5 ]] || { echo "usage: config/demo.sh [SECONDS, at least 5]" >&2; exit 64; }
picture=$PWD/demo.png
cd "$(dirname "$0")/.."

config/setup.sh
echo "demo: building (about a minute the first time)"
cmake --preset release >/dev/null
cmake --build --preset release

# A Modbus anemometer that is not there: the simulator plays its wind on the real protocol. Each part takes a free port and
# says which.
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
  xvfb-run -a "$bin/yuragi-viewer" --connect "$stream" --at 4 --screenshot "$picture" >"$work/viewer.log" 2>&1 &
  viewer=$!
  "$bin/yuragi" sensors watch --connect "$stream" --duration "$duration_s"
  wait "$viewer" || { cat "$work/viewer.log" >&2; exit 1; }
  echo "demo: picture written to $picture"
fi
