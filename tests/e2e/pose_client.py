#!/usr/bin/python3
"""A small client of Yuragi's stream, in Python: an example to copy from, and an independent check of the stream.

    pose_client.py                              watch 127.0.0.1:7410, a line a second
    pose_client.py --frames 300 --check --json  take 300 frames, verify them, print a summary; exit 0 or 1

It knows nothing but the schema, engine/wire/pose.fbs: flatc makes Python modules of it, python3-flatbuffers reads them, and
the comments in the schema say what the numbers mean. Debian packages: python3-flatbuffers python3-numpy flatbuffers-compiler.
"""

import argparse
import json
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import time

import flatbuffers
import numpy as np

PROTOCOL = 1
MAX_MESSAGE_BYTES = 256 << 20
SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "engine" / "wire" / "pose.fbs"


def load_schema(folder=None):
    """Makes `yuragi.stream` importable: from `folder`, where flatc has been already, or by running flatc now."""
    if folder is None:
        temporary = tempfile.TemporaryDirectory()
        load_schema.keep = temporary  # removed when the program ends
        folder = temporary.name
        subprocess.run(["flatc", "--python", "-o", folder, str(SCHEMA)], check=True)
    sys.path.insert(0, str(folder))


# ---- The transport: a u32 little-endian byte count, then that many bytes of a FlatBuffer ----


class SocketBytes:
    """Bytes from a TCP connection."""

    def __init__(self, address, timeout_s):
        host, _, port = address.rpartition(":")
        self.socket = socket.create_connection((host.strip("[]"), int(port)), timeout_s)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def read(self, count):
        data = bytearray(count)
        view = memoryview(data)
        while view:
            received = self.socket.recv_into(view)
            if received == 0:
                raise EOFError("the server closed the connection")
            view = view[received:]
        return data

    def send(self, data):
        self.socket.sendall(data)


class FileBytes:
    """Bytes from a file that holds a stream as it went over the wire."""

    def __init__(self, path):
        self.file = open(path, "rb")

    def read(self, count):
        data = self.file.read(count)
        if len(data) < count:
            raise EOFError("the file ends")
        return data

    def send(self, data):
        pass


def messages(source):
    """Yields (message, its bytes on the wire), one after the other. `message` is the schema's root table."""
    from yuragi.stream.Message import Message

    while True:
        (size,) = struct.unpack("<I", source.read(4))
        # Refuse what is absurd before making room for it.
        if not 8 <= size <= MAX_MESSAGE_BYTES:
            raise ValueError(f"a message of {size} bytes")
        body = source.read(size)
        if not Message.MessageBufferHasIdentifier(body, 0):
            raise ValueError("not a Yuragi message: the file identifier is missing")
        yield Message.GetRootAs(body, 0), 4 + size


def subscribe_message(poses=True, sensors=False, client="pose_client.py"):
    """The one message that a client sends: what it wants to see."""
    from yuragi.stream import Body, Message, Subscribe

    builder = flatbuffers.Builder(256)
    name = builder.CreateString(client)
    Subscribe.Start(builder)
    Subscribe.AddProtocol(builder, PROTOCOL)
    Subscribe.AddPoses(builder, poses)
    Subscribe.AddSensors(builder, sensors)
    Subscribe.AddClient(builder, name)
    subscribe = Subscribe.End(builder)
    Message.Start(builder)
    Message.AddBodyType(builder, Body.Body.Subscribe)
    Message.AddBody(builder, subscribe)
    builder.FinishSizePrefixed(Message.End(builder), b"YURA")
    return bytes(builder.Output())


def body_of(message):
    """The message's body as (name, table), or (None, None) for a kind that this schema does not have."""
    from yuragi.stream import Frame, Hello, Scenes, Sensors
    from yuragi.stream.Body import Body

    kinds = {
        Body.Hello: ("Hello", Hello.Hello),
        Body.Scenes: ("Scenes", Scenes.Scenes),
        Body.Frame: ("Frame", Frame.Frame),
        Body.Sensors: ("Sensors", Sensors.Sensors),
    }
    if message.BodyType() not in kinds:
        return None, None
    name, table_class = kinds[message.BodyType()]
    table = table_class()
    table.Init(message.Body().Bytes, message.Body().Pos)
    return name, table


