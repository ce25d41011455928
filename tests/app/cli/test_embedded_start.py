"""The embedded default needs no extra: it starts, builds and answers without the extra `team`."""

import os
import subprocess
import sys

import httpx
import pytest
from bare_shells import BUSH
from patience import patient
from serving import API

from app.team.processes import ChildProgram, free_port

BUILD = f"{API}/models/plain_bearing/versions/1/build"
BUILT = {"parameters": {**BUSH, "inner_diameter": "46.75 mm"}}
EXTRAS = (
    "distributed", "dask", "joserfc", "obstore", "psycopg", "psycopg_binary", "pypdf", "opentelemetry.sdk",
    "opentelemetry.exporter",
)  # fmt: skip
"""What `pip install crankwright` leaves out; the extras `team` and `traces` bring these."""
ABSENT = f'''
"""Python imports this at its start: packages of the extras are not there, and who imports them is noted."""

import os
import sys
from importlib.machinery import PathFinder


class Absent(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if not any(f"{{name}}.".startswith(f"{{one}}.") for one in {EXTRAS}):
            return super().find_spec(name, path, target)
        if sys._getframe(2).f_code.co_name == "_find_and_load_unlocked":  # no mere look if it is there
            with open(os.environ["ASKED_FOR"], "a") as file:
                file.write(name + "\\n")
        return None


sys.meta_path[sys.meta_path.index(PathFinder)] = Absent
'''


@pytest.mark.slow
def test_the_embedded_service_asks_for_no_extra_and_does_its_work(tmp_path, request, monkeypatch):
    """In an interpreter of its own: what tests have imported is not there."""
    for name in [name for name in os.environ if name.startswith("CRANKWRIGHT_")]:
        monkeypatch.delenv(name)
    packages, asked, port = tmp_path / "packages", tmp_path / "asked", free_port()
    packages.mkdir()
    (packages / "sitecustomize.py").write_text(ABSENT)
    environment = {"PYTHONPATH": f"{packages}:{request.config.rootpath}", "ASKED_FOR": str(asked)}
    command = [sys.executable, "-m", "app", "serve", "--port", str(port), "--data", str(tmp_path / "data")]
    server = ChildProgram("the service", command, tmp_path / "log", environment=environment)
    try:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=patient(120), trust_env=False) as http:
            server.until(lambda: ready(http), patient(120))
            build = http.post(BUILD, json=BUILT, headers={"Prefer": "wait=100"})
            assert build.status_code == 200, build.text
            assert http.get("/designs", headers={"Accept": "text/html"}).status_code == 200
            assert http.get("/metrics").status_code == 200
    finally:
        server.stop()
    assert (asked.read_text() if asked.exists() else "") == ""


def test_the_trial_notes_who_asks(tmp_path, request):
    """So that the test above can fail."""
    (tmp_path / "sitecustomize.py").write_text(ABSENT)
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "ASKED_FOR": str(tmp_path / "asked")}
    command = [sys.executable, "-c", "import distributed"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert "No module named 'distributed'" in done.stderr
    assert (tmp_path / "asked").read_text() == "distributed\n"


def ready(http):
    try:
        return http.get("/readyz").status_code == 200
    except httpx.TransportError:
        return False
