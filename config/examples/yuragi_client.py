#!/usr/bin/env python3
"""Reads Yuragi's stream: the wind, sensors, and the joints of everything that moves. To copy, with pose.fbs beside it.

    yuragi_client.py [HOST:PORT]           prints the wind once a second
    yuragi_client.py --poses [HOST:PORT]   prints the scenes, too, and where the first joint of each is

In a program of your own:

    from yuragi_client import Client
    for frame in Client("127.0.0.1:7410", wind=True, rate_hz=30).frames():
        print(frame.wind.u_m_s, frame.wind.v_m_s)

pose.fbs describes every message: each field of a table there is an attribute here, with the same name. Needs Python 3.8 and nothing
else; numpy for poses.
"""
import argparse
import math
import pathlib
import re
import signal
import socket
import struct
import sys
import time

try:
    import numpy as np
except ImportError:  # enough for the wind and the sensors
    np = None

PROTOCOL = 1
MAX_MESSAGE_BYTES = 256 << 20
RETRY_S = 1.0
SILENCE_S = 10.0  # then the connection is made again


# ---- The schema: pose.fbs, read as text ----

CODES = {"bool": "?", "ubyte": "B", "uint8": "B", "int16": "h", "uint32": "I", "float": "f", "int64": "q", "uint64": "Q", "double": "d"}


class Schema:
    """The tables, structs, enums and unions of pose.fbs. tables: {table: {field: (slot, type, default)}}; structs: {struct:
    {field: (offset, type)}}; enums: {enum: [name]}; unions: {union: [table]}, the first is "NONE"."""

    def __init__(self, text):
        text = re.sub(r"//.*", "", text)
        names = {kind: re.findall(rf"{kind} (\w+)[^{{;]*\{{([^}}]*)\}}", text) for kind in ("enum", "union", "struct", "table")}
        self.enums = {name: re.findall(r"\w+", body) for name, body in names["enum"]}
        self.unions = {name: ["NONE", *re.findall(r"\w+", body)] for name, body in names["union"]}
        self.structs = {name: self._layout(body) for name, body in names["struct"]}
        self.tables = {name: self._slots(body) for name, body in names["table"]}

    @staticmethod
    def _fields(body):
        return re.findall(r"(\w+)\s*:\s*(\[?\w+\]?)(?:\s*=\s*([\w.-]+))?", body)

    def _layout(self, body):
        fields, at = {}, 0
        for name, kind, _ in self._fields(body):
            size = self.size_of(kind)
            at = (at + size - 1) // size * size
            fields[name] = (at, kind)
            at += size
        return fields

    def _slots(self, body):
        fields, slot = {}, 0
        for name, kind, default in self._fields(body):
            slot += kind in self.unions  # the slot before it has the kind
            fields[name] = (slot, kind, self._default(kind, default))
            slot += 1
        return fields

    def _default(self, kind, text):
        if kind in self.enums:
            return text or self.enums[kind][0]
        if kind not in CODES:
            return () if kind.startswith("[") else None
        if text == "null":
            return None
        return text == "true" if kind == "bool" else float(text or 0) if kind in ("float", "double") else int(text or 0)

    def size_of(self, kind):
        return 1 if kind in self.enums else struct.calcsize(CODES.get(kind, "I"))


def find_schema():
    here = pathlib.Path(__file__).resolve().parent
    places = [here / "pose.fbs", *(folder / "engine" / "wire" / "pose.fbs" for folder in here.parents)]
    for place in places:
        if place.is_file():
            return place.read_text(encoding="utf-8")
    raise FileNotFoundError(f"pose.fbs is missing: copy it to {here}")


SCHEMA = Schema(find_schema())


# ---- FlatBuffers: reading and writing tables ----


def unpack(code, data, at):
    return struct.unpack_from("<" + code, data, at)[0]


