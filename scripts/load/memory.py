"""Memory of the largest request of each kind, above idle."""

import time

import demands
from client import Connection, accepted
from process import service
from report import within

LIMIT = 200
DIRECTIONS, ROWS = 1_000_000, 10_000_000


def of_batch(rounds, end):
    """The largest batch in and out."""
    return peaks(rounds, f"{DIRECTIONS:,} directions, {end}", demands.batch(DIRECTIONS, end))


def of_diagram(rounds, medium):
    """The largest diagram."""
    return peaks(rounds, f"{ROWS:,} rows, {medium}", demands.diagram(ROWS, medium))


def peaks(rounds, name, message):
    """Megabytes of resident memory at the peak, less those before, each time in a process of its own."""
    measured = [peak(message) for _ in range(min(rounds, 3))]
    answer = measured[0][1]
    note = f"answer of {answer.length / 1e6:.0f} MB in {answer.last_byte:.1f} s"
    return [within(f"memory above idle: {name}", "MB", [megabytes for megabytes, _ in measured], LIMIT, note)]


def peak(message):
    """Megabytes, and the answer."""
    with service() as server, Connection(server.address, timeout=600) as connection:
        accepted(connection.exchange(demands.one()))
        time.sleep(0.5)
        idle = server.status("VmRSS")
        server.forget_peak()
        answer = accepted(connection.exchange(message))
        return (server.status("VmHWM") - idle) / 1e6, answer
