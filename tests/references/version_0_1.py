"""Makes `version_0_1.sql`: the database that the service of version 0.1 left, as SQL text.

Run by hand, in an environment with the dependencies, for a checkout of that version (commit 8c2968d):

    git worktree add ../version_0_1 8c2968d
    python tests/references/version_0_1.py ../version_0_1

It starts that service on a new data folder, fills it through the interface, reads what it answers, and kills
it while jobs run and wait. Tables and rows go to `version_0_1.sql`, the answers to `version_0_1.json`.
"""

import json
import os
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import httpx

HERE = Path(__file__).parent
PORT = 8917
API = f"http://127.0.0.1:{PORT}/api/v1"
PATIENCE = 180.0  # s
STEPS = {
    "duty": {
        "template": "oil_film",
        "version": 1,
        "inputs": {
            "radial_load": "25 kN",
            "diametral_clearance": "0.055 mm",
            "bearing_diameter": "= scale * 48 mm",
            "bearing_width": "18 mm",
            "speed": "5000 rpm",
            "oil_inlet_temperature": "80 degC",
            "oil_outlet_temperature": "87.762 degC",
        },
    }
}
BEARING = {
    "name": "435 cc main bearing",
    "parameters": {"scale": "1"},
    "steps": STEPS,
    "model": {
        "id": "ball_bearing",
        "version": 1,
        "parameters": {"inner_diameter": "= duty.bearing_diameter"},
    },
    "note": "as in the paper",
}
SHELL = {
    "name": "shell, loaded by its own weight",
    "parameters": {"load": "= 24 kN + model.mass * 9.81 kN/kg"},
    "steps": {"duty": {**STEPS["duty"], "inputs": {**STEPS["duty"]["inputs"], "radial_load": "= load",
                                                   "bearing_diameter": "48 mm"}}},
    "model": {"id": "ball_bearing", "version": 1, "parameters": {"inner_diameter": "= load * 2 mm/kN"}},
}  # fmt: skip
LOOP = {"through": "model.mass", "start": "0.1 kg"}
TORSION = "/models/crank_throw/versions/1/analyses/torsion"
THROW = {
    "journal_diameter": "50 mm", "journal_length": "20 mm", "pin_diameter": "45 mm", "pin_length": "24 mm",
    "web_thickness": "18 mm", "web_width": "70 mm", "web_shape": "rectangular", "throw": "35 mm",
}  # fmt: skip


class Service:
    """The old service on a data folder of its own."""

    def __init__(self, program: Path, data: Path) -> None:
        environment = {**os.environ, "PYTHONPATH": str(program), "CRANKWRIGHT_JOB_DEADLINE": "60"}
        command = [sys.executable, "-m", "app", "serve", "--port", str(PORT), "--data", str(data)]
        self.process = subprocess.Popen(command, cwd=program, env=environment)
        self.http = httpx.Client(base_url=API, timeout=PATIENCE, trust_env=False)
        wait_for(lambda: self._answers())

    def _answers(self) -> bool:
        try:
            return self.http.get(f"http://127.0.0.1:{PORT}/healthz").is_success
        except httpx.TransportError:
            return False

    def post(self, path, body, **headers):
        response = self.http.post(path, json=body, headers={"Prefer": "wait=60", **headers})
        assert response.is_success, response.text
        return response.json()

    def patch(self, design, body, **headers):
        sent = {"Prefer": "wait=60", "If-Match": f'"{design["revision"]}"', **headers}
        response = self.http.patch(f"/designs/{design['id']}", json=body, headers=sent)
        assert response.is_success, response.text
        return response.json()


def wait_for(condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.1)


def fill(service):
    """Designs of every kind, and the keys of two requests; returns one of these requests and its answer."""
    sent = {"Idempotency-Key": "sent-before-the-upgrade"}
    design = service.post("/designs", BEARING, **sent)
    repeated = {"path": "/designs", "body": BEARING, "headers": sent, "design": design["id"]}
    design = service.patch(design, {"parameters": {"scale": "1.02"}, "note": "next size"})
    design = service.patch(design, {"steps": {"duty": {"inputs": {"radial_load": "27 kN"}}}}, **sent)
    service.post(f"/designs/{design['id']}/revisions/1/restore", {}, **{"If-Match": '"3"'})
    service.post(f"/designs/{design['id']}/copy", {"name": "copy of the bearing"})
    service.post("/designs", {**SHELL, "iterations": [LOOP]})
    service.post("/designs", {**SHELL, "name": "unsettled", "iterations": [{**LOOP, "limit": 1}]})
    gone = service.post("/designs", {**BEARING, "name": "deleted"})
    service.http.delete(f"/designs/{gone['id']}")
    service.post(TORSION, {"parameters": THROW, "level": "coarse", "outputs": ["stiffness"]})
    return repeated


def answers(service):
    """What the service says of its designs and jobs, to be compared after an upgrade."""
    answered = {}
    for design in service.http.get("/designs", params={"limit": 500}).json()["items"]:
        place = f"/designs/{design['id']}"
        revisions = service.http.get(f"{place}/revisions", params={"limit": 500}).json()["items"]
        answered[design["id"]] = {
            "design": service.http.get(place).json(),
            "revisions": [service.http.get(f"{place}/revisions/{one['number']}").json() for one in revisions],
        }
    return {"designs": answered, "jobs": service.http.get("/jobs", params={"limit": 500}).json()["items"]}


def leave_work_behind(service):
    """Jobs that run and wait, and one that is cancelled; the service is killed while they are at work."""
    later = {"Prefer": "respond-async"}
    for diameter in (51, 52, 53):
        body = {"parameters": {**THROW, "journal_diameter": f"{diameter} mm"}, "outputs": ["stiffness"]}
        last = service.http.post(TORSION, json=body, headers=later).headers["Location"]
    service.http.delete(f"http://127.0.0.1:{PORT}{last}").raise_for_status()
    for diameter in (61, 62, 63):
        body = {"name": f"left behind, {diameter} mm", "model": {**BEARING["model"], "parameters": {
            "inner_diameter": f"{diameter} mm"}}}  # fmt: skip
        service.http.post("/designs", json=body, headers=later)
    service.process.send_signal(signal.SIGKILL)
    service.process.wait()


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "data"
        service = Service(program, data)
        repeated = fill(service)
        reference = {"repeated": repeated, **answers(service)}
        leave_work_behind(service)
        connection = sqlite3.connect(data / "crankwright.sqlite")
        text = "\n".join(connection.iterdump())
        states = dict(connection.execute("SELECT state, count(*) FROM job GROUP BY state"))
    assert set(states) == {"queued", "running", "done", "failed", "cancelled"}, states
    assert folder not in text
    (HERE / "version_0_1.sql").write_text(f"{text}\n")
    (HERE / "version_0_1.json").write_text(f"{json.dumps(reference, indent=1, ensure_ascii=False)}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
