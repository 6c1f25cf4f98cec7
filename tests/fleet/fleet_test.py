#!/usr/bin/env python3
"""A leader and its followers by way of real NATS servers: the same poses at the same ticks, whatever is lost, ends or hangs.

usage: fleet_test.py FOLDER_OF_PROGRAMS

Prints a table: a step is relative to the largest one in the same wind without a disturbance.
"""
import json
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
import urllib.request

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
import fleet  # noqa: E402
from programs import HANG_S, free_port  # noqa: E402
from fleet import RATE_HZ, Daemon, add_row  # noqa: E402
from nats import Client, Cluster, LossyNetwork, Server  # noqa: E402

fleet.FleetTest.programs = os.path.abspath(sys.argv.pop(1))
tearDownModule = fleet.print_table
MAX_HALT = RATE_HZ  # periods without a frame: a daemon that waits for its leader has none for longer
MAX_STEP = 8.0  # relative to the usual largest one, 1 to 5 measured: without a fade it is 12 to 26
HERE = os.path.dirname(os.path.abspath(__file__))
PROJECT = os.path.join(HERE, "..", "..")
CHROMIUM, BROWSER_TOOLS = "/usr/bin/chromium", os.path.join(PROJECT, "build", "browser")
PASSWORDS = {"leader": "change-this", "follower": "change-this-too"}
with open(os.path.join(PROJECT, "config", "nats", "leader-and-followers.conf"), encoding="utf-8") as written:
    PERMISSIONS = written.read()
LOGINS = {user: f"{user}:{password}" for user, password in PASSWORDS.items()}


