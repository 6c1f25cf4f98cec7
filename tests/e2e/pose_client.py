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
    from yuragi.stream import Body, Message, Subscribe

    builder = flatbuffers.Builder(256)
    name = builder.CreateString(client)
    traced = builder.CreateString(raw_sensor or "")
    names = [builder.CreateString(scene) for scene in scenes]
    Subscribe.StartScenesVector(builder, len(names))
    for offset in reversed(names):
        builder.PrependUOffsetTRelative(offset)
    wanted = builder.EndVector()
    Subscribe.Start(builder)
    Subscribe.AddProtocol(builder, PROTOCOL)
    Subscribe.AddPoses(builder, poses)
    Subscribe.AddSensors(builder, sensors)
    Subscribe.AddClient(builder, name)
    Subscribe.AddRaw(builder, raw_sensor is not None)
    Subscribe.AddRawSensor(builder, traced)
    Subscribe.AddTakesNewScenes(builder, takes_new_scenes)
    Subscribe.AddScenes(builder, wanted)
    Subscribe.AddEvery(builder, every)
    Subscribe.AddRateHz(builder, rate_hz)
    subscribe = Subscribe.End(builder)
    Message.Start(builder)
    Message.AddBodyType(builder, Body.Body.Subscribe)
    Message.AddBody(builder, subscribe)
    builder.FinishSizePrefixed(Message.End(builder), b"YURA")
    return bytes(builder.Output())


def control_message(scene, shown=True, hide_others=False, over_s=2.0):
    """The wish to show or hide a scene; to be sent at any time after subscribe_message()."""
    from yuragi.stream import Body, Control, Message

    builder = flatbuffers.Builder(256)
    name = builder.CreateString(scene)
    Control.Start(builder)
    Control.AddScene(builder, name)
    Control.AddShown(builder, shown)
    Control.AddHideOthers(builder, hide_others)
    Control.AddOverS(builder, over_s)
    control = Control.End(builder)
    Message.Start(builder)
    Message.AddBodyType(builder, Body.Body.Control)
    Message.AddBody(builder, control)
    builder.FinishSizePrefixed(Message.End(builder), b"YURA")
    return bytes(builder.Output())


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


# ---- What the numbers mean ----


def numbers(array):
    """An array of the schema in double precision. flatbuffers says 0 for one that is absent, which is to say empty."""
    return np.zeros(0) if isinstance(array, int) else np.asarray(array, dtype=float)


def vectors(*components):
    """Three arrays of coordinates as one array of vectors."""
    return np.stack([numbers(component) for component in components], axis=1)


def is_unit(vectors_):
    return bool(np.allclose(np.linalg.norm(vectors_, axis=1), 1.0, atol=1e-3))


def turned(vectors_, axis, angle_rad):
    """Vectors turned about unit axes by angles (Rodrigues' formula)."""
    cos, sin = np.cos(angle_rad)[:, None], np.sin(angle_rad)[:, None]
    along = np.sum(axis * vectors_, axis=1)[:, None]
    return vectors_ * cos + np.cross(axis, vectors_) * sin + axis * along * (1.0 - cos)


