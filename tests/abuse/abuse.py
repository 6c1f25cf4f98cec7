#!/usr/bin/env python3
"""Attacks and faults on the running programs, each a row of a table with a criterion.

usage: abuse.py --programs FOLDER --helpers FOLDER --schema FOLDER [--long] [--seed NUMBER] [--markdown FILE] [NAME...]
"""
import argparse
import concurrent.futures
import sys
import time

import bench
import client_rows  # noqa: F401  (the order of the rows)
import recording_rows  # noqa: F401
import sensor_rows  # noqa: F401
import station_rows  # noqa: F401
import start_rows  # noqa: F401
import daemon_rows  # noqa: F401
import endurance_rows  # noqa: F401


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="rows; default: all")
    parser.add_argument("--programs", required=True, help="folder of yuragi and yuragi-sim")
    parser.add_argument("--helpers", required=True, help="folder of the library of faults and of yuragi-half-year")
    parser.add_argument("--schema", required=True, help="folder of the modules that flatc --python made")
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--seed", type=int, default=None, help="of all random choices; default: another each time")
    parser.add_argument("--minutes", type=float, help="how long the rows half-hour (30) and stations (120) take in their long form")
    parser.add_argument("--beside", type=int, default=1, help="rows that are tried at the same time")
    parser.add_argument("--markdown", help="write the table into this file, too")
    options = parser.parse_args()
    seed = options.seed if options.seed is not None else time.time_ns() % 1_000_000
    settings = bench.Settings(options.programs, options.helpers, options.schema, options.long, seed, options.minutes)
    names = [line.name for line in bench.LINES]
    if unknown := set(options.names) - set(names):
        parser.error(f"no row {', '.join(sorted(unknown))}; there are: {', '.join(names)}")
    bench.raise_descriptor_limit()
    bench.pose_client.load_schema(options.schema)

    def tried(line):
        done = bench.try_row(settings, line)
        print(f"{line.name}: {bench.result_text(done)}; {'; '.join(done.figures)} ({done.took_s:.1f} s)", file=sys.stderr,
              flush=True)
        return done

    chosen = [line for line in bench.LINES if not options.names or line.name in options.names]
    with concurrent.futures.ThreadPoolExecutor(options.beside) as pool:
        futures = {line: pool.submit(tried, line) for line in sorted(chosen, key=lambda line: -line.short_s)}
    lines = [(line, futures[line].result()) for line in chosen]
    text = bench.table(lines, settings)
    print(text)
    if options.markdown:
        with open(options.markdown, "w", encoding="utf-8") as out:
            out.write(text)
    return 1 if any(done.failures for _, done in lines) else 0


if __name__ == "__main__":
    sys.exit(main())
