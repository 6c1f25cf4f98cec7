#!/usr/bin/env bash
# Builds the Debian package and says where it lies. The same commit gives the same bytes, wherever and whenever it is built with
# the same Debian packages.
set -euo pipefail
cd "$(dirname "$0")/.."

config/setup.sh
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct) # the date of all that is in it
export SOURCE_DATE_EPOCH
cmake --preset package --log-level=WARNING
cmake --build --preset package
rm -rf build/package/package
(cd build/package && cpack -G DEB >cpack.log) || { cat build/package/cpack.log >&2; exit 1; }
rm -rf build/package/package/_CPack_Packages
package=$(ls "$PWD"/build/package/package/*.deb)
echo "package: $package ($(stat -c %s "$package") bytes, SHA-256 $(sha256sum "$package" | cut -c1-16)...)"
echo "         apt install $package"
