#!/usr/bin/env python3
"""What the daemon publishes on a real MQTT broker ([mqtt]), as mosquitto_sub shows it.

usage: mqtt_feed_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import unittest

from programs import HANG_S, Program, free_port

PROGRAMS = os.path.abspath(sys.argv.pop(1))


class MqttFeed(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory(prefix="yuragi-mqtt-"))
        self.port = free_port()
        self.environment = {**os.environ, "STATE_DIRECTORY": self.folder}

    def file(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        os.chmod(path, 0o600)
        return path

    def broker(self):
        config = self.file("broker.conf", f"listener {self.port} 127.0.0.1\nuser root\nallow_anonymous true\npersistence false\n")
        broker = self.enterContext(Program("mosquitto", "-c", config))
        broker.wait_for("running")
        return broker

    def reader(self):
        """Prints RETAINED TOPIC PAYLOAD for each message from now on; RETAINED is 1 if the broker has kept it."""
        self.publish("test/here", "here", "-r")
        reader = self.enterContext(Program("mosquitto_sub", "-h", "127.0.0.1", "-p", self.port, "-F", "%r %t %p", "-t", "#"))
        reader.wait_for("1 test/here")
        return reader

    def publish(self, topic, payload, *options):
        subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(self.port), "-q", "1", "-t", topic, "-m", payload, *options],
                       check=True, timeout=HANG_S)

    def daemon(self, more=""):
        config = self.file("yuragi.toml", f"""[http]
listen = "127.0.0.1:0"

[mqtt]
host = "127.0.0.1"
port = {self.port}
topic = "yuragi/hall-2"
every = 1
commands = true
{more}
[[scene]]
name = "grass"
kind = "grass"
blades_across = 10
blades_deep = 10

[[alert]]
name = "storm"
when = "wind_above"
speed = 100
command = "true"
""")
        return self.enterContext(Program(os.path.join(PROGRAMS, "yuragi"), "run", "--config", config, "--listen", "127.0.0.1:0",
                                         env=self.environment))

    def retained(self):
        """What the broker keeps, by topic."""
        reader = self.reader()
        self.publish("test/end", "")
        reader.wait_for("0 test/end")
        kept = dict(line.split(" ", 2)[1:] for line in reader.text().splitlines() if line.startswith("1 "))
        kept.pop("test/here")
        return kept

    def test_a_daemon_that_is_killed_is_offline_by_the_will(self):
        self.broker()
        reader = self.reader()
        daemon = self.daemon()
        page = daemon.wait_for(r"answering at (http://\S+)").group(1)
        reader.wait_for(r"0 yuragi/hall-2/status online")
        config = json.loads(reader.wait_for(r"0 homeassistant/device/yuragi_[0-9a-f]{16}/config (.*)\n").group(1))
        self.assertEqual(config["dev"]["configuration_url"], page + "/")
        reader.wait_for(r"0 yuragi/hall-2/scene/grass ON")
        reader.wait_for(r"0 yuragi/hall-2/alert/storm OFF")
        wind = json.loads(reader.wait_for(r"0 yuragi/hall-2/wind (.*)\n").group(1))
        self.assertEqual(list(wind), ["speed_m_s", "gust_m_s", "min_m_s", "direction_deg", "norm", "live", "source", "utc"])
        self.assertLessEqual(wind["min_m_s"], wind["speed_m_s"])
        self.assertLessEqual(wind["speed_m_s"], wind["gust_m_s"])
        daemon.end(signal.SIGKILL)
        reader.wait_for(r"0 yuragi/hall-2/status offline")
        kept = self.retained()
        device = [topic for topic in kept if topic.startswith("homeassistant/")]
        self.assertEqual(len(device), 1)
        self.assertEqual({topic: kept[topic] for topic in kept if topic not in device},
                         {"yuragi/hall-2/status": "offline", "yuragi/hall-2/alert/storm": "OFF",
                          "yuragi/hall-2/problem": kept["yuragi/hall-2/problem"]})

    def test_scenes_are_shown_and_hidden_whatever_stream_control_allows(self):
        self.broker()
        reader = self.reader()
        self.daemon("[stream]\ncontrol = \"nobody\"\n")
        reader.wait_for(r"0 yuragi/hall-2/scene/grass ON")
        self.publish("yuragi/hall-2/scene/grass/set", "OFF")
        reader.wait_for(r"0 yuragi/hall-2/scene/grass OFF")
        self.publish("yuragi/hall-2/scene/grass/set", "show")
        reader.wait_for(r"(?s)scene/grass OFF.*0 yuragi/hall-2/scene/grass ON")

    def test_the_broker_comes_later_and_is_restarted(self):
        daemon = self.daemon()
        daemon.wait_for(r"feed mqtt: cannot reach MQTT broker .*it is tried again")
        broker = self.broker()
        self.reader().wait_for(r"yuragi/hall-2/status online")
        broker.end(signal.SIGKILL)
        self.broker()
        reader = self.reader()
        reader.wait_for(r"homeassistant/device/yuragi_[0-9a-f]{16}/config")
        reader.wait_for(r"0 yuragi/hall-2/wind")
        self.assertEqual(daemon.end(), 0)
        reader.wait_for(r"yuragi/hall-2/status offline")

    def test_home_assistant_that_starts_gets_the_device(self):
        self.broker()
        reader = self.reader()
        self.daemon()
        reader.wait_for(r"0 yuragi/hall-2/wind")
        self.publish("homeassistant/status", "online")
        reader.wait_for(r"(?s)homeassistant/status online.*0 homeassistant/device/yuragi_[0-9a-f]{16}/config.*"
                        r"yuragi/hall-2/scene/grass ON")


if __name__ == "__main__":
    unittest.main(verbosity=2)
