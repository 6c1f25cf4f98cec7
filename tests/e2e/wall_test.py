#!/usr/bin/env python3
"""The picture alone, /wall, in Chromium: gives wall_test.mjs ports of its own, and runs it. Exit code 77: what it needs is not there.

usage: wall_test.py FOLDER_OF_PROGRAMS FOLDER_OF_BROWSER_TOOLS FOLDER_OF_SCREENSHOTS
"""
import os
import shutil
import socket
import subprocess
import sys

from programs import free_ports

CHROMIUM = "/usr/bin/chromium"
here = os.path.dirname(os.path.abspath(__file__))
programs, tools, screenshots = (os.path.abspath(path) for path in sys.argv[1:])
needed = (CHROMIUM, os.path.join(tools, "node_modules/playwright-core"), os.path.join(programs, "../share/yuragi/wall/viewer.wasm"))
missing = [path for path in needed if not os.path.exists(path)]
if missing or not shutil.which("node"):
    print("skipped: not there:", *(missing or ["node"]), "(config/setup.sh --test installs it; the viewer takes emscripten)")
    sys.exit(77)
ports = free_ports([socket.SOCK_STREAM] * 4)
garden = os.path.join(here, "../../config/garden.toml")
command = ["node", os.path.join(here, "wall_test.mjs"), CHROMIUM, programs, tools, screenshots, garden, *map(str, ports)]
sys.exit(subprocess.run(command, check=False).returncode)
