"""Runs the image as docs/operations.md says one should, and holds it to what is promised; see scripts/container.sh.

With --all every black-box test asks it, without only the first.
"""

import json
import os
import socket
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
IMAGE = "localhost/reflectance"
NAME = f"reflectance-{os.getpid()}"
# What docs/operations.md recommends; crun does not run everywhere, and the limits are below those of a plain machine.
HARDENED = ["--read-only", "--cap-drop", "all", "--security-opt", "no-new-privileges"]
MACHINE = ["--runtime", "runc", "--cgroup-manager", "cgroupfs"]
LIMITS = ["--ulimit", "nofile=1024:1024", "--ulimit", "nproc=1024:1024"]
LARGEST = 30e6
STARTS = 11
USER = 65532
BLACK_BOX = [
    ("every value of the oracle that is asked over HTTP", ["cargo", "test", "--quiet", "--test", "golden", "api"]),
    ("examples and generated clients", ["scripts/clients.sh"]),
    ("schemathesis", ["scripts/schemathesis.sh", "20"]),
    ("the service's own tests, each with containers of its own", ["cargo", "test", "--quiet", "--test", "api", "--", "--test-threads", "4"]),
]


def podman(*arguments, check=True):
    """What a command of podman says."""
    command = ["podman", *MACHINE, *arguments]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    if check and ended.returncode:
        raise SystemExit(f"{' '.join(command)}: {ended.returncode}\n{ended.stdout}{ended.stderr}")
    return ended.stdout.strip() if check else ended.returncode


def inspect(kind, name):
    (found,) = json.loads(podman(kind, "inspect", name))
    return found


def run(*flags):
    """A container in the background; where it is reached."""
    podman("run", "--detach", "--name", NAME, *HARDENED, *LIMITS, "--publish", "127.0.0.1::8080", *flags, IMAGE)
    return podman("port", NAME, "8080").splitlines()[0]


def remove():
    podman("rm", "--force", "--time", "0", NAME, check=False)


def answers(address, path="/readyz"):
    """The status of one answer; none if there is nobody yet."""
    host, port = address.split(":")
    try:
        with socket.create_connection((host, int(port)), timeout=5) as connection:
            connection.sendall(f"GET {path} HTTP/1.1\r\nhost: check\r\nconnection: close\r\n\r\n".encode())
            return connection.recv(12).decode().removeprefix("HTTP/1.1 ")
    except OSError:
        return ""


def until_ready(address, clock, seconds=10):
    """By the clock, when the first answer had come."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if answers(address) == "200":
            return clock()
    raise SystemExit(f"{address} is not ready after {seconds} s")


def free_address():
    with socket.create_server(("127.0.0.1", 0)) as held:
        return "127.0.0.1:%d" % held.getsockname()[1]


def start(command, address):
    """Seconds from before a process is made to its first answer."""
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        return until_ready(address, time.monotonic) - begin
    finally:
        process.kill()
        process.wait()


def start_alone(binary):
    """The start of the image's file, without the engine around it."""
    address = free_address()
    return start([binary, "--listen", address, "--log-level", "off"], address)


def start_in_container():
    """The start of a container that is there, the engine's own time included."""
    address = free_address()
    # Health checks are run by systemd's timers, which need not be here.
    flags = ["--network", "host", "--no-healthcheck", "--env", f"REFLECTANCE_LISTEN={address}"]
    podman("create", "--name", NAME, *HARDENED, *LIMITS, *flags, IMAGE)
    try:
        return start(["podman", *MACHINE, "start", NAME], address)
    finally:
        remove()


def milliseconds(times):
    return f"median {1e3 * statistics.median(times):.1f} ms, {1e3 * min(times):.1f} to {1e3 * max(times):.1f}"


class Checks:
    """Each a line of the output; the first that fails ends it."""

    def __init__(self):
        self.passed = 0

    def that(self, what, holds):
        if not holds:
            raise SystemExit(f"container: NOT {what}")
        self.passed += 1
        print(f"container: {what}")


