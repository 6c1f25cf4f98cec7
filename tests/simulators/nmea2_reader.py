#!/usr/bin/env python3
"""Reads sentences from a TCP server with pynmea2, which is nobody's here, and prints what it makes of the wind.

usage: nmea2_reader.py PORT COUNT

A line for each sentence whose checksum is right: its name, and its fields by pynmea2's names. Anything else ends it with
an exception.
"""
import socket
import sys

import pynmea2

FIELDS = {
    "MWV": ("wind_angle", "reference", "wind_speed", "wind_speed_units", "status"),
    "MWD": ("direction_true", "wind_speed_knots", "wind_speed_meters"),
    "VWR": ("deg_r", "l_r", "wind_speed_kn", "wind_speed_ms", "wind_speed_km"),
    "VWT": ("wind_angle_vessel", "direction", "wind_speed_knots", "wind_speed_meters", "wind_speed_km"),
    "MDA": ("direction_true", "wind_speed_knots", "wind_speed_meters"),
}


def main():
    port, count = int(sys.argv[1]), int(sys.argv[2])
    with socket.create_connection(("127.0.0.1", port), timeout=60) as server:
        lines = server.makefile("r", encoding="ascii", newline="\r\n")
        for _ in range(count):
            sentence = pynmea2.parse(lines.readline(), check=True)
            name = sentence.sentence_type
            if name == "XDR":
                transducers = [sentence.get_transducer(i) for i in range(sentence.num_transducers)]
                print(name, *(":".join((one.type, one.value, one.units, one.id)) for one in transducers), flush=True)
            else:
                print(name, *(getattr(sentence, field) for field in FIELDS[name]), flush=True)


main()