def read_value(kind, data, at):
    """The value of this type that stands at `at`."""
    if kind in CODES:
        return unpack(CODES[kind], data, at)
    if kind in SCHEMA.enums:
        names = SCHEMA.enums[kind]
        return names[data[at]] if data[at] < len(names) else data[at]  # a number: of a newer server
    if kind in SCHEMA.structs:
        return Table(kind, data, at)
    at += unpack("I", data, at)  # everything else stands elsewhere
    if kind == "string":
        return bytes(data[at + 4 : at + 4 + unpack("I", data, at)]).decode("utf-8", "replace")
    if not kind.startswith("["):
        return Table(kind, data, at)
    item, count, at = kind[1:-1], unpack("I", data, at), at + 4
    if item not in CODES:
        return [read_value(item, data, at + 4 * i) for i in range(count)]
    end = at + count * SCHEMA.size_of(item)
    if end > len(data):
        raise ValueError("an array ends behind its message")
    return memoryview(data)[at:end].cast(CODES[item])


class Table:
    """A table or struct of a message. The fields of pose.fbs are attributes: numbers, texts, lists, and for an array of numbers a
    memoryview. An absent field has its default: None for a text, a table and `= null`, an empty tuple for an array."""

    __slots__ = ("table_name", "data", "at")

    def __init__(self, table_name, data, at):
        self.table_name, self.data, self.at = table_name, data, at

    def __getattr__(self, name):
        try:
            if self.table_name in SCHEMA.structs:
                offset, kind = SCHEMA.structs[self.table_name][name]
                return read_value(kind, self.data, self.at + offset)
            slot, kind, default = SCHEMA.tables[self.table_name][name]
        except KeyError:
            raise AttributeError(f"{self.table_name} in pose.fbs has no field {name}") from None
        place = self.place_of(slot)
        if place is None:
            return default
        if kind not in SCHEMA.unions:
            return read_value(kind, self.data, place)
        kind_place = self.place_of(slot - 1)
        number = 0 if kind_place is None else self.data[kind_place]
        tables = SCHEMA.unions[kind]
        return read_value(tables[number], self.data, place) if 0 < number < len(tables) else None

    def place_of(self, slot):
        fields = self.at - unpack("i", self.data, self.at)  # the table of offsets
        offset = 4 + 2 * slot
        if offset >= unpack("H", self.data, fields):
            return None
        distance = unpack("H", self.data, fields + offset)
        return self.at + distance if distance else None

    def __dir__(self):
        return [*SCHEMA.tables.get(self.table_name, {}), *SCHEMA.structs.get(self.table_name, {})]


def encode(table_name, **values):
    """A message of this kind, as bytes with the size prefix. The values: numbers, texts, lists of texts, dictionaries for tables."""
    out = bytearray(12)  # the size prefix, the place of the message, the identifier

    def put(kind, value):
        """Appends what a field refers to, and returns its place."""
        if kind in SCHEMA.tables:
            return put_table(kind, value)
        out.extend(bytes(-len(out) % 4))
        place = len(out)
        if kind == "string":
            text = value.encode("utf-8")
            out.extend(struct.pack("<I", len(text)) + text + b"\0")
        else:
            out.extend(struct.pack("<I", len(value)) + bytes(4 * len(value)))
            for number, item in enumerate(value):
                refer(place + 4 + 4 * number, put(kind[1:-1], item))
        return place

    def refer(place, to):
        struct.pack_into("<I", out, place, to - place)

    def put_table(name, given):
        fields, size, slots = [], 4, {}
        for field, value in given.items():
            slot, kind, _ = SCHEMA.tables[name][field]
            if kind in SCHEMA.unions:
                fields.append((slot - 1, "ubyte", SCHEMA.unions[kind].index(value[0])))
                kind, value = value
            fields.append((slot, kind, value))
        for slot, kind, _ in fields:
            width = SCHEMA.size_of(kind)
            slots[slot] = (size + width - 1) // width * width
            size = slots[slot] + width
        offsets = [slots.get(slot, 0) for slot in range(max(slots, default=-1) + 1)]
        head = struct.pack(f"<HH{len(offsets)}H", 4 + 2 * len(offsets), size, *offsets)
        out.extend(bytes(-(len(out) + len(head)) % 8) + head)
        table = len(out)
        out.extend(struct.pack("<i", len(head)) + bytes(size - 4))
        for slot, kind, value in fields:
            place = table + slots[slot]
            if kind in CODES:
                struct.pack_into("<" + CODES[kind], out, place, value)
            else:
                refer(place, put(kind, value))
        return table

    message = put_table("Message", {"body": (table_name, values)})
    struct.pack_into("<II4s", out, 0, len(out) - 4, message - 4, b"YURA")
    return bytes(out)


