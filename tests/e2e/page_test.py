#!/usr/bin/env python3
"""The daemon's page in Chromium: gives page_test.mjs ports of its own, and runs it. Exit code 77: what it needs is not there.

usage: page_test.py FOLDER_OF_PROGRAMS FOLDER_OF_BROWSER_TOOLS FOLDER_OF_SCREENSHOTS
"""
import os
import shutil
import socket
import subprocess
import sys

from programs import free_ports

CHROMIUM = "/usr/bin/chromium"
programs, tools, screenshots = (os.path.abspath(path) for path in sys.argv[1:])
missing = [path for path in (CHROMIUM, *(os.path.join(tools, "node_modules", name) for name in ("playwright-core", "axe-core", "p5")))
           if not os.path.exists(path)]
if missing or not shutil.which("node"):
    print("skipped: not there:", *(missing or ["node"]), "(config/setup.sh --test installs it)")
    sys.exit(77)
ports = free_ports([socket.SOCK_STREAM] * 10)
script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "page_test.mjs")
sys.exit(subprocess.run(["node", script, CHROMIUM, programs, tools, screenshots, *map(str, ports)], check=False).returncode)
