"""Requests over raw sockets: what the load generator does costs as little as Python allows."""

import socket
import time
from dataclasses import dataclass

CHUNK = 1 << 20

JSON = "application/json"
CSV = "text/csv"
ARROW = "application/vnd.apache.arrow.stream"
NPY = "application/x-npy"


def request(method, target, body=b"", **headers):
    """The bytes of a request; `content_type="…"` becomes Content-Type."""
    lines = [f"{method} {target} HTTP/1.1", "Host: load"]
    lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
    if body or method == "POST":
        lines.append(f"Content-Length: {len(body)}")
    return "\r\n".join([*lines, "", ""]).encode() + body


@dataclass
class Answer:
    """What came back; times in seconds from when the first byte was sent."""

    status: int
    headers: dict
    length: int
    first_byte: float
    last_byte: float
    body: bytes


class Connection:
    """One keep-alive connection."""

    def __init__(self, address, timeout=120):
        self.socket = socket.create_connection(address, timeout)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.buffer = bytearray(CHUNK)
        self.ahead = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def exchange(self, message, keep=False):
        """Sends a request and reads its answer; the body is dropped unless it is to be kept."""
        self.started = time.perf_counter()
        try:
            self.socket.sendall(message)
        except BrokenPipeError:
            # A body that was refused before its end: the answer says why.
            pass
        head = self._until(b"\r\n\r\n").decode("latin-1").split("\r\n")
        status = int(head[0].split()[1])
        headers = {name.lower(): value.strip() for name, _, value in (h.partition(":") for h in head[1:])}
        kept = [] if keep else None
        self.first = None
        if status in (204, 304):
            length = 0
        elif headers.get("transfer-encoding", "").lower() == "chunked":
            length = self._chunks(kept)
        else:
            length = int(headers.get("content-length", 0))
            self._exactly(length, kept)
        last = time.perf_counter() - self.started
        first = last if self.first is None else self.first
        return Answer(status, headers, length, first, last, b"".join(kept or []))

    def _until(self, end):
        """Up to and without `end`; of a head and of the lines between chunks."""
        data = self.ahead
        while end not in data:
            more = self.socket.recv(1 << 16)
            if not more:
                raise ConnectionError("the server closed the connection")
            data += more
        line, _, self.ahead = data.partition(end)
        return line

    def _chunks(self, kept):
        length = 0
        while True:
            size = int(self._until(b"\r\n").split(b";")[0], 16)
            self._exactly(size, kept)
            if self._until(b"\r\n") != b"":
                raise ConnectionError("a chunk that is not as long as it says")
            if size == 0:
                return length
            length += size

    def _exactly(self, length, kept):
        if length and self.first is None and self.ahead:
            self.first = time.perf_counter() - self.started
        taken, self.ahead = self.ahead[:length], self.ahead[length:]
        if kept is not None:
            kept.append(taken)
        left = length - len(taken)
        while left:
            count = self.socket.recv_into(self.buffer, min(left, CHUNK))
            if not count:
                raise ConnectionError("the server closed the connection")
            if self.first is None:
                self.first = time.perf_counter() - self.started
            if kept is not None:
                kept.append(bytes(self.buffer[:count]))
            left -= count


def accepted(answer):
    """The answer, if it is one of success."""
    if answer.status not in (200, 304):
        raise RuntimeError(f"answered {answer.status}: {answer.body[:400].decode('utf-8', 'replace')}")
    return answer
