#!/usr/bin/env python3
"""--json: each command that prints a table has it, what it prints can be read, and holds what the table holds.

usage: json_test.py FOLDER_OF_PROGRAMS PROJECT_ROOT

A new command fails here until it is in one of the two lists.
"""
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from programs import HANG_S, Program, free_port

BIN, ROOT = (os.path.abspath(word) for word in (sys.argv.pop(1), sys.argv.pop(1)))
YURAGI = os.path.join(BIN, "yuragi")
sys.path.insert(0, os.path.join(ROOT, "config", "package"))
import program_help  # pylint: disable=wrong-import-position

PASSWORD = "hunter2-correct-horse"
CONFIG = f"""\
[[sensor]]
name = "made-up"
driver = "synthetic"

[[sensor]]
name = "garden"
driver = "mqtt"
topic = "garden/speed"
port = 1
user = "garden"
password = "{PASSWORD}"

[[sensor]]
name = "played"
driver = "windlog"
file = "FOLDER/wind.windlog"

[[scene]]
kind = "grass"
blades_across = 8
blades_deep = 8
"""

# Commands that print no table, and why.
WITHOUT_A_TABLE = {
    "run": "runs", "replay": "runs", "record": "runs",
    "decode": "prints JSON always", "report": "writes a page; --json FILE writes its numbers",
    "import": "writes a recording, and says so", "export": "writes CSV, a table for programs",
    "clean-secrets": "says what it did", "noise": "writes a file, and says so", "field": "writes a file, and says so",
    "wind": "writes CSV, a table for programs",
    "calibrate zero": "a dialog", "calibrate north": "a dialog", "calibrate span": "a dialog",
    "calibrate microphone": "a dialog",
    "feeds rest": "says what it did",
    "support-bundle": "writes a file, and says so",
    **{f"hand {what}": "says what it did" for what in ("wind", "blackout", "camera")},
    **{f"hand release {what}": "says what it did" for what in ("wind", "blackout", "camera")},
    "scene show": "says what it did", "scene hide": "says what it did", "scene switch": "says what it did",
    **{f"{of} {what}": "says what it did" for of in ("scene", "look") for what in ("set", "reset")},
}

# Commands with --json: their arguments, and where in the table a text stands that the JSON must hold, too.
TABLES = {
    "status": (["--connect", "ADDRESS"], [r"^  - (sensor garden is \w+)", r"^scene (\S+) ", r"^(made-up|garden|played) +(\S+) "]),
    "fleet": (["--config", "FLEET"], [r"^(roof)$", r"^  (leads)$", r", (yuragi \S+)$"]),
    "doctor": (["--config", "CONFIG", "--connect", "ADDRESS"], [r"^(ok|warning|error) +(?!clock)(\S+) +(\S.*)$", r"fix: (.*)$"]),
    "accept": (["--config", "ALONE", "--for", "4", "--force", "--out", "PAGE"], [r"^(made-up) +(\w+) ", r"^  - (its readings are synthetic.*)$"]),
    "sensors list": ([], [r'^    driver = "(\w+)"']),
    "sensors probe modbus": (["MODBUS", "--id", "1-2"], [r"^#   fits (\S+) "]),
    "sensors describe": ([], [r"^(\w+) +(.*)$"]),
    "sensors try": (["ALONE", "--duration", "2"], [r"^(made-up) +(\w+) "]),
    "sensors watch": (["--connect", "ADDRESS", "--once"], [r"^(made-up|garden|played) +(\S+) "]),
    "calibrate list": (["--config", "CONFIG"], [r"^(made-up|garden): (zero), (span), (north)$"]),
    "check-config": (["CONFIG"], [r"^  sensor (\S+) \((\S+)\), (\S+),", r"^  scene (\S+) \((\S+)\)"]),
    "describe": ([], [r"^(\[.*?\])  # (.*)$", r"^  (\w+) {2,}(\S.*)$"]),
    "verify": (["WIND"], [r"^(\S+): sound; (\d+) readings"]),
    "spectrum": (["--frequency", "0.01,0.1,1"], [r"^([\d.]+) ([\d.e-]+)$"]),
    "reload": (["--connect", "ADDRESS"], [r"^needs a restart: (.*)$"]),
    "token": (["--config", "CONFIG"], [r"^pairing code: (\S+),"]),
    "scene list": (["--connect", "ADDRESS"], [r"^(\S+) +(\w+) "]),
    "scene values": (["--connect", "ADDRESS"], [r"^(\S+) \((\w+)\)$", r"^  (\w+) +([\d.]+)\b"]),
    "look values": (["--connect", "ADDRESS"], [r"^  (\w+) +([\d.]+)\b"]),
    **{f"player {name}": (["--connect", "ADDRESS", *words], [r"^(\w+): "])
       for name, words in {"status": [], "pause": [], "resume": [], "step": ["2"], "seek": ["1"], "rate": ["2"]}.items()},
}


