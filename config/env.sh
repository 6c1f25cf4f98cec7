# Puts the programs that config/demo.sh has built on PATH, from whatever folder bash stands in:
#
#   source config/env.sh
if [ -x "$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/yuragi" ]; then
  PATH=$(cd "$(dirname "${BASH_SOURCE[0]}")/../build/release/bin" && pwd):$PATH
  export PATH
else
  echo "env.sh: nothing is built yet; config/demo.sh builds it" >&2
  return 1
fi
