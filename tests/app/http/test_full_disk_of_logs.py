"""A log on a full disk never stops the server."""

import signal
from contextlib import suppress
from pathlib import Path

import httpx
import pytest
from patience import until
from serving import ServerProcess


@pytest.mark.slow
def test_a_log_on_a_full_disk_stops_no_server(tmp_path):
    server = ServerProcess(tmp_path / "data", CRANKWRIGHT_LOG_LEVEL="info")
    server.log = Path("/dev/full")
    server.start()
    with httpx.Client(base_url=server.url, trust_env=False) as http:
        until(lambda: answers(http), seconds=60)
        for _ in range(300):
            assert http.get("/nothing").status_code == 404
    assert server.stop() in (0, -signal.SIGTERM)


def answers(http):
    with suppress(httpx.TransportError):
        return http.get("/healthz").status_code == 200