# ---- What the numbers mean ----


def numbers(array):
    """An array of the schema in double precision. flatbuffers says 0 for one that is absent, which is to say empty."""
    return np.zeros(0) if isinstance(array, int) else np.asarray(array, dtype=float)


def vectors(*components):
    """Three arrays of coordinates as one array of vectors."""
    return np.stack([numbers(component) for component in components], axis=1)


class Strands:
    """A StrandSkeleton: chains that stand somewhere, point somewhere at rest, and curl."""

    def __init__(self, table):
        self.links = table.LinksPerStrand()
        self.root_m = vectors(table.RootXMAsNumpy(), table.RootYMAsNumpy(), table.RootZMAsNumpy())
        self.rest = vectors(table.RestXAsNumpy(), table.RestYAsNumpy(), table.RestZAsNumpy())
        self.curl = vectors(table.CurlXAsNumpy(), table.CurlYAsNumpy(), table.CurlZAsNumpy())
        self.rest_curl_rad = numbers(table.RestCurlRadAsNumpy())
        self.link_length_m = numbers(table.LinkLengthMAsNumpy())

    @property
    def count(self):
        return len(self.root_m)

    def tips_m(self, bend_east_rad, bend_south_rad):
        """Where the tips are in a pose: the forward kinematics that the schema describes. World: x east, y up, z south."""
        # The axis of every turn is up x bend = (0, 1, 0) x (east, 0, south); any axis does for no bend.
        angle_rad = np.hypot(bend_east_rad, bend_south_rad)
        safe = np.where(angle_rad > 0.0, angle_rad, 1.0)
        axis = vectors(bend_south_rad / safe, np.zeros(self.count), -bend_east_rad / safe)

        tip_m = self.root_m.copy()
        for i in range(self.links):
            # Link i at rest, then turned by its share of the bend (Rodrigues' formula).
            curl_rad = (i * self.rest_curl_rad)[:, None]
            rest = self.rest * np.cos(curl_rad) + self.curl * np.sin(curl_rad)
            turn_rad = ((i + 1) / self.links * angle_rad)[:, None]
            along_axis = np.sum(axis * rest, axis=1)[:, None]
            link = (
                rest * np.cos(turn_rad)
                + np.cross(axis, rest) * np.sin(turn_rad)
                + axis * along_axis * (1.0 - np.cos(turn_rad))
            )
            tip_m += self.link_length_m[:, None] * link
        return tip_m


def read_scenes(table):
    """The Scenes message as [(name, kind, Strands)]; None in place of strands of a kind that this client does not know."""
    from yuragi.stream.Skeleton import Skeleton
    from yuragi.stream.StrandSkeleton import StrandSkeleton

    scenes = []
    for i in range(table.ScenesLength()):
        scene = table.Scenes(i)
        strands = None
        if scene.SkeletonType() == Skeleton.StrandSkeleton:
            skeleton = StrandSkeleton()
            skeleton.Init(scene.Skeleton().Bytes, scene.Skeleton().Pos)
            strands = Strands(skeleton)
        scenes.append((scene.Name().decode(), scene.Kind().decode(), strands))
    return scenes


def read_bends(scene_pose):
    """A ScenePose as (east, south) in radians, one value a strand; None for a kind that this client does not know."""
    from yuragi.stream.Pose import Pose
    from yuragi.stream.StrandPose import StrandPose

    if scene_pose.PoseType() != Pose.StrandPose:
        return None
    pose = StrandPose()
    pose.Init(scene_pose.Pose().Bytes, scene_pose.Pose().Pos)
    return pose.BendStepRad() * numbers(pose.BendEastAsNumpy()), pose.BendStepRad() * numbers(pose.BendSouthAsNumpy())


# ---- What this program does with it ----


