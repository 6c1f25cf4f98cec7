#!/usr/bin/env bash
# Installs the packages that Yuragi needs to build, run and be tested, on Debian 12 and 13, Ubuntu 24.04 and Raspberry Pi OS. Safe to
# run again: installed packages stay.
#
#   config/setup.sh          build and run
#   config/setup.sh --web    and what the viewer for browsers is built with
#   config/setup.sh --nats   and the library by which daemons share one wind
#   config/setup.sh --test   and what the tests and the sanitizer builds need besides
#   config/setup.sh --arm64  and what a package for arm64 is built with here
#   config/setup.sh --list   prints the names of the packages of --test, as Debian 12 has them
#
# Prints what it installs, and stops before apt would remove anything. Without root and sudo it prints the command for an administrator.
set -euo pipefail

# "a|b": the first of them that the distribution has. A distribution may lack a test's package, but no other.
build_packages=(
  build-essential cmake ninja-build ccache pkg-config python3
  "libboost1.81-dev|libboost-dev" # Asio; Debian 12's default 1.74 does not fit C++20, and the two exclude each other
  libfftw3-dev libsqlite3-dev libhowardhinnant-date-dev
  libmodbus-dev libhidapi-dev libusb-1.0-0-dev portaudio19-dev libmosquitto-dev liblo-dev # the sensors
  libtomlplusplus-dev nlohmann-json3-dev libcli11-dev libspdlog-dev libfmt-dev
  libflatbuffers-dev flatbuffers-compiler flatbuffers-compiler-dev
  prometheus-cpp-dev libssl-dev libcurl4-openssl-dev # metrics; proof of the token; webhooks of alerts
  esbuild                    # the page that the daemon serves
  libtinygltf-dev            # takes for 3D programs
  libpng-dev libjpeg-dev     # pictures on cloth
  libglfw3-dev libepoxy-dev libglm-dev libimgui-dev libstb-dev
  python3-markdown           # the guide as HTML
  gnuplot-nox                # plots
  tzdata                     # opening hours in local time
  libgl1-mesa-dri libegl-mesa0 libegl1 # the viewer's drivers, with a display and without
)
web_packages=(
  emscripten brotli # WebAssembly, and its form on the wire
)
nats_packages=(
  libnats-dev
)
arm64_packages=(
  g++-aarch64-linux-gnu qemu-user-static # its compiler; runs its programs
)
test_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev
  clang lld clang-tidy clang-format libclang-rt-dev # the distribution's default version: 14 on Debian 12
  python3-numpy python3-flatbuffers
  mbpoll python3-pymodbus python3-serial python3-serial-asyncio # independent Modbus peers
  mosquitto liblo-tools socat                             # independent MQTT and OSC peers; serial lines
  python3-nmea2                                           # an independent reader of NMEA 0183
  ola ola-python                                          # an independent receiver of sACN and Art-Net
  puredata-core python3-yaml                              # run and read examples
  avahi-daemon avahi-utils dbus-daemon iproute2           # services that a network's programs find, in networks of a test's own
  nginx-light caddy                                       # proxies in front of the page
  nats-server                                             # between daemons that share one wind
  mosquitto-clients openssl                               # a publisher that is not ours; a certificate for the broker
  umockdev libumockdev-dev                                # USB devices without a kernel's
  libasound2-dev libasound2-plugins pulseaudio pulseaudio-utils # sound cards without a card
  xvfb libxtst-dev                                        # a display for the viewer's window, with keys and a mouse
  xserver-xorg-core xserver-xorg-video-dummy x11-xserver-utils libx11-dev # monitors that come and go, for its wall
  glslang-tools                                           # an independent judge of the shaders
  systemd lintian man-db                                  # independent judges of the units and of the package
  chromium nodejs node-typescript                         # the page: a browser, and the types of its scripts
  qemu-system-x86 busybox-static kmod cpio usbip alsa-utils     # USB and sound through a real kernel, in a virtual machine
)

# install_from_npm NAME: the packages of tests/e2e/NAME into build/NAME, where npm can get them.
install_from_npm() {
  local from=tests/e2e/$1 to=build/$1
  cmp -s "$from/package-lock.json" "$to/package-lock.json" && [ -d "$to/node_modules" ] && return
  mkdir -p "$to"
  cp "$from/package.json" "$from/package-lock.json" "$to"
  if npm ci --prefix "$to" --ignore-scripts --omit=optional --no-audit --no-fund --loglevel=error >/dev/null; then
    echo "setup: the tests have in $to what they need from npm."
  else
    rm -f "$to/package-lock.json" # tried again the next time
    echo "setup: npm could not install $from: the tests that need it will be skipped."
  fi
}

