"""Load on an HTTP service, made by another process: wrk if there is one, else a client of plain sockets.

`python -m benchmarks.service_load URL SECONDS FILE` is that client; it prints requests per second.
"""

import atexit
import os
import re
import selectors
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

CONNECTIONS = 16
WRK = shutil.which("wrk")
_SCRIPT = """wrk.method = "POST"
wrk.headers["Content-Type"] = "application/json"
wrk.body = [==[{body}]==]
"""


def requests_per_second(url: str, body: bytes, seconds: float) -> float:
    """POST a body over and over by kept connections; raises if any answer is no success."""
    return _by_wrk(url, body, seconds) if WRK else _by_sockets(url, body, seconds)


def _by_wrk(url: str, body: bytes, seconds: float) -> float:
    # wrk counts whole seconds
    command = [WRK, "-t1", f"-c{CONNECTIONS}", f"-d{max(1, round(seconds))}s", "-s", _script(body), url]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    match = re.search(r"Requests/sec:\s*([0-9.]+)", printed)
    if match is None or "Non-2xx" in printed or "Socket errors" in printed:
        raise RuntimeError(f"{url}: {printed}")
    return float(match[1])


@cache
def _script(body: bytes) -> str:
    with tempfile.NamedTemporaryFile("w", suffix=".lua", delete=False) as file:
        file.write(_SCRIPT.format(body=body.decode()))
    atexit.register(os.unlink, file.name)
    return file.name


def _by_sockets(url: str, body: bytes, seconds: float) -> float:
    with tempfile.NamedTemporaryFile() as file:
        file.write(body)
        file.flush()
        command = [sys.executable, "-m", "benchmarks.service_load", url, str(seconds), file.name]
        return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def post(path: str, body: bytes, headers: str = "") -> bytes:
    """The bytes of a request."""
    head = f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n{headers}"
    return f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body


class Connection:
    """One kept connection, with one request on its way."""

    def __init__(self, host: str, port: int, request: bytes) -> None:
        self.request, self.buffer, self.answered = request, bytearray(), 0
        self.socket = socket.create_connection((host, port))
        self.socket.sendall(request)

    def receive(self) -> None:
        """Take what has come; after a whole answer, ask again."""
        self.buffer += self.socket.recv(1 << 18)
        end = self.buffer.find(b"\r\n\r\n")
        if end < 0:
            return
        length = re.search(rb"(?i)content-length: *([0-9]+)", self.buffer[:end])
        if length is None or not self.buffer.startswith(b"HTTP/1.1 200"):
            raise RuntimeError(bytes(self.buffer[:1000]))
        if len(self.buffer) >= end + 4 + int(length[1]):
            self.buffer.clear()
            self.answered += 1
            self.socket.sendall(self.request)


def main() -> None:
    """Be the client."""
    url, seconds, file = urlsplit(sys.argv[1]), float(sys.argv[2]), Path(sys.argv[3])
    request = post(url.path, file.read_bytes())
    connections = [Connection(url.hostname or "", url.port or 80, request) for _ in range(CONNECTIONS)]
    start = time.perf_counter()
    with selectors.DefaultSelector() as ready:
        for connection in connections:
            ready.register(connection.socket, selectors.EVENT_READ, connection)
        while time.perf_counter() < start + seconds:
            for key, _ in ready.select(1):
                key.data.receive()
    print(sum(connection.answered for connection in connections) / (time.perf_counter() - start))


if __name__ == "__main__":
    main()
