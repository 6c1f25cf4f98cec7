#!/usr/bin/env python3
"""The daemon on a real kernel's devices: simulated sensors come in over USB/IP, and leave, and return.

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

import virtual_machine

HERE = pathlib.Path(__file__).resolve().parent
BIN, CACHE = (pathlib.Path(word).resolve() for word in (sys.argv.pop(1), sys.argv.pop(1)))
SKIPPED = 77
BOOT_TIMEOUT_S = 420.0

SPEED_M_S = 8.0
DIRECTION_DEG = 90.0


def make_file_system(root, kernel_folder):
    files = virtual_machine.RootFileSystem(root)
    files.add_modules(kernel_folder, virtual_machine.MODULES)
    for program in ("yuragi", "yuragi-sim"):
        files.add_program(BIN / program, f"/usr/bin/{program}")
    files.add_program(virtual_machine.need("usbip", "usbip"), "/usr/sbin/usbip")

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
    for name, lines in (("passwd", "root:x:0:0::/root:/bin/sh\n"), ("group", "root:x:0:\n")):
        (files.root / "etc" / name).write_text(lines, encoding="ascii")

    files.add_file(HERE / "init.sh", "/init", executable=True)
    files.add_file(HERE / "plan.sh", "/plan.sh")
    files.add_file(HERE / "wall.toml", "/wall.toml")
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
        names = ("console.log", "daemon.log", "hid.log", "usb.log", "usbip.log", "dmesg.log")
        return "\n".join(f"---- {name}\n{self.text(name)}" for name in names if (self.results / name).exists())

    def readings_of(self, sensor, least):
        found = [reading for reading in self.readings if reading["sensor"] == sensor]
        self.assertGreaterEqual(len(found), least, f"readings of {sensor}\n{self.all_logs()}")
        return found

    def check_wind(self, readings):
        """Every reading is one of the simulated wind, and their means are its means."""
        speeds_m_s = [float(reading["speed_m_s"]) for reading in readings]
        mean_m_s = sum(speeds_m_s) / len(speeds_m_s)
        self.assertAlmostEqual(mean_m_s, SPEED_M_S, delta=0.1 * SPEED_M_S)
        self.assertGreater(min(speeds_m_s), 0.4 * SPEED_M_S)
        self.assertLess(max(speeds_m_s), 1.6 * SPEED_M_S)
        angles_rad = [math.radians(float(reading["direction_deg"])) for reading in readings]
        mean_deg = math.degrees(math.atan2(sum(map(math.sin, angles_rad)), sum(map(math.cos, angles_rad))))
        self.assertAlmostEqual(mean_deg, DIRECTION_DEG, delta=10.0)
        print(f"  {readings[0]['sensor']}: {len(readings)} readings, {mean_m_s:.2f} m/s from {mean_deg:.0f} deg")

    def check_it_came_back(self, readings, gap_s, wait_s):
        """There is one gap of at least `gap_s`, with readings on both sides, and it is no longer than `wait_s`."""
        times_s = [float(reading["time_s"]) for reading in readings]
        gaps_s = [later - sooner for sooner, later in zip(times_s, times_s[1:])]
        self.assertEqual(sum(gap > gap_s for gap in gaps_s), 1, f"{gaps_s}\n{self.all_logs()}")
        self.assertLess(max(gaps_s), wait_s, self.all_logs())

    def test_the_kernel_had_the_devices(self):
        kernel = self.text("dmesg.log")
        self.assertRegex(kernel, r"hid-generic .*: hidraw0: USB HID")
        self.assertIn("idVendor=0cd5, idProduct=0003", kernel)
        self.assertGreaterEqual(len(re.findall(r"vhci_hcd .*: connection closed|USB disconnect", kernel)), 2)

    def test_the_daemon_ended_in_order(self):
        self.assertIn("the daemon has ended with 0", self.text("console.log"), self.daemon_log)
        self.assertRegex(self.daemon_log, r"recorded \d+ readings, lost 0")

    def test_a_weather_station_is_read_by_hidraw_and_comes_back(self):
        readings = self.readings_of("station", 8)
        self.check_wind(readings)
        self.check_it_came_back(readings, gap_s=5.0, wait_s=20.0)

    def test_a_counter_is_read_by_libusb_and_comes_back(self):
        readings = self.readings_of("cup", 100)
        self.check_wind(readings)
        self.check_it_came_back(readings, gap_s=4.0, wait_s=18.0)


if __name__ == "__main__":
    try:
        for program, package in (("qemu-system-x86_64", "qemu-system-x86"), ("busybox", "busybox-static"),
                                 ("cpio", "cpio"), ("modprobe", "kmod"), ("usbip", "usbip")):
            virtual_machine.need(program, package)
        KERNEL = virtual_machine.unpacked([virtual_machine.kernel_package()], CACHE)
        virtual_machine.unpacked(virtual_machine.UDEV_PACKAGES, CACHE)
    except virtual_machine.Unavailable as why:
        print(f"skipped: {why}", file=sys.stderr)
        sys.exit(SKIPPED)
    os.environ["PATH"] = virtual_machine.SYSTEM_PATH
    unittest.main(verbosity=2)
