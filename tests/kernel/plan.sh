# What happens in the emulated machine: four real sensors of the kernel's, none of which exists.
#   a WMR300 by USB/IP      -> usbhid    -> /dev/hidraw0         -> hidapi    -> the daemon
#   a LabJack U3 by USB/IP  -> usbfs     -> /dev/bus/usb/001/... -> libusb    -> the daemon
#   the sound of wind       -> snd-aloop -> /dev/snd/pcmC0D1c    -> PortAudio -> the daemon
#   frames of NMEA 2000     -> vcan      -> AF_CAN                                    -> the daemon
# They play the same wind. The first two are unplugged and plugged in again while the daemon runs; the CAN interface's
# controller leaves the bus, it is switched off and on, and it is taken away and plugged in again. Another one is down.

# What can happen to a CAN interface, one after the other.
trouble_bus() {
  wait_for 600 grep -q "sensor bus: connected" /results/daemon.log
  echo "exception 5" >/run/can
  wait_for 600 grep -q "sensor bus: .*(bus off)" /results/daemon.log
  sleep 4
  milestone "switching the CAN interface off"
  ip link set vcan0 down
  wait_for 600 grep -q "sensor bus: .* is down" /results/daemon.log
  ip link del vcan0
  wait_for 600 grep -q "sensor bus: .*there is no CAN interface" /results/daemon.log
  plug_in_bus vcan0
  milestone "the CAN interface is back"
}

run_plan() {
  wind="--wind /wind.windlog"
  mkfifo /run/hid /run/usb /run/can # what is typed there goes wrong
  yuragi-sim hid --device wmr300 --usbip 127.0.0.1:3240 $wind <>/run/hid >/results/hid.log 2>&1 &
  yuragi-sim usb --device labjack-u3 --usbip 127.0.0.1:3241 $wind <>/run/usb >/results/usb.log 2>&1 &
  yuragi-sim microphone $wind --out - --format s16 --rate 8000 </dev/null 2>/results/microphone.log |
    aplay -q -D hw:0,0 -t raw -f S16_LE -r 8000 -c 1 >/results/aplay.log 2>&1 &
  plug_in_bus vcan0
  ip link add dev vcan1 type vcan
  yuragi-sim nmea2000 --can vcan0 --rate 5 $wind <>/run/can >/results/can.log 2>&1 &
  keep_plugged_in 3240:0fde 3241:0cd5 &
  wait_for 600 has_device_of 0cd5
  wait_for 600 test -c /dev/hidraw0
  milestone "plugged in"
  ls -l /dev/hidraw* /dev/snd

  yuragi sensors list >/results/list.log 2>&1
  milestone "listed"

  # As an ordinary user, who may open what config/udev lets the group plugdev open, and sound cards.
  chmod 777 /results
  su -s /bin/sh wind -c 'id; exec yuragi run --config /wall.toml --record /results/wall.windlog --duration 50 --verbose' \
    >/results/daemon.log 2>&1 &
  daemon=$!
  trouble_bus &

  wait_for 600 grep -q "sensor cup: connected" /results/daemon.log
  wait_for 600 grep -q "sensor station: connected" /results/daemon.log
  sleep 8
  milestone "unplugging the counter"
  echo "unplug 4" >/run/usb
  sleep 6
  milestone "unplugging the station"
  echo "unplug 5" >/run/hid
  wait $daemon
  milestone "the daemon has ended with $?"
  usbip port >/results/ports.log 2>&1
}
