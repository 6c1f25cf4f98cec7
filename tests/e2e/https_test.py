#!/usr/bin/env python3
"""The page by HTTPS: by the daemon itself, and behind nginx and Caddy as config/proxies has them. For each: the page with its policy,
the rights of another machine, a paired browser whose cookie is for TLS only, a WebSocket, and a recording byte for byte.

usage: https_test.py FOLDER_OF_PROGRAMS
"""
import http.client
import json
import os
import pathlib
import shutil
import socket
import ssl
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from programs import HANG_S, Program, free_port

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")
PROXIES = pathlib.Path(__file__).resolve().parents[2] / "config/proxies"
NGINX = shutil.which("nginx", path=os.environ["PATH"] + ":/usr/sbin")
NAME = "wall.museum.example"  # in config/proxies
RECORDING_ROWS = 20_000
COMPLETED = "wall-20260101T000000Z.windlog"
SCENE = '[[sensor]]\nname = "roof"\ndriver = "synthetic"\n[[scene]]\nname = "meadow"\nkind = "grass"\nblades_across = 20\nblades_deep = 20\n'
HIDE = {"scene": "meadow", "shown": False, "over_s": 0}


class Https(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.certificate, self.key = self.make_certificate("wall")

    def path(self, name):
        return os.path.join(self.folder, name)

    def make_certificate(self, name, days=30):
        files = self.path(name + ".pem"), self.path(name + ".key")
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", str(days),
                        "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost", "-out", files[0], "-keyout", files[1]],
                       check=True, capture_output=True)
        os.chmod(files[1], 0o640)
        return files

    def start_daemon(self, http="", recording=""):
        file = self.path("yuragi.toml")
        with open(file, "w", encoding="utf-8") as config:
            config.write(f'[http]\nlisten = "127.0.0.1:0"\n{http}{recording}{SCENE}')
        self.daemon = self.enterContext(Program(YURAGI, "run", "--config", file, "--listen", "127.0.0.1:0"))
        self.config = file
        return self.daemon.wait_for(r"answering at (https?)://127.0.0.1:(\d+)").groups()

    def start_recording_daemon(self, http=""):
        """With a token, and a completed recording."""
        table = self.path("table.csv")
        with open(table, "w", encoding="ascii") as rows:
            rows.write("time,speed,direction\n")
            rows.writelines(f"{1767225600 + i},3.{i % 10},200\n" for i in range(RECORDING_ROWS))
        subprocess.run([YURAGI, "import", table, "-o", self.path(COMPLETED)], check=True, capture_output=True)
        http += f'token_file = "{self.path("token")}"\n'
        with open(self.path("yuragi.toml"), "w", encoding="utf-8") as config:
            config.write("[http]\n" + http)
        subprocess.run([YURAGI, "token", "--config", self.path("yuragi.toml"), "--new"], check=True, capture_output=True)
        return self.start_daemon(http, f'[recording]\nfile = "{self.path("wall.windlog")}"\n')

    def context(self):
        return ssl.create_default_context(cafile=self.certificate)

    def ask(self, port, path, body=None, **fields):
        """Status, fields and body of an answer by TLS."""
        connection = http.client.HTTPSConnection("localhost", port, timeout=HANG_S, context=self.context())
        try:
            fields = {name.replace("_", "-"): value for name, value in fields.items()}
            data = None if body is None else json.dumps(body)
            connection.request("GET" if body is None else "POST", path, data, {"Content-Type": "application/json", **fields})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def open_web_socket(self, port, **fields):
        """The status of its answer, and the file of what comes behind it; the wish for the state has been sent."""
        connection = self.context().wrap_socket(self.enterContext(socket.create_connection(("localhost", port), HANG_S)), server_hostname="localhost")
        self.addCleanup(connection.close)
        more = "".join(f"{name}: {value}\r\n" for name, value in fields.items())
        connection.sendall(f"GET /ws HTTP/1.1\r\nHost: localhost:{port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n{more}"
                           "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode())
        answer = self.enterContext(connection.makefile("rb"))
        status = int(answer.readline().split()[1])
        while status == 101 and answer.readline().strip():
            pass
        if status == 101:
            wish = b'{"status": 2, "wind": 20}'
            connection.sendall(bytes([0x81, 0x80 | len(wish)]) + bytes(4) + wish)
        return status, answer

    def message_of(self, answer):
        """The next message of a WebSocket, in one frame."""
        _, size = answer.read(2)
        if size == 126:
            size = struct.unpack(">H", answer.read(2))[0]
        elif size == 127:
            size = struct.unpack(">Q", answer.read(8))[0]
        return answer.read(size)

    def check_what_goes_through(self, port):
        """Of start_recording_daemon(), for a client that has no rights before it is paired."""
        status, fields, page = self.ask(port, "/")
        self.assertEqual((status, fields["Content-Security-Policy"][:18]), (200, "default-src 'none'"))
        self.assertIn(b"<title>", page)
        for path, body in (("scenes", HIDE), ("log", None), ("recordings", None)):
            self.assertEqual(self.ask(port, "/api/v1/" + path, body)[0], 401, path)

        code = json.loads(subprocess.run([YURAGI, "token", "--config", self.config, "--json"], capture_output=True, check=True).stdout)["pairing_code"]
        status, fields, _ = self.ask(port, "/api/v1/pair", {"code": code}, Origin=f"https://localhost:{port}")
        self.assertEqual(status, 200)
        self.assertRegex(fields["Set-Cookie"], "^yuragi_session=.*; HttpOnly; SameSite=Strict; Secure$")
        session = fields["Set-Cookie"].split(";")[0]
        self.assertEqual(self.ask(port, "/api/v1/scenes", HIDE, Cookie=session, Origin=f"https://localhost:{port}")[0], 200)
        self.assertEqual(self.ask(port, "/api/v1/scenes", HIDE, Cookie=session, Origin="https://evil.example")[0], 403)

        with open(self.path(COMPLETED), "rb") as recording:
            whole = recording.read()
        self.assertGreater(len(whole), 512 * 1024)
        self.assertEqual(self.ask(port, "/api/v1/recordings/" + COMPLETED, Cookie=session)[2], whole)

        self.assertEqual(self.open_web_socket(port, Origin="https://evil.example")[0], 403)
        status, answer = self.open_web_socket(port, Origin=f"https://localhost:{port}")
        self.assertEqual(status, 101)
        self.assertTrue({"wind", "status"} & json.loads(self.message_of(answer)).keys())

    def check_rights_of_another_machine(self, port):
        """Of a daemon without a token, which lets this machine change something."""
        for spoofed in ({}, {"X_Forwarded_For": "127.0.0.1"}, {"Forwarded": "for=127.0.0.1"}):
            self.assertEqual(self.ask(port, "/api/v1/scenes", HIDE, **spoofed)[0], 401, spoofed)
        self.assertEqual(self.ask(port, "/api/v1/scenes")[0], 200)

    def wait_for_server(self, program, port):
        hangs = time.monotonic() + HANG_S
        while time.monotonic() < hangs and program.process.poll() is None:
            try:
                return socket.create_connection(("127.0.0.1", port), HANG_S).close()
            except ConnectionRefusedError:
                time.sleep(0.02)
        self.fail(f"{program.process.args} does not serve:\n{program.text()}")

    def changed(self, text, *pairs):
        """The snippet, for this test's files and ports."""
        for before, after in pairs:
            self.assertIn(before, text)
            text = text.replace(before, after)
        return text

    def start_nginx(self, daemon_port):
        port = free_port()
        folder = f"/etc/letsencrypt/live/{NAME}/"
        snippet = self.changed((PROXIES / "yuragi.nginx.conf").read_text(encoding="utf-8"),
                               ("listen 443 ssl;", f"listen 127.0.0.1:{port} ssl;"), (f"server_name {NAME};", "server_name localhost;"),
                               (folder + "fullchain.pem", self.certificate), (folder + "privkey.pem", self.key),
                               ("http://127.0.0.1:7480", f"http://127.0.0.1:{daemon_port}"))
        temporary = "".join(f"{kind}_temp_path {self.path(kind)};\n" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        user = "user root;\n" if os.geteuid() == 0 else ""
        with open(self.path("nginx.conf"), "w", encoding="utf-8") as config:
            config.write(f"{user}daemon off;\nmaster_process off;\npid {self.path('nginx.pid')};\nerror_log stderr;\nevents {{}}\n"
                         f"http {{\naccess_log off;\n{temporary}{snippet}\n}}\n")
        self.wait_for_server(self.enterContext(Program(NGINX, "-p", self.folder, "-e", "stderr", "-c", self.path("nginx.conf"))), port)
        return port

    def start_caddy(self, daemon_port):
        port = free_port()
        snippet = self.changed((PROXIES / "yuragi.Caddyfile").read_text(encoding="utf-8"),
                               (f"\n{NAME} {{\n", f"\nhttps://localhost:{port} {{\n\tbind 127.0.0.1\n\ttls {self.certificate} {self.key}\n"),
                               ("127.0.0.1:7480 {", f"127.0.0.1:{daemon_port} {{"))
        with open(self.path("Caddyfile"), "w", encoding="utf-8") as config:
            config.write("{\n\tadmin off\n\tauto_https off\n}\n" + snippet)
        home = {**os.environ, "HOME": self.folder, "XDG_DATA_HOME": self.folder, "XDG_CONFIG_HOME": self.folder}
        self.wait_for_server(self.enterContext(Program("caddy", "run", "--adapter", "caddyfile", "--config", self.path("Caddyfile"), env=home)), port)
        return port

    @unittest.skipUnless(NGINX, "nginx (Debian: nginx-light) is not installed")
    def test_nginx_as_the_guide_has_it(self):
        self.check_what_goes_through(self.start_nginx(self.start_recording_daemon()[1]))
        self.check_rights_of_another_machine(self.start_nginx(self.start_daemon()[1]))

    @unittest.skipUnless(shutil.which("caddy"), "caddy is not installed")
    def test_caddy_as_the_guide_has_it(self):
        self.check_what_goes_through(self.start_caddy(self.start_recording_daemon()[1]))
        self.check_rights_of_another_machine(self.start_caddy(self.start_daemon()[1]))

    def by_tls(self):
        return f'certificate = "{self.certificate}"\nkey = "{self.key}"\n'

    def test_the_daemon_serves_it_by_its_certificate(self):
        scheme, port = self.start_recording_daemon(self.by_tls())
        self.assertEqual(scheme, "https")
        self.check_what_goes_through(int(port))
        with open(self.config, encoding="utf-8") as config:
            text = config.read()
        with open(self.config, "w", encoding="utf-8") as config:
            config.write(text.replace("127.0.0.1:0", f"127.0.0.1:{port}"))
        sessions = json.loads(subprocess.run([YURAGI, "token", "--config", self.config, "--sessions", "--json"], capture_output=True, check=True).stdout)
        self.assertEqual(len(sessions["sessions"]), 1)

    def test_a_renewed_certificate_is_shown_after_a_reload(self):
        port = int(self.start_daemon(self.by_tls())[1])
        self.assertEqual(self.ask(port, "/healthz")[0], 200)
        before = ssl.get_server_certificate(("localhost", port))
        for made, used in zip(self.make_certificate("renewed"), (self.certificate, self.key)):
            os.replace(made, used)
        self.daemon.process.send_signal(1)  # SIGHUP
        hangs = time.monotonic() + HANG_S
        while ssl.get_server_certificate(("localhost", port)) == before and time.monotonic() < hangs:
            time.sleep(0.02)
        self.assertEqual(self.ask(port, "/healthz")[0], 200, "it is trusted by the new certificate alone")

    def test_a_certificate_that_cannot_be_used_is_named_and_tried_again(self):
        os.rename(self.key, self.key + ".away")
        http = self.by_tls()
        with open(self.path("yuragi.toml"), "w", encoding="utf-8") as config:
            config.write(f'[http]\nlisten = "127.0.0.1:0"\n{http}{SCENE}')
        daemon = self.enterContext(Program(YURAGI, "run", "--config", self.path("yuragi.toml"), "--listen", "127.0.0.1:0"))
        daemon.wait_for(r"the page and HTTP are not served: \[http\] key: .*wall.key. does not exist.*it is tried again")
        checked = subprocess.run([YURAGI, "check-config", self.path("yuragi.toml")], capture_output=True, text=True)
        self.assertNotEqual(checked.returncode, 0)
        self.assertRegex(checked.stderr, r"\[http\] key: .*wall.key. does not exist")
        for name, value, why in (("certificate", self.certificate, "[http] key: is missing"), ("key", self.key, "half.toml:2:7: http.key: needs the certificate")):
            with open(self.path("half.toml"), "w", encoding="utf-8") as config:
                config.write(f'[http]\n{name} = "{value}"\n')
            checked = subprocess.run([YURAGI, "check-config", self.path("half.toml")], capture_output=True, text=True)
            self.assertNotEqual(checked.returncode, 0)
            self.assertIn(why, checked.stderr)
        os.rename(self.key + ".away", self.key)
        daemon.wait_for(r"answering at https://")
        os.chmod(self.key, 0o644)
        checked = subprocess.run([YURAGI, "check-config", self.path("yuragi.toml")], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn("everybody on this machine can read", checked.stderr)

    def test_a_certificate_that_expires_soon_needs_attention(self):
        self.certificate, self.key = self.make_certificate("soon", 10)
        port = int(self.start_daemon(self.by_tls())[1])
        hangs = time.monotonic() + HANG_S
        text = b""
        while b"soon.pem" not in text and time.monotonic() < hangs:
            text = self.ask(port, "/healthz")[2]
        self.assertRegex(text.decode(), r"\[http\] certificate: .* expires on \d{4}-")


if __name__ == "__main__":
    unittest.main()
