"""Debian's nats-server on the loopback, a client of it in plain sockets, and a network before it that loses messages."""
import json
import os
import random
import signal
import socket
import threading

from programs import HANG_S, Program, free_port


class Server:
    """A nats-server, which a test can kill, hold up and start again at the same port. `more`: lines of its configuration."""

    def __init__(self, test, name, more="", scheme="nats", waits=True):
        self.test, self.name, self.port = test, name, free_port()
        self.address = f"{scheme}://127.0.0.1:{self.port}"
        self.file = os.path.join(test.folder, name + ".conf")
        with open(self.file, "w", encoding="utf-8") as file:
            # Such a server is left by its leaf nodes and its neighbours within 1.5 s when it hangs.
            file.write(f'host: "127.0.0.1"\nport: {self.port}\nserver_name: "{name}"\nlogtime: true\nping_interval: "500ms"\nping_max: 2\n{more}')
        test.servers.append(self)
        self.start(waits)

    def start(self, waits=True):
        self.program = self.test.enterContext(Program("nats-server", "-c", self.file))
        if waits:
            self.program.wait_for("Server is ready")

    def kill(self):
        self.program.end(signal.SIGKILL)

    def hold(self):
        """It hangs: its connections stay, and it sends nothing."""
        self.program.process.send_signal(signal.SIGSTOP)

    def go_on(self):
        self.program.process.send_signal(signal.SIGCONT)


class Cluster:
    """Three servers, and a leaf node that is connected to one of them. `more`: lines of each one's configuration. With `stores` each of
    the three has JetStream, and they have elected who places streams."""

    def __init__(self, test, more="", stores=False):
        routes, leaves = [free_port() for _ in range(3)], [free_port() for _ in range(3)]
        others = ", ".join(f'"nats://127.0.0.1:{port}"' for port in routes)
        self.nodes = [Server(test, f"node-{i}", f"""
leafnodes {{ listen: "127.0.0.1:{leaves[i]}" }}
cluster {{ name: "fleet", listen: "127.0.0.1:{routes[i]}", routes: [{others}], no_advertise: true }}
{more}""" + (f'jetstream {{ store_dir: "{test.folder}/node-{i}", max_mem: 0, max_file: 128MB }}\n' if stores else ""), waits=False) for i in range(3)]
        for node in self.nodes:
            node.program.wait_for("Server is ready")
        if stores:
            self.wait_for_election(test)
        # One entry with several addresses: two entries would be a loop.
        remotes = ", ".join(f'"nats://127.0.0.1:{port}"' for port in leaves)
        self.leaf = Server(test, "leaf", f"""
leafnodes {{ reconnect: 1, remotes: [{{ urls: [{remotes}] }}] }}
""")

    def wait_for_election(self, test):
        """The one that is elected logs it; others may not."""
        elected = threading.Event()

        def look(program):
            if program.wait_until(lambda text: "Self is new JetStream cluster metadata leader" in text):
                elected.set()
        for node in self.nodes:
            threading.Thread(target=look, args=(node.program,), daemon=True).start()
        test.assertTrue(elected.wait(HANG_S), test.logs())

    def addresses(self, first=0):
        """Of the nodes, in their order from this one on."""
        return ", ".join(self.nodes[(first + i) % 3].address for i in range(3))


class Stream:
    """The lines and payloads that NATS sends on a connection."""

    def __init__(self, source):
        self.file = source.makefile("rb")

    def next(self):
        """The words of a command, its payload, and both as they came; None at the end."""
        line = self.file.readline()
        if not line.endswith(b"\n"):
            return None
        words = line.split()
        payload = b""
        if words and words[0] in (b"MSG", b"HMSG"):
            payload = self.file.read(int(words[-1]) + 2)
        return words, payload[:-2], line + payload


class Client:
    """Whoever can reach the server. `login`: "user:password"."""

    def __init__(self, test, server, login=""):
        self.messages, self.errors, self.pongs = [], [], 0
        self.news = threading.Condition()
        self.socket = socket.create_connection(("127.0.0.1", server.port), HANG_S)
        test.addCleanup(self.socket.close)
        user, _, password = login.partition(":")
        options = {"verbose": False, "pedantic": False, "lang": "python", "version": "1", "name": "tests/fleet"}
        if login:
            options.update({"user": user, "pass": password})
        self.send(b"CONNECT " + json.dumps(options).encode() + b"\r\n")
        threading.Thread(target=self.read, args=(Stream(self.socket),), daemon=True).start()
        self.flush()

    def send(self, data):
        self.socket.sendall(data)

    def read(self, stream):
        """Keeps (subject, where a reply goes, payload) of each message."""
        try:
            while (command := stream.next()) is not None:
                words, payload, _ = command
                with self.news:
                    if words[:1] == [b"MSG"]:
                        reply_to = words[3].decode() if len(words) == 5 else ""
                        self.messages.append((words[1].decode(), reply_to, payload))
                    elif words[:1] == [b"-ERR"]:
                        self.errors.append(b" ".join(words[1:]).decode())
                    elif words[:1] == [b"PONG"]:
                        self.pongs += 1
                    elif words[:1] == [b"PING"]:
                        self.send(b"PONG\r\n")
                    self.news.notify_all()
        except (OSError, ValueError):
            return

    def wait_until(self, find):
        with self.news:
            if not self.news.wait_for(find, HANG_S):
                raise AssertionError(f"the server sent nothing of the kind; {len(self.messages)} messages, errors: {self.errors}")

    def flush(self):
        """Waits until the server has done everything that was sent."""
        with self.news:
            before = self.pongs
        self.send(b"PING\r\n")
        self.wait_until(lambda: self.pongs > before)

    def subscribe(self, subject):
        self.send(f"SUB {subject} {abs(hash(subject)) % 1000 + 1}\r\n".encode())
        self.flush()

    def publish(self, subject, payload, reply_to=""):
        self.send(f"PUB {subject} {reply_to} {len(payload)}\r\n".encode() + payload + b"\r\n")

    def kept(self, subject):
        """The messages of this subject so far."""
        with self.news:
            return [message for message in self.messages if message[0] == subject]


class LossyNetwork:
    """Passes connections on to a server, and loses some of its messages: those whose subject ends so, by chance."""

    def __init__(self, test, server, subject, seed):
        self.port, self.subject = server.port, subject.encode()
        self.chance, self.share = random.Random(seed), 0.0
        self.lost = self.passed = 0
        self.listener = socket.create_server(("127.0.0.1", 0))
        test.addCleanup(self.listener.close)
        self.address = "nats://127.0.0.1:%d" % self.listener.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            try:
                near = self.listener.accept()[0]
                far = socket.create_connection(("127.0.0.1", self.port))
            except OSError:
                return
            for one in (near, far):
                one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            threading.Thread(target=self.carry, args=(near, far), daemon=True).start()
            threading.Thread(target=self.carry_messages, args=(far, near), daemon=True).start()

    @staticmethod
    def close(*sockets):
        for one in sockets:
            try:
                one.shutdown(socket.SHUT_RDWR)
            except OSError:
                continue

    def carry(self, source, sink):
        try:
            while block := source.recv(65536):
                sink.sendall(block)
        except OSError:
            pass
        self.close(source, sink)

    def carry_messages(self, source, sink):
        stream = Stream(source)
        try:
            while (command := stream.next()) is not None:
                words, _, whole = command
                if words[:1] == [b"MSG"] and words[1].endswith(self.subject):
                    if self.chance.random() < self.share:
                        self.lost += 1
                        continue
                    self.passed += 1
                sink.sendall(whole)
        except OSError:
            pass
        self.close(source, sink)