class Bends:
    """A StrandPose: a vector (east, south) for each strand, in radians."""

    def __init__(self, table):
        self.east_rad = table.BendStepRad() * numbers(table.BendEastAsNumpy())
        self.south_rad = table.BendStepRad() * numbers(table.BendSouthAsNumpy())

    def __len__(self):
        return len(self.east_rad) if len(self.east_rad) == len(self.south_rad) else -1

    def angle_rad(self):
        return np.hypot(self.east_rad, self.south_rad)

    def axis(self):
        """up x bend = (0, 1, 0) x (east, 0, south), of length 1; any axis does for no bend."""
        angle_rad = self.angle_rad()
        safe = np.where(angle_rad > 0.0, angle_rad, 1.0)
        return np.stack([self.south_rad / safe, np.zeros(len(safe)), -self.east_rad / safe], axis=1)


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

    @property
    def nodes(self):
        return self.count * self.links

    def describe(self):
        return f"{self.count} strands of {self.links} links"

    def faults(self):
        across = np.abs(np.sum(self.rest * self.curl, axis=1))
        if not is_unit(self.rest) or not is_unit(self.curl):
            yield "rest or curl is no unit vector"
        if not np.all(across < 1e-3):
            yield "curl is not across rest"
        if not np.all(np.isfinite(self.root_m)):
            yield "a root is not finite"
        if not np.all(self.link_length_m > 0.0):
            yield "a link has no length"

    def fits(self, bends):
        return isinstance(bends, Bends) and len(bends) == self.count

    def joints_m(self, bends, root_m=None, root_turns=()):
        """Every joint in a pose, (links, strands, 3): the forward kinematics that the schema describes. World: x east, y up,
        z south. In a tree the roots are elsewhere, and first turned, by a list of (axis, angle)."""
        angle_rad, axis = bends.angle_rad(), bends.axis()
        at_m = (self.root_m if root_m is None else root_m).copy()
        joints_m = np.empty((self.links, self.count, 3))
        for i in range(self.links):
            # Link i at rest, turned with its root, then turned by its share of the bend.
            curl_rad = (i * self.rest_curl_rad)[:, None]
            link = self.rest * np.cos(curl_rad) + self.curl * np.sin(curl_rad)
            for turn_axis, turn_rad in root_turns:
                link = turned(link, turn_axis, turn_rad)
            link = turned(link, axis, (i + 1) / self.links * angle_rad)
            at_m += self.link_length_m[:, None] * link
            joints_m[i] = at_m
        return joints_m

    def points_m(self, bends):
        """The tips."""
        return self.joints_m(bends)[-1]

    def pose_faults(self, bends):
        reach_m = np.linalg.norm(self.points_m(bends) - self.root_m, axis=1)
        if not np.all(reach_m <= self.links * self.link_length_m * (1 + 1e-5)):
            yield "a strand has stretched"


class Ways:
    """A GridPose: how far each joint is from its place at rest, in metres."""

    def __init__(self, table):
        self.columns = table.Columns()
        step_m = table.StepM()
        self.offset_m = step_m * vectors(table.OffsetXAsNumpy(), table.OffsetYAsNumpy(), table.OffsetZAsNumpy())


class Cloth:
    """A GridSkeleton: rows of joints, the first of which is fixed."""

    def __init__(self, table):
        self.columns, self.rows = table.Columns(), table.Rows()
        self.is_first_column_fixed = table.IsFirstColumnFixed()
        self.rest_m = vectors(table.RestXMAsNumpy(), table.RestYMAsNumpy(), table.RestZMAsNumpy())
        self.nodes = self.columns * self.rows

    def describe(self):
        return f"a cloth of {self.columns} x {self.rows} joints"

    def faults(self):
        if len(self.rest_m) != self.nodes:
            yield "its arrays have not columns * rows joints"
        if not np.all(np.isfinite(self.rest_m)):
            yield "a joint is not finite"

    def fits(self, ways):
        return isinstance(ways, Ways) and ways.columns == self.columns and len(ways.offset_m) == self.nodes

    def points_m(self, ways):
        """Every joint, row after row."""
        return self.rest_m + ways.offset_m

    def pose_faults(self, ways):
        if not np.all(np.isfinite(ways.offset_m)):
            yield "an offset is not finite"


class Sways:
    """A TreePose: Bends for each level."""

    def __init__(self, table):
        self.levels = [Bends(table.Levels(i)) for i in range(table.LevelsLength())]