class Watcher:
    """Takes the messages in, keeps count, and notes what is not as it should be."""

    def __init__(self, check):
        self.check = check
        self.problems = []
        self.tick_rate_hz = 0.0
        self.scenes = None
        self.frames = 0
        self.bytes = 0
        self.missed = 0
        self.max_bend_rad = 0.0
        self.first = self.last = None  # (sequence, tick, time_s, when it arrived)
        self.first_bytes = 0
        self.wind = (0.0, 0.0)
        self.bends = []

    def expect(self, condition, problem):
        if self.check and not condition and len(self.problems) < 20:
            self.problems.append(problem)

    def hello(self, hello):
        if hello.Refused() is not None:
            raise EOFError("the server refuses: " + hello.Refused().decode())
        self.expect(hello.Protocol() == PROTOCOL, f"protocol {hello.Protocol()}")
        self.expect(hello.TickRateHz() > 0.0, f"tick rate {hello.TickRateHz()} Hz")
        self.tick_rate_hz = hello.TickRateHz()

    def scenes_message(self, table):
        self.expect(self.scenes is None, "Scenes came twice")
        self.scenes = read_scenes(table)
        for name, _, strands in self.scenes:
            if strands is None or not self.check:
                continue
            across = np.abs(np.sum(strands.rest * strands.curl, axis=1))
            self.expect(np.allclose(np.linalg.norm(strands.rest, axis=1), 1.0, atol=1e-3), f"{name}: rest is no unit vector")
            self.expect(np.allclose(np.linalg.norm(strands.curl, axis=1), 1.0, atol=1e-3), f"{name}: curl is no unit vector")
            self.expect(np.all(across < 1e-3), f"{name}: curl is not across rest")
            self.expect(np.all(np.isfinite(strands.root_m)), f"{name}: a root is not finite")
            self.expect(np.all(strands.link_length_m > 0.0), f"{name}: a link has no length")

    def frame(self, frame, size, now_s):
        here = (frame.Sequence(), frame.Tick(), frame.TimeS(), now_s)
        if self.last is None:
            self.first, self.first_bytes = here, size
        else:
            self.expect(here[0] > self.last[0], f"sequence {self.last[0]} was followed by {here[0]}")
            self.expect(here[1] > self.last[1], f"tick {self.last[1]} was followed by {here[1]}")
            self.expect(here[2] > self.last[2], f"time {self.last[2]} s was followed by {here[2]} s")
            self.missed += max(0, here[0] - self.last[0] - 1)
        self.last = here
        self.frames += 1
        self.bytes += size
        self.wind = (frame.Wind().UMS(), frame.Wind().VMS())
        self.expect(np.all(np.isfinite(self.wind)), "the wind is not finite")

        # Dequantise every scene's bends. They pair with the skeletons of the Scenes message.
        self.expect(self.scenes is not None, "a Frame came before Scenes")
        scenes = self.scenes or []
        self.expect(frame.ScenesLength() == len(scenes), f"{frame.ScenesLength()} poses for {len(scenes)} scenes")
        self.bends = [read_bends(frame.Scenes(i)) for i in range(frame.ScenesLength())]
        for (name, _, strands), bend in zip(scenes, self.bends):
            if strands is None or bend is None:
                continue
            self.expect(len(bend[0]) == len(bend[1]) == strands.count, f"{name}: pose and skeleton differ in length")
            if len(bend[0]) == len(bend[1]) == strands.count > 0:
                self.max_bend_rad = max(self.max_bend_rad, float(np.max(np.hypot(*bend))))
                if self.check and self.frames % 60 == 1:
                    self.check_tips(name, strands, bend)

    def check_tips(self, name, strands, bend):
        reach_m = np.linalg.norm(strands.tips_m(*bend) - strands.root_m, axis=1)
        self.expect(np.all(reach_m <= strands.links * strands.link_length_m * (1 + 1e-5)), f"{name}: a strand has stretched")

    def tips_m(self):
        """The tips of every known scene in the last frame: {name: array of (x, y, z)}."""
        return {
            name: strands.tips_m(*bend)
            for (name, _, strands), bend in zip(self.scenes, self.bends)
            if strands is not None and bend is not None
        }

    def summary(self, subscribed_s):
        frames_s = self.last[3] - self.first[3] if self.last else 0.0
        stream_s = self.last[2] - self.first[2] if self.last else 0.0
        if stream_s > 0.0:
            rate_hz = (self.last[1] - self.first[1]) / stream_s
            self.expect(abs(rate_hz / self.tick_rate_hz - 1.0) < 0.01, f"ticks come at {rate_hz:.2f} Hz")
        latency_s = self.first[3] - subscribed_s if self.first else None
        strands = [s for _, _, s in self.scenes or [] if s is not None]
        return {
            "frames": self.frames,
            "bytes": self.bytes,
            "payload_mbit_s": 8e-6 * (self.bytes - self.first_bytes) / frames_s if frames_s > 0.0 else None,
            "payload_mbit_s_at_tick_rate": 8e-6 * self.bytes / self.frames * self.tick_rate_hz if self.frames else None,
            "first_frame_latency_s": latency_s,
            "first_frame_latency_frames": latency_s * self.tick_rate_hz if latency_s is not None else None,
            "missed": self.missed,
            "max_bend_rad": self.max_bend_rad,
            "tick_rate_hz": self.tick_rate_hz,
            "strands": sum(s.count for s in strands),
            "nodes": sum(s.count * s.links for s in strands),
            "wind_u_m_s": self.wind[0],
            "wind_v_m_s": self.wind[1],
            "problems": self.problems,
        }


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--connect", default="127.0.0.1:7410", metavar="HOST:PORT")
    parser.add_argument("--file", help="read a captured stream from here instead")
    parser.add_argument("--schema", help="folder of the modules that flatc --python made; without it, flatc is run")
    parser.add_argument("--frames", type=int, help="end after this many frames")
    parser.add_argument("--timeout", type=float, default=10.0, help="seconds without any message that end it (10)")
    parser.add_argument("--check", action="store_true", help="verify everything that the schema promises")
    parser.add_argument("--tips", action="store_true", help="print the first tips of the last frame")
    parser.add_argument("--json", action="store_true", help="print a summary in JSON and nothing else")
    return parser.parse_args()


