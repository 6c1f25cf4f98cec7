#!/usr/bin/env bash
# Builds the Debian package and prints its path. The same commit gives the same bytes, wherever and whenever it is built with
# the same Debian packages.
#
#   config/package.sh           for this machine's processor; with the viewer for browsers where config/setup.sh --web has installed
#                               emscripten; daemons can share one wind where config/setup.sh --nats has installed libnats-dev
#   config/package.sh --arm64   for arm64 (Raspberry Pi 4 and 5), built here on amd64 with the libraries of config/arm64_sysroot.sh
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
  "")
    preset=package
    sysroot=
    config/setup.sh ;;
  --arm64)
    preset=package-arm64
    sysroot=build/arm64-sysroot
    export DEB_HOST_ARCH=arm64 # dpkg-shlibdeps looks into the programs by the tools for it
    config/setup.sh --arm64
    config/arm64_sysroot.sh ;;
  *) echo "usage: config/package.sh [--arm64]" >&2; exit 64 ;;
esac
built=build/$preset
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct) # the date of all that is in it
export SOURCE_DATE_EPOCH
nats=OFF
[ ! -e "$sysroot/usr/include/nats/nats.h" ] || nats=ON
cmake --preset $preset --log-level=WARNING -D YURAGI_NATS=$nats
cmake --build --preset $preset
rm -rf $built/package
(cd $built && cpack -G DEB >cpack.log) || { cat $built/cpack.log >&2; exit 1; }
rm -rf $built/package/_CPack_Packages
package=$(ls "$PWD"/$built/package/*.deb)
echo "package: $package ($(stat -c %s "$package") bytes, SHA-256 $(sha256sum "$package" | cut -c1-16)...)"
echo "         apt install $package"
