#!/usr/bin/env python3
"""A follower that is built for arm64 has, in an emulator, the poses of its leader on this machine, bit for bit, for 10 s.

usage: arm64_follower.py FOLDER_OF_PROGRAMS COMMAND...

COMMAND runs the daemon that is built for arm64. tests/arm64.sh calls this.
"""
import os
import sys
import time
import unittest

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
import fleet  # noqa: E402
from fleet import RATE_HZ, Daemon  # noqa: E402
from nats import Server  # noqa: E402

fleet.FleetTest.programs = os.path.abspath(sys.argv[1])
ON_ARM64 = sys.argv[2:]
del sys.argv[1:]
tearDownModule = fleet.print_table


class Arm64Follower(fleet.FleetTest):
    def test_its_poses_are_those_of_its_leader(self):
        server = Server(self, "server")
        leader = Daemon(self, "leader", lead=server.address, scenes=fleet.SCENES)
        began_s = time.monotonic()
        follower = Daemon(self, "follower", follow=server.address, scenes=fleet.SCENES, speed_m_s=2.0, program=ON_ARM64)
        took_s = self.wait_until_equal(leader, follower, began_s, ticks=10 * RATE_HZ)
        common, equal = self.share_equal(leader, follower, began_s)
        fleet.add_row("arm64 in an emulator", equal=f"{equal} of {common}, the last {10 * RATE_HZ} without a gap", seconds=took_s)
        follower.wait_for_feed("sends", "the same picture as its leader")


if __name__ == "__main__":
    unittest.main(verbosity=2)
