#!/usr/bin/env bash
# Attacks and faults on the release programs in their long form: about an hour and a half for all rows, and a table in Markdown.
#
#   sudo tests/abuse/by_hand.sh [NAME...] [--seed NUMBER] [--short] [--markdown FILE]
#
# As root, since some rows mount small disks and cut networks, in namespaces of their own; without it they say that they are not
# tried. Nothing leaves this machine.
set -euo pipefail
cd "$(dirname "$0")/../.."

cmake --preset release --log-level=WARNING && cmake --build --preset release --target yuragi yuragi-sim
cmake --preset test --log-level=WARNING
cmake --build --preset test --target yuragi_abuse_faults yuragi-half-year yuragi_schema_modules

form=--long arguments=()
for argument in "$@"; do
  [ "$argument" = --short ] && form='' || arguments+=("$argument")
done
exec /usr/bin/python3 tests/abuse/abuse.py $form --programs build/release/bin --helpers build/test/tests/abuse \
  --schema build/test/tests/e2e/schema "${arguments[@]}"
