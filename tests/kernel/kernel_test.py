#!/usr/bin/env python3
"""The daemon on a real kernel's devices: simulated sensors come in over USB/IP, sound and CAN, and leave, and return.

usage: kernel_test.py FOLDER_OF_PROGRAMS CACHE_FOLDER
Exits with 77, saying why, where an emulated machine cannot be had.
"""
import csv
import io
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy

import virtual_machine

HERE = pathlib.Path(__file__).resolve().parent
BIN, CACHE = (pathlib.Path(word).resolve() for word in (sys.argv.pop(1), sys.argv.pop(1)))
SKIPPED = 77
BOOT_TIMEOUT_S = 420.0

# The wind that is played, again and again: it swells and dies away, and turns to and fro.
SPEED_M_S = 8.0
SWELL_M_S = 2.0
PERIOD_S = 20.0
DIRECTION_DEG = 90.0
TURN_DEG = 15.0
BAND_HZ = (20.0, 200.0)  # the microphone driver's, unless it is told otherwise


def make_wind(windlog):
    with tempfile.NamedTemporaryFile("w", suffix=".csv", encoding="ascii") as table:
        table.write("time_s,speed_m_s,direction_deg\n")
        for i in range(int(10 * 3 * PERIOD_S)):
            wave = math.sin(2.0 * math.pi * 0.1 * i / PERIOD_S)
            table.write(f"{0.1 * i:.1f},{SPEED_M_S + SWELL_M_S * wave:.3f},{DIRECTION_DEG + TURN_DEG * wave:.2f}\n")
        table.flush()
        subprocess.run([BIN / "yuragi", "import", table.name, "-o", windlog], check=True, capture_output=True)


def microphone_gain_m_s(folder):
    """How the simulated microphone is calibrated: 10 m/s over the fourth root of its sound's mean square in the band."""
    sound = folder / "calibration.raw"
    subprocess.run([BIN / "yuragi-sim", "microphone", "--speed", "10", "--turbulence", "0", "--rate", "8000", "--duration",
                    "30", "--out", sound], check=True, capture_output=True)
    samples = numpy.fromfile(sound, dtype="<f4").astype(float)
    powers = numpy.abs(numpy.fft.rfft(samples)) ** 2 * 2.0 / len(samples) ** 2
    frequencies_hz = numpy.fft.rfftfreq(len(samples), 1.0 / 8000.0)
    mean_square = powers[(frequencies_hz >= BAND_HZ[0]) & (frequencies_hz < BAND_HZ[1])].sum()
    return 10.0 / mean_square ** 0.25


def make_file_system(root, kernel_folder):
    files = virtual_machine.RootFileSystem(root)
    files.add_modules(kernel_folder, virtual_machine.MODULES)
    for program in ("yuragi", "yuragi-sim"):
        files.add_program(BIN / program, f"/usr/bin/{program}")
    for program, package in (("usbip", "usbip"), ("aplay", "alsa-utils")):
        path = virtual_machine.need(program, package)
        files.add_program(path, path)
    files.add_folder("/usr/share/alsa", without=("ucm", "ucm2", "topology", "init"))

    # udev, without which libusb hears of no device that comes or goes.
    udev = virtual_machine.unpacked(virtual_machine.UDEV_PACKAGES, CACHE)
    private = udev / "usr/lib/x86_64-linux-gnu/systemd"
    files.add_program(udev / "bin/udevadm", "/bin/udevadm", [private])
    (files.root / "lib/systemd").mkdir(exist_ok=True)
    (files.root / "lib/systemd/systemd-udevd").symlink_to("/bin/udevadm")
    for rules in ("50-udev-default.rules", "60-serial.rules", "99-systemd.rules"):
        source = udev / "lib/udev/rules.d" / rules
        if source.is_file():
            files.add_file(source, f"/lib/udev/rules.d/{rules}")
    for rules in (HERE.parents[1] / "config/udev").glob("*.rules"):
        files.add_file(rules, f"/etc/udev/rules.d/{rules.name}")
    users = "root:x:0:0::/root:/bin/sh\nwind:x:1000:1000::/tmp:/bin/sh\n"
    groups = "root:x:0:\naudio:x:29:wind\nplugdev:x:46:wind\nwind:x:1000:\n"
    for name, lines in (("passwd", users), ("group", groups)):
        (files.root / "etc" / name).write_text(lines, encoding="ascii")

    files.add_file(HERE / "init.sh", "/init", executable=True)
    files.add_file(HERE / "plan.sh", "/plan.sh")
    wall = (HERE / "wall.toml").read_text(encoding="utf-8")
    (files.root / "wall.toml").write_text(wall.replace("@gain@", f"{microphone_gain_m_s(files.root / 'tmp'):.3f}"),
                                          encoding="utf-8")
    make_wind(files.root / "wind.windlog")
    return files


class KernelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="yuragi-kernel-")
        cls.addClassCleanup(folder.cleanup)
        place = pathlib.Path(folder.name)
        make_file_system(place / "root", KERNEL).pack(place / "initrd.cpio")
        console = place / "console.log"
        virtual_machine.boot(KERNEL, place / "initrd.cpio", place / "disk", console, BOOT_TIMEOUT_S)
        cls.results = place / "results"
        if not virtual_machine.take_results(place / "disk", cls.results):
            raise AssertionError("the machine left no results; it said:\n" + console.read_text(errors="replace"))
        cls.daemon_log = cls.text("daemon.log")
        text = subprocess.run([BIN / "yuragi", "export", cls.results / "wall.windlog", "-o", "-"], capture_output=True,
                              text=True, check=True).stdout
        cls.readings = list(csv.DictReader(io.StringIO(text)))

    @classmethod
    def text(cls, name):
        return (cls.results / name).read_text(encoding="utf-8", errors="replace")

    def all_logs(self):
        names = ("console.log", "daemon.log", "hid.log", "usb.log", "usbip.log", "can.log", "list.log", "microphone.log", "aplay.log", "dmesg.log")
        return "\n".join(f"---- {name}\n{self.text(name)}" for name in names if (self.results / name).exists())

    def readings_of(self, sensor, least):
        found = [reading for reading in self.readings if reading["sensor"] == sensor]
        self.assertGreaterEqual(len(found), least, f"readings of {sensor}\n{self.all_logs()}")
        return found

    def check_wind(self, readings, tolerance, least_swell, most_swell):
        """The readings are the wind that was played: its mean and its wave, fitted at its period (a sensor that was away
        for a part of a wave has another mean), and never anything else."""
        times_s = numpy.array([float(reading["time_s"]) for reading in readings])
        speeds_m_s = numpy.array([float(reading["speed_m_s"]) for reading in readings])
        phases_rad = 2.0 * math.pi * times_s / PERIOD_S
        terms = numpy.stack([numpy.ones_like(times_s), numpy.sin(phases_rad), numpy.cos(phases_rad)], axis=1)
        mean_m_s, sine_m_s, cosine_m_s = numpy.linalg.lstsq(terms, speeds_m_s, rcond=None)[0]
        swell_m_s = math.hypot(sine_m_s, cosine_m_s)
        print(f"  {readings[0]['sensor']}: {len(readings)} readings, {mean_m_s:.2f} m/s of {SPEED_M_S:.2f}, swell"
              f" {swell_m_s:.2f} m/s of {SWELL_M_S:.2f}")
        self.assertAlmostEqual(mean_m_s, SPEED_M_S, delta=tolerance * SPEED_M_S, msg=self.all_logs())
        self.assertGreater(swell_m_s, least_swell * SWELL_M_S)
        self.assertLess(swell_m_s, most_swell * SWELL_M_S)
        self.assertGreater(speeds_m_s.min(), SPEED_M_S - 2.5 * SWELL_M_S)
        self.assertLess(speeds_m_s.max(), SPEED_M_S + 2.5 * SWELL_M_S)

    def check_direction(self, readings):
        for reading in readings:
            self.assertAlmostEqual(float(reading["direction_deg"]), DIRECTION_DEG, delta=TURN_DEG + 5.0)

    def check_it_came_back(self, readings, gap_s, wait_s):
        """It was lost and found again, and silent for no longer than `wait_s`. A busy machine may lose it more than once: it is late."""
        times_s = [float(reading["time_s"]) for reading in readings]
        longest_s = max(later - sooner for sooner, later in zip(times_s, times_s[1:]))
        self.assertGreater(longest_s, gap_s, self.all_logs())
        self.assertLess(longest_s, wait_s, self.all_logs())
        self.assertRegex(self.daemon_log, rf"sensor {readings[0]['sensor']}: \d+ readings .* [1-9]\d* reconnects?\b")

    def test_the_kernel_had_the_devices(self):
        kernel = self.text("dmesg.log")
        self.assertRegex(kernel, r"hid-generic .*hidraw0: USB HID")
        self.assertIn("idVendor=0cd5, idProduct=0003", kernel)
        self.assertGreaterEqual(len(re.findall(r"vhci_hcd .*: connection closed|USB disconnect", kernel)), 2)

    def test_the_daemon_needed_no_more_than_the_udev_rules_give(self):
        self.assertRegex(self.daemon_log, r"uid=1000\(wind\)")
        # On a busy machine a device may be there for a moment before udev has given it to the group.
        for refused in re.finditer(r"sensor (\w+): .*[Pp]ermission", self.daemon_log):
            self.assertRegex(self.daemon_log[refused.end() :], rf"sensor {refused.group(1)}: connected", refused.group(0))

    def test_the_daemon_ended_in_order(self):
        self.assertEqual(self.text("console.log").count("the daemon has ended with 0"), 1, self.daemon_log)
        self.assertRegex(self.daemon_log, r"recorded \d+ readings, lost 0")

    def test_a_weather_station_is_read_by_hidraw_and_comes_back(self):
        readings = self.readings_of("station", 6)
        self.check_wind(readings, 0.1, 0.5, 1.3)
        self.check_direction(readings)
        self.check_it_came_back(readings, gap_s=5.0, wait_s=30.0)

    def test_a_counter_is_read_by_libusb_and_comes_back(self):
        readings = self.readings_of("cup", 40)
        self.check_wind(readings, 0.05, 0.8, 1.2)
        self.check_direction(readings)
        self.check_it_came_back(readings, gap_s=3.0, wait_s=25.0)

    def test_a_bus_is_read_by_its_can_interface_whatever_becomes_of_that(self):
        readings = self.readings_of("bus", 60)
        self.check_wind(readings, 0.05, 0.8, 1.2)
        self.check_direction(readings)
        link = r"sensor bus: connecting: "
        self.assertRegex(self.daemon_log, link + r"CAN interface vcan0 has left the bus .* \(bus off\)")
        self.assertRegex(self.daemon_log, link + r"the CAN interface vcan0 is down: sudo ip link set vcan0 up")
        self.assertRegex(self.daemon_log, link + r"there is no CAN interface vcan0: plug its adapter in")
        self.assertRegex(self.daemon_log, r"sensor bus: \d+ readings .* [2-9] reconnects\b")
        self.assertNotRegex(self.daemon_log, r"sensor bus: .*not mine")

    def test_the_can_interfaces_are_listed_with_what_they_need(self):
        listed = self.text("list.log")
        self.assertRegex(listed, r'interface = "vcan0"')
        self.assertRegex(listed, r"vcan1[^$]*it is down[^$]*sudo ip link set vcan1 up")

    def test_the_sound_of_wind_is_heard_through_a_sound_card(self):
        readings = self.readings_of("microphone", 30)
        settled = [reading for reading in readings if float(reading["time_s"]) > 5.0]
        self.check_wind(settled, 0.15, 0.6, 1.4)


if __name__ == "__main__":
    try:
        for program, package in (("qemu-system-x86_64", "qemu-system-x86"), ("busybox", "busybox-static"),
                                 ("cpio", "cpio"), ("modprobe", "kmod"), ("usbip", "usbip"), ("aplay", "alsa-utils")):
            virtual_machine.need(program, package)
        KERNEL = virtual_machine.unpacked([virtual_machine.kernel_package()], CACHE)
        virtual_machine.unpacked(virtual_machine.UDEV_PACKAGES, CACHE)
    except virtual_machine.Unavailable as why:
        print(f"skipped: {why}", file=sys.stderr)
        sys.exit(SKIPPED)
    os.environ["PATH"] = virtual_machine.SYSTEM_PATH
    unittest.main(verbosity=2)
