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
        moments = [whole * (0.2 + 0.6 * trial / trials) for trial in range(trials)]
        taken, spent = zip(*(leave(server, message, moment) for moment in moments))
    # The longest counts: no cancelled request may compute longer.
    note = f"longest of {trials}, median {median(taken):.1f}; {max(spent):.1f} ms of processor time at most"
    return [within(f"idle after a client leaves: {name}", "ms", [max(taken)], LIMIT, note)]


def leave(server, message, moment):
    """Milliseconds until the threads that compute rest, and those that they take until then, after leaving so many
    seconds after the request began to be sent."""
    clocks = server.workers()
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
        samples.append((now, sum(int(clock.read_text().split()[0]) for clock in clocks) * 1e-9))
        time.sleep(0.0002 if now < 0.05 else 0.005)
    total = samples[-1][1]
    rested = next(now for now, spent in samples if total - spent < NOTHING)
    return rested * 1e3, (total - samples[0][1]) * 1e3
