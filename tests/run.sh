#!/usr/bin/env bash
# Installs what is missing, builds the test preset (CMakePresets.json) and runs every test. The last line says how many passed and failed.
#
#   tests/run.sh                 every test but the long ones
#   tests/run.sh --unsanitized   of these the engine's tests and what sanitizer builds leave out: .ci/run runs the others with sanitizers
#   tests/run.sh --long          everything: also tests that do on other records, seeds and species what others do on one; 10 minutes more
#   tests/run.sh -R noise -V     arguments go to ctest
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/support/stages.sh

config/setup.sh --test
[ -d ../shared/data ] || echo "note: ../shared/data is not there: the tests that need its recordings will skip."

selection=()
if [ "${1-}" = --long ]; then
  shift
  echo "The long tests take about 10 minutes more on two cores."
elif [ "${1-}" = --unsanitized ]; then
  shift
  configuration=(-D YURAGI_WITHOUT_SANITIZED=ON)
  selection=(-LE long -L "native|engine|pictures")
elif [ $# -eq 0 ]; then
  selection=(-LE long)
fi
stage test test_preset test "${selection[@]}" "$@"
if [ $# -eq 0 ] && [ ${#configuration[@]} -eq 0 ]; then
  check "a driver against a fault" /usr/bin/python3 tests/support/fault_table.py build/test/results.xml || true
fi
finish
