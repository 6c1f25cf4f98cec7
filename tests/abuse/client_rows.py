"""Clients that do not behave, beside one that does."""
import os
import re
import shutil
import subprocess
import sys
import time
import urllib.request

from bench import HANG_S, HERE, NotHere, Sampler, Witness, free_port, row

CONTROL_S = (4.0, 2.0)  # a quiet time to compare with: of the long and of the short form


def attack_beside_witness(bench, kinds, seconds, until=None, end_by_themselves=()):
    """Runs attacks [(kind, count of clients)] at the same time, for some seconds or until the well-behaved client receives a
    state of the daemon `until` which is true; then waits for those kinds that end when all their clients were let go.
    Returns the daemon, and what each attack did."""
    daemon = bench.start_daemon("[stream]\nmax_clients = 64\n")
    witness = Witness(bench, daemon)
    quiet = witness.watch(bench.choose(*CONTROL_S))
    sampler = Sampler(daemon.process.pid, every_s=0.2)
    before = sampler.sample()
    witness.mark()
    attackers = [(kind, bench.attack(kind, daemon.address(), seconds, *([count] if count else []))) for kind, count in kinds]
    is_so = until and witness.wait_for(until)
    done = {kind: bench.end_of_attack(attacker, now=until is not None and kind not in end_by_themselves)
            for kind, attacker in attackers}
    attacked = witness.mark()
    bench.expect_alive(daemon)
    bench.expect(until is None or is_so, "what was waited for did not come about")
    witness.expect_undisturbed(quiet, attacked)
    bench.expect(witness.wait_for(lambda sensors: sensors["clients"] == 1), "the places of clients that have gone stay taken")
    sampler.end()
    after = sampler.sample()
    bench.expect(after[3] <= before[3], f"{after[3] - before[3]} descriptors more than before")
    bench.expect(after[1] - before[1] < 16 * 1024, f"{after[1] - before[1]} KiB more memory than before")
    for kind, counts in done.items():
        for what, number in counts.items():
            bench.count(number, f"{what} ({kind})" if len(done) > 1 else what)
    bench.figure("client beside it: " + attacked.text())
    most = max(sample[3] for sample in sampler.samples)
    bench.figure(f"memory {after[1] - before[1]:+,} KiB of {after[1]:,}")
    bench.figure(f"descriptors {after[3] - before[3]:+} of {after[3]} (at most {most})")
    return daemon, done


@row("300 clients at once that all want everything")
def crowd(bench):
    daemon, done = attack_beside_witness(bench, [("crowd", 300)], 30.0)
    counts = done["crowd"]
    bench.expect(counts.get("refused", 0) + counts.get("taken", 0) + counts.get("closed", 0) == 300, "not everybody got an answer")
    bench.expect(0 < counts.get("taken", 0) <= 63, f"{counts.get('taken', 0)} were taken, where 63 places are free")
    bench.expect(counts.get("refused", 0) > 0, "nobody was told why not")
    bench.expect_ends(daemon)


@row("connections without a word, and with half of one", short_s=10)
def idle_clients(bench):
    # On a busy machine the slow ones may be among the first 40 that the daemon lets go.
    daemon, done = attack_beside_witness(bench, [("idle", 20), ("half_said", 20), ("slow", 20)], HANG_S,
                                         lambda sensors: sensors["idle_clients"] >= 40, ("idle", "half_said"))
    for kind in ("idle", "half_said"):
        bench.expect(done[kind].get("let go", 0) == 20, f"{done[kind].get('let go', 0)} of 20 were let go ({kind})")
    bench.expect_ends(daemon)


@row("connections that come and go as fast as they can")
def connection_storm(bench):
    daemon, done = attack_beside_witness(bench, [("storm", 0)], bench.choose(60.0, 2.0))
    bench.expect(done["storm"]["connections"] >= 20, "hardly any connection")
    lines = re.findall(r"(?m)^.*client", daemon.text())
    bench.figure(f"{len(lines)} lines of log about clients")
    bench.expect(len(lines) < 200 + 2 * bench.choose(60, 2), f"{len(lines)} lines of log")
    bench.expect_ends(daemon)


@row("hostile messages: mutated, random, oversized")
def hostile_messages(bench):
    daemon, done = attack_beside_witness(bench, [("mutated", 0), ("random_bytes", 0), ("oversized", 0)], bench.choose(60.0, 2.0))
    for kind, counts in done.items():
        bench.expect(counts.get("messages", 0) >= 20, f"hardly any message was {kind}")
    bench.expect_ends(daemon)


