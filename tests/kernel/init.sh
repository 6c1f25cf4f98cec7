#!/bin/sh
# The first program of the emulated machine: loads the drivers, plugs in what is simulated, runs the daemon, writes the
# results to the disk and switches the machine off. What happens there stands in plan.sh; a line with ### is a milestone.
export PATH=/bin:/sbin:/usr/bin:/usr/sbin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
mkdir -p /results /dev/shm /run/udev
exec >/results/console.log 2>&1

milestone() {
  echo "### $(cut -d' ' -f1 /proc/uptime) s: $*"
  echo "### $(cut -d' ' -f1 /proc/uptime) s: $*" >/dev/console
}

# Waits for a condition, for at most so many tenths of a second.
wait_for() {
  tenths=$1
  shift
  while [ "$tenths" -gt 0 ]; do
    "$@" && return 0
    sleep 0.1
    tenths=$((tenths - 1))
  done
  milestone "gave up waiting for: $*"
  return 1
}

# Is a device of that vendor plugged in?
has_device_of() {
  grep -qs "$1" /sys/bus/usb/devices/*/idVendor
}

# Makes a virtual CAN interface and switches it on.
plug_in_bus() {
  ip link add dev "$1" type vcan && ip link set "$1" up
}

# Plugs simulated devices in, PORT:VENDOR each, whenever their servers offer them and they are not there. One after the
# other: two `usbip attach` at the same time may both choose the same place, and then one of them never ends.
keep_plugged_in() {
  while :; do
    for device in "$@"; do
      has_device_of "${device#*:}" || usbip --tcp-port "${device%:*}" attach -r 127.0.0.1 -b 1-1 >>/results/usbip.log 2>&1
    done
    sleep 1
  done
}

milestone "the kernel is up"
ip link set lo up
for module in virtio_pci virtio_blk usbhid hid-generic vhci-hcd vcan can-raw; do modprobe "$module" || echo "no module $module"; done
modprobe snd-aloop index=0 id=Loopback pcm_substreams=2 || echo "no module snd-aloop"
/lib/systemd/systemd-udevd --daemon
udevadm trigger --action=add
udevadm settle --timeout=20
milestone "drivers and udev are up"

. /plan.sh
run_plan

milestone "writing the results"
dmesg >/results/dmesg.log
tar -C /results -cf /dev/vda .
sync
poweroff -f
