#!/usr/bin/env bash
# Draws the golden pictures anew, and says how far each is from the one before. Look at them before you commit them.
#
#   tests/pictures/renew.sh [--scene NAME]...
set -euo pipefail
cd "$(dirname "$0")/../.."
cmake --preset test --log-level=WARNING
cmake --build --preset test --target draw_goldens
build/test/tests/pictures/draw_goldens tests/pictures/golden tests/pictures/golden "$@"
