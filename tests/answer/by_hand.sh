#!/usr/bin/env bash
# What the tests of this folder are too short for, about 25 minutes on two cores: nine further winds, ten minutes of each
# scene in search of repeats, and the stream of a running daemon, measured by a program that shares no code with this one.
#
#   tests/answer/by_hand.sh          with the programs of build/test (tests/run.sh builds them)
set -euo pipefail
cd "$(dirname "$0")/../.."
build=build/test
answer=$build/tests/answer/yuragi-answer
status=0

"$answer" --further-winds || status=1
"$answer" --long || status=1
for beaufort in 3 5; do
  /usr/bin/python3 tests/e2e/answer_stream_test.py "$build/bin/yuragi" "$answer" "$build/tests/e2e/schema" --beaufort "$beaufort" || status=1
done
exit $status