class Tree:
    """A TreeSkeleton: levels of strands that grow on the strands of earlier levels."""

    class Level:
        def __init__(self, table):
            self.strands = Strands(table.Strands())
            self.parent_level = table.ParentLevel()
            self.parent = numbers(table.ParentAsNumpy()).astype(int)
            self.parent_link = numbers(table.ParentLinkAsNumpy()).astype(int)
            self.is_turned_by_block = table.IsTurnedByBlock()
            self.is_leaves = table.IsLeaves()
            self.radius_m = np.stack([numbers(table.BaseRadiusMAsNumpy()), numbers(table.TipRadiusMAsNumpy())])

    def __init__(self, table):
        self.levels = [Tree.Level(table.Levels(i)) for i in range(table.LevelsLength())]
        self.nodes = sum(level.strands.nodes for level in self.levels)

    def describe(self):
        return "a tree of " + ", ".join(str(level.strands.count) for level in self.levels) + " strands"

    def faults(self):
        for number, level in enumerate(self.levels):
            yield from level.strands.faults()
            if level.radius_m.shape != (2, level.strands.count) or not np.all(level.radius_m >= 0.0):
                yield "radii are missing or below 0"
            if number == 0:
                continue
            if level.parent_level >= number or len(level.parent) != level.strands.count:
                yield "a level does not grow on an earlier one"
                continue
            parents = self.levels[level.parent_level].strands
            if not np.all((level.parent < parents.count) & (level.parent_link < parents.links)):
                yield "a strand grows on a link that is not there"

    def fits(self, sways):
        return (
            isinstance(sways, Sways)
            and len(sways.levels) == len(self.levels)
            and all(level.strands.fits(bends) for level, bends in zip(self.levels, sways.levels))
        )

    def points_m(self, sways):
        """The tips of every level, one after the other."""
        joints_m, turns = [], []
        for number, (level, bends) in enumerate(zip(self.levels, sways.levels)):
            if number == 0:
                turns.append([])
                joints_m.append(level.strands.joints_m(bends))
                continue
            # The turn of the link that each strand grows from; of the first strand of 16, where they share it.
            parents, parent_bends = self.levels[level.parent_level].strands, sways.levels[level.parent_level]
            strand = np.arange(level.strands.count)
            of = strand // 16 * 16 if level.is_turned_by_block else strand
            parent, link = level.parent[of], level.parent_link[of]
            share_rad = (link + 1) / parents.links * parent_bends.angle_rad()[parent]
            root_turns = [(axis[parent], angle[parent]) for axis, angle in turns[level.parent_level]]
            root_turns.append((parent_bends.axis()[parent], share_rad))
            turns.append(root_turns)
            root_m = joints_m[level.parent_level][level.parent_link, level.parent]
            joints_m.append(level.strands.joints_m(bends, root_m, root_turns))
        return np.concatenate([level[-1] for level in joints_m])

    def pose_faults(self, sways):
        if not np.all(np.isfinite(self.points_m(sways))):
            yield "a tip is not finite"


class Displacements:
    """A SurfacePose: how far each point is moved along its normal, in metres, and its colour on the ramp; and how far the points of
    each row are moved besides."""

    def __init__(self, table):
        self.displacement_m = table.StepM() * numbers(table.DisplacementAsNumpy())
        east, south, drop = (numbers(a) for a in (table.RowEastAsNumpy(), table.RowSouthAsNumpy(), table.RowDropAsNumpy()))
        self.row_m = table.StepM() * np.stack([east, -drop, south], axis=1)
        slopes = [numbers(a) for a in (table.RowSlopeEastAsNumpy(), table.RowSlopeSouthAsNumpy())]
        self.row_slope = table.SlopeStep() * np.stack(slopes, axis=1)
        self.heat = numbers(table.HeatAsNumpy()).astype(int)


