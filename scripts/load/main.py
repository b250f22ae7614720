"""The load test: prints what the service costs beside its floors, measured in the same run. See scripts/load.sh."""

import argparse
import sys
import time
from functools import partial

import batches
import fairness
import leaving
import memory
import report
import small
import streams
from client import ARROW, CSV, JSON

# Each on its own, so that one that fails leaves the others standing.
MEASURES = {
    "instructions": [small.counted],
    "one": [small.timed],
    "json": [batches.as_json],
    "columns": [batches.as_columns],
    "stream": [partial(streams.first_byte, medium=medium) for medium in (JSON, CSV)],
    "fairness": [partial(fairness.p99, end=end) for end in ("json", "arrow")],
    "repeated": [partial(small.repeated, medium=medium) for medium in (JSON, CSV)],
    "memory": [
        *[partial(memory.of_batch, end=end) for end in ("json", "arrow", "npy")],
        *[partial(memory.of_diagram, medium=medium) for medium in (JSON, CSV, ARROW)],
    ],
    "leaving": [
        *[partial(leaving.batch, end=end) for end in ("json", "arrow")],
        *[partial(leaving.diagram, medium=medium) for medium in (JSON, CSV)],
    ],
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="repetitions; medians are reported (5)")
    parser.add_argument("--only", action="append", choices=MEASURES, help="this measure alone; may be repeated")
    parser.add_argument("--json", metavar="FILE", help="writes every round")
    arguments = parser.parse_args()
    rows, failed = [], []
    print(report.HEAD, flush=True)
    for name in arguments.only or MEASURES:
        start = time.monotonic()
        for measure in MEASURES[name]:
            try:
                measured = measure(arguments.rounds)
            except (RuntimeError, OSError, KeyError) as error:
                failed.append(name)
                about = " ".join(getattr(measure, "keywords", {}).values())
                print(f"| {name} {about} | FAILED: {type(error).__name__}: {error} |", flush=True)
                continue
            for row in measured:
                print(report.line(row), flush=True)
            rows += measured
        print(f"{name}: {time.monotonic() - start:.0f} s", file=sys.stderr)
    if arguments.json:
        report.write(rows, arguments.json)
    missed = [row.what for row in rows if not row.kept]
    print(f"\n{len(rows)} figures, {len(missed)} beyond their limit, {len(failed)} measures failed")
    return 1 if missed or failed else 0


if __name__ == "__main__":
    sys.exit(main())
