#!/usr/bin/python3
"""The proof of the stream's schema: a reader that was written from its comments alone (config/examples/yuragi_client.py) finds every
joint of strands, trees, cloth and surfaces where the engine has it, and reads every field of the schema as flatc's modules do.

    stream_schema_test.py STREAM_CAPTURE SCHEMA_MODULES
"""

import importlib
import inspect
import pathlib
import struct
import subprocess
import sys
import tempfile

import numpy as np

import pose_client
import yuragi_client

TOLERANCE_M = 5e-6  # of floats, some metres from the origin


def flatc_class(name):
    return getattr(importlib.import_module(f"yuragi.stream.{name}"), name)


def compare_schemas():
    """yuragi_client reads pose.fbs itself: each field is where flatc has it, and has the same default."""
    schema = yuragi_client.SCHEMA
    empty = struct.pack("<HHi", 4, 4, 4)  # a table without fields, at 4
    filled = bytes(range(1, 65))
    count = 0
    for name, fields in [*schema.tables.items(), *schema.structs.items()]:
        is_table = name in schema.tables
        data, at = (empty, 4) if is_table else (filled, 0)
        theirs, ours = flatc_class(name)(), yuragi_client.Table(name, data, at)
        theirs.Init(data, at)
        for field, (place, kind, *_) in fields.items():
            count += 1
            method = getattr(theirs, "".join(word.capitalize() for word in field.split("_")))
            if is_table:
                assert f"Offset({4 + 2 * place})" in inspect.getsource(method), f"{name}.{field} stands elsewhere"
            value = getattr(ours, field)
            if kind in schema.enums and isinstance(value, str):
                assert getattr(flatc_class(kind), value) == method(), f"{name}.{field}: {value}"
            elif kind in schema.enums or kind in yuragi_client.CODES:
                assert value == method(), f"{name}.{field}: {value}, {method()}"
    for name, tables in schema.unions.items():
        assert [getattr(flatc_class(name), table) for table in tables] == list(range(len(tables))), name
    print(f"{count} fields of {len(schema.tables)} tables and {len(schema.structs)} structs")
    assert count > 200, "pose.fbs was hardly read"


def read_by_flatc():
    """A message that yuragi_client writes is what flatc's modules read."""
    written = yuragi_client.encode("Subscribe", protocol=1, wind=True, poses=False, client="Wärter", scenes=["elm", "a pond"], every=8,
                                   rate_hz=12.5)
    (size,) = struct.unpack_from("<I", written)
    assert size == len(written) - 4
    from yuragi.stream import Message, Subscribe

    body = Message.Message.GetRootAs(bytearray(written[4:]), 0).Body()
    read = Subscribe.Subscribe()
    read.Init(body.Bytes, body.Pos)
    assert (read.Protocol(), read.Wind(), read.Poses(), read.Every(), read.RateHz()) == (1, True, False, 8, 12.5)
    assert read.Client().decode() == "Wärter" and read.Token() is None and not read.Sensors()
    assert [read.Scenes(i).decode() for i in range(read.ScenesLength())] == ["elm", "a pond"]


def main():
    capture, schema = sys.argv[1:]
    pose_client.load_schema(schema)
    compare_schemas()
    read_by_flatc()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([capture, folder], check=True)
        stream = pathlib.Path(folder) / "stream.bin"
        expected_m = np.fromfile(pathlib.Path(folder) / "joints.f32", dtype="<f4").reshape(-1, 3)

        # The whole client on the file, as a user runs it.
        client = [sys.executable, pose_client.__file__, "--schema", schema, "--file", stream, "--frames", "5", "--check"]
        subprocess.run(client, check=True)

        # And its joints of the last frame against the engine's.
        watcher = pose_client.Watcher(check=True)
        try:
            for message, size in pose_client.messages(pose_client.FileBytes(stream)):
                kind, table = pose_client.body_of(message)
                if kind == "Hello":
                    watcher.hello(table)
                elif kind == "Scenes":
                    watcher.scenes_message(table)
                elif kind == "Frame":
                    watcher.frame(table, size, 0.0)
        except EOFError:
            pass

    assert watcher.frames == 5 and not watcher.problems, watcher.problems
    joints_m = np.concatenate(list(watcher.joints_m().values()))
    assert joints_m.shape == expected_m.shape, (joints_m.shape, expected_m.shape)
    error_m = float(np.max(np.abs(joints_m - expected_m)))
    print(f"{len(joints_m)} joints, {error_m * 1e6:.2f} micrometres apart at most, bends up to {watcher.max_bend_rad:.2f} rad")
    assert watcher.opacities == [1.0, 1.0, 0.5, 1.0, 0.25, 1.0, 0.0], watcher.opacities
    assert watcher.wind_place == (-12.5, 0.75), watcher.wind_place
    fire = watcher.poses[5]
    assert np.ptp(fire.heat) > 200 and len(watcher.scenes[5][2].ramp_rgba) == 256, "the flame does not glow"
    assert watcher.max_bend_rad > 2.0, "the captured poses hardly bend"
    assert error_m < TOLERANCE_M, "the schema's comments and the engine's kinematics disagree"


if __name__ == "__main__":
    main()
