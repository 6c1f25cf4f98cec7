#!/usr/bin/env python3
"""A well-behaved client: takes every frame and every state of the sensors, and says on request what it has seen.

usage: witness.py FOLDER_OF_SCHEMA_MODULES HOST:PORT

For each line on standard input it prints one in JSON: for "next" the next state of the sensors, for any other what it has seen
since the last such line.
"""
import json
import os
import sys
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
import pose_client  # noqa: E402


class Seen:
    """What is counted between two questions."""

    def __init__(self):
        self.begin_s = time.monotonic()
        self.frames = self.missed = self.skipped = 0
        self.longest_pause_s = 0.0


class Witness:
    def __init__(self, address):
        self.source = pose_client.SocketBytes(address, None)
        self.source.send(pose_client.subscribe_message(sensors=True, client="witness"))
        self.news = threading.Condition()
        self.seen = Seen()
        self.last = None  # (sequence, tick, when)
        self.sensors = None
        self.states = 0
        self.has_ended = False
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        try:
            for message, _ in pose_client.messages(self.source):
                kind, table = pose_client.body_of(message)
                with self.news:
                    if kind == "Frame":
                        self.take_frame(table)
                    elif kind == "Sensors":
                        self.sensors = table  # read when somebody asks
                        self.states += 1
                        self.news.notify_all()
        except (OSError, EOFError):
            pass
        with self.news:
            self.has_ended = True
            self.news.notify_all()

    def take_frame(self, frame):
        now = (frame.Sequence(), frame.Tick(), time.monotonic())
        self.seen.frames += 1
        if self.last is not None:
            self.seen.missed += now[0] - self.last[0] - 1
            self.seen.skipped += (now[1] - self.last[1]) - (now[0] - self.last[0])  # a tick that was made has a frame
            self.seen.longest_pause_s = max(self.seen.longest_pause_s, now[2] - self.last[2])
        else:
            self.news.notify_all()
        self.last = now

    def waited_s(self):
        """For how long it has been ready to read and had no processor, since it began."""
        with open(f"/proc/self/task/{self.reader.native_id}/schedstat", encoding="ascii") as schedstat:
            return 1e-9 * int(schedstat.read().split()[1])

    def answer(self, question):
        """None where the connection has ended."""
        with self.news:
            if question == "next":
                before = self.states
                self.news.wait_for(lambda: self.has_ended or self.states > before)
            else:
                self.news.wait_for(lambda: self.has_ended or self.last is not None)
            if self.has_ended:
                return None
            if question == "next":
                return summary_of(self.sensors)
            seen, self.seen = self.seen, Seen()
            return {"seconds": self.seen.begin_s - seen.begin_s, "frames": seen.frames, "missed": seen.missed,
                    "skipped": seen.skipped, "longest_pause_s": seen.longest_pause_s, "waited_s": self.waited_s(),
                    "sensors": None if self.sensors is None else summary_of(self.sensors)}


def summary_of(sensors):
    recorder = sensors.Recorder()
    tick, io = sensors.TickLateness(), sensors.IoLateness()
    return {
        "clients": sensors.Clients(), "late_ticks": sensors.LateTicks(), "refused_clients": sensors.RefusedClients(),
        "stuck_clients": sensors.StuckClients(), "idle_clients": sensors.IdleClients(),
        "tick_lateness_s": [tick.P50S(), tick.P99S(), tick.MaxS()] if tick else None,
        "io_lateness_s": [io.P50S(), io.P99S(), io.MaxS()] if io else None,
        "recorder": None if recorder is None else {
            "state": recorder.State(), "written": recorder.Written(), "waiting": recorder.Waiting(), "lost": recorder.Lost(),
            "error": (recorder.Error() or b"").decode()},
        "sensors": [{"name": sensors.Sensors(i).Name().decode(), "state": sensors.Sensors(i).State(),
                     "readings": sensors.Sensors(i).Readings(), "frames": sensors.Sensors(i).Frames(),
                     "reconnects": sensors.Sensors(i).Reconnects()} for i in range(sensors.SensorsLength())],
    }


def main():
    pose_client.load_schema(sys.argv[1])
    witness = Witness(sys.argv[2])
    for line in sys.stdin:
        answer = witness.answer(line.strip())
        if answer is None:
            return
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
