#!/usr/bin/python3
"""The proof of the stream's schema: a reader that was written from its comments alone finds the tips of strands and trees, and the
points of cloth and surfaces, where the engine has them.

    stream_schema_test.py STREAM_CAPTURE SCHEMA_MODULES
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import pose_client

TOLERANCE_M = 5e-6  # of floats, some metres from the origin


def main():
    capture, schema = sys.argv[1:]
    pose_client.load_schema(schema)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([capture, folder], check=True)
        stream = pathlib.Path(folder) / "stream.bin"
        expected_m = np.fromfile(pathlib.Path(folder) / "points.f32", dtype="<f4").reshape(-1, 3)

        # The whole client on the file, as a user runs it.
        client = [sys.executable, pose_client.__file__, "--schema", schema, "--file", stream, "--frames", "5", "--check"]
        subprocess.run(client, check=True)

        # And its points of the last frame against the engine's.
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
    points_m = np.concatenate(list(watcher.points_m().values()))
    assert points_m.shape == expected_m.shape, (points_m.shape, expected_m.shape)
    error_m = float(np.max(np.abs(points_m - expected_m)))
    print(f"{len(points_m)} points, {error_m * 1e6:.2f} micrometres apart at most, bends up to {watcher.max_bend_rad:.2f} rad")
    assert watcher.opacities == [1.0, 1.0, 0.5, 1.0, 0.25, 1.0, 0.0], watcher.opacities
    assert watcher.wind_place == (-12.5, 0.75), watcher.wind_place
    fire = watcher.poses[5]
    assert np.ptp(fire.heat) > 200 and len(watcher.scenes[5][2].ramp_rgba) == 256, "the flame does not glow"
    assert watcher.max_bend_rad > 2.0, "the captured poses hardly bend"
    assert error_m < TOLERANCE_M, "the schema's comments and the engine's kinematics disagree"


if __name__ == "__main__":
    main()
