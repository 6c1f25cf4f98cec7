#!/usr/bin/env bash
# Installs what is missing, builds the test preset (CMakePresets.json) and runs every test. The last line says how many passed and failed.
#
#   tests/run.sh                 everything
#   tests/run.sh -R noise -V     arguments go to ctest
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/support/stages.sh

config/setup.sh --test
[ -d ../shared/data ] || echo "note: ../shared/data is not there: the tests that need its recordings will skip."

stage test test_preset test "$@"
if [ $# -eq 0 ]; then
  check "a driver against a fault" /usr/bin/python3 tests/support/fault_table.py build/test/results.xml || true
fi
finish
