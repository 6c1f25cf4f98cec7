#!/usr/bin/env bash
# The wall's unit in a whole Debian with a kernel, systemd and Xorg of its own, on an emulated graphics card: started, stopped by
# SIGSTOP, started again by the watchdog, ended. By hand, as root, in about 6 minutes:
#
#   sudo tests/package/wall_by_hand.sh [PACKAGE.deb]     default: the one that config/package.sh has built
#
# Needs mmdebstrap, qemu-system-x86 and e2fsprogs, 4 GB in /var/tmp, and a mirror of Debian. The viewer feeds the watchdog whenever it
# has drawn a picture. It draws the test card: emulated processors take minutes for a scene.
set -euo pipefail
cd "$(dirname "$0")/../.."
package=$(realpath "${1:-$(ls build/package/package/*.deb)}")

work=$(mktemp -d /var/tmp/yuragi-wall-XXXXXX)
trap 'rm -rf --one-file-system "$work"' EXIT
cp "$package" "$work/yuragi.deb"

# The emulated machine runs this after its start. Each line goes to its serial console.
cat >"$work/look-at-the-wall" <<'END'
#!/bin/bash
unit=yuragi-viewer@7
property() { systemctl show --property "$1" --value $unit; }
fail() {
  echo "FAILED: $*"
  systemctl status $unit --no-pager
  journalctl --unit $unit --no-pager --lines 40 --output cat
  tail -20 /var/lib/yuragi/.local/share/xorg/Xorg.7.log
  poweroff -f
}
wait_for() { # WHAT, COMMAND...
  local what=$1
  shift
  for ((tries = 0; tries < 400; tries++)); do
    "$@" && echo "ok: $what" && return
    sleep 1
  done
  fail "$what"
}
draws() { # the watchdog was fed after the start
  [ "$(property ActiveState)" = active ] && (($(property WatchdogTimestampMonotonic) > $(property ExecMainStartTimestampMonotonic) + 5000000))
}
restarted() { [ "$(property NRestarts)" = 1 ]; }
in_unit() { grep -q "$unit" "/proc/$(pidof "$1")/cgroup"; }

systemctl start $unit
wait_for "the viewer draws" draws
in_unit Xorg && in_unit yuragi-viewer || fail "Xorg and the viewer are in the unit"
[ "$(stat -c %U "/proc/$(pidof Xorg)")" = yuragi ] || fail "Xorg runs as yuragi"
kill -STOP "$(pidof yuragi-viewer)"
wait_for "a viewer that hangs is restarted" restarted
wait_for "it draws again" draws
systemctl stop $unit
[ -z "$(pidof Xorg yuragi-viewer)" ] || fail "nothing runs after a stop"
echo "the wall: all as it should be"
poweroff -f
END
cat >"$work/look-at-the-wall.service" <<'END'
[Service]
ExecStart=/bin/bash /root/look-at-the-wall
StandardOutput=tty
TTYPath=/dev/ttyS0
END
cat >"$work/wall.conf" <<'END'
[Service]
Environment=YURAGI_VIEWER_OPTIONS="--test-card --samples 1"
END

# xserver-xorg-core and what else the package recommends for the wall.
recommended=$(dpkg-deb -f "$package" Recommends | tr -d ' ')
mmdebstrap --quiet --variant=minbase --include="systemd-sysv,udev,procps,linux-image-amd64,$recommended" \
  --aptopt='APT::Install-Recommends "false"' --customize-hook="copy-in '$work/yuragi.deb' '$work/look-at-the-wall' /root" \
  --customize-hook='chroot "$1" apt-get install -qq -y /root/yuragi.deb' \
  --customize-hook="copy-in '$work/look-at-the-wall.service' /etc/systemd/system" \
  --customize-hook='mkdir -p "$1/etc/systemd/system/yuragi-viewer@7.service.d"' \
  --customize-hook="copy-in '$work/wall.conf' /etc/systemd/system/yuragi-viewer@7.service.d" \
  --customize-hook='mkdir -p "$1/etc/systemd/system/multi-user.target.wants"' \
  --customize-hook='ln -s ../look-at-the-wall.service "$1/etc/systemd/system/multi-user.target.wants/"' \
  bookworm "$work/tree" >"$work/apt.log" 2>&1 || { tail -30 "$work/apt.log"; exit 1; }
truncate -s 4G "$work/disk"
mke2fs -q -t ext4 -d "$work/tree" "$work/disk"
echo "made: Debian with $(basename "$package")"

# Emulated, whatever /dev/kvm looks like: see tests/kernel/virtual_machine.py.
timeout 1200 qemu-system-x86_64 -M q35 -accel tcg,thread=multi -cpu max -smp 2 -m 2048 -nodefaults -no-reboot -display none \
  -kernel "$work"/tree/boot/vmlinuz-* -initrd "$work"/tree/boot/initrd.img-* -append "root=/dev/vda rw console=ttyS0 quiet systemd.mask=serial-getty@ttyS0.service" \
  -drive "file=$work/disk,format=raw,if=virtio,cache=unsafe" -device virtio-gpu-pci,xres=640,yres=480 -device virtio-rng-pci \
  -serial "file:$work/console" || true
tr -d '\r' <"$work/console" | grep -a -E '^(ok: |the wall: )' || true
grep -a -q 'the wall: all as it should be' "$work/console" || { tail -80 "$work/console"; exit 1; }
