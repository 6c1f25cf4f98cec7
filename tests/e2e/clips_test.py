#!/usr/bin/env python3
"""The examples for other programs, in these programs: Pure Data and Node-RED get the wind that a daemon sends. The entities that
the example for Home Assistant names are those that a daemon announces.

usage: clips_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import pathlib
import re
import shutil
import socket
import struct
import sys
import tempfile
import threading
import unittest

import yaml

from programs import HANG_S, Program, free_port

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")
ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "config" / "examples"
NODE_RED = ROOT / "build" / "node_red" / "node_modules" / "node-red" / "red.js"
CONFIG = ('[stream]\nlisten = "127.0.0.1:0"\n'
          '[[sensor]]\ndriver = "synthetic"\nname = "roof"\nspeed = 6.0\nturbulence = 0.3\nrate = 20\n')
NUMBER = r"(-?[0-9.]+(?:e-[0-9]+)?)"
MIN_VALUES = 30  # that are compared


class Sent:
    """What a daemon sends by an [[osc]] of its own (bundle = false), by the name of the value."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.values = {}
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        while data := self.socket.recv(65536):
            self.values.setdefault(data[:data.index(0)].decode(), []).append(struct.unpack(">f", data[-4:])[0])

    def end(self):
        """Returns what came, after the daemon has ended. An empty datagram is the last."""
        self.socket.sendto(b"", ("127.0.0.1", self.port))
        self.reader.join(HANG_S)
        self.socket.close()
        return self.values


