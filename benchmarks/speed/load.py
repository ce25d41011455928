"""Load an HTTP service from a separate process: one request after another on persistent connections.

`python -m benchmarks.speed.load URL SECONDS FILE` is that process; it prints how many requests were answered.
"""

from __future__ import annotations

import re
import selectors
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import urlsplit

CONNECTIONS = 16


def answered(url: str, body: bytes, seconds: float) -> int:
    """Return how many times a body was posted and answered; raise an error if an answer is no success."""
    with tempfile.NamedTemporaryFile() as file:
        file.write(body)
        file.flush()
        command = [sys.executable, "-m", "benchmarks.speed.load", url, str(seconds), file.name]
        return int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


class Connection:
    """One persistent connection with one pending request."""

    def __init__(self, host: str, port: int, request: bytes) -> None:
        self.request, self.buffer, self.answered = request, bytearray(), 0
        self.socket = socket.create_connection((host, port))
        self.socket.sendall(request)

    def receive(self) -> None:
        """Read available data; after a complete answer, send the next request."""
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
    """Send the requests."""
    url, seconds, body = urlsplit(sys.argv[1]), float(sys.argv[2]), Path(sys.argv[3]).read_bytes()
    head = f"POST {url.path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    request = f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body
    connections = [Connection(url.hostname or "", url.port or 80, request) for _ in range(CONNECTIONS)]
    end = time.perf_counter() + seconds
    with selectors.DefaultSelector() as ready:
        for connection in connections:
            ready.register(connection.socket, selectors.EVENT_READ, connection)
        while time.perf_counter() < end:
            for key, _ in ready.select(1):
                key.data.receive()
    print(sum(connection.answered for connection in connections))


if __name__ == "__main__":
    main()
