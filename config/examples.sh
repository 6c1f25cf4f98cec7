#!/usr/bin/env bash
# Makes build/examples: the recordings, the table, the log and the configurations that README.md names. The winds are made up
# by the wind model, an hour each, the same ones every time. What is already there stays as it is.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=$PWD/build/release/bin
mkdir -p build/examples
cp -n config/garden.toml config/examples/* build/examples/
cp -rn config/rehearsals build/examples/
cd build/examples

record() { # FILE OPTION...
  [ -e "$1" ] || "$bin/yuragi-sim" recording -o "$@"
}
record good-day.windlog --speed 5 --direction 240 --turbulence 0.25 --seed 1
record storm.windlog --speed 17 --direction 280 --turbulence 0.3 --seed 2
record calm-day.windlog --speed 0.8 --direction 100 --turbulence 0.5 --seed 3
record both.windlog --speed 6 --seed 4 --sensor roof:0.95 --sensor mast # the roof measures 5 % too little
[ -e mast.csv ] || "$bin/yuragi" export good-day.windlog -o mast.csv 2>/dev/null
