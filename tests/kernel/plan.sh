# What happens in the emulated machine: three real sensors of the kernel's, none of which exists.
#   a WMR300 by USB/IP      -> usbhid -> /dev/hidraw0          -> hidapi    -> the daemon
#   a LabJack U3 by USB/IP  -> usbfs  -> /dev/bus/usb/001/...  -> libusb    -> the daemon
# Both are unplugged and plugged in again while the daemon runs.
wind="--speed 8 --direction 90 --turbulence 0.1"
yuragi-sim hid --device wmr300 --usbip 127.0.0.1:3240 $wind --fault unplug@26+6 </dev/null >/results/hid.log 2>&1 &
yuragi-sim usb --device labjack-u3 --usbip 127.0.0.1:3241 $wind --fault unplug@20+5 </dev/null >/results/usb.log 2>&1 &
keep_plugged_in 3240 0fde &
keep_plugged_in 3241 0cd5 &
wait_for 300 grep -qs 0cd5 /sys/bus/usb/devices/*/idVendor
wait_for 300 test -c /dev/hidraw0
milestone "plugged in: $(cat /sys/bus/usb/devices/*/product | tr '\n' ',') $(ls -l /dev/hidraw0)"

yuragi run --config /wall.toml --record /results/wall.windlog --duration 55 --verbose >/results/daemon.log 2>&1
milestone "the daemon has ended with $?"
usbip port >/results/ports.log 2>&1
