"""A process under load: started and stopped, its processor time, memory, threads and descriptors."""

import os
import re
import signal
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "target" / "load"
RELEASE = Path(os.environ.get("REFLECTANCE_RELEASE", ROOT / "target" / "release"))

# The service as it runs in production: every request logged as JSON, to a file. All else is on by default.
PRODUCTION = ["--listen", "127.0.0.1:0", "--log-format", "json"]


class Process:
    """A server that prints the address at which it listens; `with` stops it."""

    def __init__(self, name, command):
        WORK.mkdir(parents=True, exist_ok=True)
        self.name = name
        output = WORK / f"{name}.out"
        with open(output, "wb") as out, open(WORK / f"{name}.log", "wb") as log:
            self.process = subprocess.Popen(command, stdout=out, stderr=log, cwd=WORK)
        self.pid = self.process.pid
        self.address = self._address(output)

    def _address(self, output):
        until = time.monotonic() + 60
        while time.monotonic() < until and self.process.poll() is None:
            said = re.search(r"http://(127\.0\.0\.1):(\d+)", output.read_text())
            if said:
                return said[1], int(said[2])
            time.sleep(0.05)
        self.stop()
        raise RuntimeError(f"{self.name} did not say where it listens: see {WORK / self.name}.log")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def stop(self):
        """SIGTERM, and SIGKILL to what does not end."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self.process.wait(40)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()

    @property
    def url(self):
        return "http://{}:{}".format(*self.address)

    def cpu(self):
        """Processor seconds of all its threads, those that ended included, to the nanosecond."""
        # The kernel's clock of another process: see clock_getcpuclockid(3).
        return time.clock_gettime((~self.pid << 3) | 2)

    def workers(self):
        """The clocks of the threads that serve and compute: not of those by which jemalloc gives memory back."""
        tasks = Path(f"/proc/{self.pid}/task").iterdir()
        return [task / "schedstat" for task in tasks if not (task / "comm").read_text().startswith("jemalloc")]

    def status(self, field):
        """A number from /proc/PID/status; of memory in bytes."""
        for line in Path(f"/proc/{self.pid}/status").read_text().splitlines():
            name, _, value = line.partition(":")
            if name == field:
                number = int(value.split()[0])
                return number * 1024 if value.endswith("kB") else number
        raise KeyError(field)

    def descriptors(self):
        """How many are open."""
        return len(os.listdir(f"/proc/{self.pid}/fd"))

    def forget_peak(self):
        """Starts the peak of resident memory anew."""
        Path(f"/proc/{self.pid}/clear_refs").write_text("5")


def service(*more):
    """The service, with more flags."""
    return Process("reflectance", [str(RELEASE / "reflectance"), *PRODUCTION, *more])


def hello():
    """The bare axum server beside it."""
    return Process("hello", [str(RELEASE / "examples" / "hello")])
