"""Many small requests by `wrk`: processor time a request, and how long clients wait."""

import json
import os
import subprocess
from pathlib import Path

SCRIPT = Path(__file__).with_name("wrk.lua")
CONNECTIONS = 64


def run(server, message, seconds, connections=CONNECTIONS, pause=0):
    """Sends one request over and over. Answers wrk's figures (times in µs), with processor seconds a request."""
    head, _, body = message.partition(b"\r\n\r\n")
    first, *headers = head.decode().split("\r\n")
    method, target, _ = first.split(" ")
    # wrk adds these two itself.
    headers = [line for line in headers if line.split(":")[0].lower() not in ("host", "content-length")]
    environment = {**os.environ, "LOAD_METHOD": method, "LOAD_HEADERS": "\n".join(headers), "LOAD_PAUSE": str(pause)}
    if body:
        environment["LOAD_BODY"] = body.decode()
    command = ["wrk", "-t1", f"-c{connections}", f"-d{seconds}s", "--timeout", "30s", "-s", SCRIPT, server.url + target]
    before = server.cpu()
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    spent = server.cpu() - before
    figures = json.loads(done.stdout.splitlines()[-1])
    if figures["refused"] or figures["broken"] or not figures["requests"]:
        raise RuntimeError(f"{server.name} did not answer every request of wrk with success: {figures}")
    figures["cpu"] = spent / figures["requests"]
    return figures
