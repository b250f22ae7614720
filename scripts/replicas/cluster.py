"""Three replicas and the balancer, each a process of its own on a free port of loopback."""

import csv
import http.client
import os
import signal
import socket
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "target" / "replicas"
NAMES = ["replica-1", "replica-2", "replica-3"]


def free_ports(count):
    """Ports that nobody has; the sockets are held until all are found, so that no two are the same."""
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [held.getsockname()[1] for held in sockets]
    for held in sockets:
        held.close()
    return ports


def until(what, happened, seconds=10):
    """Waits for something that has to happen."""
    end = time.monotonic() + seconds
    while not happened():
        if time.monotonic() > end:
            raise RuntimeError(f"not within {seconds} s: {what}")
        time.sleep(0.02)


class Replica:
    """One service on a port of its own, started as often as it is needed."""

    def __init__(self, name, port, binary):
        self.name = name
        self.address = f"127.0.0.1:{port}"
        self.binary = binary
        self.process = None

    def start(self):
        with open(WORK / f"{self.name}.log", "ab") as log:
            command = [self.binary, "--listen", self.address, "--log-level", "warn"]
            self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=log)

    def kill(self):
        """As the kernel does when memory is short: without a word."""
        self.process.kill()
        self.process.wait()

    def stop(self):
        """As a supervisor does. The exit code says whether anything was cut off."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(40)


class Cluster:
    """`with` starts all and stops all."""

    def __init__(self, binary, config):
        WORK.mkdir(parents=True, exist_ok=True)
        *ports, public, metrics = free_ports(len(NAMES) + 2)
        self.replicas = [Replica(name, port, binary) for name, port in zip(NAMES, ports)]
        self.public = f"127.0.0.1:{public}"
        self.metrics = f"127.0.0.1:{metrics}"
        self.state = WORK / f"{os.getpid()}.sock"
        addresses = {f"REPLICA_{place}": replica.address for place, replica in enumerate(self.replicas, 1)}
        self.environment = os.environ | addresses | {
            "PUBLIC": self.public,
            "METRICS": self.metrics,
            "STATE_SOCKET": str(self.state),
        }
        self.config = config
        self.balancer = None

    def __enter__(self):
        command = ["haproxy", "-f", str(self.config)]
        subprocess.run([*command, "-c", "-q"], env=self.environment, check=True)
        for replica in self.replicas:
            replica.start()
        with open(WORK / "haproxy.log", "wb") as log:
            # In the foreground, its lines on standard output.
            self.balancer = subprocess.Popen([*command, "-db"], env=self.environment, stdout=log, stderr=log)
        try:
            until("the balancer's socket", self.state.exists)
            for name in NAMES:
                self.wait_until_up(name)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in [self.balancer, *(replica.process for replica in self.replicas)]:
            if process and process.poll() is None:
                process.kill()
                process.wait()
        self.state.unlink(missing_ok=True)

    def statistics(self):
        """The balancer's numbers, by replica."""
        with socket.socket(socket.AF_UNIX) as connection:
            connection.connect(str(self.state))
            connection.sendall(b"show stat\n")
            text = b"".join(iter(lambda: connection.recv(1 << 16), b"")).decode()
        rows = csv.DictReader(text.lstrip("# ").splitlines())
        return {row["svname"]: row for row in rows if row["pxname"] == "replicas"}

    def wait_until_up(self, name):
        """Until the balancer sends requests to it."""
        until(f"{name} is up", lambda: self.statistics()[name]["status"] == "UP")

    def wait_until_down(self, name):
        """Until the balancer has noticed that it is gone."""
        until(f"{name} is down", lambda: self.statistics()[name]["status"].startswith("DOWN"))

    def exports_metrics(self):
        """Whether the balancer's own metrics are there for Prometheus."""
        connection = http.client.HTTPConnection(self.metrics, timeout=10)
        connection.request("GET", "/metrics")
        answer = connection.getresponse()
        return answer.status == 200 and b"haproxy_server_status" in answer.read()