def decode(data):
    """The body of a message, whose bytes come without the size prefix; None for a kind that pose.fbs does not have."""
    if bytes(data[4:8]) != b"YURA":
        raise ValueError("this is not a message of Yuragi")
    return Table("Message", data, unpack("I", data, 0)).body


# ---- The connection ----


class Refused(ConnectionError):
    """The daemon ends the connection and reports why."""


def split_address(address):
    host, _, port = address.rpartition(":")
    return host.strip("[]"), int(port)


class Connection:
    """One connection to the daemon; iterates over its messages, and raises OSError, EOFError or ValueError when it ends."""

    def __init__(self, address, silence_s=SILENCE_S):
        self.silence_s = silence_s
        self.socket = socket.create_connection(split_address(address), silence_s)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, message):
        self.socket.sendall(message)

    def read(self, count):
        data = bytearray(count)
        rest = memoryview(data)
        while rest:
            try:
                received = self.socket.recv_into(rest)
            except socket.timeout:
                raise TimeoutError(f"nothing has come for {self.silence_s:g} s") from None
            if received == 0:
                raise EOFError("the daemon has closed the connection")
            rest = rest[received:]
        return data

    def __iter__(self):
        while True:
            size = unpack("I", self.read(4), 0)
            if not 8 <= size <= MAX_MESSAGE_BYTES:  # before there is room for it
                raise ValueError(f"a message has {size} bytes")
            body = decode(self.read(size))
            if body is None:
                continue  # of a newer server
            if body.table_name == "Hello":
                if body.refused is not None:
                    raise Refused(body.refused)
                if body.protocol != PROTOCOL:
                    raise Refused(f"the daemon has protocol {body.protocol}, this program protocol {PROTOCOL}")
            yield body

    def close(self):
        self.socket.close()