def main():
    options = parse_arguments()
    load_schema(options.schema)
    say = (lambda *_, **__: None) if options.json else print
    watcher = Watcher(options.check)
    ended_early = None
    subscribed_s = time.monotonic()
    try:
        source = FileBytes(options.file) if options.file else SocketBytes(options.connect, options.timeout)
        source.send(subscribe_message())
        subscribed_s = line_s = time.monotonic()
        line_frames = line_bytes = line_missed = 0
        for message, size in messages(source):
            kind, table = body_of(message)
            now_s = time.monotonic()
            if kind == "Hello":
                watcher.hello(table)
                say(f"{table.Software().decode()}, {table.TickRateHz():g} Hz")
            elif kind == "Scenes":
                watcher.scenes_message(table)
                for name, scene_kind, strands in watcher.scenes:
                    what = f"{strands.count} strands of {strands.links} links" if strands else "not known here"
                    say(f"scene {name} ({scene_kind}): {what}")
            elif kind == "Frame":
                watcher.frame(table, size, now_s)
            # Anything else was not asked for, or is of a newer server.

            if now_s - line_s >= 1.0:
                rate = 8e-6 * (watcher.bytes - line_bytes) / (now_s - line_s)
                say(
                    f"{watcher.frames - line_frames} frames, {rate:.2f} Mbit/s, {watcher.missed - line_missed} missed, "
                    f"wind {watcher.wind[0]:+.2f} m/s east {watcher.wind[1]:+.2f} m/s north",
                    flush=True,
                )
                line_s, line_frames, line_bytes, line_missed = now_s, watcher.frames, watcher.bytes, watcher.missed
            if options.frames is not None and watcher.frames >= options.frames:
                break
    except KeyboardInterrupt:
        pass
    except (OSError, EOFError, ValueError, struct.error) as error:
        ended_early = str(error) or type(error).__name__

    # A file ends by its nature; a server is asked for a number of frames, or watched until it goes.
    if ended_early is not None and not (options.file and options.frames is None):
        watcher.problems.append(ended_early)
    summary = watcher.summary(subscribed_s)
    if options.tips and watcher.scenes:
        for name, tips_m in watcher.tips_m().items():
            for tip_m in tips_m[:10]:
                say(f"tip in {name}: x {tip_m[0]:+.4f} y {tip_m[1]:+.4f} z {tip_m[2]:+.4f} m")
    if options.json:
        print(json.dumps(summary, indent=2))
    else:
        say(f"{summary['frames']} frames, {summary['bytes']} bytes, {summary['missed']} missed")
        for problem in watcher.problems:
            print("pose_client.py:", problem, file=sys.stderr)
    return 1 if watcher.problems or watcher.frames == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