# unpack NAME: the distribution's package into build/NAME. chrony is not installed: apt would remove what sets this machine's clock.
unpack() {
  local to=build/$1 folder
  [ ! -d "$to" ] || return 0
  folder=$(mktemp -d)
  mkdir -p build
  if (cd "$folder" && apt-get download -q "$1" >/dev/null 2>&1) && dpkg -x "$folder"/*.deb "$to"; then
    echo "setup: the tests have $1 in $to."
  else
    rm -rf "$to"
    echo "setup: $1 could not be downloaded or unpacked: the tests that need it will be skipped."
  fi
  rm -rf "$folder"
}

cd "$(dirname "$0")/.."
packages=("${build_packages[@]}")
finish() { :; }
case "${1:-}" in
  "") ;;
  --test)
    packages+=("${test_packages[@]}" "${web_packages[@]}" "${nats_packages[@]}" "${arm64_packages[@]}")
    command -v npm >/dev/null || packages+=(npm) # Node.js of others brings its own
    finish() {
      unpack chrony
      install_from_npm browser
      install_from_npm node_red
    } ;;
  --web) packages+=("${web_packages[@]}") ;;
  --nats) packages+=("${nats_packages[@]}") ;;
  --arm64) packages+=("${arm64_packages[@]}") ;;
  --list) printf '%s\n' "${build_packages[@]%%|*}" "${test_packages[@]}" "${web_packages[@]}" "${nats_packages[@]}" "${arm64_packages[@]}"; exit 0 ;;
  *) echo "usage: config/setup.sh [--web | --nats | --test | --arm64 | --list]" >&2; exit 64 ;;
esac

installed() { [ -n "${is_installed[$1]-}" ]; } # PACKAGE

has_lists() { compgen -G '/var/lib/apt/lists/*Packages*' >/dev/null; } # does apt know what the distribution has?

# Sets `missing` to the packages to install, and `unknown` to those that apt does not have. Takes the first of alternatives that is
# installed or that apt has. Asks apt only if the first is not installed.
find_missing() {
  local group package available=
  local -A is_installed=()
  while read -r package; do
    is_installed[$package]=1
  done < <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p')
  missing=()
  unknown=()
  for group in "${packages[@]}"; do
    if installed "${group%%|*}"; then continue; fi
    [ -n "$available" ] || available=$(LC_ALL=C apt-cache policy $(tr '|' ' ' <<<"${packages[*]}") |
      awk '/^[^ ]/ { name = $1; sub(":$", "", name) } $1 == "Candidate:" && $2 != "(none)" { print name }')
    for package in ${group//|/ }; do
      if installed "$package"; then continue 2; fi
      if grep -qxF "$package" <<<"$available"; then
        missing+=("$package")
        continue 2
      fi
    done
    unknown+=("$group")
  done
}

# Prints the packages that the distribution lacks. Fails if Yuragi cannot be built without one of them.
report_unknown() {
  local group
  for group in "${unknown[@]}"; do
    if printf '%s\n' "${build_packages[@]}" | grep -qxF "$group"; then
      echo "setup: this distribution has no package $group, and Yuragi cannot be built without it." >&2
      exit 69
    fi
  done
  [ ${#unknown[@]} -eq 0 ] || echo "setup: not in this distribution, so the tests that need them skip or fail: ${unknown[*]}"
}

install_missing() {
  local as_root plan removed
  if [ "$(id -u)" -eq 0 ]; then
    as_root=(env)
  elif command -v sudo >/dev/null; then
    as_root=(sudo)
  else
    echo "setup: packages are missing, and only root can install them. An administrator has to run:" >&2
    if has_lists; then
      echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    else # which of the alternatives there are is not known yet
      echo "  apt-get update" >&2
      echo "setup: then run this again: it prints what to install." >&2
    fi
    exit 77
  fi
  "${as_root[@]}" apt-get update -q >/dev/null
  find_missing
  report_unknown
  [ ${#missing[@]} -gt 0 ] || return 0
  echo "setup: installing ${#missing[@]} of ${#packages[@]} packages: ${missing[*]}"
  plan=$(LC_ALL=C apt-get install -s -y --no-install-recommends "${missing[@]}")
  if removed=$(grep '^Remv' <<<"$plan"); then
    echo "setup: apt would remove packages of yours, so nothing was done:" >&2
    echo "$removed" >&2
    echo "setup: install by hand what is listed above, or remove these first (libboost1.74-dev gives way to libboost1.81-dev)." >&2
    exit 1
  fi
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}" >/dev/null
  # Their packages start servers that listen to every network; the tests start their own.
  local pair service
  for pair in ola:olad nginx-light:nginx caddy:caddy nats-server:nats-server; do
    service=${pair#*:}
    if [[ " ${missing[*]} " = *" ${pair%:*} "* ]] && [ -d /run/systemd/system ]; then
      "${as_root[@]}" systemctl disable --now "$service" || echo "setup: $service could not be disabled: systemctl disable --now $service"
    fi
  done
}

find_missing
if [ ${#missing[@]} -gt 0 ] || { [ ${#unknown[@]} -gt 0 ] && ! has_lists; }; then
  install_missing
  echo "setup: done."
else
  report_unknown
  echo "setup: $((${#packages[@]} - ${#unknown[@]})) of ${#packages[@]} packages are installed."
fi
finish
