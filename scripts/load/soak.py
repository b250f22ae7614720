"""Half of what the service can take, for as long as asked: prints the curve of memory and descriptors, and fails
if they grow. See scripts/soak.sh."""

import argparse
import random
import socket
import struct
import sys
import threading
import time

import demands
from client import ARROW, CSV, JSON, Connection
from process import service
from report import slope

# What may be added from the end of the warm-up to the end, by the line of least squares through the samples.
MEMORY_GROWTH = 16e6
DESCRIPTOR_GROWTH = 8
# Part of the time in which caches and allocators fill.
WARM_UP = 1 / 3
CAPACITY_SECONDS = 5
CLIENTS = 6
BATCH = 20_000
# Of the curve, as printed; all samples count.
LINES = 30


def mix():
    """What clients ask for: weight, request, whether the client leaves before the answer has ended, expected status."""
    wrong = demands.ONE.replace(b"0.55", b"-1")
    return [
        (60, demands.one(), False, 200),
        (8, demands.batch(BATCH, "json"), False, 200),
        (8, demands.batch(BATCH, "arrow"), False, 200),
        (6, demands.diagram(161, JSON), False, 200),
        (4, demands.diagram(50_000, CSV), False, 200),
        (2, demands.diagram(50_000, ARROW), False, 200),
        (4, demands.request("POST", "/v1/radiance", wrong, content_type=JSON), False, 422),
        (2, demands.request("GET", "/nowhere"), False, 404),
        (2, demands.request("GET", "/metrics"), False, 200),
        (2, demands.diagram(1_000_000, CSV), True, 200),
        (2, demands.batch(BATCH * 5, "json"), True, 200),
    ]


class Client(threading.Thread):
    """Asks at random, one request after another, every `interval` seconds on average; 0 is as fast as it can."""

    def __init__(self, address, kinds, interval, seed):
        super().__init__(daemon=True)
        self.address, self.kinds, self.interval = address, kinds, interval
        self.random = random.Random(seed)
        self.done, self.left, self.failures = 0, 0, []
        self.stop = threading.Event()
        self.connection = None

    def run(self):
        weights = [kind[0] for kind in self.kinds]
        due = time.monotonic()
        while not self.stop.is_set():
            _, message, leaves, expected = self.random.choices(self.kinds, weights)[0]
            try:
                self.ask(message, leaves, expected)
            except (OSError, ConnectionError) as error:
                self.failures.append(str(error))
                self.drop()
            due += self.random.expovariate(1 / self.interval) if self.interval else 0
            self.stop.wait(max(0, due - time.monotonic()))
        self.drop()

    def ask(self, message, leaves, expected):
        if self.connection is None:
            self.connection = Connection(self.address)
        if leaves:
            self.leave(message)
            return
        answer = self.connection.exchange(message)
        if answer.status != expected:
            raise ConnectionError(f"answered {answer.status} instead of {expected}")
        self.done += 1

    def leave(self, message):
        """Sends all of a request, reads a little or nothing, and is gone without a word."""
        self.connection.socket.sendall(message)
        time.sleep(self.random.uniform(0, 0.02))
        self.connection.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.drop()
        self.left += 1

    def drop(self):
        if self.connection is not None:
            self.connection.socket.close()
            self.connection = None


def start(server, interval):
    # Once for all: the first to ask for a batch writes it.
    kinds = mix()
    clients = [Client(server.address, kinds, interval, seed) for seed in range(CLIENTS)]
    for client in clients:
        client.start()
    return clients


def finish(clients):
    for client in clients:
        client.stop.set()
    for client in clients:
        client.join()
    failures = [failure for client in clients for failure in client.failures]
    if failures:
        raise RuntimeError(f"{len(failures)} requests failed: {failures[0]}")
    return sum(client.done + client.left for client in clients)


def capacity(server):
    """Requests a second of the mix, as many as the clients can make it answer."""
    clients = start(server, 0)
    time.sleep(CAPACITY_SECONDS)
    return finish(clients) / CAPACITY_SECONDS


def samples(server, seconds):
    """Once a second: time, resident bytes, threads, descriptors, processor seconds."""
    begun = time.monotonic()
    while (now := time.monotonic() - begun) < seconds:
        yield now, server.status("VmRSS"), server.status("Threads"), server.descriptors(), server.cpu()
        time.sleep(max(0, 1 - (time.monotonic() - begun - now)))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("seconds", type=int, nargs="?", default=60)
    seconds = parser.parse_args().seconds
    with service() as server:
        idle = server.status("VmRSS")
        rate = capacity(server)
        print(f"idle {idle / 1e6:.1f} MB; capacity {rate:.0f} requests/s of the mix; {seconds} s at half of it", flush=True)
        print("seconds  MB resident  threads  descriptors  CPU %")
        clients = start(server, CLIENTS / (rate / 2))
        taken, before = [], server.cpu()
        for sample in samples(server, seconds):
            if len(taken) % max(1, seconds // LINES) == 0:
                show(sample, (sample[4] - before) / max(sample[0], 1))
            taken.append(sample)
        requests = finish(clients)
        time.sleep(2)
        print(f"{requests} requests; {server.status('VmRSS') / 1e6:.1f} MB two seconds after the last")
    steady = [sample for sample in taken if sample[0] >= WARM_UP * seconds]
    return judge(steady)


def show(sample, busy):
    now, resident, threads, descriptors, _ = sample
    print(f"{now:7.0f}  {resident / 1e6:11.1f}  {threads:7d}  {descriptors:11d}  {100 * busy:5.0f}", flush=True)


def judge(steady):
    """Prints the growth; the exit code."""
    duration = steady[-1][0] - steady[0][0]
    times = [sample[0] for sample in steady]
    memory = slope(times, [sample[1] for sample in steady]) * duration
    descriptors = slope(times, [sample[3] for sample in steady]) * duration
    print(f"growth in the last {duration:.0f} s: {memory / 1e6:+.1f} MB (at most {MEMORY_GROWTH / 1e6:.0f}), "
          f"{descriptors:+.1f} descriptors (at most {DESCRIPTOR_GROWTH})")
    return 0 if memory <= MEMORY_GROWTH and descriptors <= DESCRIPTOR_GROWTH else 1


if __name__ == "__main__":
    sys.exit(main())
