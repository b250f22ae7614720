"""Row 6: small requests beside maximal batches."""

import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from statistics import median

import demands
import wrk
from process import service
from report import Row

SECONDS = 5
BATCHES = 8
LARGEST = 1_000_000
# Four clients that each ask about every 10 ms: enough for a percentile, too little to keep a processor busy.
CLIENTS, PAUSE = 4, 10


def p99(rounds, end):
    """The 99th percentile of one direction with and without eight maximal batches at work."""
    calm, busy, done, used = [], [], [], []
    with service() as server:
        quietly(server, 1)
        for _ in range(rounds):
            calm.append(quietly(server, SECONDS)["p99"])
            with batches(server, end) as running:
                before = server.cpu()
                busy.append(quietly(server, SECONDS)["p99"])
                used.append((server.cpu() - before) / SECONDS)
            done.append(running["done"] / running["seconds"])
    # That they were at work, and did not wait for their clients.
    note = f"{median(done):.1f} batches/s beside it, {100 * median(used):.0f} % of a processor"
    what = f"p99 of one direction beside {BATCHES} batches of {LARGEST:,}, {end}"
    return [Row(what, "µs", "p99 without them", busy, calm, at_most=3.0, note=note)]


def quietly(server, seconds):
    """A light load of single directions."""
    return wrk.run(server, demands.one(), seconds, connections=CLIENTS, pause=PAUSE)


@contextmanager
def batches(server, end):
    """Keeps the batches running, from a process of low priority: the server is measured, not their clients."""
    demands.body(LARGEST, end)
    script = Path(__file__).with_name("batch_clients.py")
    command = ["nice", "-n", "10", sys.executable, script, *map(str, server.address), end, str(BATCHES), str(LARGEST)]
    running = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    figures = {}
    try:
        # It says so once every client has sent its batch.
        running.stdout.readline()
        yield figures
        said, _ = running.communicate("stop\n", timeout=60)
        if running.returncode:
            raise RuntimeError("batches were refused")
        figures["done"], figures["seconds"] = map(float, said.split())
    finally:
        running.kill()
        running.wait()
    if not figures["done"]:
        raise RuntimeError("no batch was finished: nothing was beside the small requests")