@row("requests with bytes that are no text in each of their parts, to the page and to a sensor that is pushed to")
def http_bytes(bench):
    push_port = free_port()
    daemon = bench.start_daemon('[http]\nlisten = "127.0.0.1:0"\n[[sensor]]\nname = "roof"\ndriver = "ecowitt-push"\n'
                                f"port = {push_port}\n")
    page = re.search(r"answering at http://(\S+)", daemon.wait_for(r"answering at http://\S+").group(0)).group(1)
    seconds = bench.choose(60.0, 2.0)
    attackers = [bench.attack("http_bytes", address, seconds) for address in (page, f"127.0.0.1:{push_port}")]
    for attacker, where in zip(attackers, ("page", "pushes"), strict=True):
        counts = bench.end_of_attack(attacker)
        bench.expect(counts.get("requests", 0) >= 20, f"hardly any request ({where})")
        bench.expect(counts.get("answers", 0) >= counts["requests"] // 4, f"hardly any answer ({where})")
        bench.expect(counts["faults (500)"] == 0, f"{counts['faults (500)']} answers with 500 ({where})")
        bench.count(counts["requests"], f"requests ({where})")
    bench.expect_alive(daemon)
    with urllib.request.urlopen(f"http://{page}/api/v1/status", timeout=HANG_S) as answer:
        bench.expect(answer.status == 200, "the page does not answer any more")
    bench.expect("\x1b" not in daemon.text(), "control characters of a request are in the log")
    bench.expect("fault of the program" not in daemon.text(), "an exception was contained: see the log")
    bench.expect_ends(daemon)


@row("clients that want every frame and stop reading", short_s=12)
def stalled_clients(bench):
    daemon, done = attack_beside_witness(bench, [("stalled", 20)], HANG_S, lambda sensors: sensors["stuck_clients"] == 20)
    bench.expect(done["stalled"].get("let go", 0) == 20, f"{done['stalled'].get('let go', 0)} of 20 were let go")
    bench.expect_ends(daemon)


@row("a flood of orders, and names of a kilobyte")
def flood_of_orders(bench):
    seconds = bench.choose(60.0, 2.0)
    daemon, done = attack_beside_witness(bench, [("controls", 0), ("names", 0)], seconds)
    bench.expect(done["controls"].get("orders", 0) >= 20, "hardly any order")
    bench.expect(done["names"]["names"] >= 20, "hardly any name")
    text = daemon.text()
    longest = max(map(len, text.splitlines()))
    bench.figure(f"log {len(text):,} bytes, the longest line {longest}")
    bench.expect(longest < 512, f"a line of log of {longest} characters")
    bench.expect("\x1b" not in text and "\r" not in text, "a name's control characters are in the log")
    bench.expect(len(text) < 512 * (200 + 2 * seconds), f"{len(text)} bytes of log")
    bench.expect_ends(daemon)


@row("clients whose network goes away (network namespaces)")
def vanished_clients(bench):
    if shutil.which("ip") is None:
        raise NotHere("ip (iproute2) is not installed")
    ends = [bench.start("unshare", "--net", "sh", "-c", "ip link set lo up && echo ready; exec tail -f /dev/null")
            for _ in range(2)]
    for end in ends:
        if not end.wait_until(lambda text: "ready" in text):
            raise NotHere("no network namespace (only root may make one)")
    here, there = (("nsenter", "--net", "--target", str(end.process.pid)) for end in ends)

    def inside(end, words):
        subprocess.run([*end, *words.split()], check=True, capture_output=True, timeout=HANG_S)

    inside(here, f"ip link add v0 type veth peer name v1 netns {ends[1].process.pid}")
    for end, name, number in ((here, "v0", 1), (there, "v1", 2)):
        inside(end, f"ip address add 192.0.2.{number}/24 dev {name}")
        inside(end, f"ip link set {name} up")
    config = bench.file("namespace.toml", "")
    daemon = bench.start(*here, bench.settings.yuragi, "run", "--listen", "0.0.0.0:0", "--config", config)
    port = daemon.address().rsplit(":", 1)[1]
    # One that wants frames is missed when it reads none; one that wants nothing, by keep-alive alone, within a minute.
    kinds = bench.choose({"stalled": 45.0, "silent": 75.0}, {"stalled": 45.0})
    clients = 4
    for kind in kinds:
        bench.start(*there, sys.executable, os.path.join(HERE, "attackers.py"), bench.settings.schema_modules, kind,
                    f"192.0.2.1:{port}", 600, 1, clients)

    def all_of_them(text):
        found = re.findall(r"client (192\.0\.2\.2:\d+) .*subscribes", text)
        return len(found) == clients * len(kinds) and found

    everybody = daemon.wait_until(all_of_them)
    if not bench.expect(everybody, "they did not all come: " + daemon.text()[-500:]):
        return
    inside(there, "ip link set v1 down")
    begin_s = time.monotonic()
    gone = {}
    while len(gone) < len(everybody) and time.monotonic() < begin_s + 90.0:
        daemon.wait_until(lambda text: len(re.findall(r"client 192\.0\.2\.2:\d+ .*disconnected", text)) > len(gone))
        for address in re.findall(r"client (192\.0\.2\.2:\d+) .*disconnected", daemon.text()):
            gone.setdefault(address, time.monotonic() - begin_s)
    bench.count(len(everybody), "clients")
    bench.expect(len(gone) == len(everybody), f"{len(everybody) - len(gone)} of them keep their places")
    slowest_s = max(gone.values(), default=0.0)
    bench.expect(slowest_s < max(kinds.values()), f"they were missed after {slowest_s:.0f} s")
    bench.figure(f"missed after {min(gone.values(), default=0.0):.1f} to {slowest_s:.1f} s")
    bench.expect_ends(daemon)
