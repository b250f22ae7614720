"""Rows 3 and 4: batches beside what they cost at least, and beside NumPy."""

import json
import struct
import subprocess
from pathlib import Path
from statistics import median

import demands
from client import Connection, accepted
from process import RELEASE, WORK, Process, service
from report import Row

COUNT = 100_000
REPEATS = 12
PORT = 18089
WHAT = f"{COUNT:,} directions in "


def as_json(rounds):
    """JSON in and out, beside decoding, evaluating and encoding each alone."""
    values, floors = {"json": [], "short.json": []}, []
    with service() as server:
        for _ in range(rounds):
            for end, measured in values.items():
                measured.append(once(server, end))
            floors.append(floor())
    sums = {
        end: [parts[decode] + parts["kernel"] + parts["encode"] for parts in floors]
        for end, decode in (("json", "decode"), ("short.json", "decode_short"))
    }
    shares = ", ".join(f"{part} {median(parts[part] for parts in floors):.2f}" for part in floors[0])
    return [
        Row(f"{WHAT}JSON, {digits}", "ms CPU", "decode + kernel + encode", values[end], sums[end], 1.25, note=note)
        for end, digits, note in (("json", "all digits", f"ms: {shares}"), ("short.json", "6 decimals", ""))
    ]


def as_columns(rounds):
    """Columns in and out, beside the kernel and beside FastAPI with NumPy."""
    values, kernel = {"arrow": [], "npy": [], "f64": []}, []
    with service() as server, numpy_service() as rival:
        agree(server, rival)
        for _ in range(rounds):
            for end, measured in values.items():
                measured.append(once(rival if end == "f64" else server, end))
            kernel.append(floor()["kernel"])
    ours = {"Arrow": values["arrow"], "npy": values["npy"]}
    rival = "FastAPI + NumPy, 100 terms, raw doubles"
    rows = [Row(WHAT + name, "ms CPU", "kernel", measured, kernel, 1.3) for name, measured in ours.items()]
    return rows + [Row(rival, "ms CPU", name, values["f64"], ours[name], at_least=3.0) for name in ours]


def message(end):
    """The batch; the competitor takes raw doubles."""
    if end == "f64":
        return demands.request("POST", "/radiance", demands.body(COUNT, end))
    return demands.batch(COUNT, end)


def once(server, end):
    """Processor milliseconds of one batch, of many over one connection."""
    with Connection(server.address) as connection:
        accepted(connection.exchange(message(end), keep=True))
        before = server.cpu()
        for _ in range(REPEATS):
            accepted(connection.exchange(message(end)))
        return (server.cpu() - before) / REPEATS * 1e3


def floor():
    """Processor milliseconds of each part alone."""
    for end in ("json", "short.json"):
        demands.body(COUNT, end)
    command = [RELEASE / "examples" / "floors", "measure", demands.BODIES, str(COUNT), "9"]
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    measured = [json.loads(line) for line in lines]
    return {part: median(parts[part] for parts in measured) * 1e3 for part in measured[0]}


def numpy_service():
    """The competitor, out of its virtual environment."""
    python = WORK / "venv" / "bin" / "python"
    return Process("numpy", [str(python), str(Path(__file__).with_name("numpy_service.py")), str(PORT)])


def agree(server, rival):
    """Both must do the same job: their answers agree to what 100 terms in doubles can hold."""
    ours = json.loads(answer(server, "json"))["total"]
    theirs = struct.unpack(f"<{COUNT}d", answer(rival, "f64"))
    worst = max(abs(a - b) / max(abs(a), 1e-12) for a, b in zip(ours, theirs, strict=True))
    if worst > 1e-6:
        raise RuntimeError(f"NumPy and the service differ by {worst:.1e}")


def answer(server, end):
    """The body of one answer."""
    with Connection(server.address) as connection:
        return accepted(connection.exchange(message(end), keep=True)).body