def image(checks):
    about = inspect("image", IMAGE)
    checks.that(f"{about['Size'] / 1e6:.1f} MB", about["Size"] < LARGEST)
    config = about["Config"]
    labels = {name.rpartition(".")[2] for name in config["Labels"] if name.startswith("org.opencontainers.image.")}
    checks.that("labels", {"title", "description", "licenses", "version", "revision"} <= labels)
    checks.that("a user by number, and a signal to stop", (config["User"], config["StopSignal"]) == ("65532:65532", "SIGTERM"))
    healthcheck = about.get("HealthCheck") or about.get("Healthcheck") or config.get("Healthcheck") or {}
    checks.that("a health check by its own binary", healthcheck.get("Test") == ["CMD", "/reflectance", "health"])


def process(checks, pid):
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    status = {name: value.split() for name, _, value in (line.partition(":") for line in lines)}
    checks.that(f"runs as {USER}", status["Uid"] == [str(USER)] * 4 and status["Gid"] == [str(USER)] * 4)
    checks.that("without any capability, and can get none", int(status["CapEff"][0], 16) == 0 and status["NoNewPrivs"] == ["1"])
    mounts = [line.split() for line in Path(f"/proc/{pid}/mounts").read_text().splitlines()]
    (root,) = [mount for mount in mounts if mount[1] == "/"]
    checks.that("its root file system is read-only", "ro" in root[3].split(","))
    names = [(task / "comm").read_text().strip() for task in Path(f"/proc/{pid}/task").iterdir()]
    checks.that("memory is given back as .cargo/config.toml says", any(name.startswith("jemalloc") for name in names))


def service(checks, tests):
    """A container from its first answer to its end; the black-box tests ask it meanwhile."""
    address = run()
    try:
        until_ready(address, time.monotonic)
        process(checks, inspect("container", NAME)["State"]["Pid"])
        checks.that("healthy", podman("healthcheck", "run", NAME, check=False) == 0)
        named = podman("exec", NAME, "/reflectance", "health", "--url", "http://localhost:8080", check=False)
        checks.that("looks names up", named == 0)
        wrong = podman("exec", NAME, "/reflectance", "health", "--url", "http://localhost:8081", check=False)
        checks.that("would be unhealthy where nobody answers", wrong == 1)
        try:
            black_box(checks, f"http://{address}", tests)
        finally:
            # Those whose podman was killed, as tests do to what they started.
            left = podman("ps", "--all", "--quiet", "--filter", "label=reflectance=test").split()
            if left:
                podman("rm", "--force", "--time", "0", *left)
        begin = time.monotonic()
        podman("stop", "--time", "40", NAME)
        code = inspect("container", NAME)["State"]["ExitCode"]
        checks.that(f"SIGTERM ended it in {time.monotonic() - begin:.1f} s with exit code {code}", code == 0)
    finally:
        remove()


def black_box(checks, url, tests):
    """The tests that know nothing but a URL."""
    environment = os.environ | {
        "REFLECTANCE_URL": url,
        "REFLECTANCE_SERVER": str(ROOT / "scripts" / "container" / "run.sh"),
    }
    for what, command in tests:
        begin = time.monotonic()
        ended = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
        if ended.returncode:
            print(ended.stdout, ended.stderr)
        checks.that(f"{what}, {time.monotonic() - begin:.0f} s", ended.returncode == 0)


def file_of_image():
    """The binary as it is in the image."""
    file = ROOT / "target" / "container" / "reflectance"
    podman("create", "--name", NAME, IMAGE)
    try:
        podman("cp", f"{NAME}:/reflectance", str(file))
    finally:
        remove()
    return file


def main():
    checks = Checks()
    image(checks)
    binary = file_of_image()
    linked = subprocess.run(["ldd", binary], capture_output=True, text=True, check=False)
    checks.that("a static binary", "not a dynamic executable" in linked.stderr or "statically" in linked.stdout)
    print(f"container: process start to first answer: {milliseconds([start_alone(binary) for _ in range(STARTS)])}")
    print(f"container: podman start to first answer: {milliseconds([start_in_container() for _ in range(STARTS)])}")
    service(checks, BLACK_BOX if "--all" in sys.argv else BLACK_BOX[:1])
    print(f"test result: ok. {checks.passed} passed; 0 failed; 0 ignored;")


if __name__ == "__main__":
    main()
