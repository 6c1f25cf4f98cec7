"""A network between a program and its server that delays the server's bytes."""
import socket
import threading
import time


class SlowNetwork:
    """Passes a TCP connection on, and delays each block of the server's bytes by delay_s(). In order: a
    late block holds up those behind it."""

    def __init__(self, to, delay_s):
        self.to, self.delay_s = to, delay_s
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.listener.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        near = self.listener.accept()[0]
        host, port = self.to.rsplit(":", 1)
        far = socket.create_connection((host, int(port)))
        threading.Thread(target=self.carry, args=(near, far, lambda: 0.0), daemon=True).start()
        self.carry(far, near, self.delay_s)

    @staticmethod
    def carry(source, sink, delay_s):
        waiting, news = [], threading.Condition()

        def write():
            while True:
                with news:
                    news.wait_for(lambda: waiting)
                    due_s, block = waiting.pop(0)
                time.sleep(max(0.0, due_s - time.monotonic()))  # the delay that is tested
                try:
                    sink.sendall(block)
                except OSError:
                    return
                if not block:
                    return

        threading.Thread(target=write, daemon=True).start()
        while True:
            try:
                block = source.recv(65536)
            except OSError:
                block = b""
            with news:
                waiting.append((time.monotonic() + delay_s(), block))
                news.notify()
            if not block:
                return
