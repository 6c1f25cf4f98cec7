#!/usr/bin/env bash
# The package in a whole Debian with a real systemd (a container of systemd-nspawn): installed, started, killed by the watchdog and
# started again, with a bad configuration, reloaded, upgraded, rolled back, purged. By hand, as root, in about 2 minutes, the first time 4:
#
#   sudo tests/package/by_hand.sh [PACKAGE.deb]     default: the one that config/package.sh has built
#
# Needs mmdebstrap and systemd-container, and a mirror of Debian.
set -euo pipefail
cd "$(dirname "$0")/../.."
package=${1:-$(ls build/package/package/*.deb)}

work=$(mktemp -d /var/tmp/yuragi-by-hand-XXXXXX)
tree=$work/tree
mkdir "$tree"
nspawn='' leader=''
finish() {
  [ -z "$leader" ] || kill -KILL "$leader" 2>/dev/null || true
  [ -z "$nspawn" ] || wait "$nspawn" 2>/dev/null || true
  rm -rf --one-file-system "$work"
}
trap finish EXIT

inside() { nsenter --target "$leader" --mount --uts --ipc --net --pid -- "$@"; }
property() { inside systemctl show --property "$1" --value yuragi; }
say() { printf '%-66s %s\n' "$1" "$2"; }
expect() { # WHAT, WANTED, IS
  [ "$2" = "$3" ] && say "$1" "$3" || { say "$1" "$3, and not $2: FAILED"; inside journalctl -u yuragi --no-pager -n 30; exit 1; }
}
seconds_since() { printf '%d.%d s' $(($(($(date +%s%N) - $1)) / 1000000000)) $(($(($(date +%s%N) - $1)) / 100000000 % 10)); }
journal_end() { inside journalctl --lines 1 --quiet --show-cursor | sed -n 's/^-- cursor: //p'; }
# Waits for what the journal says of the unit after its place $1.
wait_for_journal() {
  timeout 120 bash -c "nsenter --target $leader --mount --uts --ipc --net --pid -- \
    journalctl --unit yuragi --after-cursor '$1' --follow --lines all --output cat | grep --quiet --max-count 1 '$2'"
}

base=build/debian-base.tar # made once
[ -f "$base" ] || mmdebstrap --quiet --variant=minbase --include=systemd-sysv,dbus,udev bookworm "$base"
tar -xf "$base" -C "$tree"
cp --remove-destination /etc/resolv.conf "$tree/etc/resolv.conf"
cp "$package" "$tree/root/yuragi.deb"
chroot "$tree" apt-get update -qq
DEBIAN_FRONTEND=noninteractive chroot "$tree" apt-get install -qq -y --no-install-recommends /root/yuragi.deb >"$work/apt.log" 2>&1 \
  || { cat "$work/apt.log"; exit 1; }
say "apt install ./yuragi.deb in a fresh Debian" done
dpkg-deb -R "$package" "$work/next"
sed -i 's/^Version: .*/Version: 99.0/' "$work/next/DEBIAN/control"
dpkg-deb --root-owner-group -b "$work/next" "$tree/root/next.deb" >/dev/null

systemd-nspawn -b -D "$tree" --register=no --keep-unit --private-network --console=pipe >"$work/console" 2>&1 &
nspawn=$!
until leader=$(pgrep -P $nspawn) && inside systemctl is-system-running --wait >/dev/null 2>&1 \
  || inside systemctl is-system-running 2>/dev/null | grep -q degraded; do kill -0 $nspawn; done
expect "after boot it is" inactive "$(inside systemctl is-active yuragi || true)"

begin=$(date +%s%N)
inside systemctl start yuragi
say "systemctl start returns when the first frame is there, after" "$(seconds_since "$begin")"
expect "it is" active "$(property ActiveState)"
expect "its user" yuragi "$(inside stat -c %U "/proc/$(property MainPID)")"
say "its status" "$(property StatusText)"

begin=$(date +%s%N) first=$(property MainPID) place=$(journal_end)
inside bash -c "kill -STOP $first"
wait_for_journal "$place" 'Watchdog timeout'
say "stopped by SIGSTOP: the watchdog's time is out after" "$(seconds_since "$begin")"
wait_for_journal "$place" '^Started yuragi.service'
say "and it is started again after" "$(seconds_since "$begin")"
expect "restarts" 1 "$(property NRestarts)"
[ "$(property MainPID)" != "$first" ]

inside cp /etc/yuragi/yuragi.toml /root/good.toml
echo 'nonsense = 1' | inside tee /etc/yuragi/yuragi.toml >/dev/null
inside systemctl restart yuragi 2>/dev/null || true
expect "with a mistake in the configuration it is" failed "$(property ActiveState)"
expect "by exit code" 78 "$(property ExecMainStatus)"
expect "and is not started again: restarts" 0 "$(property NRestarts)"
inside cp /root/good.toml /etc/yuragi/yuragi.toml
echo '# ours' | inside tee -a /etc/yuragi/yuragi.toml >/dev/null
inside systemctl start yuragi

first=$(property MainPID) place=$(journal_end)
printf '\n[[scene]]\nkind = "flag"\nx = 6\n' | inside tee -a /etc/yuragi/yuragi.toml >/dev/null
begin=$(date +%s%N)
inside systemctl reload yuragi || { inside journalctl -u yuragi --no-pager -n 20; exit 1; }
wait_for_journal "$place" 'reload: .* scene flag: is new'
say "systemctl reload brings a scene after" "$(seconds_since "$begin")"
expect "it is ready again by" active "$(property ActiveState)"
echo 'nonsense = 1' | inside tee -a /etc/yuragi/yuragi.toml >/dev/null
expect "with a mistake systemctl reload" refused "$(inside systemctl reload yuragi 2>/dev/null && echo done || echo refused)"
expect "and the daemon is" "active $first" "$(property ActiveState) $(property MainPID)"
inside sed -i '/^nonsense/d' /etc/yuragi/yuragi.toml
expect "yuragi status" 0 "$(inside yuragi status --quiet --config /etc/yuragi/yuragi.toml && echo 0 || echo $?)"
say "yuragi doctor" "$(inside runuser -u yuragi -- yuragi doctor --json | grep -m1 '"verdict"' || true)"
echo '# ours' | inside tee -a /etc/yuragi/yuragi.toml >/dev/null

for step in "upgraded to 99.0:next.deb" "rolled back:yuragi.deb"; do
  first=$(property MainPID)
  inside dpkg -i "/root/${step#*:}" </dev/null >/dev/null 2>&1
  expect "${step%:*}: it is" active "$(property ActiveState)"
  [ "$(property MainPID)" != "$first" ] # the new program runs
  expect "its configuration" '# ours' "$(inside tail -1 /etc/yuragi/yuragi.toml)"
done
expect "the recording is of" "yuragi:yuragi 640" "$(inside stat -c '%U:%G %a' /var/lib/yuragi/wind.windlog)"

# A recording with readings of yesterday.
inside bash -c 'set -e; systemctl stop yuragi; cd /root; echo time,speed_m_s,direction_deg >day.csv
  for hour in {00..23}; do for minute in {00..59}; do
    echo "$(date -d yesterday +%F)T$hour:$minute:00Z,$((4 + 10#$minute % 7)),240"; done; done >>day.csv
  rm /var/lib/yuragi/wind.windlog*; yuragi import day.csv -o /var/lib/yuragi/wind.windlog; chown yuragi: /var/lib/yuragi/wind.windlog
  systemctl start yuragi' >/dev/null 2>&1
inside systemctl start yuragi-report || { inside journalctl -u yuragi-report --no-pager -n 20; exit 1; }
expect "the daily page has pictures" yes \
  "$(inside bash -c 'grep -q "<svg" /var/lib/yuragi/reports/*.html && echo yes || echo no')"

inside systemctl enable --quiet yuragi
inside dpkg -P yuragi >/dev/null 2>&1
expect "purged: programs and configuration left" 0 \
  "$(inside find /usr/bin /etc /lib/systemd /usr/lib/systemd /usr/share -name '*yuragi*' | wc -l)"
expect "recordings left, yesterday's and today's" 2 "$(inside find /var/lib/yuragi -name '*.windlog' | wc -l)"
inside systemctl poweroff
wait $nspawn || true
nspawn=''
say "by_hand.sh" "all as it should be"
