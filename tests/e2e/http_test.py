#!/usr/bin/env python3
"""What the daemon answers by HTTP.

usage: http_test.py FOLDER_OF_PROGRAMS
"""
import io
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tarfile
import tempfile
import time
import unittest
import unittest.mock
import urllib.error
import urllib.parse
import urllib.request

from programs import HANG_S, Program, free_port

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../config/prometheus/yuragi.dashboard.json"), encoding="utf-8") as file:
    DASHBOARD = json.load(file)
COMPLETED = "wall-20260101T000000Z.windlog"  # beside wall.windlog
SMALL_MEADOW = '[[scene]]\nname = "meadow"\nkind = "grass"\nblades_across = 20\nblades_deep = 20\n'


class Http(unittest.TestCase):
    def write_config(self, text):
        file = os.path.join(self.enterContext(tempfile.TemporaryDirectory()), "yuragi.toml")
        with open(file, "w", encoding="utf-8") as config:
            config.write(text)
        return file

    def start_daemon(self, sensor, http=""):
        self.start_daemon_with(self.write_config('[http]\nlisten = "127.0.0.1:0"\n' + http + sensor + SMALL_MEADOW))

    def start_daemon_with(self, file, **options):
        daemon = self.enterContext(Program(YURAGI, "run", "--config", file, "--listen", "127.0.0.1:0", **options))
        self.stream = daemon.wait_for(r"listening on (\S+)").group(1)
        self.base = daemon.wait_for(r"answering at (http://\S+)").group(1)
        return daemon

    def ask(self, path, body=None, method=None, **fields):
        """Status and text of the answer; its cookies are in self.cookies."""
        data = None if body is None else json.dumps(body).encode()
        fields = {name.replace("_", "-"): value for name, value in fields.items()}
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json", **fields}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=HANG_S) as answer:
                self.cookies = answer.headers.get("Set-Cookie", "")
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as refusal:
            with refusal:
                return refusal.code, refusal.read().decode()

    def wait_for(self, path, status, pattern, hangs_s=HANG_S):
        """An answer of that status that says so."""
        hangs = time.monotonic() + hangs_s
        while time.monotonic() < hangs:
            told, text = self.ask(path)
            if told == status and re.search(pattern, text):
                return text
            time.sleep(0.1)  # what is waited for may have the lowest priority
        self.fail(f"{path} said last: {told} {text}")

    def test_a_daemon_that_is_well_says_so_and_shows_what_it_is_asked_to(self):
        self.start_daemon('[[sensor]]\nname = "roof"\ndriver = "synthetic"\n')
        self.wait_for("/healthz", 200, "all is well")
        self.wait_for("/metrics", 200, r'yuragi_sensor_believed{sensor="roof",driver="synthetic"} 1\n')
        status = json.loads(self.ask("/api/v1/status")[1])
        self.assertEqual((status["verdict"], status["sensors"][0]["name"]), ("well", "roof"))
        code, text = self.ask("/api/v1/scenes", {"scene": "meadow", "shown": False, "over_s": 0})
        self.assertEqual((code, json.loads(text)["scenes"][0]["is_shown"]), (200, False))
        code, text = self.ask("/api/v1/scenes", {"scene": "sea"})
        self.assertEqual(code, 409)
        self.assertIn("sea", json.loads(text)["detail"])

    def test_wind_and_blackout_are_set_by_hand_for_a_time(self):
        self.start_daemon('[[sensor]]\nname = "roof"\ndriver = "synthetic"\n')
        code, text = self.ask("/api/v1/hand", {"speed_m_s": 8, "direction_deg": 270, "for_s": 3600})
        self.assertEqual((code, json.loads(text)["by_hand"]["wind"]["speed_m_s"]), (200, 8))
        code, text = self.ask("/api/v1/blackout", {"for_s": None})
        self.assertEqual((code, json.loads(text)["by_hand"]["blackout"]), (200, {"left_s": None}))
        self.wait_for("/metrics", 200, r'yuragi_by_hand{part="wind"} 1\n')
        self.wait_for("/healthz", 503, "dark by hand until somebody ends it")
        for path, body in (("hand", {"speed_m_s": 8}), ("hand", {"speed_m_s": 1e300, "direction_deg": 0}), ("blackout", {"for_s": -1})):
            self.assertEqual(self.ask("/api/v1/" + path, body)[0], 400, body)
        code, text = self.ask("/api/v1/camera", {"camera": "gate"})
        self.assertEqual((code, json.loads(text)["detail"]), (409, "the configuration has no [[camera]]"))
        for path in ("hand", "blackout"):
            code, text = self.ask("/api/v1/" + path, {"release": True})
            self.assertEqual(code, 200)
        self.assertEqual(json.loads(text)["by_hand"], {"wind": None, "blackout": None, "camera": None})
        self.assertNotIn("dark", str(json.loads(self.ask("/api/v1/status")[1])["attention"]))

    def test_the_dashboard_shows_metrics_and_labels_that_there_are(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.start_daemon(f'[recording]\nfile = "{folder}/wall.windlog"\n[[sensor]]\nname = "roof"\ndriver = "synthetic"\n')
        text = self.wait_for("/metrics", 200, r'(?s)yuragi_lateness_seconds.*yuragi_recorder_written_total [1-9]')
        labels = {name: {"job", "instance"} for name in re.findall(r"(?m)^# TYPE (\w+) ", text)}  # Prometheus's own
        for name, of_value in re.findall(r"(?m)^(\w+)\{(.*)\} \S+$", text):
            labels[name] |= set(re.findall(r'(\w+)="', of_value))
        without_value = {"yuragi_sensor_refused_total": {"reason"}, "yuragi_sensor_quantity_missing": {"quantity"},
                         "yuragi_faults_total": {"kind"}, "yuragi_sensor_gust_meters_per_second": set()}
        for name, more in without_value.items():
            labels[name] |= more | ({"sensor", "driver"} if "_sensor_" in name else set())

        shown = set()
        for panel in DASHBOARD["panels"]:
            for target in panel.get("targets", []):
                expression = target["expr"]
                names = set(re.findall(r"\byuragi_\w+", expression))
                self.assertTrue(names or "ALERTS" in expression, expression)
                self.assertLessEqual(names, labels.keys(), panel["title"])
                shown |= names
                used = set(re.findall(r"{{(\w+)}}", target["legendFormat"]))
                used |= set(re.findall(r"[{,]\s*(\w+)\s*[=!]", expression)) if names else set()
                for name in names:
                    self.assertLessEqual(used, labels[name], panel["title"])
        self.assertEqual(labels.keys() - shown, set(), "each metric is shown")

    def test_the_dashboard_is_one_that_grafana_imports(self):
        self.assertGreaterEqual(DASHBOARD["schemaVersion"], 36, "Grafana 9")
        self.assertNotIn("id", DASHBOARD)
        panels = DASHBOARD["panels"]
        self.assertEqual(len({panel["id"] for panel in panels}), len(panels))
        taken = set()
        for panel in panels:
            place = panel["gridPos"]
            self.assertLessEqual(place["x"] + place["w"], 24)
            cells = {(x, y) for x in range(place["x"], place["x"] + place["w"]) for y in range(place["y"], place["y"] + place["h"])}
            self.assertFalse(cells & taken, f'{panel["title"]} covers another panel')
            taken |= cells
            for target in panel.get("targets", []):
                self.assertEqual(target["datasource"], {"type": "prometheus", "uid": "${datasource}"})
                self.assertEqual(target["expr"].count("("), target["expr"].count(")"))
                self.assertEqual(target["expr"].count("{"), target["expr"].count("}"))
        variables = {variable["name"] for variable in DASHBOARD["templating"]["list"]}
        used = set(re.findall(r"\$\{?(\w+)", json.dumps(DASHBOARD))) - {"__all", "__rate_interval"}
        self.assertEqual(used, variables)

    @unittest.skipUnless(shutil.which("promtool"), "promtool (Debian: prometheus) is not installed")
    def test_promtool_has_nothing_against_the_metrics(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.start_daemon(f'[recording]\nfile = "{folder}/wall.windlog"\n[[sensor]]\nname = "roof"\ndriver = "synthetic"\n')
        text = self.wait_for("/metrics", 200, r'(?s)yuragi_lateness_seconds.*yuragi_recorder_written_total [1-9]')
        done = subprocess.run(["promtool", "check", "metrics"], input=text, capture_output=True, text=True, timeout=HANG_S, check=False)
        self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))

    def test_the_history_of_what_it_records_and_its_log(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        sensor = '[[sensor]]\nname = "roof"\ndriver = "synthetic"\n'
        self.start_daemon(sensor)
        code, text = self.ask("/api/v1/history")
        self.assertEqual(code, 404)
        self.assertIn("[recording] file", json.loads(text)["detail"])
        recording = f'[recording]\nfile = "{folder}/wall.windlog"\n'
        self.start_daemon(recording + sensor)
        self.wait_for("/api/v1/status", 200, r'"written": [1-9]')
        history = json.loads(self.wait_for("/api/v1/history?hours=1", 200, '"roof"'))
        self.assertEqual(history["step_count"], len(history["sensors"][0]["mean_m_s"]))
        self.assertIn(None, history["sensors"][0]["mean_m_s"])
        self.assertTrue(any(mean is not None for mean in history["sensors"][0]["mean_m_s"]))
        lines = json.loads(self.ask("/api/v1/log")[1])["lines"]
        self.assertIn(f"recording to {folder}/wall.windlog", [line["text"] for line in lines])
        self.assertEqual(self.ask("/api/v1/log", X_Forwarded_For="192.0.2.7")[0], 401)
        recent = json.loads(self.wait_for("/api/v1/wind", 200, r'"measured_m_s": \[\s*\d'))
        self.assertTrue(all(age_s >= 0 for age_s in recent["age_s"]))
        self.assertEqual({len(values) for values in recent.values()}, {len(recent["age_s"])})

    def test_the_history_of_a_year_has_the_mean_of_each_day(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        day_s, now_s = 86400, int(time.time())
        first_s = now_s // day_s * day_s - 400 * day_s
        speeds = {}  # by the time of the reading; ten days without any
        for number in range(399 * 24):
            if not 2400 <= number < 2640:
                speeds[first_s + 3600 * number] = 3 + number % 24 / 10 + number % 7
        table = os.path.join(folder, "table.csv")
        with open(table, "w", encoding="ascii") as rows:
            rows.write("time,speed,direction\n" + "".join(
                f"{time.strftime('%Y-%m-%dT%H:%M:%SZ', time.gmtime(at_s))},{speed:.1f},200\n" for at_s, speed in speeds.items()))
        part = os.path.join(folder, time.strftime("wall-%Y%m%dT%H%M%SZ.windlog", time.gmtime(first_s)))
        subprocess.run([YURAGI, "import", table, "-o", part, "--unit", "m/s", "--force"], check=True, capture_output=True, timeout=HANG_S)
        with open(os.path.join(folder, "wall-20010101T000000Z.windlog"), "w", encoding="ascii") as damaged:
            damaged.write("damaged")
        self.start_daemon(f'[recording]\nfile = "{folder}/wall.windlog"\n[[sensor]]\nname = "roof"\ndriver = "synthetic"\n')
        for path in ("history?hours=8785", "history?hours=-1", "history?hours=1e3", "history?hours=" + "9" * 100):
            self.assertEqual(self.ask("/api/v1/" + path)[0], 400, path)
        history = json.loads(self.wait_for("/api/v1/history?hours=8784", 200, '"sensors"'))
        self.assertEqual((history["step_s"], history["begin_s"] % day_s, history["files_left_out"]), (day_s, 0, 1))
        self.assertLessEqual(history["step_count"], 501)
        mast = history["sensors"][0]
        for step in range(history["step_count"]):
            begin_s = history["begin_s"] + step * day_s
            of_day = [round(speeds[at_s], 1) for at_s in range(begin_s, begin_s + day_s, 3600) if at_s in speeds]
            if of_day:
                self.assertAlmostEqual(mast["mean_m_s"][step], sum(of_day) / len(of_day), delta=0.0051)
                self.assertEqual((mast["min_m_s"][step], mast["max_m_s"][step]), (min(of_day), max(of_day)))
                self.assertEqual(mast["direction_deg"][step], 200)
            else:
                self.assertEqual((mast["mean_m_s"][step], mast["direction_deg"][step]), (None, None))
        self.assertEqual(mast["mean_m_s"].count(None), 10 + 2)  # the gap; yesterday and today are the daemon's own

    def start_recording_daemon(self, **options):
        """A daemon with a completed recording beside the one that it writes; self.folder has both."""
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        table = os.path.join(self.folder, "table.csv")
        with open(table, "w", encoding="ascii") as rows:
            rows.write("time,speed,direction\n" + "".join(f"2026-01-01T00:{i // 60:02}:{i % 60:02}Z,3.{i % 10},200\n" for i in range(600)))
        subprocess.run([YURAGI, "import", table, "-o", os.path.join(self.folder, COMPLETED)], check=True, capture_output=True)
        file = self.write_config(f'[http]\nlisten = "127.0.0.1:0"\n[recording]\nfile = "{self.folder}/wall.windlog"\n'
                                 '[[sensor]]\nname = "roof"\ndriver = "synthetic"\n' + SMALL_MEADOW)
        daemon = self.start_daemon_with(file, **options)
        self.wait_for("/api/v1/status", 200, r'"written": [1-9]')
        return daemon

    def bytes_of(self, path):
        with urllib.request.urlopen(self.base + path, timeout=HANG_S) as answer:
            return answer.read()

    def ended(self, path):
        """The job that a request begins, when it has ended."""
        code, text = self.ask(path, {})
        self.assertEqual(code, 202, text)
        return self.ended_job(json.loads(text)["id"])

    def ended_job(self, number):
        return json.loads(self.wait_for(f"/api/v1/jobs/{number}", 200, '"state": "(done|failed)"', 10 * HANG_S))

    def test_recordings_are_listed_downloaded_verified_copied_and_reported(self):
        self.start_recording_daemon()
        recordings = json.loads(self.ask("/api/v1/recordings")[1])["recordings"]
        self.assertEqual([one["name"] for one in recordings], ["wall.windlog", COMPLETED])
        self.assertEqual([one["is_written"] for one in recordings], [True, False])
        self.assertEqual(recordings[1]["last_s"] - recordings[1]["first_s"], 599)
        with open(os.path.join(self.folder, COMPLETED), "rb") as completed:
            self.assertEqual(self.bytes_of("/api/v1/recordings/" + COMPLETED), completed.read())

        job = self.ended(f"/api/v1/recordings/{COMPLETED}/verify")
        self.assertEqual((job["state"], job["result"]["is_sound"], job["result"]["files"][0]["file"]), ("done", True, COMPLETED))
        self.assertEqual(job["result"]["files"][0]["readings"], 600)
        self.assertNotIn(self.folder, json.dumps(job))

        self.assertEqual(self.ask("/api/v1/recordings/wall.windlog")[0], 409)
        job = self.ended("/api/v1/recordings/wall.windlog/copy")
        copy = os.path.join(self.folder, "copy.windlog")
        with open(copy, "wb") as file:
            file.write(self.bytes_of(job["file"]["path"]))
        self.assertEqual(subprocess.run([YURAGI, "verify", copy], capture_output=True).returncode, 0)
        self.assertEqual([name for name in os.listdir(self.folder) if "-copy" in name], [])

        if shutil.which("gnuplot"):
            job = self.ended(f"/api/v1/recordings/{COMPLETED}/report")
            self.assertEqual(job["file"]["name"], COMPLETED.replace("windlog", "html"))
            self.assertIn(b"600 in 1 session", self.bytes_of(job["file"]["path"]))

    def test_a_recording_is_only_found_by_its_name_in_the_list(self):
        self.start_recording_daemon()
        names = ["..", "../table.csv", "table.csv", "wall.windlog-wal", f"../{os.path.basename(self.folder)}/{COMPLETED}",
                 f"{self.folder}/{COMPLETED}", "/etc/passwd", "--help", "wall.windlog\0", "absent.windlog", "%"]
        for name in names:
            quoted = urllib.parse.quote(name, safe="")
            self.assertEqual(self.ask(f"/api/v1/recordings/{quoted}")[0], 404, name)
            for command in ("verify", "report", "copy"):
                self.assertEqual(self.ask(f"/api/v1/recordings/{quoted}/{command}", {})[0], 404, name)
        self.assertEqual(self.ask(f"/api/v1/recordings/../{COMPLETED}")[0], 404)
        self.assertEqual(self.ask("/api/v1/recordings/" + COMPLETED + "/verify", {"gap": 1})[0], 400)
        for path in ("recordings", "recordings/" + COMPLETED, "jobs/1", "jobs/1/file", "configuration"):
            self.assertEqual(self.ask("/api/v1/" + path, X_Forwarded_For="192.0.2.7")[0], 401, path)
        for path in (f"recordings/{COMPLETED}/verify", "support-bundle"):
            self.assertEqual(self.ask("/api/v1/" + path, {}, X_Forwarded_For="192.0.2.7")[0], 401, path)
            self.assertEqual(self.ask("/api/v1/" + path, {}, Origin="https://evil.example")[0], 403, path)
        self.assertEqual(self.ask("/api/v1/jobs/1")[0], 404, "none was begun")

    def wait_for_process(self, file):
        """The process whose number a program has written into a file."""
        hangs = time.monotonic() + HANG_S
        while time.monotonic() < hangs:
            if os.path.exists(file) and os.path.getsize(file) > 0:
                with open(file, encoding="ascii") as number:
                    return int(number.read())
        self.fail(f"no {file}")

    def assert_gone(self, process):
        hangs = time.monotonic() + HANG_S
        while time.monotonic() < hangs:
            try:
                with open(f"/proc/{process}/stat", encoding="ascii") as about:
                    if about.read().rsplit(")", 1)[1].split()[0] == "Z":
                        return  # nobody waits for it
            except (FileNotFoundError, ProcessLookupError):
                return
        self.fail(f"process {process} is there")

    def test_one_job_runs_at_a_time_at_the_lowest_priority_and_a_killed_one_is_reported(self):
        programs = self.enterContext(tempfile.TemporaryDirectory())
        begun = os.path.join(programs, "begun")
        with open(os.path.join(programs, "gnuplot"), "w", encoding="ascii") as slow:  # of a report
            slow.write(f'#!/bin/sh\necho $PPID > "{begun}.new"; mv "{begun}.new" "{begun}"; exec sleep 1000\n')
        os.chmod(slow.name, 0o755)
        daemon = self.start_recording_daemon(env={**os.environ, "PATH": programs + ":" + os.environ["PATH"]})
        report = f"/api/v1/recordings/{COMPLETED}/report"
        number = json.loads(self.ask(report, {})[1])["id"]
        child = self.wait_for_process(begun)
        self.assertEqual(os.getpriority(os.PRIO_PROCESS, child), 19)
        self.assertEqual(os.getpriority(os.PRIO_PROCESS, daemon.process.pid), os.getpriority(os.PRIO_PROCESS, 0), "the daemon's own stays")
        code, text = self.ask(f"/api/v1/recordings/{COMPLETED}/verify", {})
        self.assertEqual(code, 409)
        self.assertIn(f"report of {COMPLETED}", json.loads(text)["detail"])
        self.assertIn('"running"', self.ask(f"/api/v1/jobs/{number}")[1])
        self.assertEqual(self.ask("/api/v1/status")[0], 200)
        os.kill(child, signal.SIGKILL)
        job = self.ended_job(number)
        self.assertEqual(job["state"], "failed")
        self.assertIn("killed by signal 9", job["message"])
        self.assertEqual(self.ask(f"/api/v1/jobs/{number}/file")[0], 404)

        os.remove(begun)
        self.assertEqual(self.ask(report, {})[0], 202, "the next one")
        child = self.wait_for_process(begun)
        self.assertEqual(daemon.end(), 0)
        self.assert_gone(child)

    def test_the_support_bundle_and_the_configuration_withhold_secrets(self):
        file = self.write_config('[http]\nlisten = "127.0.0.1:0"\n[[sensor]]\nname = "roof"\ndriver = "synthetic"\n'
                                 f'[mqtt]\nhost = "127.0.0.1"\nport = {free_port()}\nuser = "yuragi"\npassword = "hunter2secret"\n' + SMALL_MEADOW)
        self.start_daemon_with(file)
        code, text = self.ask("/api/v1/configuration")
        found = json.loads(text)
        self.assertEqual((code, found["is_valid"], found["file"]), (200, True, "yuragi.toml"))
        self.assertEqual(found["configuration"]["http"]["listen"], "127.0.0.1:0")
        self.assertNotIn("hunter2secret", text)
        self.assertIn("(secret)", text)
        with open(file, "a", encoding="ascii") as config:
            config.write("hight = 3\n")
        found = json.loads(self.ask("/api/v1/configuration")[1])
        self.assertEqual((found["is_valid"], found["configuration"]), (False, None))
        self.assertIn("hight", found["findings"][0])

        job = self.ended("/api/v1/support-bundle")
        self.assertEqual(job["state"], "done", job)
        with tarfile.open(fileobj=io.BytesIO(self.bytes_of(job["file"]["path"]))) as bundle:
            texts = {os.path.basename(name): bundle.extractfile(name).read().decode() for name in bundle.getnames() if name.endswith(".txt") or name.endswith(".toml")}
        self.assertIn("hight", texts["configuration-errors.txt"])
        self.assertNotIn("hunter2secret", "".join(texts.values()))

    def test_the_guide_has_every_page_that_it_links_and_every_key(self):
        self.start_daemon('[[sensor]]\ndriver = "synthetic"\n')
        self.assertIn('href="/guide/"', self.ask("/")[1])
        left, texts = ["./"], {}
        while left:
            name = left.pop()
            status, texts[name] = self.ask("/guide/" + name.removeprefix("./"))
            self.assertEqual(status, 200, name)
            links = re.findall(r'(?:href|src)="([^"#:]+)', texts[name])
            left += [link for link in set(links) if link not in texts and link not in left]
        for name, text in texts.items():
            for page, anchor in re.findall(r'href="([^"#:]*)#([^"]+)"', text):
                self.assertIn(f'id="{anchor}"', texts[page or name], f"{name}: {page}#{anchor}")
        self.assertGreater(len(texts), 11)
        described = json.loads(subprocess.run([YURAGI, "describe", "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout)
        for table in described:
            for key in table["parameters"]:
                self.assertIn(f"<code>{key['name']}</code>", texts["keys.html"])

    def policy_of(self, path, **fields):
        """The Content-Security-Policy of an answer, by directive; nothing that it forbids stands in a page's text."""
        request = urllib.request.Request(self.base + path, headers={name.replace("_", "-"): value for name, value in fields.items()})
        try:
            answer = urllib.request.urlopen(request, timeout=HANG_S)
        except urllib.error.HTTPError as refusal:
            answer = refusal
        with answer:
            text = answer.read().decode()
            policy = dict(directive.strip().partition(" ")[::2] for directive in answer.headers["Content-Security-Policy"].split(";"))
            if answer.headers["Content-Type"].startswith("text/html"):
                self.assertNotRegex(text, r"(?i)<script(?![^>]*\ssrc=)|\son[a-z]+=|javascript:", path)
                if "'unsafe-inline'" not in policy.get("style-src", ""):
                    self.assertNotRegex(text, r"(?i)<style|<[^>]*\sstyle=", path)
            self.assertEqual(answer.headers["X-Content-Type-Options"], "nosniff", path)
            return policy

    def test_each_page_has_a_policy_as_small_as_it_can_be(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        with open(os.path.join(folder, "index.html"), "w", encoding="ascii") as page:
            page.write("<!doctype html><title>own</title>")
        self.start_daemon('[[sensor]]\ndriver = "synthetic"\n', f'folder = "{folder}"\n')
        own = {"default-src": "'none'", "script-src": "'self'", "style-src": "'self'", "connect-src": "'self'", "img-src": "'self'",
               "manifest-src": "'self'", "base-uri": "'none'", "form-action": "'none'", "frame-ancestors": "'none'"}
        guide = {"/guide/" + name for name in re.findall(r'href="([a-z-]+\.html)', self.ask("/guide/")[1])}
        self.assertGreater(len(guide), 10)
        to_read = {name: value for name, value in own.items() if name.split("-")[0] not in ("script", "connect", "img", "manifest")}
        for path in {"/guide/", *guide}:
            self.assertEqual(self.policy_of(path), to_read, path)
        for path in ("/", "/page.js", "/page.css"):
            self.assertEqual(self.policy_of(path), own, path)
        self.assertEqual(self.policy_of("/wall"), {**own, "script-src": "'self' 'wasm-unsafe-eval'"})
        self.assertEqual(self.policy_of("/wall.js"), own)
        nothing = {"default-src": "'none'", "frame-ancestors": "'none'"}
        for path in ("/healthz", "/metrics", "/api/v1/status", "/api/v1/openapi.json", "/absent", "/api/v1/absent", "/guide/absent.html", "/site/absent.html"):
            self.assertEqual(self.policy_of(path), nothing, path)
        self.assertEqual(self.policy_of("/", Host="evil.example"), nothing)
        self.assertEqual(self.policy_of("/api/v1/log", X_Forwarded_For="192.0.2.7"), nothing)
        site = self.policy_of("/site/")
        self.assertEqual((site["default-src"], site["script-src"], site["base-uri"], site["form-action"], site["frame-ancestors"]),
                         ("'self'", "'self' 'wasm-unsafe-eval'", "'none'", "'none'", "'self'"))

    def open_web_sockets(self, count):
        """The status codes by which `count` WebSockets are answered that all connect, then ask, and then read."""
        host, port = self.base.removeprefix("http://").split(":")
        sockets = [self.enterContext(socket.create_connection((host, int(port)), HANG_S)) for _ in range(count)]
        for one in sockets:
            one.sendall(f"GET /ws HTTP/1.1\r\nHost: {host}:{port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode())
        return [int(self.enterContext(one.makefile("rb")).readline().split()[1]) for one in sockets]

    def test_96_web_sockets_that_open_at_once_are_served_and_no_more(self):
        self.start_daemon('[[sensor]]\ndriver = "synthetic"\n')
        self.assertEqual(self.open_web_sockets(96), [101] * 96)
        self.assertEqual(self.open_web_sockets(1), [503])
        self.assertEqual(self.ask("/api/v1/status")[0], 200, "HTTP has places of its own")

    def test_a_sensor_that_is_not_there_is_told_with_what_to_do(self):
        self.start_daemon(f'[[sensor]]\nname = "roof"\ndriver = "nmea"\ntransport = "tcp"\nhost = "127.0.0.1"\nport = {free_port()}\n')
        self.wait_for("/healthz", 503, "roof.*127.0.0.1")
        self.wait_for("/metrics", 200, r'yuragi_sensor_believed{sensor="roof",driver="nmea"} 0\n')

    def test_rights_come_from_the_token_whatever_the_address(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        token_file = os.path.join(folder, "token")
        http = f'[http]\nlisten = "127.0.0.1:0"\ntoken_file = "{token_file}"\nreaders = "token"\n'
        file = self.write_config(http + '[[sensor]]\nname = "roof"\ndriver = "synthetic"\n' + SMALL_MEADOW)
        token = [YURAGI, "token", "--config", file]
        self.assertEqual(subprocess.run(token, capture_output=True).returncode, 69, "there is none yet")
        made = subprocess.run([*token, "--new"], capture_output=True, text=True, check=True)
        self.assertEqual(os.stat(token_file).st_mode & 0o007, 0)
        with open(token_file, encoding="ascii") as secret_file:
            secret = secret_file.read().strip()
        self.assertNotIn(secret, made.stdout + made.stderr)
        self.start_daemon_with(file)

        from_elsewhere = {"X_Forwarded_For": "192.0.2.7"}
        hide = {"scene": "meadow", "shown": False, "over_s": 0}
        for address in (from_elsewhere, {}):
            self.assertEqual(self.ask("/api/v1/scenes", **address)[0], 401)
            self.assertEqual(self.ask("/api/v1/scenes", hide, **address)[0], 401)
        self.wait_for("/healthz", 200, "all is well")  # this machine always reads it
        self.assertEqual(self.ask("/healthz", **from_elsewhere)[0], 401)

        # The stream, and the commands, which read the file that they are told of.
        switch = [YURAGI, "scene", "hide", "meadow", "--connect", self.stream]
        refused = subprocess.run(switch, capture_output=True, text=True)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("token", refused.stderr)
        subprocess.run(switch, env={**os.environ, "YURAGI_TOKEN_FILE": token_file}, capture_output=True, check=True)
        self.assertEqual(self.ask("/api/v1/scenes", hide, **from_elsewhere, Authorization="Bearer " + secret)[0], 200)

        code = json.loads(subprocess.run([*token, "--json"], capture_output=True, check=True).stdout)["pairing_code"]
        self.assertEqual(self.ask("/api/v1/pair", {"code": "0000-0000"}, **from_elsewhere)[0], 403)
        self.assertEqual(self.ask("/api/v1/pair", {"code": code.lower()}, **from_elsewhere)[0], 200)
        self.assertRegex(self.cookies, "^yuragi_session=.*; HttpOnly; SameSite=Strict$")
        session = self.cookies.split(";")[0]
        self.assertEqual(self.ask("/api/v1/scenes", **from_elsewhere, Cookie=session)[0], 200)
        self.assertEqual(self.ask("/api/v1/scenes", hide, **from_elsewhere, Cookie=session)[0], 200)

    def test_paired_browsers_are_listed_and_revoked_also_after_a_restart(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        token_file = os.path.join(folder, "token")
        http = f'[http]\nlisten = "127.0.0.1:{free_port()}"\ntoken_file = "{token_file}"\n'
        file = self.write_config(http + '[[sensor]]\nname = "roof"\ndriver = "synthetic"\n' + SMALL_MEADOW)
        token = [YURAGI, "token", "--config", file]
        subprocess.run([*token, "--new"], capture_output=True, check=True)
        asleep = subprocess.run([*token, "--sessions"], capture_output=True, text=True)
        self.assertEqual(asleep.returncode, 69, asleep.stderr)
        self.assertIn("is `yuragi run` running?", asleep.stderr)

        daemon = self.start_daemon_with(file)
        none = subprocess.run([*token, "--sessions"], capture_output=True, text=True, check=True)
        self.assertEqual(none.stdout, "no browser is paired\n")
        code = json.loads(subprocess.run([*token, "--json"], capture_output=True, check=True).stdout)["pairing_code"]
        self.assertEqual(self.ask("/api/v1/pair", {"code": code}, X_Forwarded_For="192.0.2.7")[0], 200)
        session = self.cookies.split(";")[0]
        daemon.end()

        self.start_daemon_with(file)
        self.assertEqual(self.ask("/api/v1/pair", {"code": code})[0], 403, "it was used before the restart")
        self.assertEqual(self.ask("/api/v1/sessions")[0], 401)
        sessions = json.loads(subprocess.run([*token, "--sessions", "--json"], capture_output=True, check=True).stdout)["sessions"]
        self.assertEqual([one["address"] for one in sessions], ["127.0.0.1"])
        table = subprocess.run([*token, "--sessions"], capture_output=True, text=True, check=True)
        self.assertRegex(table.stdout, rf"{sessions[0]['id']}  \d{{4}}-\d\d-\d\d \d\d:\d\d  .* 127.0.0.1\n")
        hide = {"scene": "meadow", "shown": False, "over_s": 0}
        self.assertEqual(self.ask("/api/v1/scenes", hide, Cookie=session)[0], 200)
        unknown = subprocess.run([*token, "--revoke", "0000000000"], capture_output=True, text=True)
        self.assertEqual(unknown.returncode, 70, unknown.stderr)
        subprocess.run([*token, "--revoke", sessions[0]["id"]], capture_output=True, check=True)
        self.assertEqual(self.ask("/api/v1/scenes", hide, Cookie=session)[0], 401)

        with open(token_file, "w", encoding="ascii") as other:
            other.write("another token than the daemon's\n")
        refused = subprocess.run([*token, "--sessions"], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 77, refused.stderr)

    def start_daemon_for_setup(self, settings=""):
        """A daemon without a sensor, and the rights to change it."""
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.token_file = os.path.join(folder, "token")
        http = f'[http]\nlisten = "127.0.0.1:0"\ntoken_file = "{self.token_file}"\n'
        self.file = self.write_config(http + settings + SMALL_MEADOW)
        self.page = self.file + ".page.toml"
        subprocess.run([YURAGI, "token", "--config", self.file, "--new"], capture_output=True, check=True)
        with open(self.token_file, encoding="ascii") as secret_file:
            self.rights = {"Authorization": "Bearer " + secret_file.read().strip()}
        return self.start_daemon_with(self.file)

    def set_up(self, path="", body=None, method=None):
        code, text = self.ask("/api/v1/sensors" + path, body, method, **self.rights)
        return code, json.loads(text)

    def change_and_wait(self, daemon, *request):
        """Changes what the page has set up, and waits for the daemon, which starts again."""
        starts = daemon.text().count("answering at")
        code, answer = self.set_up(*request)
        self.assertEqual(code, 200, answer)
        self.base = daemon.wait_for(rf"(?s)(?:answering at.*){{{starts}}}answering at (http://\S+)").group(1)

    def sensors(self):
        hangs = time.monotonic() + HANG_S
        while time.monotonic() < hangs:
            code, text = self.ask("/api/v1/status")
            if code == 200:
                return [sensor["name"] for sensor in json.loads(text)["sensors"]]
        self.fail(text)

    def test_a_sensor_is_tried_added_removed_and_the_change_undone(self):
        simulator = self.enterContext(Program(os.path.join(os.path.dirname(YURAGI), "yuragi-sim"), "nmea", "--tcp", "127.0.0.1:0", "--rate", "5"))
        port = int(simulator.wait_for(r"127\.0\.0\.1:(\d+)").group(1))
        parameters = {"transport": "tcp", "host": "127.0.0.1", "port": port}
        daemon = self.start_daemon_for_setup()
        self.assertEqual(self.sensors(), ["synthetic"])
        self.assertEqual(self.set_up(), (200, {"sensors": [], "calibrated": [], "can_undo": False, "trouble": None}))
        drivers = json.loads(self.ask("/api/v1/drivers", **self.rights)[1])["drivers"]
        keys = {driver["name"]: [key["name"] for key in driver["parameters"]] for driver in drivers}
        self.assertIn("port", keys["nmea"])
        self.assertNotIn("file", keys["nmea"])
        self.assertNotIn("windlog", keys)

        code, job = self.set_up("/try", {"driver": "nmea", "parameters": parameters})
        self.assertEqual(code, 202)
        hangs = time.monotonic() + HANG_S
        while job["state"] == "running" and time.monotonic() < hangs:
            time.sleep(0.1)
            job = json.loads(self.ask("/api/v1/jobs/" + job["id"], **self.rights)[1])
        self.assertEqual((job["state"], job["result"][0]["state"]), ("done", "live"), job)
        self.assertFalse(os.path.exists(self.page), "a trial writes nothing")

        added = {"name": "roof", "driver": "nmea", "parameters": parameters}
        self.change_and_wait(daemon, "", added)
        self.assertEqual(self.sensors(), ["roof"])
        self.wait_for("/api/v1/status", 200, '"state": "live"')
        self.assertEqual(os.stat(self.page).st_mode & 0o077, 0)
        self.assertEqual(self.set_up(), (200, {"sensors": ["roof"], "calibrated": [], "can_undo": True, "trouble": None}))
        self.assertIn(self.page, subprocess.run([YURAGI, "check-config", self.file], capture_output=True, text=True, check=True).stdout)
        code, refusal = self.set_up("/try", {"driver": "nmea", "parameters": parameters})
        self.assertEqual(code, 409)
        self.assertIn('"roof"', refusal["detail"], "its device is the daemon's")

        self.change_and_wait(daemon, "/roof", None, "DELETE")
        self.assertEqual(self.sensors(), ["synthetic"])
        self.change_and_wait(daemon, "/undo", {})
        self.assertEqual(self.sensors(), ["roof"])
        self.change_and_wait(daemon, "/undo", {})
        self.assertEqual(self.sensors(), ["synthetic"])

    def kept(self, path="", body=None, method=None):
        code, text = self.ask("/api/v1/kept" + path, body, method, **self.rights)
        return code, json.loads(text)

    def wait_for_values(self, haze, gain):
        """Of [look] and of the scene meadow: those in force, and those of the configuration with what is kept."""
        hangs = time.monotonic() + HANG_S
        while time.monotonic() < hangs:
            code, text = self.ask("/api/v1/parameters")
            groups = {group["scene"]: {one["name"]: one for one in group["parameters"]} for group in json.loads(text).get("parameters", [])}
            now = code == 200 and [(groups[scene][key]["value"], groups[scene][key]["configured"]) for scene, key in (("", "haze"), ("meadow", "gain"))]
            if now == [(haze, haze), (gain, gain)]:
                return
            time.sleep(0.05)
        self.fail(f"{now} in place of {haze}, {gain}")

    def test_kept_values_outlive_a_kill_and_a_reload_and_go_back_to_the_configuration(self):
        daemon = self.start_daemon_for_setup()
        for body in ({"set": {"haze": 0.6}}, {"scene": "meadow", "set": {"gain": 2}}):
            self.assertEqual(self.ask("/api/v1/parameters", body, **self.rights)[0], 200)
        code, answer = self.kept("", {"look": {"haze": 0.6}, "scenes": {"meadow": {"gain": 2}}})
        self.assertEqual((code, answer), (200, {"message": "2 values are kept"}))
        self.wait_for_values(0.6, 2)
        self.assertEqual(daemon.text().count("answering at"), 1, "it is not started again")
        daemon.process.kill()
        daemon.process.wait()

        daemon = self.start_daemon_with(self.file)
        self.wait_for_values(0.6, 2)
        self.assertEqual(self.ask("/api/v1/parameters", {"set": {"haze": 0.9}}, **self.rights)[0], 200)
        self.assertEqual(self.ask("/api/v1/reload", {}, **self.rights)[0], 200)
        self.wait_for_values(0.6, 2)
        self.assertEqual(self.kept(), (200, {"kept": ["[look] haze", "scene meadow: gain"], "can_undo": True, "trouble": None}))
        checked = subprocess.run([YURAGI, "check-config", self.file], capture_output=True, text=True, check=True).stdout
        self.assertIn("  scene meadow: gain is kept on the page\n", checked)
        shown = json.loads(self.ask("/api/v1/configuration", **self.rights)[1])["configuration"]
        self.assertEqual((shown["look"]["haze"], shown["page"]), (0.6, {"file": self.page, "kept": ["[look] haze", "scene meadow: gain"]}))

        self.assertEqual(self.kept("/undo", {})[0], 200)
        self.wait_for_values(0.15, 1)
        self.assertEqual(self.kept("/undo", {})[0], 200)
        self.wait_for_values(0.6, 2)
        self.assertEqual(self.kept("", None, "DELETE")[0], 200)
        self.wait_for_values(0.15, 1)
        self.assertEqual(self.kept(), (200, {"kept": [], "can_undo": True, "trouble": None}))
        self.assertEqual(daemon.text().count("answering at"), 1)

    def test_a_kept_value_of_a_scene_that_is_gone_is_passed_over_and_said(self):
        daemon = self.start_daemon_for_setup()
        self.assertEqual(self.kept("", {"look": {"haze": 0.6}, "scenes": {"meadow": {"gain": 2}}})[0], 200)
        daemon.end()
        with open(self.file, encoding="utf-8") as file:
            text = file.read()
        with open(self.file, "w", encoding="utf-8") as file:
            file.write(text.replace('kind = "grass"', 'kind = "grass"\nname = "lawn"').replace('name = "meadow"\n', ""))
        daemon = self.start_daemon_with(self.file)
        why = r'a value that the page keeps is passed over: .*page\.toml:\d+:\d+: scene: there is no scene "meadow"'
        self.assertRegex(daemon.text(), why)
        self.wait_for("/api/v1/status", 200, '"verdict"')
        checked = subprocess.run([YURAGI, "check-config", self.file], capture_output=True, text=True, check=True)
        self.assertRegex(checked.stderr, why)
        self.assertEqual(self.kept()[1]["kept"], ["[look] haze", "scene meadow: gain"])

    def test_nothing_is_set_up_without_rights_or_with_a_mistake(self):
        self.start_daemon_for_setup('[[sensor]]\nname = "mast"\ndriver = "synthetic"\n')
        roof = {"name": "roof", "driver": "nmea", "parameters": {"transport": "tcp", "host": "127.0.0.1", "port": 4001}}
        for path, body, method in (("", None, None), ("", {"look": {"haze": 0.5}}, None), ("", None, "DELETE"), ("/undo", {}, None)):
            self.assertEqual(self.ask("/api/v1/kept" + path, body, method)[0], 401, path)
        requests = (("", roof, None), ("/find", {}, None), ("/try", {"driver": "nmea"}, None), ("/undo", {}, None), ("/mast", None, "DELETE"))
        for path, body, method in requests:
            self.assertEqual(self.ask("/api/v1/sensors" + path, body, method)[0], 401, path)
            self.assertEqual(self.ask("/api/v1/sensors" + path, body, method, Origin="http://other.example", **self.rights)[0], 403, path)
        self.assertEqual(self.ask("/api/v1/drivers")[0], 401)

        def refused(name="roof", driver="nmea", **parameters):
            code, answer = self.set_up("", {"name": name, "driver": driver, "parameters": parameters})
            self.assertEqual(code, 409, answer)
            return answer["detail"]

        self.assertIn('"mast" is in use', refused(name="mast"))
        self.assertIn("sensor.driver: is \"nothing\"", refused(driver="nothing"))
        self.assertIn("sensor.port: is 0", refused(transport="tcp", host="127.0.0.1", port=0))
        self.assertIn("sensor.file: is not for the page", refused(transport="file", file="/etc/passwd"))
        self.assertIn("sensor.worker: is not for the page", refused(driver="microphone", worker="/bin/sh"))
        self.assertIn("must be a device in /dev", refused(device="/etc/passwd"))
        self.assertIn("not for the page", refused(driver="windlog", file="/tmp/a.windlog"))
        self.assertIn("sensor.x", refused(x="1"))
        for body in ({"name": "roof"}, {"driver": "nmea"}, {"name": "roof", "driver": "nmea", "parameters": {"a": [1]}}, {"name": "roof", "driver": "nmea", "run": "x"}):
            self.assertEqual(self.set_up("", body)[0], 400, body)
        self.assertEqual(self.set_up("/mast", None, "DELETE")[0], 404, "it is in the configuration")
        self.assertEqual(self.set_up("/undo", {})[0], 409)
        self.assertFalse(os.path.exists(self.page))

    def test_without_a_token_nobody_sets_sensors_up(self):
        self.start_daemon('[[sensor]]\nname = "mast"\ndriver = "synthetic"\n')
        code, text = self.ask("/api/v1/sensors", {"name": "roof", "driver": "synthetic"})
        self.assertEqual(code, 409)
        self.assertIn("token_file", json.loads(text)["detail"])

    def start_station(self):
        station = self.enterContext(Program(os.path.join(os.path.dirname(YURAGI), "yuragi-sim"), "nmea", "--tcp", "127.0.0.1:0", "--rate", "5",
                                            "--speed", "8", "--direction", "350", "--turbulence", "0"))
        port = int(station.wait_for(r"127\.0\.0\.1:(\d+)").group(1))
        roof = f'[[sensor]]\nname = "roof"\ndriver = "nmea"\ntransport = "tcp"\nhost = "127.0.0.1"\nport = {port}\n'
        return station, self.start_daemon_for_setup(roof)

    def job_when(self, job, holds):
        hangs = time.monotonic() + HANG_S
        while not holds(job):
            self.assertLess(time.monotonic(), hangs, job)
            time.sleep(0.1)
            job = json.loads(self.ask("/api/v1/jobs/" + job["id"], **self.rights)[1])
        return job

    def calibrated(self, **order):
        code, job = self.set_up("/roof/calibrate", order)
        self.assertEqual(code, 202, job)
        job = self.job_when(job, lambda job: job["state"] != "running")
        self.assertEqual(job["state"], "done", job)
        return job["result"]

    def check_config(self, *options):
        return subprocess.run([YURAGI, "check-config", self.file, *options], capture_output=True, text=True, check=True)

    def direction(self):
        return json.loads(self.ask("/api/v1/status")[1])["sensors"][0]["direction_deg"]

    def test_a_sensor_is_calibrated_and_a_later_calibration_of_the_terminal_counts(self):
        _, daemon = self.start_station()
        listed = json.loads(self.ask("/api/v1/calibrations", **self.rights)[1])["sensors"]
        self.assertEqual([sensor["sensor"] for sensor in listed], ["roof"])
        self.assertIn("must not move", listed[0]["ways"][0]["preparation"])
        self.wait_for("/api/v1/status", 200, '"state": "live"')

        found = self.calibrated(calibration="north", bearing_deg=90, for_s=5)
        self.assertEqual(found["before"], {"north_offset": 0.0})
        self.assertAlmostEqual(found["after"]["north_offset"], 100.0, delta=2.0)
        self.assertGreater(found["readings"][0]["count"], 4)
        self.assertIn("The vane reads", found["notes"][-1])
        self.assertEqual(found["effect"]["rows"][0]["indicated"], 0.0)
        self.assertFalse(os.path.exists(self.page), "a calibration writes nothing before it is kept")
        kept = {key: found[key] for key in ("before", "after")}
        self.change_and_wait(daemon, "/roof/calibration", kept)
        self.wait_for("/api/v1/status", 200, '"state": "live"')
        self.assertAlmostEqual(self.direction(), 90.0, delta=3.0)
        self.assertEqual(self.set_up()[1]["calibrated"], ["roof"])
        self.assertIn("calibrated on the page: north_offset = ", self.check_config().stdout)
        self.assertIn(f"north_offset = {found['after']['north_offset']}", self.check_config("--full").stdout)
        self.assertEqual(self.set_up("/roof/calibration", kept)[0], 409, "it has other values now")

        # Known winds: each is a job, and the page keeps what was measured.
        point = self.calibrated(calibration="span", speed_m_s=8.8, for_s=2)["points"][0]
        self.assertAlmostEqual(point["measured_m_s"], 8.0, delta=0.3)
        line = self.calibrated(calibration="span", points=f"2:2.2 {point['measured_m_s']}:{point['true_m_s']}")
        self.assertAlmostEqual(line["after"]["gain"], 1.1, delta=0.05)

        stream = re.findall(r"listening on (\S+)", daemon.text())[-1]  # it was started again
        done = subprocess.run([YURAGI, "calibrate", "span", "--config", self.file, "--connect", stream, "--speed", "8.8", "--for", "2", "--yes"],
                              capture_output=True, text=True, check=True)
        self.assertIn("calibration.north_offset", done.stdout, "what the page has calibrated is taken over")
        checked = self.check_config("--full")
        self.assertRegex(checked.stderr, r"calibration of roof \(north_offset = .*\) does not count: .* was changed since")
        self.assertRegex(checked.stdout, r"gain = 1\.(0[5-9]|1)")
        self.assertIn(f"north_offset = {found['after']['north_offset']}", checked.stdout)
        self.assertAlmostEqual(self.direction(), 90.0, delta=3.0)
        self.change_and_wait(daemon, "/roof/calibration", None, "DELETE")
        self.assertEqual(self.set_up()[1]["calibrated"], [])

    def test_a_calibration_is_cancelled_and_ends_when_its_sensor_is_lost(self):
        station, _ = self.start_station()
        self.wait_for("/api/v1/status", 200, '"state": "live"')

        def begun():
            code, job = self.set_up("/roof/calibrate", {"calibration": "zero", "for_s": 1800})
            self.assertEqual(code, 202, job)
            return self.job_when(job, lambda job: job["result"] and any(one["count"] > 0 for one in job["result"]["readings"]))

        job = begun()
        self.assertEqual((job["state"], job["result"]["duration_s"]), ("running", 1800))
        self.assertEqual(self.ask("/api/v1/jobs/" + job["id"], None, "DELETE")[0], 401)
        self.assertEqual(self.ask("/api/v1/jobs/" + job["id"], None, "DELETE", **self.rights)[0], 200)
        job = self.job_when(job, lambda job: job["state"] != "running")
        self.assertEqual((job["state"], job["message"]), ("failed", "it was cancelled"))

        job = begun()
        station.process.kill()
        job = self.job_when(job, lambda job: job["state"] != "running")
        self.assertEqual(job["state"], "failed")
        self.assertIn('the sensor "roof" was lost meanwhile', job["message"])
        self.assertFalse(os.path.exists(self.page))

    def sound_of_wind(self, speed_m_s):
        """A microphone in a wind of this speed, which the sound card of tests/support delivers."""
        return Program(os.path.join(os.path.dirname(YURAGI), "yuragi-sim"), "microphone", "--listen", self.card, "--speed", str(speed_m_s),
                       "--turbulence", "0", "--exponent", "1.6", "--noise", "-120")

    def wait_for_speed(self, low_m_s, high_m_s):
        """A reading averages the sound of a second: it is there later than the wind."""
        hangs = time.monotonic() + HANG_S
        while not low_m_s < (json.loads(self.ask("/api/v1/status")[1])["sensors"][0]["speed_m_s"] or 0.0) < high_m_s:
            self.assertLess(time.monotonic(), hangs)
            time.sleep(0.1)

    def test_a_microphone_is_calibrated_while_it_runs(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.card = os.path.join(folder, "card")
        library = os.path.join(os.path.dirname(YURAGI), "../lib/libasound_module_pcm_windsim.so")
        cards = os.path.join(folder, "asound.conf")
        with open(cards, "w", encoding="utf-8") as file:
            file.write(f'pcm.default {{ type null }}\npcm_type.windsim {{ lib "{os.path.abspath(library)}" }}\n'
                       f'pcm.windmic {{ type windsim path "{self.card}" channels 1 rate 48000 }}\n')
        self.enterContext(unittest.mock.patch.dict(os.environ, ALSA_CONFIG_PATH=cards))
        microphone = '[[sensor]]\nname = "roof"\ndriver = "microphone"\ndevice = "windmic"\nnoise_floor = -150\n'
        with self.sound_of_wind(4):
            daemon = self.start_daemon_for_setup(microphone)
            listed = json.loads(self.ask("/api/v1/calibrations", **self.rights)[1])["sensors"][0]
            self.assertEqual([(way["calibration"], way["given"]) for way in listed["ways"]], [("microphone", "reference"), ("microphone", "speed")])
            self.assertEqual(listed["now"]["level_exponent"], 2.0)
            self.wait_for("/api/v1/status", 200, "not calibrated")
            self.wait_for_speed(1.7, 2.1)
            soft = self.calibrated(calibration="microphone", speed_m_s=4, for_s=5)
        self.assertIsNone(soft["after"], "one wind is not enough")
        with self.sound_of_wind(10):
            self.wait_for_speed(3.6, 4.3)
            loud = self.calibrated(calibration="microphone", speed_m_s=10, for_s=5)
            points = [one["points"][0] for one in (soft, loud)]
            text = " ".join(f"{point['measured_m_s']}:{point['true_m_s']}" for point in points)
            found = self.calibrated(calibration="microphone", points=text)
            self.assertAlmostEqual(found["after"]["level_exponent"], 1.6, delta=0.1)
            self.assertEqual(found["before"]["level_exponent"], 2.0)
            self.change_and_wait(daemon, "/roof/calibration", {key: found[key] for key in ("before", "after")})
            self.wait_for("/api/v1/status", 200, '"state": "live"')
            self.wait_for_speed(8.5, 11.5)
            self.assertNotIn("not calibrated", self.ask("/api/v1/status")[1])
            self.assertIn("calibrated on the page: level_gain = ", self.check_config().stdout)

            # The level is computed with the settings of the file, which must be those that the daemon has.
            with open(self.file, encoding="utf-8") as config:
                changed = config.read().replace("noise_floor = -150", "noise_floor = -140", 1)
            with open(self.file, "w", encoding="utf-8") as config:
                config.write(changed)
            code, answer = self.set_up("/roof/calibrate", {"calibration": "microphone", "speed_m_s": 4, "for_s": 5})
            self.assertEqual(code, 409)
            self.assertIn("start it again", answer["detail"])

    def test_nothing_is_calibrated_without_rights_or_with_a_mistake(self):
        self.start_daemon_for_setup('[[sensor]]\nname = "mast"\ndriver = "synthetic"\n')
        zero = {"calibration": "zero", "for_s": 5}
        kept = {"before": {"gain": 1}, "after": {"gain": 2}}
        for path, body, method in (("/mast/calibrate", zero, None), ("/mast/calibration", kept, None), ("/mast/calibration", None, "DELETE")):
            self.assertEqual(self.ask("/api/v1/sensors" + path, body, method)[0], 401, path)
            self.assertEqual(self.ask("/api/v1/sensors" + path, body, method, Origin="http://other.example", **self.rights)[0], 403, path)
        self.assertEqual(self.ask("/api/v1/calibrations")[0], 401)
        self.assertEqual(self.set_up("/roof/calibrate", zero)[0], 404)
        self.assertEqual(self.set_up("/--help/calibrate", zero)[0], 404)
        self.assertEqual(self.set_up("/mast/calibrate", {"calibration": "north", "reference": "roof"})[0], 404)
        self.assertEqual(self.set_up("/mast/calibrate", {"calibration": "microphone"})[0], 400)
        self.assertEqual(self.set_up("/mast/calibration", {"before": {"height": 0}, "after": {"height": 4}})[0], 409)
        self.assertEqual(self.set_up("/mast/calibration", {"before": {"gain": 1}, "after": {"gain": 1e9}})[0], 409)
        self.assertFalse(os.path.exists(self.page))

    def test_a_damaged_file_of_the_page_is_left_out_and_said(self):
        daemon = self.start_daemon_for_setup('[[sensor]]\nname = "mast"\ndriver = "synthetic"\n')
        self.change_and_wait(daemon, "", {"name": "roof", "driver": "synthetic"})
        self.assertEqual(self.sensors(), ["mast", "roof"])
        daemon.end()
        with open(self.page, "a", encoding="utf-8") as page:
            page.write("[[alert]]\nname = 'a'\ncommand = 'touch /tmp/owned'\n")
        daemon = self.start_daemon_with(self.file)
        self.assertEqual(self.sensors(), ["mast"])
        self.wait_for("/healthz", 503, r"what the page has set up is left out: .*page\.toml:\d+:\d+: alert: is not for the page")
        checked = subprocess.run([YURAGI, "check-config", self.file], capture_output=True, text=True, check=True)
        self.assertIn("is left out", checked.stderr)

    def test_a_daemon_that_is_killed_while_a_sensor_is_added_has_all_of_it_or_nothing(self):
        whole = "# The sensors"
        for wait_s in (0, 0.002, 0.005, 0.01, 0.02):
            daemon = self.start_daemon_for_setup()
            body = json.dumps({"name": "roof", "driver": "synthetic"}).encode()
            address = urllib.parse.urlsplit(self.base).netloc
            with socket.create_connection(address.split(":")) as client:
                client.sendall((f"POST /api/v1/sensors HTTP/1.1\r\nHost: {address}\r\nContent-Type: application/json\r\n"
                                f"Authorization: {self.rights['Authorization']}\r\nContent-Length: {len(body)}\r\n\r\n").encode() + body)
                time.sleep(wait_s)
                daemon.process.kill()
                daemon.process.wait()
            if os.path.exists(self.page):
                with open(self.page, encoding="utf-8") as page:
                    text = page.read()
                self.assertTrue(text.startswith(whole) and text.endswith('driver = "synthetic"\n'), text)
            self.start_daemon_with(self.file)
            self.assertEqual(self.sensors(), ["roof"] if os.path.exists(self.page) else ["synthetic"])

    def test_what_cannot_be_opened_at_the_start_is_tried_again(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        token_file = os.path.join(folder, "token")
        with socket.create_server(("127.0.0.1", 0)) as other:
            address = "127.0.0.1:%d" % other.getsockname()[1]
            http = f'[http]\nlisten = "{address}"\ntoken_file = "{token_file}"\n'
            file = self.write_config(http + '[[sensor]]\nname = "roof"\ndriver = "synthetic"\n' + SMALL_MEADOW)
            daemon = self.enterContext(Program(YURAGI, "run", "--config", file, "--listen", "127.0.0.1:0"))
            daemon.wait_for(r"token_file: .* all changes are refused.* it is tried again")
            daemon.wait_for(r"the page and HTTP are not served: .*; it is tried again")
            stream = daemon.wait_for(r"listening on (\S+)").group(1)
            status = subprocess.run([YURAGI, "status", "--connect", stream], capture_output=True, text=True)
            self.assertEqual(status.returncode, 1, status.stdout + status.stderr)
            self.assertRegex(status.stdout, r"(?s)token_file: .*the page and HTTP are not served: ")
        self.base = daemon.wait_for(r"answering at (http://\S+)").group(1)
        hide = {"scene": "meadow", "shown": False, "over_s": 0}
        self.assertEqual(self.ask("/api/v1/scenes", hide)[0], 401, "nobody has the token")
        subprocess.run([YURAGI, "token", "--config", file, "--new"], capture_output=True, check=True)
        daemon.wait_for(r"the token in .* is valid from now on")
        self.wait_for("/healthz", 200, "all is well")
        with open(token_file, encoding="ascii") as secret_file:
            bearer = "Bearer " + secret_file.read().strip()
        self.assertEqual(self.ask("/api/v1/scenes", hide, Authorization=bearer)[0], 200)


if __name__ == "__main__":
    unittest.main()