class Client:
    """Subscribes to the stream, and does so again whenever the connection is lost.

    wind: frames with the wind alone. poses: frames with the wind and all poses. scenes, every, rate_hz: less of them, by the names
    of scenes, every n-th strand, frames a second. sensors: their state twice a second. token: that of the installation. The same
    words in pose.fbs, table Subscribe, have the details.

    A refusal (a scene that does not exist, no free place) raises Refused, unless frames have come before: then the daemon is asked
    again. `scenes` has the scenes of the frames: [(name, kind, model)]."""

    def __init__(self, address="127.0.0.1:7410", *, wind=False, poses=False, sensors=False, scenes=(), every=1, rate_hz=0.0,
                 token="", name="yuragi_client.py"):
        self.address = address
        self.subscription = encode("Subscribe", protocol=PROTOCOL, wind=wind, poses=poses, sensors=sensors, scenes=list(scenes),
                                   every=every, rate_hz=rate_hz, token=token, client=name, takes_new_scenes=True)
        self.silence_s = max(SILENCE_S, 3.0 / rate_hz) if rate_hz else SILENCE_S
        self.scenes = []

    def __iter__(self):
        """The messages, each a Table; its `table_name` is "Hello", "Scenes", "Frame" or "Sensors"."""
        last_error, has_begun = None, False

        def log(text):
            print(f"yuragi at {self.address}: {text}", file=sys.stderr, flush=True)

        while True:
            connection = None
            try:
                connection = Connection(self.address, self.silence_s)
                connection.send(self.subscription)
                for message in connection:
                    if message.table_name == "Scenes":
                        self.scenes = read_scenes(message)
                    if message.table_name == "Hello":
                        log(f"connected, {message.software}")
                    else:
                        has_begun, last_error = True, None
                    yield message
            except (OSError, EOFError, ValueError, struct.error) as error:
                if isinstance(error, Refused) and not has_begun:
                    raise
                if str(error) != last_error:  # once, not each second
                    log(f"{error}; trying again")
                last_error = str(error)
            finally:
                if connection is not None:
                    connection.close()
            time.sleep(RETRY_S)

    def frames(self):
        """The frames alone."""
        return (message for message in self if message.table_name == "Frame")

    def joints(self, frame):
        """Yields (name, opacity, joints_m) of each scene that a frame shows. joints_m: an array of (x, y, z) in metres, x east, y up,
        z south; strand by strand from root to tip, row by row of a cloth or surface, level by level of a tree. While scenes are
        replaced, two may have the same name."""
        for (name, _, model), scene_pose in zip(self.scenes, frame.scenes):
            pose = read_pose(scene_pose)
            if model is not None and pose is not None and model.fits(pose):
                yield name, scene_pose.opacity, model.joints_m(pose)


def speed_m_s(wind):
    return math.hypot(wind.u_m_s, wind.v_m_s)


def from_deg(wind):
    """Where the wind comes from, 0 to 360 clockwise from north."""
    return math.degrees(math.atan2(-wind.u_m_s, -wind.v_m_s)) % 360.0


# ---- Skeletons and poses: where the joints are ----


def numbers(array):
    """An array of a message in double precision."""
    if np is None:
        raise ImportError("poses need numpy")
    return np.asarray(array, dtype=float)


def vectors(*components):
    """Arrays of coordinates as one array of vectors."""
    return np.stack([numbers(component) for component in components], axis=1)


def turned(vectors_, axis, angle_rad):
    """Vectors turned about unit axes by angles (Rodrigues' formula)."""
    cos, sin = np.cos(angle_rad)[:, None], np.sin(angle_rad)[:, None]
    along = np.sum(axis * vectors_, axis=1)[:, None]
    return vectors_ * cos + np.cross(axis, vectors_) * sin + axis * along * (1.0 - cos)


class Bends:
    """A StrandPose: a vector (east, south) for each strand, in radians."""

    def __init__(self, table):
        self.east_rad = table.bend_step_rad * numbers(table.bend_east)
        self.south_rad = table.bend_step_rad * numbers(table.bend_south)

    def __len__(self):
        return min(len(self.east_rad), len(self.south_rad))

    def angle_rad(self):
        return np.hypot(self.east_rad, self.south_rad)

    def axis(self):
        """up x bend = (0, 1, 0) x (east, 0, south), of length 1. Without a bend any axis is right."""
        angle_rad = self.angle_rad()
        safe = np.where(angle_rad > 0.0, angle_rad, 1.0)
        return np.stack([self.south_rad / safe, np.zeros(len(safe)), -self.east_rad / safe], axis=1)


class Strands:
    """A StrandSkeleton: chains with a root, a direction at rest, and a curl."""

    def __init__(self, table):
        self.links = table.links_per_strand
        self.root_m = vectors(table.root_x_m, table.root_y_m, table.root_z_m)
        self.rest = vectors(table.rest_x, table.rest_y, table.rest_z)
        self.curl = vectors(table.curl_x, table.curl_y, table.curl_z)
        self.rest_curl_rad = numbers(table.rest_curl_rad)
        self.link_length_m = numbers(table.link_length_m)

    @property
    def count(self):
        return len(self.root_m)

    @property
    def nodes(self):
        return self.count * self.links

    def describe(self):
        return f"{self.count} strands of {self.links} links"

    def fits(self, bends):
        return isinstance(bends, Bends) and len(bends.east_rad) == len(bends.south_rad) == self.count

    def chains_m(self, bends, root_m=None, root_turns=()):
        """The joints as (links, strands, 3). In a tree the roots are elsewhere, and turned first, by a list of (axis, angle)."""
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

    def joints_m(self, bends):
        """Every joint, strand by strand from root to tip."""
        return by_strand(self.chains_m(bends))


