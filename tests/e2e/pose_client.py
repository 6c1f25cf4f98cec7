#!/usr/bin/python3
"""A client of Yuragi's stream that checks all that the schema promises. For your own program take config/examples/yuragi_client.py.

    pose_client.py                              watch 127.0.0.1:7410, a line a second
    pose_client.py --frames 300 --check --json  take 300 frames, verify them, print a summary; exit 0 or 1

It knows nothing but the schema, engine/wire/pose.fbs. Messages are read by modules that flatc makes of it (python3-flatbuffers),
skeletons and poses by yuragi_client.py, which has a reader of its own: both are checked.
Debian packages: python3-flatbuffers python3-numpy flatbuffers-compiler.
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

import numpy as np

PROJECT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(PROJECT / "config" / "examples"))
import yuragi_client  # noqa: E402
from yuragi_client import MAX_MESSAGE_BYTES, PROTOCOL, Bends, Cloth, Strands, Surface, Sways, Tree  # noqa: E402

SCHEMA = PROJECT / "engine" / "wire" / "pose.fbs"


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
                raise EOFError("the daemon closed the connection")
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


def subscribe_message(
    poses=True,
    sensors=False,
    client="pose_client.py",
    raw_sensor=None,
    takes_new_scenes=False,
    scenes=(),
    every=1,
    rate_hz=0.0,
):
    """The one message that a client sends: what it wants to see. raw_sensor: the sensor whose raw messages it wants; "": all.
    takes_new_scenes: it does not mind that Scenes comes again; otherwise the daemon ends the connection when the scenes change.
    scenes, every, rate_hz: of these scenes alone, every so many-th strand, at most so many frames a second; as they are: all."""
    return yuragi_client.encode(
        "Subscribe",
        protocol=PROTOCOL,
        poses=poses,
        sensors=sensors,
        client=client,
        raw=raw_sensor is not None,
        raw_sensor=raw_sensor or "",
        takes_new_scenes=takes_new_scenes,
        scenes=list(scenes),
        every=every,
        rate_hz=rate_hz,
    )


def control_message(scene, shown=True, hide_others=False, over_s=2.0):
    """The wish to show or hide a scene; to be sent at any time after subscribe_message()."""
    return yuragi_client.encode("Control", scene=scene, shown=shown, hide_others=hide_others, over_s=over_s)


def body_of(message):
    """The message's body as (name, table), or (None, None) for a kind that this schema does not have."""
    from yuragi.stream import ControlReply, Frame, Hello, RawTrace, Scenes, Sensors
    from yuragi.stream.Body import Body

    kinds = {
        Body.Hello: ("Hello", Hello.Hello),
        Body.Scenes: ("Scenes", Scenes.Scenes),
        Body.Frame: ("Frame", Frame.Frame),
        Body.Sensors: ("Sensors", Sensors.Sensors),
        Body.ControlReply: ("ControlReply", ControlReply.ControlReply),
        Body.RawTrace: ("RawTrace", RawTrace.RawTrace),
    }
    if message.BodyType() not in kinds:
        return None, None
    name, table_class = kinds[message.BodyType()]
    table = table_class()
    table.Init(message.Body().Bytes, message.Body().Pos)
    return name, table


# ---- What the numbers mean: config/examples/yuragi_client.py has the kinematics ----


def same_table(name, table):
    """A table of flatc's modules as one of yuragi_client's."""
    return yuragi_client.Table(name, table._tab.Bytes, table._tab.Pos)


def read_scenes(table):
    """The Scenes message as [(name, kind, model)]; None in place of a model of a kind that this client does not know."""
    return yuragi_client.read_scenes(same_table("Scenes", table))


def read_pose(scene_pose):
    """A ScenePose as Bends, Ways, Sways or Displacements; None for a kind that this client does not know, and for a scene that
    is hidden."""
    return yuragi_client.read_pose(same_table("ScenePose", scene_pose))


def is_unit(vectors):
    return bool(np.allclose(np.linalg.norm(vectors, axis=1), 1.0, atol=1e-3))


def strand_faults(strands):
    across = np.abs(np.sum(strands.rest * strands.curl, axis=1))
    if not is_unit(strands.rest) or not is_unit(strands.curl):
        yield "rest or curl is no unit vector"
    if not np.all(across < 1e-3):
        yield "curl is not across rest"
    if not np.all(np.isfinite(strands.root_m)):
        yield "a root is not finite"
    if not np.all(strands.link_length_m > 0.0):
        yield "a link has no length"


def cloth_faults(cloth):
    if len(cloth.rest_m) != cloth.nodes:
        yield "its arrays have not columns * rows joints"
    if not np.all(np.isfinite(cloth.rest_m)):
        yield "a joint is not finite"


def tree_faults(tree):
    for number, level in enumerate(tree.levels):
        yield from strand_faults(level.strands)
        if level.radius_m.shape != (2, level.strands.count) or not np.all(level.radius_m >= 0.0):
            yield "radii are missing or below 0"
        if number == 0:
            continue
        if level.parent_level >= number or len(level.parent) != level.strands.count:
            yield "a level does not grow on an earlier one"
            continue
        parents = tree.levels[level.parent_level].strands
        if not np.all((level.parent < parents.count) & (level.parent_link < parents.links)):
            yield "a strand grows on a link that is not there"


