"""Sends the wind by OSC as `/wind SPEED DIRECTION` (m/s, degrees where it comes from): wind_to_osc.py [TO:PORT [DAEMON:PORT]]"""
import contextlib
import signal
import socket
import struct
import sys

from yuragi_client import Client, from_deg, speed_m_s, split_address

receiver = split_address(sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1:9000")
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
out.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
signal.signal(signal.SIGINT, signal.SIG_DFL)
for frame in Client(*sys.argv[2:3], wind=True, name="wind_to_osc.py").frames():
    with contextlib.suppress(OSError):  # a receiver that cannot be reached misses this one
        out.sendto(b"/wind\0\0\0,ff\0" + struct.pack(">ff", speed_m_s(frame.wind), from_deg(frame.wind)), receiver)
