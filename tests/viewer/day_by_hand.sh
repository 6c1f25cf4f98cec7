#!/usr/bin/env bash
# A day of pictures (or HOURS) as fast as they can be made: `yuragi-viewer --render` takes all but the drawing of each through
# the stream of a replay. Prints the memory of the viewer and of the replay at the start, after a tenth and at the end, KiB.
#
#   tests/viewer/day_by_hand.sh DIRECTORY-OF-THE-PROGRAMS [HOURS]
set -euo pipefail
programs=$1 hours=${2:-24}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$programs/yuragi-sim" recording -o "$folder/hour.windlog" > "$folder/recording.log"
printf '[look]\nquality = "low"\n[[scene]]\nname = "meadow"\nkind = "grass"\nblades_across = 20\nblades_deep = 20\n' > "$folder/scenes.toml"

resident_kib() { sed -n 's/VmRSS:[^0-9]*\([0-9]*\).*/\1/p' "/proc/$1/status" 2> /dev/null || true; }

# An hour's recording at so many pictures a second is as many pictures as so many hours at 60.
"$programs/yuragi-viewer" --render "$folder/hour.windlog" --config "$folder/scenes.toml" --size 16x16 --fps $((60 * hours)) \
  --draw-nothing --out - 2> "$folder/film.log" > /dev/null &
viewer=$!
while kill -0 $viewer 2> /dev/null; do
  child=$(pgrep -P $viewer || true)
  now="$(resident_kib $viewer) + $(resident_kib "${child:-none}")"
  [[ "$now" == *[0-9]" + "[0-9]* ]] && echo "$now" >> "$folder/memory.log"
  sleep 0.5
done
wait $viewer
samples=$(wc -l < "$folder/memory.log")
at() { sed -n "$1p" "$folder/memory.log"; }
tail -1 "$folder/film.log"
echo "viewer + replay, KiB: at the start $(at 2), after a tenth $(at $((2 + samples / 10))), at the end $(at $((samples - 1)))"
