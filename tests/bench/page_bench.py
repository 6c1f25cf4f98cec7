#!/usr/bin/env python3
"""What many pages and pictures in browsers cost one daemon: lateness of its ticks and processor time, without any, with 64 pages, with
20 pictures as well, and without any again.

usage: page_bench.py FOLDER_OF_PROGRAMS [--seconds N] [--pages N] [--pictures N] [--every N]

A page reads its files and then the state twice a second by /ws; a picture reads every N-th pose as well. They are clients in another
process, which only count what comes: no browser draws.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

from feeds_bench import cpu_s, row, start_daemon, status, web_socket

HTTP = '[stream]\nlisten = "127.0.0.1:0"\n[http]\nlisten = "127.0.0.1:0"\n[[sensor]]\ndriver = "synthetic"\n'


class Clients:
    def __init__(self, url, pages, pictures, every):
        self.url, self.port = url, int(url.rsplit(":", 1)[1])
        self.bytes, self.messages, self.refused, self.lock = [0, 0], [0, 0], 0, threading.Lock()
        for wishes, is_picture in ((pages, False), (pictures, True)):
            for _ in range(wishes):
                threading.Thread(target=self.read, args=(is_picture, every), daemon=True).start()

    def read(self, is_picture, every):
        if not is_picture:
            for path in ("/", "/page.css", "/page.js"):
                urllib.request.urlopen(self.url + path).read()
        wish = {"status": 2, **({"stream": {"sensors": True, "every": every, "rate": 30}} if is_picture else {})}
        try:
            for payload in web_socket(self.port, "/ws", wish):
                with self.lock:
                    self.bytes[is_picture] += len(payload)
                    self.messages[is_picture] += 1
        except ConnectionError:
            with self.lock:
                self.refused += 1


def run_clients(arguments):
    """In a process of its own: prints bytes and messages a second, of pages and of pictures, and how many have no connection."""
    url, pages, pictures, every, seconds = arguments[0], *map(int, arguments[1:4]), float(arguments[4])
    clients = Clients(url, pages, pictures, every)
    time.sleep(seconds / 2)
    before = clients.bytes + clients.messages
    time.sleep(seconds / 2)
    print(*((now - then) / (seconds / 2) for now, then in zip(clients.bytes + clients.messages, before)), clients.refused)


def measure(options, yuragi, pages, pictures):
    with tempfile.TemporaryDirectory(prefix="yuragi-page-bench-") as folder:
        daemon, address = start_daemon(yuragi, folder, HTTP)
        url = daemon.wait_for(r"answering at (http://\S+)").group(1)
        began_s = cpu_s(daemon)
        clients = subprocess.run([sys.executable, __file__, "--clients", url, str(pages), str(pictures), str(options.every), str(options.seconds)],
                                 stdout=subprocess.PIPE, check=True, text=True).stdout.split()
        state = status(yuragi, address)
        lateness = state["tick_lateness"]
        page_bytes, picture_bytes, page_messages, picture_messages, refused = map(float, clients)
        row(pages, pictures, f"{1e3 * lateness['p50_s']:.2f}", f"{1e3 * lateness['p99_s']:.2f}", state["recent_skipped_ticks"],
            f"{60 * (cpu_s(daemon) - began_s) / options.seconds:.1f}", f"{page_messages:.0f}", f"{page_bytes / 1e6:.2f}",
            f"{picture_messages:.0f}", f"{picture_bytes / 1e6:.2f}", f"{refused:.0f}")
        daemon.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--pages", type=int, default=64)
    parser.add_argument("--pictures", type=int, default=20)
    parser.add_argument("--every", type=int, default=2)
    options = parser.parse_args()
    yuragi = os.path.join(os.path.abspath(options.programs), "yuragi")
    row("pages", "pictures", "lateness of ticks: p50, ms", "p99, ms", "skipped", "CPU s a minute", "pages: messages/s", "MB/s",
        "pictures: messages/s", "MB/s", "refused")
    row(*11 * ["---"])
    for pages, pictures in ((0, 0), (options.pages, 0), (options.pages, options.pictures), (0, 0)):
        measure(options, yuragi, pages, pictures)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--clients"]:
        run_clients(sys.argv[2:])
    else:
        main()
