"""Instructions a request, counted by callgrind: they do not depend on the machine's mood."""

import re
import signal
import subprocess

from client import Connection, accepted
from process import PRODUCTION, RELEASE, WORK, Process

FEW, MANY = 200, 1200


def count(name, command, message, requests):
    """Instructions of a process from its start to its end, with so many requests over one connection."""
    profile = WORK / f"callgrind.{name}.{requests}"
    valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", *command]
    with Process(f"callgrind.{name}", valgrind) as process:
        with Connection(process.address) as connection:
            for _ in range(requests):
                accepted(connection.exchange(message, keep=True))
        if name == "hello":
            # It does not end by itself; callgrind writes what it has at SIGINT.
            process.process.send_signal(signal.SIGINT)
            process.process.wait(60)
    return int(re.search(r"^totals: (\d+)", profile.read_text(), re.M)[1])


def a_request(name, command, message):
    """What one request more costs: what it takes to start is in both counts."""
    return (count(name, command, message, MANY) - count(name, command, message, FEW)) / (MANY - FEW)


def service(message, *flags):
    """Of the service."""
    return a_request("reflectance", [str(RELEASE / "reflectance"), *PRODUCTION, *flags], message)


def hello(message):
    """Of the bare server."""
    return a_request("hello", [str(RELEASE / "examples" / "hello")], message)


def profile(name):
    """Where the instructions of the longer run went, the dearest functions first."""
    file = WORK / f"callgrind.{name}.{MANY}"
    return subprocess.run(["callgrind_annotate", str(file)], capture_output=True, text=True, check=True).stdout
