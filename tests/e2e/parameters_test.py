#!/usr/bin/env python3
"""What is set while the daemon runs: values of [look] and of scenes, by `yuragi look` and `yuragi scene`, and by `yuragi hand` wind,
blackout and camera, under a client that sees every frame.

usage: parameters_test.py FOLDER_OF_PROGRAMS FOLDER_OF_SCHEMA_MODULES SCENE_BOUNDS
"""
import csv
import json
import subprocess
import unittest

import pose_client
import reload_test
from reload_test import GRASS, HANG_S, PARTS_OF_THE_BOUND, SENSOR, YURAGI

FLAG = '[[scene]]\nkind = "flag"\nname = "elm"\nx = 3\n'
LOOK = "[look]\nhaze = 0.2\n"


class Commands(reload_test.RunningDaemon):
    def run_command(self, *arguments):
        return subprocess.run([YURAGI, *map(str, arguments), "--connect", self.address], capture_output=True, text=True,
                              timeout=HANG_S, check=False)

    def done(self, *arguments):
        result = self.run_command(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""), arguments)
        return result.stdout

    def refused(self, code, *arguments):
        result = self.run_command(*arguments)
        self.assertEqual((result.returncode, result.stdout), (code, ""), arguments)
        return result.stderr


class Parameters(Commands):
    def look_haze_after(self, *arguments):
        """What a viewer, connected beforehand, is told of the haze once the command has been carried out."""
        source = pose_client.SocketBytes(self.address, HANG_S)
        self.addCleanup(source.socket.close)
        source.send(pose_client.subscribe_message(False, True, "parameters_test.py"))
        tables = (table for kind, table in map(pose_client.body_of, (message for message, _ in pose_client.messages(source)))
                  if kind == "Sensors")
        before = next(tables)
        self.done(*arguments)
        return next(table for table in tables if table.ParametersRevision() != before.ParametersRevision()).Look().Haze()

    def test_the_look_is_set_and_goes_back_to_the_file_when_it_is_read_again(self):
        self.start_daemon(LOOK + SENSOR + GRASS)
        self.assertEqual(self.done("look", "values", "--toml"), "")
        self.assertEqual(self.look_haze_after("look", "set", "haze=0.4"), 0.4)
        self.assertIn('time: left out -> "06:30"', self.done("look", "set", "time=06:30", "clouds=1"))
        lines = self.done("look", "values", "--toml")
        self.assertEqual(set(lines.splitlines()[1:]), {'time = "06:30"', "clouds = 1", "haze = 0.4"})
        self.assertIn("0.4  (the configuration: 0.2)", self.done("look", "values"))
        listed, = json.loads(self.done("look", "values", "--json"))
        haze, = (one for one in listed["parameters"] if one["name"] == "haze")
        self.assertEqual([haze[key] for key in ("value", "configured", "default", "min", "max", "kind", "change")],
                         [0.4, 0.2, 0.15, 0, 1, "number", "at once"])

        # What is printed is what the configuration needs to keep the values.
        self.write(LOOK.replace("haze = 0.2\n", "\n".join(lines.splitlines()[1:]) + "\n") + SENSOR + GRASS)
        self.assertEqual(reload_test.reload("--connect", self.address).stdout, "nothing has changed\n")
        self.assertEqual(self.done("look", "values", "--toml"), "")

        self.done("look", "set", "haze=0.9")
        self.write(LOOK + SENSOR + GRASS)
        self.assertIn("[look] haze: 0.9 -> 0.2\n", reload_test.reload("--connect", self.address).stdout)
        self.done("look", "set", "haze=0.9", "exposure=1")
        self.assertIn("haze: 0.9 -> 0.2", self.done("look", "reset", "haze"))
        self.assertIn("exposure: 1.0 -> 0.0", self.done("look", "reset"))
        self.assertIn("nothing has changed", self.done("look", "reset"))

    def test_a_scene_is_set_without_a_jump_and_keeps_the_value_through_fades(self):
        daemon = self.start_daemon(SENSOR + GRASS + FLAG)
        frames = self.frames()
        for gain in (0, 9, 0.5):
            self.assertIn("scene grass: gain: ", self.done("scene", "set", "grass", f"gain={gain}"))
            frames.more(40)
        self.assertEqual(frames.lists, [["grass", "elm"]], "nothing was made anew")

        # Made anew while it fades out, so slowly that it is not over on a busy machine either, and again before that is over.
        self.done("scene", "hide", "elm", "--fade", "20")
        self.assertIn("scene elm: x: 3.0 -> 4.0", self.done("scene", "set", "elm", "x=4"))
        self.assertIn("x: 4.0 -> 5.0", self.done("scene", "set", "elm", "x=5", "shown=true"))
        frames.until(lambda seen: len(seen.lists) >= 5 and seen.lists[-1] == ["grass", "elm"])
        self.assertEqual(self.done("scene", "values", "--toml", "elm").splitlines()[1:], ["x = 5"])
        self.assertGreater(frames.largest_step_m, 0.0)
        self.assertLessEqual(frames.largest_step_m, PARTS_OF_THE_BOUND * self.bound_m())
        # Over 1 s at 60 Hz, which is shorter than these fades.
        self.assertLessEqual(frames.largest_opacity_step, 1.6 / 60.0)
        print(f"largest step of a joint {1e3 * frames.largest_step_m:.2f} mm, allowed {1e3 * self.bound_m():.2f} mm; "
              f"of an opacity {frames.largest_opacity_step:.4f}")

        self.assertIn("x: 5.0 -> 3.0", self.done("scene", "reset", "elm"))
        self.assertEqual(self.done("scene", "values", "--toml", "elm"), "")
        self.assertIn("scene grass: gain: 0.5 -> 1.0", reload_test.reload("--connect", self.address).stdout)
        self.assertEqual(self.done("scene", "values", "--toml"), "")
        self.assertEqual(daemon.end(), 0)

    def test_a_mistake_is_told_as_of_the_file_and_changes_nothing(self):
        self.start_daemon(LOOK + SENSOR + GRASS + FLAG)
        self.write("[look]\nhaze = 4.0\n")
        of_file = subprocess.run([YURAGI, "check-config", self.config], capture_output=True, text=True, timeout=HANG_S, check=False)
        told = self.refused(64, "look", "set", "haze=4").removeprefix("yuragi: ").strip()
        self.assertIn("look.haze: is 4; allowed: number from 0 to 1", told)
        self.assertIn(told, of_file.stderr)
        self.assertIn("look.mist: is not a known key here; known: ", self.refused(64, "look", "set", "mist=1"))
        self.assertIn('there is no scene "oak"; there are: grass, elm', self.refused(64, "scene", "set", "oak", "gain=1"))
        self.assertIn('there is no scene "oak"; there are: grass, elm', self.refused(64, "scene", "values", "oak"))
        self.assertIn("scene.gain: is -1; allowed: number from 0 to 10", self.refused(64, "scene", "set", "elm", "x=1", "gain=-1"))
        self.assertIn("scene.columns: is a text", self.refused(64, "scene", "set", "elm", "columns=many"))
        self.assertIn("is not KEY=VALUE", self.refused(64, "look", "set", "haze"))
        self.assertIn("too many values", self.refused(64, "look", "set", *(f"haze={part / 100}" for part in range(65))))
        self.assertEqual(self.done("scene", "values", "--toml") + self.done("look", "values", "--toml"), "")

    def test_who_may_set_is_configured(self):
        self.start_daemon('[stream]\ncontrol = "nobody"\n' + LOOK + SENSOR + GRASS)
        self.assertIn('[stream] control = "nobody"', self.refused(77, "look", "set", "haze=0.4"))
        self.assertIn('[stream] control = "nobody"', self.refused(77, "scene", "set", "grass", "shown=false"))
        self.assertIn("haze                 0.2\n", self.done("look", "values"), "anybody may see them")


