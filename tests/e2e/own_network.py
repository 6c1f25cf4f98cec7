"""Runs a test again in a network of its own, in which the ports that a protocol or a document fixes are free."""
import fcntl
import os
import shutil
import socket
import struct
import subprocess
import sys

INSIDE = "YURAGI_TEST_IN_OWN_NETWORK"


def enter(*more, needs=()):
    """Runs this program again in a network namespace in which only the loopback is, and in namespaces of the kinds `more`. Returns ""
    there. Returns the reason if the system does not allow it, or if it lacks one of the programs `needs`."""
    script = os.path.realpath(sys.argv[0])
    if os.environ.get(INSIDE) == script:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:  # ip link set lo up
            fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh14x", b"lo", 0x1 | 0x40))  # SIOCSIFFLAGS, IFF_UP | IFF_RUNNING
        return ""
    missing = [name for name in ("unshare", *needs) if not shutil.which(name)]
    if missing:
        return f"not installed: {', '.join(missing)} (config/setup.sh --test installs it)"
    unshare = ["unshare", "--map-root-user", "--net", *(f"--{kind}" for kind in more)]
    if subprocess.run([*unshare, "true"], stderr=subprocess.DEVNULL, check=False).returncode != 0:
        return "the system allows no networks of its own"
    os.environ[INSIDE] = script
    os.execvp("unshare", [*unshare, sys.executable, *sys.argv])
