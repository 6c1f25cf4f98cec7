#!/usr/bin/env bash
# Tries the project's HEAD on another distribution, in a tree of its own: config/setup.sh, the demo, and the tests of the engine and
# the drivers (preset `test`) but those labelled `native`. Prints one row of a table. Needs root, mmdebstrap and the network.
#
#   tests/support/try_distribution.sh bookworm|trixie|noble [FOLDER]
#
# FOLDER (build/distributions/NAME) keeps the tree, for the next try. The logs are beside it, in FOLDER.STEP.log.
set -euo pipefail
project=$(realpath "$(dirname "$0")/../..")
name=${1-}
tree=$(realpath -m "${2:-$project/build/distributions/$name}")

# Debian 12 has no package of Ubuntu's keys, so they come from Ubuntu's own.
keyring=/usr/share/keyrings/ubuntu-archive-keyring.gpg
keyring_package=https://archive.ubuntu.com/ubuntu/pool/main/u/ubuntu-keyring/ubuntu-keyring_2023.11.28.1_all.deb
keyring_sha256=36de43b15853ccae0028e9a767613770c704833f82586f28eb262f0311adb8a8

case "$name" in
  bookworm | trixie) sources=(http://deb.debian.org/debian) ;;
  noble) sources=(--components=main,universe --keyring="$tree.keyring.gpg" http://archive.ubuntu.com/ubuntu) ;;
  *) echo "usage: tests/support/try_distribution.sh bookworm|trixie|noble [FOLDER]" >&2; exit 64 ;;
esac

get_ubuntu_keyring() {
  if [ ! -e "$keyring" ]; then
    curl -sSfo "$tree.keyring.deb" "$keyring_package"
    sha256sum --quiet --check <<<"$keyring_sha256  $tree.keyring.deb"
    dpkg-deb --fsys-tarfile "$tree.keyring.deb" | tar -xO ".$keyring" >"$tree.keyring.gpg"
  else
    cp "$keyring" "$tree.keyring.gpg"
  fi
}

if [ ! -e "$tree/etc/os-release" ]; then
  mkdir -p "$(dirname "$tree")"
  [ "$name" != noble ] || get_ubuntu_keyring
  echo "making $tree"
  mmdebstrap --quiet --variant=minbase --include=apt,ca-certificates \
    --dpkgopt=force-unsafe-io "$name" "$tree" "${sources[@]}"
  # The same archive without the path of this machine's keys: the tree has its own.
  sed -i 's/^deb \[signed-by="[^"]*"\]/deb/' "$tree/etc/apt/sources.list"
fi
cp --remove-destination /etc/resolv.conf "$tree/etc/resolv.conf"
mkdir -p "$tree/src"
[ -d "$tree/src/yuragi" ] || git clone -q --no-hardlinks "$project" "$tree/src/yuragi"
git -C "$tree/src/yuragi" fetch -q "$project" HEAD
git -C "$tree/src/yuragi" reset -q --hard FETCH_HEAD
[ ! -d "$project/../shared/data" ] || { mkdir -p "$tree/src/shared" && cp -r "$project/../shared/data" "$tree/src/shared"; }

# Also ends what a failed step has left running.
mounted=()
leave() {
  local place
  for place in "${mounted[@]}"; do umount -l "$tree/$place"; done
}
trap leave EXIT
for place in proc dev dev/pts dev/shm; do
  case $place in
    proc) mount -t proc proc "$tree/proc" ;;
    *) mount --bind "/$place" "$tree/$place" ;;
  esac
  mounted=("$place" "${mounted[@]}")
done

# step NAME COMMAND: runs it in the tree; sets `result` to "ok (SECONDS s)" or "FAILED".
failed=0
step() {
  local began=$SECONDS
  if chroot "$tree" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 TERM=dumb \
    bash -c "cd /src/yuragi && $2" >"$tree.$1.log" 2>&1 </dev/null; then
    result="ok ($((SECONDS - began)) s)"
  else
    result="FAILED ($((SECONDS - began)) s)"
    failed=1
  fi
  echo "$name: $1: $result; $tree.$1.log" >&2
}

step setup 'config/setup.sh'
[ "$failed" -eq 0 ] || exit 1
row="| $name | $result"
step demo 'rm -f demo.png && config/demo.sh 8 && test -s demo.png'
built=$(sed -n 's/^demo: built in //p' "$tree.demo.log")
warnings=$(grep -c 'warning:' "$tree/src/yuragi/build/demo.log" || true)
row+=" | ${built:-FAILED}, $warnings warnings | $result"
step setup-test 'config/setup.sh --test'
row+=" | $result"
programs='engine_tests engine_tests_threadless drivers_tests drivers_tests_threadless'
step build-tests "cmake --preset test --log-level=WARNING && cmake --build --preset test --target $programs"
row+=" | $result"
step tests "for program in $programs; do \$(find build/test -name \$program -type f) --gtest_brief=1 || failed=1; done; [ -z \"\$failed\" ]"
# count PASSED|FAILED: the sum of GoogleTest's lines "[  PASSED  ] 12 tests."
count() { awk -v mark="[  $1  ]" 'index($0, mark) == 1 && $5 ~ /^test/ { sum += $4 } END { print sum + 0 }' "$tree.tests.log"; }
row+=" | $(count PASSED) passed, $(count FAILED) failed, $result |"

echo "| distribution | set-up | build | demo's picture | set-up for tests | build of tests (warnings are errors) | tests |"
echo "| --- | --- | --- | --- | --- | --- | --- |"
echo "$row"
[ "$failed" -eq 0 ]
