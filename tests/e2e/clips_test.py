#!/usr/bin/env python3
"""The examples for other programs, in these programs: Pure Data and Node-RED get the wind of a daemon.

usage: clips_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import pathlib
import re
import shutil
import socket
import sys
import tempfile
import unittest

from programs import Program, free_port

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")
ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "config" / "examples"
NODE_RED = ROOT / "build" / "node_red" / "node_modules" / "node-red" / "red.js"
STEADY_M_S = 6.0  # the mean of the wind that is sent
CONFIG = f'[stream]\nlisten = "127.0.0.1:0"\n[[sensor]]\ndriver = "synthetic"\nname = "roof"\nspeed = {STEADY_M_S}\n'
NUMBER = r"(-?[0-9.]+(?:e-[0-9]+)?)"


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

    @unittest.skipUnless(shutil.which("pd"), "Pure Data is not there; config/setup.sh --test installs it")
    def test_pure_data_reads_each_value(self):
        port = free_port(socket.SOCK_DGRAM)
        patch = (EXAMPLES / "wind.pd").read_text(encoding="utf-8").replace("-b 9000;", f"-b {port};")
        # The example shows numbers; here they are printed. Objects are counted in their order, without the canvas.
        objects = [line for line in patch.splitlines() if line.startswith("#X ") and not line.startswith("#X connect")]
        route = next(i for i, line in enumerate(objects) if " route speed norm gust_norm u v live;" in line)
        printed = patch.splitlines()
        first_connection = next(i for i, line in enumerate(printed) if line.startswith("#X connect"))
        names = ["speed", "norm", "gust_norm", "u", "v", "live"]
        printed[first_connection:first_connection] = [f"#X obj 20 20 print {name};" for name in names]
        printed += [f"#X connect {route} {i} {len(objects) + i} 0;" for i in range(len(names))]
        (self.folder / "wind.pd").write_text("\n".join(printed) + "\n", encoding="utf-8")
        pd = self.start("pd", "-nogui", "-noaudio", "-noprefs", self.folder / "wind.pd")
        self.start_daemon(f'[[osc]]\nto = "127.0.0.1:{port}"\n')
        values = {name: float(pd.wait_for(rf"(?m)^{name}: {NUMBER}$")[1]) for name in names}
        self.assertNotRegex(pd.text(), "couldn't create|no such object|error:")
        self.assertGreater(values["speed"], 0.2 * STEADY_M_S)
        self.assertLess(values["speed"], 3.0 * STEADY_M_S)
        for name in ("norm", "gust_norm", "live"):
            self.assertTrue(0.0 <= values[name] <= 1.0, (name, values))

    @unittest.skipUnless(NODE_RED.exists() and shutil.which("node"),
                         "Node-RED is not there; config/setup.sh --test installs it, where npm can get it")
    def test_node_red_reads_the_gust(self):
        port, own_port = free_port(), free_port()
        flow = json.loads((EXAMPLES / "node_red_flow.json").read_text(encoding="utf-8"))
        for node in flow:
            if node["type"] == "websocket-client":
                self.assertEqual(node["path"], "ws://127.0.0.1:7480/ws")
                node["path"] = f"ws://127.0.0.1:{port}/ws"
            if node["type"] == "debug":
                node["console"] = True
        (self.folder / "flow.json").write_text(json.dumps(flow), encoding="utf-8")
        self.start_daemon(f'[http]\nlisten = "127.0.0.1:{port}"\n')
        red = self.start("node", NODE_RED, "--port", own_port, "--userDir", self.folder, self.folder / "flow.json")
        gusts = red.wait_until(lambda text: (found := re.findall(rf"(?m)\[debug:yuragi-debug\] {NUMBER}$", text))[3:] and found)
        self.assertTrue(gusts, red.text())
        for gust_norm in gusts:
            self.assertTrue(0.0 <= float(gust_norm) <= 1.0, gusts)
        self.assertEqual(re.findall("unknown node|Missing node", red.text()), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
