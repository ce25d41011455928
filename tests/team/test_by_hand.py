"""The compose file's commands work under the conditions of containers: read-only root, only its variables."""

import hashlib

import httpx
import pytest
from bare_shells import BUSH
from by_hand import Stack, require_namespaces
from patience import patient, until
from serving import API

from app.team.processes import free_port

pytest.importorskip("cryptography")
from test_dask_tls import Authority

NAME = "crankwright.example.com"
ADA = ("keys", "add", "Ada Weber", "--role", "admin", "--role", "author")


@pytest.fixture(scope="module")
def stack(cluster, object_store, tmp_path_factory):
    require_namespaces()
    folder = tmp_path_factory.mktemp("by_hand")
    authority = Authority(folder / "tls")
    for name, file in {"ca.pem": "dask_ca", "dask.pem": "dask_cert", "dask.key": "dask_key"}.items():
        authority.files[file].rename(folder / "tls" / name)
    object_store.create("crankwright", versioned=True)
    url = cluster.create("by_hand")
    port = free_port()
    yield Stack(
        folder / "tls",
        {
            "POSTGRES_PASSWORD": "secret", "S3_USER": "trial", "S3_PASSWORD": "trial",
            "CRANKWRIGHT_NAME": NAME,
        },
        {
            "postgresql+psycopg://crankwright:secret@database/crankwright": url,
            "http://files:9000": object_store.endpoint,
            "scheduler:8786": f"127.0.0.1:{port}",
        },
    ), folder, port  # fmt: skip
    cluster.drop("by_hand")


@pytest.mark.slow
def test_the_services_of_the_compose_file_work_by_hand(stack):
    stack, folder, port = stack
    refused = stack.run("one", *stack.services()["one"]["command"][1:])
    assert refused.returncode == 1
    assert "keys add" in refused.stderr
    parts = [stack.start("scheduler", folder / "scheduler.log", "--port", str(port))]
    try:
        parts.append(stack.start("worker", folder / "worker.log"))
        added = stack.run("one", *ADA)
        assert added.returncode == 0, added.stderr
        key = added.stdout.strip()
        servers = []
        for name in ("one", "two"):
            own = free_port()
            part = stack.start(name, folder / f"{name}.log", CRANKWRIGHT_PORT=str(own))
            parts.append(part)
            headers = {"Host": NAME, "Authorization": f"Bearer {key}"}
            http = httpx.Client(
                base_url=f"http://127.0.0.1:{own}", headers=headers, timeout=patient(120), trust_env=False
            )
            part.until(lambda http=http: ready(http), patient(180))
            servers.append(http)
        one_builds_and_the_other_has_it(*servers)
        commands_do_without_a_writable_root(stack, key)
        for http in servers:
            http.close()
    finally:
        for part in reversed(parts):
            part.stop()


def ready(http):
    try:
        return http.get("/readyz").status_code == 200
    except httpx.TransportError:
        return False


def one_builds_and_the_other_has_it(one, two):
    made = one.post(
        f"{API}/models/plain_bearing/versions/1/build",
        json={"parameters": {**BUSH, "inner_diameter": "46.75 mm"}},
        headers={"Prefer": "wait=120"},
    )
    assert made.status_code == 200, made.text
    sha = until(lambda: two.get(f"{API}/builds/{made.json()['build']}").json())["artifacts"]["step"]
    assert hashlib.sha256(two.get(f"{API}/artifacts/{sha}").content).hexdigest() == sha


def commands_do_without_a_writable_root(stack, key):
    listed = stack.run("two", "keys", "list")
    assert listed.returncode == 0, listed.stderr
    assert "Ada Weber  person  author, admin" in listed.stdout
    for arguments in (
        ("check",),
        ("audit", "verify"),
        ("audit", "list"),
        ("backup", "/tmp/all.tar.gz"),  # in the container's memory
        ("keys", "disable", "Ada Weber"),
        ("keys", "enable", "Ada Weber"),
        ("keys", "revoke", key.split("_")[1]),
    ):
        done = stack.run("one", *arguments)
        assert done.returncode == 0, (arguments, done.stdout, done.stderr)
