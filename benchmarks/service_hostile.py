"""Hostile inputs, each sent over a socket of its own, timed to the whole answer.

python -m benchmarks.service_hostile          texts that are hard to read, and /healthz meanwhile; two minutes
python -m benchmarks.service_hostile quick    each of them three times

`benchmarks.service` measures the list of issue 2. Writes `benchmarks/results/service_hostile.json`.
"""

import json
import os
import re
import select
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx

from app.calculations.schemas import OIL_FILM
from benchmarks import service_process
from benchmarks.hostile_texts import EVERY, Request
from benchmarks.service_process import Server

RESULTS = Path("benchmarks/results/service_hostile.json")
SLOWEST_ANSWER, SLOWEST_PING = 250.0, 50.0  # the aims [ms]

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
    """50 MB whose length is not stated."""
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
    length = re.search(rb"(?i)content-length: *(\d+)", head[0])
    missing = head.end() + int(length[1]) - len(answer) if length else 0
    while missing > 0 and (more := request.recv(1 << 20)):
        missing -= len(more)
    return int(head[1])


def measure(server: Server, cases: dict[str, Sender], repeats: int) -> dict[str, dict[str, Any]]:
    """Times [ms] and statuses of every case, interleaved."""
    by_case: dict[str, dict[str, Any]] = {name: {"ms": [], "statuses": set()} for name in cases}
    for _ in range(repeats):
        for name, send in cases.items():
            seconds, status = answered(server, send)
            by_case[name]["ms"].append(1e3 * seconds)
            by_case[name]["statuses"].add(status)
    return by_case


def texts(server: Server) -> dict[str, Sender]:
    """The texts that are hard to read, as senders; some are about a design, which is made here."""
    with httpx.Client(base_url=server.url, trust_env=False) as http:
        design = http.post(DESIGNS, json={"name": "any", "parameters": {"a": "1"}}).raise_for_status().json()
    return {name: _text(request, design["id"]) for name, request in EVERY.items()}


def _text(request: Request, design: str) -> Sender:
    method, path, headers, body = request
    given = {"Host": "localhost", **headers, "Content-Length": str(len(body)), "Connection": "close"}
    lines = [
        f"{method} {path.format(design=design)} HTTP/1.1",
        *(f"{n}: {v}" for n, v in given.items()),
        "",
        "",
    ]
    return lambda connection: connection.sendall("\r\n".join(lines).encode() + body)


@contextmanager
def pinging(server: Server) -> Iterator[list[float]]:
    """Times of /healthz [ms], taken every few milliseconds until the end."""
    times: list[float] = []
    over = threading.Event()

    def ping() -> None:
        with httpx.Client(base_url=server.url, trust_env=False, timeout=LONGEST) as http:
            while not over.wait(0.003):
                start = time.perf_counter()
                http.get("/healthz").raise_for_status()
                times.append(1e3 * (time.perf_counter() - start))

    thread = threading.Thread(target=ping)
    thread.start()
    try:
        yield times
    finally:
        over.set()
        thread.join()


def measure_texts(server: Server, repeats: int) -> dict[str, dict[str, Any]]:
    """Every text: processor time of the server, time of its answer, the slowest /healthz meanwhile [ms]."""
    senders, rows = texts(server), {}
    for name, send in senders.items():
        answered(server, send)  # what is imported and compiled once is not the text's
        used = server.processor_seconds()
        runs = [answered(server, send) for _ in range(repeats)]
        used = (server.processor_seconds() - used) / repeats
        with pinging(server) as pings:
            runs += [answered(server, send) for _ in range(repeats)]
        row = _row([1e3 * seconds for seconds, _ in runs], {status for _, status in runs}, pings)
        rows[name] = {"processor": round(1e3 * used, 1), **row}
        print(_line(name, rows[name]), flush=True)
    return rows


def _row(times: list[float], statuses: set[int], pings: list[float]) -> dict[str, Any]:
    ordered = sorted(times)
    row = {"median": ordered[len(ordered) // 2], "slowest": ordered[-1], "healthz": max(pings, default=0.0)}
    met = row["median"] < SLOWEST_ANSWER and row["healthz"] < SLOWEST_PING
    return {**{n: round(ms, 1) for n, ms in row.items()}, "statuses": sorted(statuses), "met": met}


def _line(name: str, row: dict[str, Any]) -> str:
    cost = "{processor:6.1f} ms of the processor, {median:7.1f} ms, slowest {slowest:7.1f}".format(**row)
    verdict = "" if row["met"] else "  MISSED"
    return f"{name:38} {cost}, /healthz {row['healthz']:6.1f} ms  {row['statuses']}{verdict}"


def main() -> None:
    """Measure the texts, print a line for each, and write the results unless it is a quick run."""
    quick = "quick" in sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder, service_process.crankwright(Path(folder)) as server:
        rows = measure_texts(server, 3 if quick else 8)
    missed = [name for name, row in rows.items() if not row["met"]]
    print(f"{len(rows)} texts, {len(missed)} missed: {', '.join(missed) or 'none'}")
    if not quick:
        date = datetime.now(UTC).isoformat(timespec="seconds")
        aims = {"answer, median [ms]": SLOWEST_ANSWER, "/healthz, slowest [ms]": SLOWEST_PING}
        head = json.dumps({"date": date, "load_average": os.getloadavg(), "aims": aims})[:-1]
        lines = ",\n".join(
            f"  {json.dumps({'text': n, **row}, ensure_ascii=False)}" for n, row in rows.items()
        )
        RESULTS.write_text(f'{head}, "rows": [\n{lines}\n]}}\n')


if __name__ == "__main__":
    main()