def by_strand(chains_m):
    return chains_m.transpose(1, 0, 2).reshape(-1, 3)


class Ways:
    """A GridPose: how far each joint is from its place at rest, in metres."""

    def __init__(self, table):
        self.columns = table.columns
        self.offset_m = table.step_m * vectors(table.offset_x, table.offset_y, table.offset_z)


class Cloth:
    """A GridSkeleton: rows of joints, the first of which is fixed."""

    def __init__(self, table):
        self.columns, self.rows = table.columns, table.rows
        self.is_first_column_fixed = table.is_first_column_fixed
        self.rest_m = vectors(table.rest_x_m, table.rest_y_m, table.rest_z_m)
        self.nodes = self.columns * self.rows

    def describe(self):
        return f"a cloth of {self.columns} x {self.rows} joints"

    def fits(self, ways):
        return isinstance(ways, Ways) and ways.columns == self.columns and len(ways.offset_m) == self.nodes

    def joints_m(self, ways):
        """Every joint, row by row."""
        return self.rest_m + ways.offset_m


class Sways:
    """A TreePose: Bends for each level."""

    def __init__(self, table):
        self.levels = [Bends(level) for level in table.levels]


class Tree:
    """A TreeSkeleton: levels of strands that grow on the strands of earlier levels."""

    class Level:
        def __init__(self, table):
            self.strands = Strands(table.strands)
            self.parent_level = table.parent_level
            self.parent = numbers(table.parent).astype(int)
            self.parent_link = numbers(table.parent_link).astype(int)
            self.is_turned_by_block = table.is_turned_by_block
            self.is_leaves = table.is_leaves
            self.radius_m = np.stack([numbers(table.base_radius_m), numbers(table.tip_radius_m)])

    def __init__(self, table):
        self.levels = [Tree.Level(level) for level in table.levels]
        self.nodes = sum(level.strands.nodes for level in self.levels)

    def describe(self):
        return "a tree of " + ", ".join(str(level.strands.count) for level in self.levels) + " strands"

    def fits(self, sways):
        return (
            isinstance(sways, Sways)
            and len(sways.levels) == len(self.levels)
            and all(level.strands.fits(bends) for level, bends in zip(self.levels, sways.levels))
        )

    def joints_m(self, sways):
        """Every joint, level by level, of each strand by strand from root to tip."""
        chains_m, turns = [], []
        for number, (level, bends) in enumerate(zip(self.levels, sways.levels)):
            if number == 0:
                turns.append([])
                chains_m.append(level.strands.chains_m(bends))
                continue
            # The turn of the link that each strand grows from; of the first strand of 16, if they share it.
            parents, parent_bends = self.levels[level.parent_level].strands, sways.levels[level.parent_level]
            strand = np.arange(level.strands.count)
            of = strand // 16 * 16 if level.is_turned_by_block else strand
            parent, link = level.parent[of], level.parent_link[of]
            share_rad = (link + 1) / parents.links * parent_bends.angle_rad()[parent]
            root_turns = [(axis[parent], angle[parent]) for axis, angle in turns[level.parent_level]]
            root_turns.append((parent_bends.axis()[parent], share_rad))
            turns.append(root_turns)
            root_m = chains_m[level.parent_level][level.parent_link, level.parent]
            chains_m.append(level.strands.chains_m(bends, root_m, root_turns))
        return np.concatenate([by_strand(level) for level in chains_m])