class Clips(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-clips-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def start(self, *command, **options):
        program = Program(*command, **options)
        self.addCleanup(program.__exit__)
        return program

    def start_daemon(self, text):
        config = self.folder / "wall.toml"
        config.write_text(CONFIG + text, encoding="utf-8")
        daemon = self.start(YURAGI, "run", "--config", config)
        daemon.wait_for("listening on")
        return daemon

    def sent(self):
        sent = Sent()
        return sent, f'[[osc]]\nname = "compared"\nto = "127.0.0.1:{sent.port}"\nbundle = false\n'

    def assert_from(self, got, sent):
        """The values that a program got are among those sent, in their order. Datagrams may be lost, but not most of them."""
        known = [value for value in got if value in set(sent)]
        self.assertGreater(len(known), len(got) / 2, (got, sent))
        rest = iter(sent)
        self.assertTrue(all(value in rest for value in known), "in their order")

    @unittest.skipUnless(shutil.which("pd"), "Pure Data is not there; config/setup.sh --test installs it")
    def test_pure_data_reads_each_value_and_makes_a_noise_of_it(self):
        port = free_port(socket.SOCK_DGRAM)
        lines = (EXAMPLES / "wind.pd").read_text(encoding="utf-8").replace("-b 9000;", f"-b {port};").splitlines()
        # The example shows numbers and plays; here both are printed. Connections name objects by their place, without the canvas.
        objects = [line for line in lines if not line.startswith(("#N", "#X connect"))]
        place = {name: i for i, line in enumerate(objects) for name in ("route speed", "dac~") if f" {name} " in line}
        connections = [line.split() for line in lines if line.startswith("#X connect")]
        source = next(words[2] for words in connections if words[4] == str(place["dac~"]))
        names = re.search("route (speed .*);", objects[place["route speed"]])[1].split()
        added = [*(f"print {name}" for name in names), "env~ 4096 4096", "print loudness"]
        lines[len(objects) + 1:len(objects) + 1] = [f"#X obj 20 20 {text};" for text in added]
        first = len(objects)
        lines += [f"#X connect {place['route speed']} {i} {first + i} 0;" for i in range(len(names))]
        loudness = first + len(names)
        lines += [f"#X connect {source} 0 {loudness} 0;", f"#X connect {loudness} 0 {loudness + 1} 0;"]
        (self.folder / "wind.pd").write_text("\n".join(lines) + "\n", encoding="utf-8")
        pd = self.start("pd", "-nogui", "-noaudio", "-noprefs", self.folder / "wind.pd")
        sent, compared = self.sent()
        daemon = self.start_daemon(f'[[osc]]\nto = "127.0.0.1:{port}"\n' + compared)

        def values(name, text):
            return re.findall(rf"(?m)^{name}: {NUMBER}$", text)

        pd.wait_until(lambda text: all(len(values(name, text)) >= MIN_VALUES for name in names))
        # 100 dB is a full scale; between a whisper and no distortion.
        self.assertTrue(pd.wait_until(lambda text: [dB for dB in values("loudness", text) if 50.0 < float(dB) < 95.0]), pd.text())
        self.assertEqual(daemon.end(), 0)
        pd.end()
        self.assertNotRegex(pd.text(), "couldn't create|no such object|error:")
        sent = sent.end()
        for name in names:
            self.assert_from(values(name, pd.text()), [f"{value:g}" for value in sent[f"/wind/{name}"]])
        self.assertGreater(len(set(values("speed", pd.text()))), MIN_VALUES / 2, "it moves")

    @unittest.skipUnless(NODE_RED.exists() and shutil.which("node"),
                         "Node-RED is not there; config/setup.sh --test installs it, where npm can get it")
    def test_node_red_reads_the_gust_and_reports_where_one_begins(self):
        port, own_port = free_port(), free_port()
        flow = json.loads((EXAMPLES / "node_red_flow.json").read_text(encoding="utf-8"))
        for node in flow:
            if node["type"] == "websocket-client":
                self.assertEqual(node["path"], "ws://127.0.0.1:7480/ws")
                node["path"] = f"ws://127.0.0.1:{port}/ws"
            if node["type"] == "debug":
                node["console"] = True
            if node["type"] == "function":  # a strong gust may take minutes
                self.assertEqual(len(re.findall(r"0\.4 : 0\.8", node["func"])), 1)
                node["func"] = node["func"].replace("0.4 : 0.8", "0.02 : 0.05")
        (self.folder / "flow.json").write_text(json.dumps(flow), encoding="utf-8")
        sent, compared = self.sent()
        daemon = self.start_daemon(f'[http]\nlisten = "127.0.0.1:{port}"\n' + compared)
        red = self.start("node", NODE_RED, "--port", own_port, "--userDir", self.folder, "--no-telemetry",
                         "-D", "uiHost=127.0.0.1", self.folder / "flow.json")

        def gusts(text):
            return re.findall(rf"(?m)\[debug:yuragi-debug\] {NUMBER}$", text)

        red.wait_until(lambda text: len(gusts(text)) >= MIN_VALUES)
        red.wait_for(r"\[debug:yuragi-begins\] a gust of [0-9.]+ m/s")
        self.assertEqual(daemon.end(), 0)
        self.assertNotRegex(red.text(), r"(?i)unknown node|missing|\[error\]")
        self.assert_from([float(gust) for gust in gusts(red.text())], [round(gust, 4) for gust in sent.end()["/wind/gust_norm"]])

    @unittest.skipUnless(shutil.which("mosquitto"), "mosquitto is not there; config/setup.sh --test installs it")
    def test_home_assistant_has_the_entities(self):
        port = free_port()
        broker = self.folder / "broker.conf"
        broker.write_text(f"listener {port} 127.0.0.1\nuser root\nallow_anonymous true\npersistence false\n", encoding="utf-8")
        self.start("mosquitto", "-c", broker).wait_for("running")
        reader = self.start("mosquitto_sub", "-h", "127.0.0.1", "-p", port, "-v", "-t", "homeassistant/#")
        self.start_daemon(f'[mqtt]\nhost = "127.0.0.1"\nport = {port}\ntopic = "yuragi"\n')
        device = json.loads(reader.wait_for(r"homeassistant/device/\S+/config (.*)\n")[1])
        # Home Assistant names an entity by its device and its own name.
        names = [(component["platform"], f"{device['dev']['name']} {component['name']}") for component in device["cmps"].values()]
        announced = {platform + "." + re.sub("[^a-z0-9]+", "_", name.lower()) for platform, name in names}
        text = (EXAMPLES / "home_assistant.yaml").read_text(encoding="utf-8")
        named = set(re.findall(r"\w+\.yuragi_\w+", re.sub("#.*", "", text)))
        self.assertGreaterEqual(len(named), 2)
        self.assertEqual(named - announced, set())
        for automation in yaml.safe_load(text)["automation"]:
            self.assertEqual(set(automation) - {"conditions"}, {"id", "alias", "triggers", "actions"})
            self.assertEqual([trigger["trigger"] for trigger in automation["triggers"]], ["numeric_state"])
            for condition in automation.get("conditions", []):
                self.assertIs(type(condition["state"]), str, "on without quotation marks is a boolean")


if __name__ == "__main__":
    unittest.main()
