"""Stations that people own: a reading every few seconds, in bursts, or on change only. None of them is called stale while it lives."""
import json
import os
import socket
import subprocess
import threading
import time

from bench import HANG_S, NotHere, free_port, row, wait_until

BELIEVED = ("live", "simulated")
MOST_UNBELIEVED_S = 2.0  # of a whole run, for each station: two looks
MOST_UNBELIEVED_SHORT = 0.2  # of the short form, in which a machine that others use stands still for longer than a station is silent

STATIONS = """\
[[sensor]]
name = "davis"
driver = "davis"
transport = "tcp"
host = "127.0.0.1"
port = {davis}

[[sensor]]
name = "tempest"
driver = "tempest"
host = "127.0.0.1"
port = {tempest}

[[sensor]]
name = "ecowitt"
driver = "ecowitt"
host = "127.0.0.1"
port = {ecowitt}
sensor_interval = {ecowitt_s}

[[sensor]]
name = "acurite"
driver = "mqtt"
port = {broker}
preset = "rtl_433"
topic = "rtl_433/events"

[[sensor]]
name = "home"
driver = "mqtt"
port = {broker}
topic = "home/wind"
on_change = true
"""

CALM = """\
[[sensor]]
name = "home"
driver = "mqtt"
port = {broker}
topic = "calm/wind"
on_change = true
"""


class Publisher:
    """What is published on one topic of a broker."""

    def __init__(self, bench, port, topic):
        self.process = subprocess.Popen(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(port), "-t", topic, "-l"],
                                        stdin=subprocess.PIPE, text=True)
        bench.cleanups.append(self.end)

    def say(self, text):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def end(self):
        if not self.process.stdin.closed:
            self.process.stdin.close()
        self.process.terminate()
        self.process.wait(HANG_S)


class Publishing(threading.Thread):
    """Three things at their own pace until its end: an Acurite 5n1 as rtl_433 hears it (each message three times, every 18 s, by turns
    with a direction), a wind that is published when it has changed, and a calm that hardly ever does."""

    def __init__(self, bench, port, pace):
        super().__init__(daemon=True)
        self.ended = threading.Event()
        self.random = bench.random
        self.pace = pace
        self.acurite = Publisher(bench, port, "rtl_433/events")
        self.home = Publisher(bench, port, "home/wind")
        self.calm = Publisher(bench, port, "calm/wind")
        self.messages = {"of the burst source": 0, "on change": 0, "of the calm": 0}
        self.start()

    def burst(self, number):
        speed_km_h = round(12.0 + self.random.uniform(-6.0, 6.0), 1)
        message = {"model": "Acurite-5n1", "id": 1298, "channel": "A", "wind_avg_km_h": speed_km_h}
        if number % 2:
            message["wind_dir_deg"] = 22.5 * self.random.randrange(16)
        for _ in range(3):
            self.acurite.say(json.dumps(message))
            self.messages["of the burst source"] += 1

    def change(self, _number):
        self.home.say(f"{self.random.uniform(0.0, 8.0):.1f}")
        self.messages["on change"] += 1

    def stay_calm(self, number):
        self.calm.say("0.0" if number % 2 == 0 else "0.1")
        self.messages["of the calm"] += 1

    def run(self):
        sources = [[time.monotonic(), 0, say, wait] for say, wait in (
            (self.burst, lambda: 18.0), (self.change, lambda: self.random.expovariate(1.0 / 60.0)),
            (self.stay_calm, lambda: 240.0))]
        while True:
            due = min(sources, key=lambda source: source[0])
            if self.ended.wait(max(0.0, due[0] - time.monotonic())):
                return
            due[2](due[1])
            due[1] += 1
            # A wind stays for less than the sensor's `silence`, 900 s.
            due[0] += min(due[3](), 800.0) / self.pace

    def end(self):
        self.ended.set()
        self.join(HANG_S)


def sensors_of(bench, address):
    """What `yuragi sensors watch` says just now."""
    done = bench.run("sensors", "watch", "--connect", address, "--once", "--json")
    return json.loads(done.stdout) if bench.expect(done.returncode == 0, f"sensors watch: {done.stderr.strip()}") else None