class Displacements:
    """A SurfacePose: how far each point is moved along its normal, in metres, and its color on the ramp; and how far the points of
    each row are moved besides."""

    def __init__(self, table):
        self.displacement_m = table.step_m * numbers(table.displacement)
        east, south, drop = numbers(table.row_east), numbers(table.row_south), numbers(table.row_drop)
        self.row_m = table.step_m * np.stack([east, -drop, south], axis=1)
        self.row_slope = table.slope_step * vectors(table.row_slope_east, table.row_slope_south)
        self.heat = numbers(table.heat).astype(int)


class Surface:
    """A SurfaceSkeleton: points that move along their normals."""

    def __init__(self, table):
        self.columns, self.rows = table.columns, table.rows
        self.shells = table.shells
        self.axis_m = vectors(table.axis_x_m, table.axis_z_m)
        self.rest_m = vectors(table.rest_x_m, table.rest_y_m, table.rest_z_m)
        self.normal = vectors(table.normal_x, table.normal_y, table.normal_z)
        self.ramp_rgba = numbers(table.ramp_rgba).reshape(-1, 4)
        self.nodes = self.columns * self.rows

    def describe(self):
        return f"a surface of {self.columns} x {self.rows} points"

    def fits(self, moved):
        return (
            isinstance(moved, Displacements)
            and len(moved.displacement_m) == self.nodes
            and len(moved.heat) == (self.nodes if len(self.ramp_rgba) else 0)
            and len(moved.row_m) == len(moved.row_slope) == len(self.axis_m)
        )

    def joints_m(self, moved):
        """Every point, row by row."""
        points_m = self.rest_m + moved.displacement_m[:, None] * self.normal
        if len(self.axis_m) == 0:
            return points_m
        of_row = np.repeat(np.arange(self.rows), self.columns)
        from_axis_m = points_m[:, [0, 2]] - self.axis_m[of_row]
        points_m[:, 1] -= np.sum(moved.row_slope[of_row] * from_axis_m, axis=1)
        return points_m + moved.row_m[of_row]


SKELETONS = {"StrandSkeleton": Strands, "GridSkeleton": Cloth, "TreeSkeleton": Tree, "SurfaceSkeleton": Surface}
POSES = {"StrandPose": Bends, "GridPose": Ways, "TreePose": Sways, "SurfacePose": Displacements}


def read_scenes(scenes):
    """A Scenes message as [(name, kind, model)]. The model is None if its kind is not known here."""
    return [(scene.name, scene.kind, read_union(SKELETONS, scene.skeleton)) for scene in scenes.scenes]


def read_pose(scene_pose):
    """A ScenePose as Bends, Ways, Sways or Displacements; None if its kind is not known here or the scene is hidden."""
    return read_union(POSES, scene_pose.pose)


def read_union(kinds, table):
    return kinds[table.table_name](table) if table is not None and table.table_name in kinds else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("address", nargs="?", default="127.0.0.1:7410", metavar="HOST:PORT")
    parser.add_argument("--poses", action="store_true", help="print the scenes, too, and where the first joint of each is")
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    client = Client(options.address, wind=True, poses=options.poses, rate_hz=1.0)
    for message in client:
        if message.table_name == "Scenes":
            for name, kind, model in client.scenes:
                print(f"scene {name} ({kind}): {model.describe() if model else 'not known here'}", flush=True)
        if message.table_name == "Frame":
            wind = message.wind
            print(f"wind {speed_m_s(wind):.2f} m/s from {from_deg(wind):.0f} deg, {wind.source}", flush=True)
            for name, _, joints_m in client.joints(message):
                print(f"  {name}: {len(joints_m)} joints, the first at {np.round(joints_m[0], 3)}", flush=True)


if __name__ == "__main__":
    try:
        main()
    except Refused as refused:
        sys.exit(f"yuragi_client.py: the daemon refuses the connection: {refused}")