class Fleet(fleet.FleetTest):
    def test_ten_followers_that_join_late_have_the_leaders_poses(self):
        server = Server(self, "server")
        leader = Daemon(self, "leader", lead=server.address, scenes=fleet.SCENES)
        leader.stream.wait_for_frames(3 * RATE_HZ)
        began_s = time.monotonic()
        all_of_them = [Daemon(self, f"follower-{i}", follow=server.address, scenes=fleet.SCENES, speed_m_s=2.0, is_watched=i < 3) for i in range(10)]
        for follower in all_of_them[:3]:
            took_s = self.wait_until_equal(leader, follower, began_s, ticks=3 * RATE_HZ)
            common, equal = self.share_equal(leader, follower, began_s + took_s)
            add_row(f"late join of ten, {follower.name}", equal=f"{equal} of {common}", seconds=took_s)
        for follower in all_of_them:
            follower.wait_for_feed("sends", "the same picture as its leader")
            ticks, _, _, states = follower.counts()  # where the machine is late, a follower is, too, and takes another state
            self.assertLess(states, 2 + ticks / (2 * RATE_HZ), "it lives on states instead of ticks")

    def test_lost_ticks_are_had_again(self):
        server = Server(self, "server")
        network = LossyNetwork(self, server, ".tick", seed=1)
        leader = Daemon(self, "leader", lead=server.address)
        follower = Daemon(self, "follower", follow=network.address)
        self.wait_until_equal(leader, follower)
        before, lost = follower.counts(), network.lost
        began_s, network.share = time.monotonic(), 0.15
        took_s = self.wait_until_equal(leader, follower, began_s, ticks=6 * RATE_HZ)
        network.share = 0.0
        lost = network.lost - lost
        self.assertGreater(lost, 10)
        follower.stream.wait_for_frames(RATE_HZ)  # the last one is had again
        after = follower.counts()
        self.assertGreaterEqual(after[1] - before[1], lost - (after[2] - before[2]))
        common, equal = self.share_equal(leader, follower, began_s)
        if after[2] == before[2]:  # all came in time
            self.assertEqual(equal, common, self.logs())
        add_row("15 % of ticks lost", lost, after[1] - before[1], equal=f"{equal} of {common}", seconds=took_s)

    def usual_steps(self, follower):
        """The largest step of each scene, in its leader's wind."""
        return follower.stream.largest_steps_m(follower.stream.wait_for_frames(3 * RATE_HZ))

    def add_row_of_motion(self, case, leader, follower, usual_m, began_s, seconds):
        """Checks how the follower has moved since then."""
        frames = follower.stream.since(began_s)
        halt, step = follower.stream.longest_halt(frames), follower.stream.largest_relative_step(usual_m, frames)
        common, equal = self.share_equal(leader, follower, began_s)
        add_row(f"{case}; {len(frames)} frames, longest halt {halt} ticks", step=step, equal=f"{equal} of {common}", seconds=seconds)
        self.assertLess(halt, MAX_HALT, self.logs())
        self.assertLess(step, MAX_STEP, self.logs())

    def test_a_leader_that_is_killed_and_comes_back(self):
        server = Server(self, "server")
        leader = Daemon(self, "leader", lead=server.address)
        followers = [Daemon(self, f"follower-{i}", follow=server.address, speed_m_s=2.0) for i in range(2)]
        for follower in followers:
            self.wait_until_equal(leader, follower)
        usual_m = self.usual_steps(followers[0])
        began_s = time.monotonic()
        leader.end(signal.SIGKILL)
        for follower in followers:
            follower.wait_for_feed("trouble", "the leader is silent")
        leader = Daemon(self, "leader-again", lead=server.address)
        again_s = time.monotonic()
        for follower in followers:
            took_s = self.wait_until_equal(leader, follower, again_s)
            self.add_row_of_motion(f"leader killed and back, {follower.name}", leader, follower, usual_m, began_s, took_s)

    def test_a_stand_by_leads_while_the_leader_is_away(self):
        server = Server(self, "server")
        leader = Daemon(self, "leader", lead=server.address)
        stand_by = Daemon(self, "stand-by", lead=server.address, follow=server.address)
        follower = Daemon(self, "follower", follow=server.address)
        for one in (stand_by, follower):
            self.wait_until_equal(leader, one)
        usual_m = self.usual_steps(follower)
        began_s = time.monotonic()
        leader.end(signal.SIGKILL)
        stand_by.wait_for(r"no leader is heard: this daemon leads")
        led_s = time.monotonic()
        took_s = self.wait_until_equal(stand_by, follower, led_s)
        self.add_row_of_motion("leader killed, the stand-by leads", stand_by, follower, usual_m, began_s, took_s)
        again_s = time.monotonic()
        leader = Daemon(self, "leader-again", lead=server.address)
        stand_by.wait_for(r"another daemon leads again")
        for one in (stand_by, follower):
            took_s = self.wait_until_equal(leader, one, again_s)
            self.add_row_of_motion(f"the leader is back, {one.name}", leader, one, usual_m, again_s, took_s)

    def test_servers_that_are_killed_or_hang(self):
        cluster = Cluster(self)
        leader = Daemon(self, "leader", lead=cluster.addresses())
        followers = [Daemon(self, "follower", follow=cluster.addresses(1)), Daemon(self, "at-the-leaf", follow=cluster.leaf.address)]
        for follower in followers:
            self.wait_until_equal(leader, follower)
        usual_m = self.usual_steps(followers[0])

        def disturb(case, action, followers):
            before = [follower.counts() for follower in followers]
            began_s = time.monotonic()
            action()
            for follower, counts in zip(followers, before):
                took_s = self.wait_until_equal(leader, follower, began_s)
                now = follower.counts()
                self.add_row_of_motion(f"{case}, {follower.name}", leader, follower, usual_m, began_s, took_s)
                fleet.ROWS[-1] = (fleet.ROWS[-1][0], f"{now[2] - counts[2]} not in time", now[1] - counts[1], *fleet.ROWS[-1][3:])

        disturb("1st server killed", cluster.nodes[0].kill, followers)
        disturb("2nd server killed", cluster.nodes[1].kill, followers)
        for node in cluster.nodes[:2]:
            node.start()
        disturb("3rd server hangs", cluster.nodes[2].hold, followers)
        # It still knows the leaf from before: the others see a loop, and may refuse the leaf for 30 s (nats-server 2.9.10).
        disturb("it goes on", cluster.nodes[2].go_on, followers[:1])
        for daemon in (leader, followers[0]):
            daemon.wait_for_feed("trouble", "^$")

    def test_what_differs_is_named(self):
        server = Server(self, "server")
        leader = Daemon(self, "leader", lead=server.address)
        other_seed = Daemon(self, "other-seed", follow=server.address, seed=fleet.SEED + 1)
        other_scene = Daemon(self, "other-scene", follow=server.address, scenes={**{name: fleet.SCENES[name] for name in fleet.FEW},
                                                                              "flag": fleet.SCENES["flag"] + "\nhalf_lift_speed = 7.0"})
        other_seed.wait_for_feed("trouble", r"cannot follow the leader: its seed or its \[wind\] evolving is another one")
        other_scene.wait_for_feed("sends", r"the leader's wind, another picture: scene flag is another one there; ")
        self.assertEqual(other_scene.feed()["trouble"], "")
        began_s = time.monotonic()
        other_scene.stream.wait_for_frames(2 * RATE_HZ)
        winds = {frame.tick: bytes_of_wind(frame) for frame in leader.stream.frames}
        common = [frame for frame in other_scene.stream.since(began_s) if frame.tick in winds]
        self.assertGreater(len(common), RATE_HZ)
        equal = sum(bytes_of_wind(frame) == winds[frame.tick] for frame in common)
        add_row("another scene: the wind", equal=f"{equal} of {len(common)}")
        self.assertGreater(equal, len(common) / 2)

    def test_another_build_is_named(self):
        server = Server(self, "server")
        other = Client(self, server)
        other.subscribe("wind.ask")
        follower = Daemon(self, "follower", follow=server.address)
        makeup = {"epoch": 5, "delay": 0.3, "software": "yuragi 99.0", "motion": 99, "rate": RATE_HZ, "wind": 1, "scenes": []}

        def lead():
            """Publishes a tick that cannot be read here, and introduces itself."""
            other.publish("wind.tick", b"a tick of another layout")
            questions = other.kept("wind.ask")
            if questions:
                other.publish(questions[-1][1], b"I" + json.dumps(makeup).encode())
            return re.search(r"cannot follow the leader: it has version 99 of the motion \(yuragi 99\.0\), this one version \d+ \(yuragi .*"
                             r"its own sensors are used", follower.feed()["trouble"])
        follower.stream.wait_until(lead, "the other build in its status", every=RATE_HZ // 3)
        add_row("another build: named in its status")

    def test_old_ticks_and_garbage_change_nothing(self):
        server = Server(self, "server")
        anyone = Client(self, server)
        for subject in ("wind.tick", "wind.ask"):
            anyone.subscribe(subject)
        leader = Daemon(self, "leader", lead=server.address)
        follower = Daemon(self, "follower", follow=server.address)
        self.wait_until_equal(leader, follower)
        leader.end(signal.SIGKILL)
        old = [payload for _, _, payload in anyone.kept("wind.tick")]
        follower.wait_for_feed("trouble", "the leader is silent")
        leader = Daemon(self, "leader-again", lead=server.address)
        began_s = time.monotonic()
        self.wait_until_equal(leader, follower, began_s)
        questions = anyone.kept("wind.ask")
        before, attack_s, chance = follower.counts(), time.monotonic(), random.Random(2)
        now = [payload for _, _, payload in anyone.kept("wind.tick")][-50:]
        inbox = questions[-1][1]
        self.assertRegex(inbox, r"^_INBOX\.")
        sent = 0
        for tick in old[-50:] + now:
            anyone.publish("wind.tick", tick)
            damaged = bytearray(tick)
            damaged[chance.randrange(len(tick))] ^= 1 << chance.randrange(8)
            for garbage in (bytes(damaged), tick[:chance.randrange(len(tick))], chance.randbytes(chance.randrange(2000))):
                for subject in ("wind.tick", "wind.ask", inbox):
                    for kind in (b"", b"I", b"T", b"S"):
                        anyone.publish(subject, kind + garbage, inbox)
                        sent += 1
        for question in (b"{", b"[" * 30000, b'{"ask":"ticks","epoch":1,"from":0,"to":18446744073709551615}', b'{"ask":"state","epoch":-1}'):
            anyone.publish("wind.ask", question, inbox)
            anyone.publish("wind.ask", question, "wind.tick")
        anyone.flush()
        took_s = self.wait_until_equal(leader, follower, attack_s, ticks=3 * RATE_HZ)
        common, equal = self.share_equal(leader, follower, attack_s)
        add_row(f"{sent} old ticks and garbage", equal=f"{equal} of {common}", seconds=took_s)
        after = follower.counts()
        if after[2] == before[2]:  # all ticks came in time
            self.assertEqual((equal, after[3]), (common, before[3]), self.logs())
        self.assertEqual((leader.feed()["trouble"], follower.feed()["trouble"]), ("", ""))

    def test_a_follower_without_rights_cannot_lead(self):
        server = Server(self, "server", PERMISSIONS)
        leader = Daemon(self, "leader", lead=server.address, wind=self.credentials("leader"))
        follower = Daemon(self, "follower", follow=server.address, wind=self.credentials("follower"))
        self.wait_until_equal(leader, follower)
        hostile = Client(self, server, LOGINS["follower"])
        hostile.subscribe("wind.tick")
        hostile.wait_until(lambda: len(hostile.messages) >= 5)
        began_s = time.monotonic()
        for _, _, tick in hostile.kept("wind.tick"):
            hostile.publish("wind.tick", tick)
        hostile.publish("_INBOX.anybody", b"T")
        hostile.wait_until(lambda: any('Publish to "_INBOX.anybody"' in error for error in hostile.errors))
        self.assertTrue(any('Publish to "wind.tick"' in error for error in hostile.errors), hostile.errors)
        # It may ask, but not so much that others get nothing.
        epoch = self.epoch(hostile)
        for _ in range(2000):
            hostile.publish("wind.ask", b'{"ask":"ticks","epoch":%d,"from":0,"to":18446744073709551615}' % epoch, "_INBOX.nobody")
        hostile.flush()
        leader.wait_for_feed("sends", r"leads; 2\d\d\d questions answered")
        sent_again = int(re.search(r"(\d+) ticks sent again", leader.feed()["sends"]).group(1))
        self.assertGreater(sent_again, 0)
        self.assertLess(sent_again, 30_000)  # of 100,000
        pretender = Daemon(self, "pretender", lead=server.address, wind=self.credentials("follower"))
        pretender.wait_for_feed("trouble", r"does not permit this user something .*wind\.(tick|ask)")
        wrong = Daemon(self, "wrong-password", follow=server.address, wind=self.credentials("follower", "follower:wrong"))
        wrong.wait_for_feed("trouble", "does not accept this user: check the file of credentials")
        took_s = self.wait_until_equal(leader, follower, began_s, ticks=2 * RATE_HZ)
        common, equal = self.share_equal(leader, follower, began_s)
        add_row("a publisher without rights", equal=f"{equal} of {common}", seconds=took_s)
        self.assertEqual((leader.feed()["trouble"], follower.feed()["trouble"]), ("", ""))

    def history(self, daemon):
        """The same as find_history(), as soon as it can be read: after a server's end its neighbours elect another one first."""
        return daemon.stream.wait_until(lambda: self.find_history(daemon), "a history", every=RATE_HZ)

    def find_history(self, daemon):
        """The seconds of the last day that each node was heard, as JetStream has them; None if they cannot be read now."""
        done = daemon.run("fleet", "--history", "--config", daemon.file, "--json")
        self.assertIn(done.returncode, (0, 2), done.stderr)
        if done.returncode == 2:
            return None
        return {node["node"]: sum(hour["heard_s"] for hour in node["hours"]) for node in json.loads(done.stdout)["nodes"]}

    def wait_for_history(self, daemon, name, more_than_s):
        def find():
            return (self.find_history(daemon) or {}).get(name, 0) > more_than_s
        daemon.stream.wait_until(find, f"more than {more_than_s} s of {name} in the history", every=RATE_HZ)

    def test_a_history_is_kept_while_the_server_is_away(self):
        cluster = Cluster(self, PERMISSIONS, stores=True)
        leader = Daemon(self, "leader", lead=cluster.addresses(), wind=self.credentials("leader") + '\nnode = "roof"')
        follower = Daemon(self, "follower", follow=cluster.nodes[2].address, wind=self.credentials("follower") + '\nnode = "room"')
        for name in ("roof", "room"):
            self.wait_for_history(leader, name, 0)
        self.assertEqual((leader.feed()["trouble"], follower.feed()["trouble"]), ("", ""))
        for node in cluster.nodes:
            stored = os.path.join(self.folder, node.name, "jetstream", "$G", "streams", "yuragi_wind")
            self.assertTrue(os.path.isdir(stored), f"{node.name} has no replica")
        cluster.nodes[2].kill()
        before_s, away_s = self.history(leader)["room"], 4
        follower.stream.wait_for_frames(away_s * RATE_HZ)
        self.assertEqual(self.history(leader)["room"], before_s)
        cluster.nodes[2].start()
        # Nothing else is handed in within these ten minutes: these are seconds in which the server was away.
        self.wait_for_history(leader, "room", before_s + away_s - 2)
        done = follower.run("fleet", "--history", "--config", follower.file)
        self.assertEqual(done.returncode, 0, done.stderr)
        table = done.stdout
        self.assertRegex(table, r"(?m)^room\n  yuragi \S+\n.*\n.* heard .*\n(.*\n)*?  \d\d:00 +\d+ min +\d+\.\d m/s ")
        self.assertRegex(table, r"  \d\d:00 +no word")
        before_s = self.history(follower)["roof"]
        leader.end()  # in order: it hands in its last seconds
        self.wait_for_history(follower, "roof", before_s)
        follower.end(signal.SIGKILL)
        leader = Daemon(self, "leader-again", lead=cluster.addresses(), wind=self.credentials("leader") + '\nnode = "roof"')

        def find():
            """The follower in the list of a leader that has never heard it."""
            return [node for node in leader.nodes() if node["node"] == "room" and node["is_silent"]]
        room, = leader.stream.wait_until(find, "the node that is gone, in the leader's list", every=RATE_HZ)
        self.assertGreater(room["last_word_s"], 5.0)
        add_row("history: the server was away; the leader is started again")

    def test_a_history_needs_jetstream(self):
        server = Server(self, "server")
        leader = Daemon(self, "leader", lead=server.address)
        done = leader.run("fleet", "--history", "--config", leader.file)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, "JetStream does not reply: .*`jetstream")
        self.assertEqual(leader.feed()["trouble"], "")

    @staticmethod
    def epoch(client):
        """Of the leader."""
        client.subscribe("_INBOX.client")
        client.publish("wind.ask", b'{"ask":"leader"}', "_INBOX.client")
        client.wait_until(lambda: client.kept("_INBOX.client"))
        return json.loads(client.kept("_INBOX.client")[0][2][1:])["epoch"]

    def credentials(self, user, text=None):
        """A file with the login of this user, as a line of [wind]."""
        path = os.path.join(self.folder, f"{user}-{text is None}.login")
        with open(path, "w", encoding="utf-8", opener=lambda name, flags: os.open(name, flags, 0o600)) as file:
            file.write((text or LOGINS[user]) + "\n")
        return f'credentials = "{path}"'

    def test_the_doctor_names_a_server_that_does_not_reply_and_a_leader_that_is_not_heard(self):
        server = Server(self, "server", PERMISSIONS)
        closed = free_port()
        follower = Daemon(self, "follower", follow=f"{server.address}, nats://127.0.0.1:{closed}", wind=self.credentials("follower"))
        self.assertRegex(follower.doctor(), rf"(?s)warning +company +{server.address}: no leader is heard on the channel wind.*"
                                            rf"error +company +nats://127.0.0.1:{closed}: .*systemctl status nats-server")
        Daemon(self, "leader", lead=server.address, wind=self.credentials("leader")).stream.wait_for_frames(RATE_HZ)
        self.assertRegex(follower.doctor(), rf"ok +company +{server.address}: a leader is heard on the channel wind")
        wrong = Daemon(self, "wrong-password", follow=server.address, wind=self.credentials("follower", "follower:wrong"))
        self.assertRegex(wrong.doctor(), rf"error +company +{server.address}: .*does not accept this user")

    def test_the_guide_leads_from_one_machine_to_a_venue(self):
        with open(os.path.join(PROJECT, "config", "guide", "several-machines.md"), encoding="utf-8") as guide:
            parts = re.findall(r"(?m)^    \[wind\]\n((?:    .+\n)+)", guide.read())
        server = Server(self, "server")
        lead, follow, stand_by = (re.sub(r"(?m)^    ", "", part).replace("nats://10.0.0.5:4222", server.address) for part in parts)
        leader, follower, other = (Daemon(self, name, wind=f'node = "{name}"\n{part}')
                                   for name, part in (("roof", lead), ("room", follow), ("stand-by", stand_by)))
        for one in (follower, other):
            self.wait_until_equal(leader, one)
            one.wait_for_feed("sends", "the same picture as its leader")
        nodes = follower.nodes()
        self.assertEqual([node["node"] for node in nodes], ["roof", "room", "stand-by"])
        self.assertEqual([node["part"] for node in nodes][0], "leads")

    def test_the_leaders_page_shows_each_wall_and_which_one_is_silent(self):
        missing = [path for path in (CHROMIUM, os.path.join(BROWSER_TOOLS, "node_modules")) if not os.path.exists(path)]
        if missing or not shutil.which("node"):
            self.skipTest(f"not there: {missing or 'node'} (config/setup.sh --test installs it)")
        server = Server(self, "server")
        leader = Daemon(self, "leader", lead=server.address, wind='node = "roof"\n[http]\nlisten = "127.0.0.1:0"')
        follower = Daemon(self, "follower", follow=server.address, wind='node = "foyer"')
        url = leader.wait_for(r"answering at (http://\S+)").group(1)
        self.wait_until_equal(leader, follower)
        screenshots = os.path.join(fleet.FleetTest.programs, "..", "tests", "fleet")
        # On a busy machine a browser takes minutes.
        subprocess.run(["node", os.path.join(HERE, "fleet_page.mjs"), CHROMIUM, BROWSER_TOOLS, screenshots, url, str(follower.process.pid)],
                       check=True, timeout=8 * HANG_S)
        with urllib.request.urlopen(url + "/api/v1/fleet", timeout=HANG_S) as answer:
            nodes = json.load(answer)["nodes"]
        self.assertEqual([(node["node"], node["is_silent"]) for node in nodes], [("foyer", True), ("roof", False)])

    def test_by_tls(self):
        certificate, key = (os.path.join(self.folder, name) for name in ("certificate.pem", "key.pem"))
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "1", "-subj",
                        "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-out", certificate, "-keyout", key],
                       check=True, capture_output=True, timeout=HANG_S)
        server = Server(self, "server", f'tls {{ cert_file: "{certificate}", key_file: "{key}" }}\n', scheme="tls")
        believed = f'authorities = "{certificate}"'
        leader = Daemon(self, "leader", lead=server.address, wind=believed)
        follower = Daemon(self, "follower", follow=server.address, wind=believed)
        stranger = Daemon(self, "stranger", follow=server.address)
        took_s = self.wait_until_equal(leader, follower, leader.stream.frames[0].come_s if leader.stream.frames else time.monotonic())
        stranger.wait_for_feed("trouble", "the TLS connection to .* failed")
        common, equal = self.share_equal(leader, follower, time.monotonic() - 1.0)
        add_row("by TLS", equal=f"{equal} of {common}", seconds=took_s)


def bytes_of_wind(frame):
    """Its speed: the age of a reading is that of the frame."""
    return struct.pack("<ff", frame.message.wind.u_m_s, frame.message.wind.v_m_s)


if __name__ == "__main__":
    unittest.main(verbosity=2)