@row("stations that speak rarely, in bursts, or on change", short_s=45)
def stations(bench):
    if not os.path.exists("/usr/sbin/mosquitto"):
        raise NotHere("mosquitto is not installed")
    seconds = bench.choose(60.0 * (bench.settings.minutes or 120.0), 25.0)
    pace = bench.choose(1.0, 5.0)  # by which the short form is faster
    broker_port = free_port()
    settings = f"listener {broker_port} 127.0.0.1\nallow_anonymous true\nuser root\npersistence false\n"
    bench.start("/usr/sbin/mosquitto", "-c", bench.file("broker.conf", settings)).wait_for("running")
    davis = bench.start_simulator("davis", "--tcp", "127.0.0.1:0", "--interval", 2.5 / pace)
    ecowitt = bench.start_simulator("ecowitt", "--tcp", "127.0.0.1:0", "--interval", 16.0 / pace)
    tempest_port = free_port(socket.SOCK_DGRAM)
    tempest = bench.start_simulator("tempest", "--udp", f"127.0.0.1:{tempest_port}", "--interval", 3.0 / pace)
    devices = (davis, ecowitt, tempest)
    ports = {"davis": davis.wait_for(r"127\.0\.0\.1:(\d+)").group(1), "ecowitt": ecowitt.wait_for(r"127\.0\.0\.1:(\d+)").group(1),
             "tempest": tempest_port, "broker": broker_port, "ecowitt_s": 16.0 / pace}
    daemon = bench.start_daemon(STATIONS.format(**ports))
    calm = bench.start_daemon(CALM.format(broker=broker_port))
    publishing = Publishing(bench, broker_port, pace)
    names = ("davis", "tempest", "ecowitt", "acurite", "home")
    times = {name: {} for name in names}  # s in each state, since its first reading
    calmest_m_s = 0.0
    begin_s = last_s = time.monotonic()
    while last_s - begin_s < seconds:
        wait_until(last_s + bench.choose(1.0, 0.5))
        now_s = time.monotonic()
        seen = sensors_of(bench, daemon.address())
        for sensor in seen["sensors"] if seen else ():
            if sensor["readings"] > 0:
                states = times[sensor["name"]]
                states[sensor["state"]] = states.get(sensor["state"], 0.0) + now_s - last_s
        seen = sensors_of(bench, calm.address())
        if seen and seen["sensors"][0]["readings"] > 0 and now_s - begin_s > seconds / 4.0:
            calmest_m_s = max(calmest_m_s, seen["wind"]["speed_m_s"])
        last_s = now_s
    for name in names:
        all_s = sum(times[name].values())
        bench.expect(all_s > 0.0, f"{name}: no reading came")
        unbelieved_s = sum(in_state_s for state, in_state_s in times[name].items() if state not in BELIEVED)
        bench.expect(unbelieved_s <= bench.choose(MOST_UNBELIEVED_S, MOST_UNBELIEVED_SHORT * all_s), f"{name}: for {unbelieved_s:.1f} s of {all_s:.0f} it was {times[name]}")
        bench.figure(name + ": " + ", ".join(f"{state} {in_state_s:,.0f} s" for state, in_state_s in sorted(times[name].items())))
    bench.expect(calmest_m_s < 0.7, f"a calm of 0.0 and 0.1 m/s blew with {calmest_m_s:.2f} m/s")
    bench.figure(f"a calm of 0.0 and 0.1 m/s, published on change, blew with {calmest_m_s:.2f} m/s at the most")
    for what, number in publishing.messages.items():
        bench.count(number, "messages " + what)

    # What falls silent is told to be.
    publishing.end()
    for device in devices:
        device.end()
    ended_s = time.monotonic()
    silent_after_s = {}
    while len(silent_after_s) < 4 and time.monotonic() < ended_s + bench.choose(600.0, HANG_S):
        wait_until(time.monotonic() + 0.5)
        seen = sensors_of(bench, daemon.address())
        for sensor in seen["sensors"] if seen else ():
            if sensor["name"] != "home" and sensor["state"] not in BELIEVED:
                silent_after_s.setdefault(sensor["name"], time.monotonic() - ended_s)
    bench.expect(len(silent_after_s) == 4, f"of the four that fell silent only {sorted(silent_after_s)} were told to be")
    bench.figure("all devices ended: told after " + ", ".join(f"{after_s:.0f} s ({name})" for name, after_s in silent_after_s.items()))
    bench.expect_ends(daemon)
    bench.expect_ends(calm)
