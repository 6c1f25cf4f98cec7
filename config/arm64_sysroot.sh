#!/usr/bin/env bash
# Makes build/arm64-sysroot: the libraries that Yuragi is built with, as Debian's packages for arm64 have them, unpacked. Nothing
# is installed on this machine, and no script of a package runs. Made again when the list of packages in config/setup.sh changes,
# or with --again. It needs `config/setup.sh --arm64`, and no root.
#
#   YURAGI_DEBIAN_MIRROR=http://... config/arm64_sysroot.sh    takes the packages from there (http://deb.debian.org/debian)
set -euo pipefail
cd "$(dirname "$0")/.."

mirror=${YURAGI_DEBIAN_MIRROR:-http://deb.debian.org/debian}
suite=bookworm # the compiler for arm64 and its C library are of this one
sysroot=$PWD/build/arm64-sysroot
apt=$PWD/build/arm64-apt # apt's own folders, apart from this machine's

case "${1:-}" in
  "") ;;
  --again) rm -rf "$sysroot" ;;
  *) echo "usage: config/arm64_sysroot.sh [--again]" >&2; exit 64 ;;
esac

# The headers and libraries of the list, and what every C++ program needs.
packages=(libc6-dev libstdc++6 libgcc-s1)
while read -r package; do
  case $package in
    libclang-* | flatbuffers-compiler-dev) ;; # of programs that run on this machine
    *-dev) packages+=("$package") ;;
  esac
done < <(config/setup.sh --list)
wanted="$mirror $suite ${packages[*]} $(sha256sum <config/arm64_sysroot.sh)" # and what is done with them
if [ "$(cat "$sysroot/complete" 2>/dev/null)" = "$wanted" ]; then
  exit 0
fi

echo "arm64_sysroot: making build/arm64-sysroot of ${#packages[@]} packages and what they depend on, from $mirror $suite"
rm -rf "$sysroot" "$apt"
mkdir -p "$apt"/etc/apt/{apt.conf.d,preferences.d,sources.list.d,trusted.gpg.d} "$apt"/var/lib/{dpkg,apt/lists/partial} \
  "$apt"/var/cache/apt/archives/partial
touch "$apt/var/lib/dpkg/status" # nothing is installed
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $suite main" >"$apt/etc/apt/sources.list"
apt_get() {
  apt-get -q -o Dir="$apt" -o Dir::State::status="$apt/var/lib/dpkg/status" -o APT::Architecture=arm64 \
    -o APT::Architectures=arm64 -o APT::Sandbox::User=root -o Acquire::Retries=3 "$@" >"$apt/log" 2>&1 && return
  echo "arm64_sysroot: apt-get $1 failed:" >&2
  tail -n 20 "$apt/log" >&2
  return 1
}
apt_get update -o APT::Update::Error-Mode=any
apt_get install --download-only --no-install-recommends -y "${packages[@]}"

# /lib is /usr/lib in Debian 12, but its packages still name both.
mkdir -p "$sysroot"/usr/{bin,lib,sbin} "$sysroot/DEBIAN"
for folder in bin lib sbin; do
  ln -s "usr/$folder" "$sysroot/$folder"
done
left_out=(usr/share/doc usr/share/man usr/share/locale usr/share/i18n usr/lib/aarch64-linux-gnu/dri # not built with, and large
  'usr/lib/aarch64-linux-gnu/libLLVM*' usr/lib/aarch64-linux-gnu/gconv)
# dpkg-shlibdeps reads which package a library belongs to, and since which version, from DEBIAN/shlibs and DEBIAN/symbols of the
# tree in which it finds the library: those of all packages, one after the other.
for package in "$apt"/var/cache/apt/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" | tar -x -C "$sysroot" --keep-directory-symlink --no-same-owner \
    "${left_out[@]/#/--exclude=./}"
  for file in shlibs symbols; do
    dpkg-deb --ctrl-tarfile "$package" | tar -x -O "./$file" >>"$sysroot/DEBIAN/$file" 2>/dev/null || true # not all have it
  done
done
# Links to a place from the root on lead out of the tree: the linker would then take libm.a in place of libm.so.
find "$sysroot" -type l -lname '/*' | while read -r link; do
  ln -sfrT "$sysroot$(readlink "$link")" "$link"
done
rm -rf "$apt"
echo "$wanted" >"$sysroot/complete"
echo "arm64_sysroot: done, $(du -sm "$sysroot" | cut -f1) MB"
