"""The hostile inputs of the issue's list, each sent over a socket of its own, timed to the whole answer."""

import json
import re
import select
import socket
import time
from collections.abc import Callable
from typing import Any

from app.calculations.schemas import OIL_FILM
from benchmarks.service_process import Server

EVALUATE = "/api/v1/templates/oil_film/versions/1/evaluate"
DESIGNS = "/api/v1/designs"
LARGE = 50 * 2**20
CHUNK = 2**16
LONGEST = 20.0  # to wait for an answer [s]

Sender = Callable[[socket.socket], None]


def length(typed: str) -> bytes:
    """A body with this as the bearing diameter."""
    inputs = json.dumps({**OIL_FILM, "bearing_diameter": "@"}).replace('"@"', typed)
    return f'{{"inputs": {inputs}}}'.encode()


BODIES: dict[str, tuple[str, bytes]] = {
    '"-4 um"': (EVALUATE, length('"-4 um"')),
    '"40 MPa" for a length': (EVALUATE, length('"40 MPa"')),
    "NaN": (EVALUATE, length("NaN")),
    "1e999": (EVALUATE, length("1e999")),
    "true": (EVALUATE, length("true")),
    '"m**9**9**9"': (EVALUATE, length('"m**9**9**9"')),
    "a lone surrogate": (EVALUATE, length('"\\ud800"')),
    "a lone surrogate, design": (DESIGNS, b'{"name": "\\ud800"}'),
    "an unknown name": (EVALUATE, json.dumps({"inputs": {**OIL_FILM, "unheard_of": "1"}}).encode()),
    "10^5 nested brackets": (EVALUATE, b"[" * 10**5 + b"]" * 10**5),
    "10^5 nested brackets, input": (EVALUATE, length("[" * 10**5 + "]" * 10**5)),
    "10^5 nested brackets, design": (DESIGNS, b"[" * 10**5 + b"]" * 10**5),
    "10^5 nested objects": (DESIGNS, b'{"a":' * 10**5 + b"1" + b"}" * 10**5),
    "10^5 brackets in a relation": (
        DESIGNS,
        json.dumps({"name": "x", "parameters": {"a": "= " + "(" * 10**5 + "1" + ")" * 10**5}}).encode(),
    ),
    "a text of a megabyte": (EVALUATE, length('"' + "9" * 2**20 + ' mm"')),
}
BEYOND: dict[str, tuple[str, bytes]] = {
    "15 MB of unknown names": (
        EVALUATE,
        b'{"inputs": {' + b",".join(b'"name_%d": "1"' % i for i in range(750_000)) + b"}}",
    ),
    "15 MB of brackets": (EVALUATE, b'{"inputs": {"speed": [' + b"[]," * 5_000_000 + b"[]]}}"),
    "15 MB of one array": (EVALUATE, b'{"inputs": {"speed": [' + b"0," * 7_500_000 + b"0]}}"),
}


def _declared(request: socket.socket) -> None:
    """50 MB, announced; sent until the server has answered."""
    request.sendall(_head(EVALUATE, f"Content-Length: {LARGE}"))
    _send_while_unanswered(request, b" " * CHUNK)


def _chunked(request: socket.socket) -> None:
    """50 MB whose length nobody has told."""
    request.sendall(_head(EVALUATE, "Transfer-Encoding: chunked"))
    _send_while_unanswered(request, b"%x\r\n%b\r\n" % (CHUNK, b" " * CHUNK))


def _head(path: str, framing: str) -> bytes:
    lines = (f"POST {path} HTTP/1.1", "Host: localhost", "Content-Type: application/json", framing, "", "")
    return "\r\n".join(lines).encode()


def _send_while_unanswered(request: socket.socket, chunk: bytes) -> None:
    left = len(chunk) * (LARGE // CHUNK)
    while left:
        answered, open_, _ = select.select([request], [request], [], LONGEST)
        if answered or not open_:
            return
        left -= request.send(chunk[-(left % len(chunk)) :])


def _plain(path: str, body: bytes) -> Sender:
    return lambda request: request.sendall(_head(path, f"Content-Length: {len(body)}") + body)


CASES: dict[str, Sender] = {
    "50 MB body": _declared,
    "50 MB body, chunked": _chunked,
    **{name: _plain(*case) for name, case in BODIES.items()},
}
LARGEST = {name: _plain(*case) for name, case in BEYOND.items()}
"""Beyond the issue's list: bodies just below the limit of 16 MiB, whose parsing alone takes its time."""


def answered(server: Server, send: Sender) -> tuple[float, int]:
    """Seconds from connecting to the whole answer, and its status; 0 if there was none."""
    start = time.perf_counter()
    with socket.create_connection(("127.0.0.1", server.port), timeout=LONGEST) as request:
        try:
            send(request)
            status = _status(request)
        except (ConnectionResetError, TimeoutError):
            status = 0
    return time.perf_counter() - start, status


def _status(request: socket.socket) -> int:
    """Read a whole answer."""
    answer = bytearray()
    while not (head := re.match(rb"HTTP/1.1 (\d+)(?s:.*?)\r\n\r\n", answer)):
        if not (more := request.recv(1 << 16)):
            return 0
        answer += more
    told = re.search(rb"(?i)content-length: *(\d+)", head[0])
    missing = head.end() + int(told[1]) - len(answer) if told else 0
    while missing > 0 and (more := request.recv(1 << 20)):
        missing -= len(more)
    return int(head[1])


def measure(server: Server, cases: dict[str, Sender], repeats: int) -> dict[str, dict[str, Any]]:
    """Times [ms] and statuses of every case, interleaved."""
    found: dict[str, dict[str, Any]] = {name: {"ms": [], "statuses": set()} for name in cases}
    for _ in range(repeats):
        for name, send in cases.items():
            seconds, status = answered(server, send)
            found[name]["ms"].append(1e3 * seconds)
            found[name]["statuses"].add(status)
    return found
