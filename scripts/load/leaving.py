"""How soon a service stops computing for a client who left."""

import socket
import struct
import time
from statistics import median

import demands
from client import Connection, accepted
from process import service
from report import within

LIMIT = 10
LARGEST = 1_000_000
# Processor seconds that a server without requests may use while it is watched.
NOTHING = 0.3e-3
WATCHED = 1.0


def batch(rounds, end):
    """Of the largest batch."""
    return stops(rounds, f"{LARGEST:,} directions, {end}", demands.batch(LARGEST, end))


def diagram(rounds, medium):
    """Of the largest diagram."""
    return stops(rounds, f"{10 * LARGEST:,} rows, {medium}", demands.diagram(10 * LARGEST, medium))


def stops(rounds, name, message):
    """Milliseconds from the end of a connection to the last of the computing."""
    with service() as server:
        with Connection(server.address, timeout=600) as connection:
            whole = accepted(connection.exchange(message)).last_byte
        trials = 4 * rounds
        taken = [1e3 * leave(server, message, whole * (0.2 + 0.6 * trial / trials)) for trial in range(trials)]
    # The longest counts: no cancelled request may compute longer.
    note = f"longest of {trials}, median {median(taken):.1f}"
    return [within(f"idle after a client leaves: {name}", "ms", [max(taken)], LIMIT, note)]


def leave(server, message, moment):
    """Seconds until the processor rests, after leaving so long after the request began to be sent."""
    with Connection(server.address) as connection:
        start = time.perf_counter()
        connection.socket.sendall(message)
        connection.socket.settimeout(0.001)
        while time.perf_counter() - start < moment:
            try:
                connection.socket.recv_into(connection.buffer)
            except TimeoutError:
                pass
        # A reset: what is under way is not waited for.
        connection.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        left = time.perf_counter()
        connection.socket.close()
    samples = []
    while (now := time.perf_counter() - left) < WATCHED:
        samples.append((now, server.cpu()))
        time.sleep(0.0002 if now < 0.05 else 0.005)
    total = samples[-1][1]
    return next(now for now, spent in samples if total - spent < NOTHING)
