"""Under hours of mixed load the memory, open files and rows of a service stay flat.

CRANKWRIGHT_TEST_SOAK says for how many hours; without it the test is skipped. `.ci/nightly` runs it for two.
"""

import itertools
import os
import sqlite3
import time
from pathlib import Path

import httpx
import pytest
from serving import API, ServerProcess, alive, created, descendants, paper

HOURS = float(os.environ.get("CRANKWRIGHT_TEST_SOAK", "0"))
SAMPLES = 40
WARM = 10  # samples of the time in which caches fill
FILM = {
    "radial_load": "25 kN", "bearing_diameter": "48 mm", "bearing_width": "18 mm", "speed": "7000 rpm",
    "diametral_clearance": "0.05 mm", "supply_temperature": "80 degC",
}  # fmt: skip
GROWTH = 1.05  # of the median of the last quarter over that of the first one after the warm-up
HANDLES = 8  # more open files than that are a leak: a connection or two may open or close meanwhile


def load(http, design):
    """Yield without end, each time having sent one request of a round that stores nothing new."""
    place, film = f"{API}/designs/{design['id']}", f"{API}/templates/oil_film/versions/2"
    wide = {"inputs": {**FILM, "radial_load": {"value": [1e3 * n for n in range(1, 400)], "unit": "N"}}}
    for number in itertools.count():
        scale = {"parameters": {"scale": str(1 + 0.001 * (number % 7))}}
        for method, path, body in (
            ("POST", f"{film}/evaluate", {"inputs": FILM, "level": "map"}),
            ("POST", f"{film}/evaluate", wide),
            ("POST", f"{place}/preview", scale),
            ("GET", place, None),
            ("GET", f"{place}/report.html", None),
            ("GET", f"{place}/models/bearing/model.step", None),
            ("GET", f"{API}/designs", None),
            ("GET", f"{API}/designs/missing", None),
            ("POST", f"{film}/evaluate", {"inputs": {**FILM, "speed": "7 mm"}}),
            ("GET", "/metrics", None),
        ):
            headers = {"Content-Type": "application/merge-patch+json"} if path.endswith("preview") else {}
            answer = http.request(method, path, json=body, headers=headers)
            assert answer.status_code < 500, (method, path, answer.text[:500])
            yield


def sampled(pid, database):
    """Proportional memory [bytes] and open files of the service and its processes, and rows of all tables."""
    family = [one for one in (pid, *descendants(pid)) if alive(one)]
    memory = sum(map(proportional, family))
    with sqlite3.connect(f"file:{database}?mode=ro", uri=True) as connection:
        tables = [
            name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
        ]
        rows = {name: connection.execute(f'SELECT count(*) FROM "{name}"').fetchone()[0] for name in tables}
    connection.close()
    return memory, len(os.listdir(f"/proc/{pid}/fd")), rows


def proportional(pid):
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith("Pss:"))


def middle(values):
    return sorted(values)[len(values) // 2]


@pytest.mark.slow
@pytest.mark.skipif(not HOURS, reason="runs for hours: set CRANKWRIGHT_TEST_SOAK")
@pytest.mark.timeout(3600 * HOURS + 600)
def test_memory_files_and_rows_stay_flat(tmp_path):
    server = ServerProcess(tmp_path / "data")
    samples, pause = [], 3600 * HOURS / SAMPLES
    with server, httpx.Client(base_url=server.url, timeout=120, trust_env=False) as http:
        requests, sent = load(http, created(http, paper())), 0
        for _ in range(SAMPLES):
            end = time.monotonic() + pause
            while time.monotonic() < end:
                next(requests)
                sent += 1
            samples.append(sampled(server.process.pid, tmp_path / "data" / "crankwright.sqlite"))
    memory, files, rows = zip(*samples[WARM:], strict=True)
    part = len(memory) // 4
    assert sent > 10 * SAMPLES, "too few requests to mean anything"
    assert middle(memory[-part:]) < GROWTH * middle(memory[:part]), [round(one / 2**20) for one in memory]
    assert max(files[-part:]) < max(files[:part]) + HANDLES, files
    grown = {name: (rows[0][name], count) for name, count in rows[-1].items() if count != rows[0][name]}
    assert not grown, grown