def run(*arguments):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, timeout=HANG_S, check=False)


def leaves(command):
    """The commands that have no subcommands, as words below the program."""
    return [one for one in command.walk() if not one.commands]


def words_of(command):
    return command.name.split(" ", 1)[1]


def values_in(value):
    """Every key, text and number in what json.loads() returned, as text."""
    if isinstance(value, dict):
        return set(value).union(*(values_in(item) for item in value.values()))
    if isinstance(value, list):
        return set().union(*(values_in(item) for item in value))
    if isinstance(value, bool) or value is None:
        return set()
    return {value if isinstance(value, str) else repr(float(value))}


class Json(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-json-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = temporary.name
        cls.config = os.path.join(cls.folder, "wall.toml")
        with open(cls.config, "w", encoding="utf-8") as out:
            out.write(CONFIG.replace("FOLDER", cls.folder))
            out.write(f'[http]\ntoken_file = "{cls.folder}/token"\n')
        os.chmod(cls.config, 0o640)
        with open(os.path.join(cls.folder, "token"), "w", encoding="ascii") as out:
            out.write("correct horse battery staple\n")
        os.chmod(out.name, 0o640)
        os.environ["YURAGI_TOKEN_FILE"] = out.name
        subprocess.run([os.path.join(BIN, "yuragi-sim"), "recording", "-o", os.path.join(cls.folder, "wind.windlog"),
                        "--speed", "6", "--duration", "600"], check=True, stdout=subprocess.DEVNULL, timeout=HANG_S)
        daemon = Program(YURAGI, "run", "--config", cls.config, "--listen", "127.0.0.1:0")
        cls.addClassCleanup(daemon.__exit__)
        cls.address = daemon.address()
        with Program(YURAGI, "sensors", "watch", "--connect", cls.address) as watch:  # two commands then find the same
            watch.wait_for(r"made-up\s.*\ssimulated\s")
            watch.wait_for(r"played\s.*\sREPLAY\s")
            watch.end()
        with open(cls.config, "a", encoding="utf-8") as out:
            out.write("[animation]\nrate = 59\n")  # for `reload` to say something of
        slave = Program(os.path.join(BIN, "yuragi-sim"), "modbus", "--tcp", "127.0.0.1:0", "--profile",
                        "renke-rs-fsjt-rs-fxjt-n01")
        cls.addClassCleanup(slave.__exit__)
        alone = os.path.join(cls.folder, "alone.toml")
        with socket.create_server(("127.0.0.1", 0)) as listener, open(alone, "w", encoding="utf-8") as out:
            out.write(f'[stream]\nlisten = "127.0.0.1:{listener.getsockname()[1]}"\n'
                      '[[sensor]]\nname = "made-up"\ndriver = "synthetic"\n')
        fleet = os.path.join(cls.folder, "fleet.toml")
        port = free_port()
        server = Program("nats-server", "-a", "127.0.0.1", "-p", port)
        cls.addClassCleanup(server.__exit__)
        server.wait_for("Server is ready")
        with open(fleet, "w", encoding="utf-8") as out:
            out.write(f'[wind]\nlead = "nats://127.0.0.1:{port}"\nnode = "roof"\n[animation]\nrate = 10\n'
                      '[[scene]]\nkind = "grass"\nblades_across = 8\nblades_deep = 8\n')
        leader = Program(YURAGI, "run", "--config", fleet, "--listen", "127.0.0.1:0")
        cls.addClassCleanup(leader.__exit__)
        leader.address()
        given_up_s = time.monotonic() + HANG_S
        while "roof" not in run("fleet", "--config", fleet).stdout:  # its first word of itself
            assert time.monotonic() < given_up_s
        cls.places = {"FLEET": fleet, "ALONE": alone, "WIND": os.path.join(cls.folder, "wind.windlog"), "PAGE": os.path.join(cls.folder, "page.html"), "ADDRESS": cls.address, "CONFIG": cls.config,
                      "MODBUS": slave.wait_for(r"(127\.0\.0\.1:\d+)").group(1)}
        cls.program = program_help.Help(program_help.Program(YURAGI))
        cls.commands = {words_of(command): command for command in leaves(cls.program)}

    def test_every_command_has_it_or_prints_no_table(self):
        for name, command in self.commands.items():
            if name in WITHOUT_A_TABLE:
                self.assertNotIn(name, TABLES)
                continue
            self.assertIn("--json", command.options(), name)
            self.assertIn(name, TABLES, "is to be tested here")
            described = [line for one in self.with_parents(name) for line in one.footer if "--json" in line]
            self.assertTrue(described, f"yuragi {name} --help does not say what --json prints")
        known = set(TABLES) | set(WITHOUT_A_TABLE)
        self.assertEqual(known - set(self.commands), set(), "of commands that are no more")

    def with_parents(self, name):
        every = {words_of(one) if " " in one.name else "": one for one in self.program.walk()}
        words = name.split(" ")
        return [every[" ".join(words[:count])] for count in range(1, len(words) + 1)]

    def test_it_holds_what_the_table_holds(self):
        for name, (arguments, patterns) in TABLES.items():
            with self.subTest(command=name):
                words = [*name.split(" "), *(self.places.get(word, word) for word in arguments)]
                table = run(*words)
                printed = run(*words, "--json")
                self.assertIn(table.returncode, (0, 1), table.stderr)
                self.assertEqual(printed.returncode, table.returncode, printed.stderr)
                self.assertNotIn(PASSWORD, printed.stdout + printed.stderr)
                self.assertNotIn("NaN", printed.stdout)
                is_line_by_line = name in ("sensors watch", "sensors try", "sensors probe modbus")
                texts = printed.stdout.splitlines() if is_line_by_line else [printed.stdout]
                held = values_in([json.loads(text) for text in texts])
                wanted = [word for pattern in patterns for match in re.finditer(pattern, table.stdout, re.M)
                          for word in match.groups()]
                if name != "sensors list":  # nothing may be plugged in
                    self.assertTrue(wanted, table.stdout)
                for word in wanted:
                    if word.startswith("sensor garden"):  # its reason may have changed in between
                        self.assertTrue(any(text.startswith(word) for text in held), word)
                        continue
                    is_number = re.fullmatch(r"-?[\d.]+(e-?\d+)?", word)
                    self.assertIn(repr(float(word)) if is_number else word, held)

    def test_what_goes_on_prints_an_object_a_line(self):
        done = run("sensors", "watch", "--connect", self.places["ADDRESS"], "--duration", "2", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertGreater(len(lines), 1)
        self.assertEqual([sensor["name"] for sensor in lines[-1]["sensors"]], ["made-up", "garden", "played"])
        self.assertIsInstance(lines[-1]["sensors"][0]["speed_m_s"], float)
        self.assertIsNone(lines[-1]["sensors"][1]["speed_m_s"])

    def test_raw_messages_are_objects_too(self):
        port = self.places["MODBUS"].rsplit(":", 1)[1]
        config = os.path.join(self.folder, "roof.toml")
        with open(config, "w", encoding="utf-8") as out:
            out.write('[[sensor]]\nname = "roof"\ndriver = "modbus"\nprofile = "renke-rs-fsjt-rs-fxjt-n01"\n'
                      f'host = "127.0.0.1"\nport = {port}\n')
        done = run("sensors", "watch", "--config", config, "--connect", "127.0.0.1:1", "--raw", "--once", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        message = json.loads(done.stdout)
        self.assertEqual(message["sensor"], "roof")
        self.assertEqual(len(message["hex"]), 2 * message["length_bytes"])

    def test_every_value_of_a_configuration_but_no_secret(self):
        done = run("check-config", self.config, "--full", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        config = json.loads(done.stdout)
        self.assertEqual(config["sensors"][1]["values"]["password"], "(secret)")
        self.assertEqual(config["sensors"][0]["values"]["speed"], 5.0)
        self.assertEqual(config["scenes"][0]["values"]["blades_deep"], 8)
        self.assertEqual(config["stream"]["listen"], "127.0.0.1:7410")
        keys = set(re.findall(r"^\s*(\w+) = ", run("check-config", self.config, "--full").stdout, re.M))
        self.assertLessEqual(keys - {"name", "driver", "kind"}, values_in(config))

    def test_every_key_that_describe_lists_is_among_the_values(self):
        """With one entry in each list; a key that is left out without a default is no value."""
        tables = json.loads(run("describe", "--json").stdout)
        feeds = [name for name in (table["table"].strip("[]") for table in tables if table["table"].startswith("[["))
                 if name.split(".")[0] not in ("sensor", "scene", "camera", "alert", "output")]
        self.assertIn("osc.cue", feeds)
        everything = os.path.join(self.folder, "everything.toml")
        with open(everything, "w", encoding="utf-8") as file:
            file.write('[[sensor]]\ndriver = "synthetic"\n[[scene]]\nkind = "grass"\n[[camera]]\nname = "a"\n'
                       '[[alert]]\nname = "a"\ncommand = "true"\n[[output]]\n[[output.window]]\n')
            for name in feeds:
                beside_the_channel = "channel = 10\n" if name == "dmx.grid" else ""
                file.write(f"[[{name}]]\n" + ("" if "." in name else 'name = "a"\n') + beside_the_channel)
        config = json.loads(run("check-config", everything, "--full", "--json").stdout)
        sensor, output = config["sensors"][0], config["outputs"][0]
        values = {"[[camera]]": config["cameras"][0]["values"], "[[alert]]": config["alerts"][0]["values"],
                  "[[output]]": output["values"], "[[output.window]]": output["windows"][0],
                  "driver synthetic": sensor["values"], "kind grass": config["scenes"][0]["values"]}
        for name in feeds:
            owner, _, below = name.partition(".")
            entry = config[owner][0]
            values[f"[[{name}]]"] = entry[below][0] if below else entry["values"]
        for table in tables:
            name = table["table"]
            if name in ("[[sensor]]", "[[scene]]"):
                kind = re.match(r'(driver|kind) = "(\S+)"', table["summary"])
                name = "kind grass" if kind is None else " ".join(kind.groups())
                if name not in values:
                    continue  # another kind's
            elif name.startswith("[sensor."):
                values[name] = sensor[name[len("[sensor."):-1]]
            elif name not in values:
                values[name] = config[name[1:-1]] if name else config
            for parameter in table["parameters"]:
                if not parameter["left_out"]:
                    self.assertIn(parameter["name"], values[name], name)

    def test_the_exit_code_of_status_says_how_it_is(self):
        done = run("status", "--connect", self.places["ADDRESS"], "--json")
        status = json.loads(done.stdout)
        self.assertEqual((done.returncode, status["verdict"]), (1, "attention"), "there is no broker")
        self.assertTrue(any(text.startswith("sensor garden is connecting") for text in status["attention"]), status)
        self.assertEqual([player["sensor"] for player in status["players"]], ["played"])
        self.assertGreater(status["running_s"], 0)
        with Program(YURAGI, "run", "--listen", "127.0.0.1:0") as well:
            address = well.address()
            watch = Program(YURAGI, "sensors", "watch", "--connect", address)
            watch.wait_for("simulated")
            watch.end()
            watch.__exit__()
            done = run("status", "--connect", address)
            self.assertRegex(done.stdout, r"^yuragi \S+ at \S+, running for .*: ")
            # On a loaded machine the only thing that can need attention is that it is late.
            self.assertEqual(re.findall(r"^  - (?!the animation is late|the thread of .* is late)(.*)$", done.stdout, re.M), [])
            self.assertEqual(done.returncode, 0 if ": all is well\n" in done.stdout else 1)
            self.assertEqual(run("status", "--connect", address, "--quiet").stdout, "")
            self.assertEqual(well.end(), 0)
        done = run("status", "--connect", address, "--json")
        self.assertEqual((done.returncode, json.loads(done.stdout)["verdict"]), (2, "no daemon"))

    def test_status_of_a_daemon_without_scenes(self):
        with Program(YURAGI, "record", os.path.join(self.folder, "new.windlog"), "--listen", "127.0.0.1:0") as recorder:
            done = run("status", "--connect", recorder.address(), "--json")
            status = json.loads(done.stdout)
            self.assertIsNone(status["running_s"])
            self.assertEqual((status["scenes"], status["recorder"]["state"]), ([], "writing"))
            self.assertEqual(recorder.end(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
