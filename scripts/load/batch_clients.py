"""Clients that keep batches running until a line arrives on standard input: see fairness.py.

Prints a line when all have begun, and at the end how many batches were answered in how many seconds.
"""

import sys
import threading
import time

import demands
from client import Connection, accepted

host, port, end, clients, count = sys.argv[1:]
message = demands.batch(int(count), end)
finished, refused, stop = [], [], threading.Event()
begun = threading.Semaphore(0)


def keep_asking():
    with Connection((host, int(port)), timeout=300) as connection:
        began = False
        while not stop.is_set():
            if not began:
                begun.release()
                began = True
            try:
                accepted(connection.exchange(message))
            except (OSError, RuntimeError) as error:
                refused.append(error)
                return
            finished.append(time.monotonic())


for _ in range(int(clients)):
    threading.Thread(target=keep_asking, daemon=True).start()
for _ in range(int(clients)):
    begun.acquire()
# Bodies are on their way; the first batches are at work when the slowest has been read.
time.sleep(1)
start = time.monotonic()
print("begun", flush=True)
sys.stdin.readline()
stop.set()
seconds = time.monotonic() - start
if refused:
    sys.exit(f"{len(refused)} batches were refused: {refused[0]}")
print(sum(start <= when <= start + seconds for when in finished), seconds, flush=True)
