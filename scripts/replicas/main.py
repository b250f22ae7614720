"""Kills a replica and restarts all of them under load; see scripts/replicas.sh.

Options: --config FILE, another configuration of the balancer.
"""

import argparse
import http.client
import os
import threading
import time
from collections import Counter
from pathlib import Path

from cluster import NAMES, ROOT, Cluster
from requests import LARGE, SMALL

CLIENTS = 12
# What an answer is: all that a client may rely on.
KEPT = ["content-type", "etag", "cache-control", "vary"]


def exchange(connection, request):
    """Who answered, and what."""
    method, path, headers, body = request
    connection.request(method, path, body, headers)
    answer = connection.getresponse()
    content = answer.read()
    headers = tuple(answer.getheader(name) for name in KEPT)
    return answer.getheader("x-served-by"), (answer.status, headers, content)


def expected(cluster):
    """The answers of one replica, after all have given the same."""
    answers = {}
    for replica in cluster.replicas:
        connection = http.client.HTTPConnection(replica.address, timeout=60)
        for place, request in enumerate(SMALL + LARGE):
            _, answer = exchange(connection, request)
            if answer[0] != 200:
                raise SystemExit(f"{request[:2]}: {answer[0]} {answer[2][:500]}")
            if answers.setdefault(place, answer) != answer:
                raise SystemExit(f"{request[:2]}: {replica.name} gives another answer than {NAMES[0]}")
    return answers


class Load:
    """Clients that ask one request after the other, and compare."""

    def __init__(self, address, answers):
        self.address = address
        self.answers = answers
        self.ended = threading.Event()
        self.large = threading.Event()
        self.lock = threading.Lock()
        self.served = Counter()
        self.failures = []
        self.large_under_way = 0
        self.threads = [threading.Thread(target=self.ask, args=[number]) for number in range(CLIENTS)]

    def ask(self, number):
        connection = http.client.HTTPConnection(self.address, timeout=60)
        served, failures = Counter(), []
        turn = number
        while not self.ended.is_set():
            turn += 1
            place = turn % (len(SMALL) + len(LARGE))
            is_large = place >= len(SMALL)
            if is_large and not self.begin_large():
                continue
            request = (SMALL + LARGE)[place]
            try:
                who, answer = exchange(connection, request)
                if answer == self.answers[place]:
                    served[who] += 1
                else:
                    failures.append(f"{request[:2]} by {who}: {answer[0]} {answer[2][:300]}")
            except (OSError, http.client.HTTPException) as error:
                failures.append(f"{request[:2]}: {error!r}")
                connection.close()
            if is_large:
                with self.lock:
                    self.large_under_way -= 1
        with self.lock:
            self.served += served
            self.failures += failures

    def begin_large(self):
        with self.lock:
            self.large_under_way += self.large.is_set()
            return self.large.is_set()

    def only_small(self):
        """Asks for nothing large from now on, and waits for what there is."""
        with self.lock:
            self.large.clear()
        while self.large_under_way:
            time.sleep(0.01)

    def __enter__(self):
        self.large.set()
        for thread in self.threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self.ended.set()
        for thread in self.threads:
            thread.join()


def kill_one(cluster, load):
    load.only_small()
    replica = cluster.replicas[0]
    replica.kill()
    cluster.wait_until_down(replica.name)
    time.sleep(1)
    replica.start()
    cluster.wait_until_up(replica.name)
    load.large.set()


def roll_all(cluster):
    codes = []
    for replica in cluster.replicas:
        codes.append(replica.stop())
        replica.start()
        cluster.wait_until_up(replica.name)
        time.sleep(0.5)
    return codes


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--config", type=Path, default=ROOT / "docker" / "haproxy.cfg")
    options = parser.parse_args()
    with Cluster(os.environ["REFLECTANCE_BINARY"], options.config) as cluster:
        answers = expected(cluster)
        begin = time.monotonic()
        with Load(cluster.public, answers) as load:
            time.sleep(2)
            kill_one(cluster, load)
            time.sleep(1)
            codes = roll_all(cluster)
            time.sleep(1)
        seconds = time.monotonic() - begin
        statistics = cluster.statistics()
        again = sum(int(statistics[name][kind]) for name in NAMES for kind in ["wretr", "wredis"])
        metrics = cluster.exports_metrics()
    answered = sum(load.served.values())
    by = ", ".join(f"{name} {load.served[name]}" for name in NAMES)
    print(f"replicas: {answered} answers in {seconds:.1f} s ({by}), {len(load.failures)} failed, {again} sent again")
    for failure in load.failures[:10]:
        print(f"  {failure}")
    if load.failures:
        raise SystemExit("requests failed")
    if codes != [0, 0, 0]:
        raise SystemExit(f"a replica that was told to stop cut something off: exit codes {codes}")
    if not all(load.served[name] for name in NAMES):
        raise SystemExit("a replica served nothing")
    if again == 0:
        raise SystemExit("no request met the replica that was killed: there was no load")
    if not metrics:
        raise SystemExit("the balancer exports no metrics")


if __name__ == "__main__":
    main()