class Surface:
    """A SurfaceSkeleton: points that move along their normals."""

    def __init__(self, table):
        self.columns, self.rows = table.Columns(), table.Rows()
        self.shells = table.Shells()
        self.axis_m = vectors(table.AxisXMAsNumpy(), table.AxisZMAsNumpy())
        self.rest_m = vectors(table.RestXMAsNumpy(), table.RestYMAsNumpy(), table.RestZMAsNumpy())
        self.normal = vectors(table.NormalXAsNumpy(), table.NormalYAsNumpy(), table.NormalZAsNumpy())
        self.ramp_rgba = numbers(table.RampRgbaAsNumpy()).reshape(-1, 4)
        self.nodes = self.columns * self.rows

    def describe(self):
        return f"a surface of {self.columns} x {self.rows} points"

    def faults(self):
        if len(self.rest_m) != self.nodes or len(self.normal) != self.nodes:
            yield "its arrays have not columns * rows points"
        if not is_unit(self.normal):
            yield "a normal is no unit vector"
        if self.shells < 1 or self.columns % self.shells:
            yield "its columns are no whole rings"
        if len(self.axis_m) not in (0, self.rows):
            yield "its axis has not as many points as there are rows"
        if len(self.ramp_rgba) not in (0, 256):
            yield f"the ramp has {len(self.ramp_rgba)} colours"

    def fits(self, moved):
        return (
            isinstance(moved, Displacements)
            and len(moved.displacement_m) == self.nodes
            and len(moved.heat) == (self.nodes if len(self.ramp_rgba) else 0)
            and len(moved.row_m) == len(moved.row_slope) == len(self.axis_m)
        )

    def points_m(self, moved):
        """Every point, row after row."""
        points_m = self.rest_m + moved.displacement_m[:, None] * self.normal
        if len(self.axis_m) == 0:
            return points_m
        of_row = np.repeat(np.arange(self.rows), self.columns)
        from_axis_m = points_m[:, [0, 2]] - self.axis_m[of_row]
        points_m[:, 1] -= np.sum(moved.row_slope[of_row] * from_axis_m, axis=1)
        return points_m + moved.row_m[of_row]

    def pose_faults(self, moved):
        if not np.all(np.isfinite(moved.displacement_m)):
            yield "a displacement is not finite"


def read_scenes(table):
    """The Scenes message as [(name, kind, model)]; None in place of a model of a kind that this client does not know."""
    from yuragi.stream import GridSkeleton, Skeleton, StrandSkeleton, SurfaceSkeleton, TreeSkeleton

    kinds = {
        Skeleton.Skeleton.StrandSkeleton: (StrandSkeleton.StrandSkeleton, Strands),
        Skeleton.Skeleton.GridSkeleton: (GridSkeleton.GridSkeleton, Cloth),
        Skeleton.Skeleton.TreeSkeleton: (TreeSkeleton.TreeSkeleton, Tree),
        Skeleton.Skeleton.SurfaceSkeleton: (SurfaceSkeleton.SurfaceSkeleton, Surface),
    }
    scenes = []
    for i in range(table.ScenesLength()):
        scene = table.Scenes(i)
        model = read_union(kinds, scene.SkeletonType(), scene.Skeleton())
        scenes.append((scene.Name().decode(), scene.Kind().decode(), model))
    return scenes


def read_pose(scene_pose):
    """A ScenePose as Bends, Ways, Sways or Displacements; None for a kind that this client does not know, and for a scene that
    is hidden."""
    from yuragi.stream import GridPose, Pose, StrandPose, SurfacePose, TreePose

    kinds = {
        Pose.Pose.StrandPose: (StrandPose.StrandPose, Bends),
        Pose.Pose.GridPose: (GridPose.GridPose, Ways),
        Pose.Pose.TreePose: (TreePose.TreePose, Sways),
        Pose.Pose.SurfacePose: (SurfacePose.SurfacePose, Displacements),
    }
    return read_union(kinds, scene_pose.PoseType(), scene_pose.Pose())


def read_union(kinds, kind, table):
    """What `kinds` makes of the table in a union; None for a kind that is not among them."""
    if kind not in kinds:
        return None
    table_class, meaning = kinds[kind]
    body = table_class()
    body.Init(table.Bytes, table.Pos)
    return meaning(body)


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
                for fault in model.faults():
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
                for fault in model.pose_faults(pose):
                    self.expect(False, f"{name}: {fault}")

    def points_m(self):
        """The tips or points of every scene that is known and seen in the last frame: {name: array of (x, y, z)}."""
        return {
            name: model.points_m(pose)
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
    parser.add_argument("--tips", action="store_true", help="print the first tips or points of the last frame")
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
    if options.tips and watcher.scenes:
        for name, tips_m in watcher.points_m().items():
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