class ByHand(Commands):
    STEADY = '[wind]\ndefault_turbulence = 0\n[[sensor]]\ndriver = "synthetic"\nname = "roof"\nspeed = 3\nturbulence = 0\n'

    def status(self):
        return json.loads(subprocess.run([YURAGI, "status", "--json", "--connect", self.address], capture_output=True, text=True,
                                         timeout=HANG_S, check=False).stdout)

    def test_a_wind_by_hand_moves_the_scenes_alone_without_a_jump_and_ends_by_itself(self):
        log = f"{self.folder}/wall.windlog"
        daemon = self.start_daemon(self.STEADY + GRASS, "--record", log)
        frames = self.frames()
        frames.until(lambda seen: abs(seen.wind_m_s - 3.0) < 0.01)
        self.assertEqual(self.done("hand", "wind", "12", "90", "--for", "1h"), "the wind is 12 m/s from 90 degrees by hand, for 1 h\n")
        daemon.wait_for(r"client \S+ \(hand\): the wind is 12 m/s")
        frames.until(lambda seen: abs(seen.wind_m_s - 12.0) < 0.01)
        status = self.status()
        self.assertAlmostEqual(status["wind"]["speed_m_s"], 3.0, 2, "the real one")
        self.assertEqual([status["by_hand"]["wind"][key] for key in ("speed_m_s", "direction_deg")], [12, 90])
        self.assertIn("by hand: 12 m/s from 90 degrees, ", status["shaping"]["text"])
        self.assertNotIn("hand", str(status["attention"]))
        self.done("hand", "wind", "9", "270", "--for", "8")
        daemon.wait_for("by hand: the scenes have the real wind again")
        frames.until(lambda seen: abs(seen.wind_m_s - 3.0) < 0.01)
        self.assertIsNone(self.status()["by_hand"]["wind"])
        self.assertLessEqual(frames.largest_step_m, PARTS_OF_THE_BOUND * self.bound_m())
        self.assertEqual(daemon.end(), 0)
        subprocess.run([YURAGI, "export", log, "-o", f"{self.folder}/wall.csv"], capture_output=True, timeout=HANG_S, check=True)
        with open(f"{self.folder}/wall.csv", encoding="ascii") as table:
            speeds = {float(row["speed_m_s"]) for row in csv.DictReader(table)}
        self.assertEqual(speeds, {3.0}, "as without it")

    def test_winds_that_replace_each_other_among_gusts_make_no_joint_jump(self):
        self.start_daemon(SENSOR + GRASS)
        frames = self.frames()
        for speed, direction in ((20, 0), (0, 90), (25, 180), (12, 300)):
            self.done("hand", "wind", speed, direction)
            frames.more(100)
        self.done("hand", "release", "wind")
        frames.more(200)
        self.assertGreater(frames.largest_step_m, 0.0)
        self.assertLessEqual(frames.largest_step_m, PARTS_OF_THE_BOUND * self.bound_m())
        print(f"largest step of a joint {1e3 * frames.largest_step_m:.2f} mm, allowed {1e3 * self.bound_m():.2f} mm")

    def test_blackout_and_camera_are_set_and_released(self):
        camera = '[[camera]]\nname = "{}"\nscene = "grass"\n'
        self.start_daemon(self.STEADY + GRASS + camera.format("gate") + camera.format("pond"))
        first = self.status()
        self.assertEqual((first["cameras"], first["camera"]), (["gate", "pond"], "gate"))
        self.done("hand", "camera", "pond")
        self.assertEqual(self.status()["camera"], "pond")
        self.done("hand", "release", "camera")
        self.assertEqual(self.status()["camera"], "gate")
        self.assertIn('there is no camera "sea"; there are: gate, pond', self.refused(64, "hand", "camera", "sea"))

        self.done("hand", "blackout", "--for", "1h")
        self.assertNotIn("dark", str(self.status()["attention"]))
        self.done("hand", "blackout", "--until-released")
        self.assertIn("dark by hand until somebody ends it", str(self.status()["attention"]))
        source = pose_client.SocketBytes(self.address, HANG_S)
        self.addCleanup(source.socket.close)
        source.send(pose_client.subscribe_message(False, True, "parameters_test.py"))
        openness = (table.Shaping().Openness() for kind, table in map(pose_client.body_of, (message for message, _ in pose_client.messages(source)))
                    if kind == "Sensors")
        self.assertGreaterEqual(next(value for value in openness if value < 0.001), 0)
        self.assertEqual(self.done("hand", "release", "blackout"), "the walls are lit again, as the opening hours are\n")
        self.assertLessEqual(next(value for value in openness if value > 0.999), 1)

    def test_what_is_no_wind_or_not_allowed_is_refused(self):
        self.start_daemon('[stream]\ncontrol = "nobody"\n' + self.STEADY + GRASS)
        self.assertIn('[stream] control = "nobody"', self.refused(77, "hand", "wind", "8", "270"))
        for words in (("nan", "0"), ("1e300", "0"), ("-1", "0"), ("61", "0"), ("8", "361"), ("8", "270", "--for", "2h"), ("8", "270", "--for", "0")):
            self.refused(64, "hand", "wind", *words)


if __name__ == "__main__":
    pose_client.load_schema(reload_test.SCHEMA_MODULES)
    unittest.main()