def surface_faults(surface):
    if len(surface.rest_m) != surface.nodes or len(surface.normal) != surface.nodes:
        yield "its arrays have not columns * rows points"
    if not is_unit(surface.normal):
        yield "a normal is no unit vector"
    if surface.shells < 1 or surface.columns % surface.shells:
        yield "its columns are no whole rings"
    if len(surface.axis_m) not in (0, surface.rows):
        yield "its axis has not as many points as there are rows"
    if len(surface.ramp_rgba) not in (0, 256):
        yield f"the ramp has {len(surface.ramp_rgba)} colours"


FAULTS = {Strands: strand_faults, Cloth: cloth_faults, Tree: tree_faults, Surface: surface_faults}


def pose_faults(model, pose):
    joints_m = model.joints_m(pose)
    if not np.all(np.isfinite(joints_m)):
        yield "a joint is not finite"
    if isinstance(model, Strands):
        reach_m = np.linalg.norm(joints_m[model.links - 1 :: model.links] - model.root_m, axis=1)
        if not np.all(reach_m <= model.links * model.link_length_m * (1 + 1e-5)):
            yield "a strand has stretched"


# ---- What this program does with it ----


class Refused(EOFError):
    """The daemon ends the connection, and says why."""


class Watcher:
    """Takes the messages in, keeps count, and notes what is not as it should be."""

    def __init__(self, check):
        self.check = check
        self.problems = []
        self.tick_rate_hz = 0.0
        self.scenes = None
        self.lists = 0  # of scenes that have come
        self.frames = 0
        self.bytes = 0
        self.missed = 0
        self.max_bend_rad = 0.0
        self.first = self.last = None  # (sequence, tick, time_s, when it arrived)
        self.first_bytes = 0
        self.wind = (0.0, 0.0)
        self.wind_place = (0.0, 0.0)  # (metres upwind of the middle, seconds until a gust is there)
        self.poses = []
        self.opacities = []

    def expect(self, condition, problem):
        if self.check and not condition and len(self.problems) < 20:
            self.problems.append(problem)

    def hello(self, hello):
        if hello.Refused() is not None:
            raise Refused("the daemon refuses the connection: " + hello.Refused().decode())
        if hello.Protocol() != PROTOCOL:
            older = "this client" if hello.Protocol() > PROTOCOL else "the daemon"
            raise EOFError(f"the daemon speaks protocol {hello.Protocol()}, this client protocol {PROTOCOL}: "
                           f"update {older}")
        self.expect(hello.TickRateHz() > 0.0, f"tick rate {hello.TickRateHz()} Hz")
        self.tick_rate_hz = hello.TickRateHz()

    def scenes_message(self, table):
        """Scenes may come again: each frame behind it is of the new ones."""
        self.lists += 1
        self.scenes = read_scenes(table)
        for name, _, model in self.scenes:
            if model is not None and self.check:
                for fault in FAULTS[type(model)](model):
                    self.expect(False, f"{name}: {fault}")

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
        # Absent where the server is older than this field: the wind is then in the middle.
        place = frame.WindPlace()
        self.wind_place = (place.UpwindM(), place.ToMiddleS()) if place is not None else (0.0, 0.0)
        self.expect(np.all(np.isfinite(self.wind_place)) and self.wind_place[1] >= 0.0, "the wind's place is none")

        # Dequantise every scene's pose. They pair with the skeletons of the Scenes message.
        self.expect(self.scenes is not None, "a Frame came before Scenes")
        scenes = self.scenes or []
        self.expect(frame.ScenesLength() == len(scenes), f"{frame.ScenesLength()} poses for {len(scenes)} scenes")
        self.poses = [read_pose(frame.Scenes(i)) for i in range(frame.ScenesLength())]
        self.opacities = [frame.Scenes(i).Opacity() for i in range(frame.ScenesLength())]
        for (name, _, model), pose, opacity in zip(scenes, self.poses, self.opacities):
            self.expect(0.0 <= opacity <= 1.0, f"{name}: an opacity of {opacity}")
            if model is None or pose is None:
                self.expect(model is None or opacity == 0.0, f"{name}: is seen, and has no pose")
                continue
            self.expect(model.fits(pose), f"{name}: pose and skeleton differ in length")
            if not model.fits(pose):
                continue
            for bends in pose.levels if isinstance(pose, Sways) else [pose] if isinstance(pose, Bends) else []:
                self.max_bend_rad = max(self.max_bend_rad, float(np.max(bends.angle_rad(), initial=0.0)))
            if self.check and self.frames % 60 == 1:
                for fault in pose_faults(model, pose):
                    self.expect(False, f"{name}: {fault}")

    def joints_m(self):
        """The joints of every scene that is known and seen in the last frame: {name: array of (x, y, z)}."""
        return {
            name: model.joints_m(pose)
            for (name, _, model), pose in zip(self.scenes, self.poses)
            if model is not None and pose is not None
        }

    def summary(self, subscribed_s):
        frames_s = self.last[3] - self.first[3] if self.last else 0.0
        stream_s = self.last[2] - self.first[2] if self.last else 0.0
        if stream_s > 0.0:
            rate_hz = (self.last[1] - self.first[1]) / stream_s
            self.expect(abs(rate_hz / self.tick_rate_hz - 1.0) < 0.01, f"ticks come at {rate_hz:.2f} Hz")
        latency_s = self.first[3] - subscribed_s if self.first else None
        models = [model for _, _, model in self.scenes or [] if model is not None]
        return {
            "frames": self.frames,
            "bytes": self.bytes,
            "payload_mbit_s": 8e-6 * (self.bytes - self.first_bytes) / frames_s if frames_s > 0.0 else None,
            "payload_mbit_s_at_tick_rate": 8e-6 * self.bytes / self.frames * self.tick_rate_hz if self.frames else None,
            "first_frame_latency_s": latency_s,
            "first_frame_latency_frames": latency_s * self.tick_rate_hz if latency_s is not None else None,
            "missed": self.missed,
            "lists_of_scenes": self.lists,
            "max_bend_rad": self.max_bend_rad,
            "tick_rate_hz": self.tick_rate_hz,
            "strands": sum(model.count for model in models if isinstance(model, Strands)),
            "nodes": sum(model.nodes for model in models),
            "wind_u_m_s": self.wind[0],
            "wind_v_m_s": self.wind[1],
            "wind_upwind_m": self.wind_place[0],
            "wind_to_middle_s": self.wind_place[1],
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
    parser.add_argument("--joints", action="store_true", help="print the first joints of the last frame")
    parser.add_argument("--old", action="store_true", help="do not take new scenes: connect again when they change")
    parser.add_argument("--scene", action="append", default=[], help="of this scene only; may be given again")
    parser.add_argument("--every", type=int, default=1, help="of strands, and a cloth's columns and rows, every so many-th")
    parser.add_argument("--rate", type=float, default=0.0, help="at most so many frames a second")
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
        wish = {"scenes": options.scene, "every": options.every, "rate_hz": options.rate}
        source.send(subscribe_message(takes_new_scenes=not options.old, **wish))
        subscribed_s = line_s = time.monotonic()
        line_frames = line_bytes = line_missed = 0
        stream = messages(source)
        while options.frames is None or watcher.frames < options.frames:
            message, size = next(stream)
            kind, table = body_of(message)
            now_s = time.monotonic()
            if kind == "Hello":
                try:
                    watcher.hello(table)
                except Refused:
                    if not (options.old and watcher.frames):
                        raise
                    # It was let go because the scenes have changed, perhaps: who connects again gets the new ones.
                    say("connecting again")
                    source = SocketBytes(options.connect, options.timeout)
                    source.send(subscribe_message(**wish))
                    stream = messages(source)
                    continue
                say(f"{table.Software().decode()}, {table.TickRateHz():g} Hz")
            elif kind == "Scenes":
                watcher.scenes_message(table)
                for name, scene_kind, model in watcher.scenes:
                    what = model.describe() if model else "not known here"
                    say(f"scene {name} ({scene_kind}): {what}")
            elif kind == "Frame":
                watcher.frame(table, size, now_s)
            # Anything else was not asked for, or is of a newer server.

            if now_s - line_s >= 1.0:
                rate = 8e-6 * (watcher.bytes - line_bytes) / (now_s - line_s)
                say(
                    f"{watcher.frames - line_frames} frames, {rate:.2f} Mbit/s, {watcher.missed - line_missed} missed, "
                    f"wind {watcher.wind[0]:+.2f} m/s east {watcher.wind[1]:+.2f} m/s north, "
                    f"in the middle in {watcher.wind_place[1]:.1f} s",
                    flush=True,
                )
                line_s, line_frames, line_bytes, line_missed = now_s, watcher.frames, watcher.bytes, watcher.missed
    except KeyboardInterrupt:
        pass
    except (OSError, EOFError, ValueError, struct.error) as error:
        ended_early = str(error) or type(error).__name__

    # A file ends by its nature; a server is asked for a number of frames, or watched until it goes.
    if ended_early is not None and not (options.file and options.frames is None):
        watcher.problems.append(ended_early)
    summary = watcher.summary(subscribed_s)
    if options.joints and watcher.scenes:
        for name, joints_m in watcher.joints_m().items():
            for x_m, y_m, z_m in joints_m[:10]:
                say(f"joint in {name}: x {x_m:+.4f} y {y_m:+.4f} z {z_m:+.4f} m")
    if options.json:
        print(json.dumps(summary, indent=2))
    else:
        say(f"{summary['frames']} frames, {summary['bytes']} bytes, {summary['missed']} missed")
        for problem in watcher.problems:
            print("pose_client.py:", problem, file=sys.stderr)
    return 1 if watcher.problems or watcher.frames == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
