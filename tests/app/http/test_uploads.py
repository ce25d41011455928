"""Uploads of models: a limit of their own, on disk, not in memory, within the quota; nothing is left over."""

import os
import re
import socket
import threading
import time
from pathlib import Path

import httpx
import pytest
from patience import until
from serving import API, ServerProcess, ended, problem, serving
from signed_in import service_with_roles

from app.http.uploads import UploadFolder
from app.settings import Settings
from app.storage.errors import DiskFull
from app.web.shared.multipart import read_parts

MIB = 2**20
BINARY = {"Content-Type": "application/octet-stream"}
SMALL = {"body_limit": MIB, "upload_limit": 3 * MIB, "wait_seconds": 0.0}


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """A service whose limits are small."""
    settings = Settings(data=tmp_path_factory.mktemp("small") / "data", port=0, **SMALL)
    with serving(settings) as served, httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        yield http


def step(size: int) -> bytes:
    """So many bytes that begin as a STEP file does, and are none."""
    return b"ISO-10303-21;\nHEADER;\n".ljust(size, b" ")


def sent(http, content, id="some", **more):
    return http.post(f"{API}/models/import", params={"id": id}, content=content, headers={**BINARY, **more})


def test_a_model_may_be_larger_than_a_body(small):
    answer = sent(small, step(2 * MIB))
    assert answer.status_code == 202
    assert answer.json()["storage_limit_mb"] is None
    job = ended(small, answer)
    original = small.get(f"{API}/jobs/{job['id']}").json()
    assert original["problem"]["status"] == 422, "it is read and refused as a STEP file"
    by_page = small.post("/models/import", data={"id": "other"}, files={"file": ("a.step", step(2 * MIB))})
    assert by_page.status_code == 303


@pytest.mark.parametrize("is_chunked", [False, True])
def test_the_refusal_names_the_limit_and_its_setting(small, is_chunked):
    content = step(4 * MIB)
    answer = sent(small, iter([content[:MIB]] * 4) if is_chunked else content)
    problem(answer, 413, "body-too-large")
    assert (
        "an uploaded file may be at most 3 MiB in size (CRANKWRIGHT_UPLOAD_LIMIT)" in answer.json()["detail"]
    )
    other = small.post(f"{API}/designs", content=b" " * 2 * MIB, headers={"Content-Type": "application/json"})
    problem(other, 413, "body-too-large")
    assert "a body may be at most 1 MiB in size (CRANKWRIGHT_BODY_LIMIT)" in other.json()["detail"]


def test_the_default_limit_is_200_mib():
    assert Settings().upload_limit == 200 * MIB


def test_the_quota_is_in_the_answer_and_in_the_refusal(tmp_path):
    with service_with_roles(tmp_path) as team:
        author = team.principals["author"]
        with team.http("admin") as admin, team.http("author") as http:
            changed = admin.post(f"{API}/principals/{author}", json={"limits": {"storage_mb": 3}})
            assert changed.status_code == 200
            answer = sent(http, step(2 * MIB))
            assert answer.status_code == 202
            assert (answer.json()["storage_mb"], answer.json()["storage_limit_mb"]) == (2, 3)
            refused = sent(http, step(2 * MIB), "more")
            problem(refused, 429, "limit-reached")
            assert "used 2 MiB of 3 MiB of storage, and this file has 2.0 MiB" in refused.json()["detail"]
            chunked = sent(http, iter([step(MIB)] * 2), "more")
            problem(chunked, 429, "limit-reached")


def test_a_full_disk_refuses_a_file_before_it_arrives(tmp_path):
    free = os.statvfs(tmp_path).f_bavail * os.statvfs(tmp_path).f_frsize // MIB
    folder = UploadFolder(tmp_path / "uploads", free + 100)
    with pytest.raises(DiskFull, match="room for 0 MiB, and this file needs 2 MiB"):
        folder.require_room(2 * MIB)


def leftovers(data: Path) -> list[Path]:
    return [*(data / "uploads").iterdir(), *data.glob("artifacts/*/.tmp-*")]


def begun(port: int, size: int) -> socket.socket:
    """A connection that has announced a file, and sent half of it."""
    connection = socket.create_connection(("127.0.0.1", port))
    head = f"POST {API}/models/import?id=half HTTP/1.1\r\nHost: localhost\r\nContent-Length: {size}\r\n"
    connection.sendall(head.encode() + b"Content-Type: application/octet-stream\r\n\r\n")
    connection.sendall(step(size // 2))
    return connection


def deleted_files(pid: int) -> list[str]:
    """Open files of a process that have no name and more than a MiB."""
    found = []
    for entry in Path(f"/proc/{pid}/fd").iterdir():
        try:
            name, size = os.readlink(entry), entry.stat().st_size
        except FileNotFoundError:
            continue
        found += [name] if "deleted" in name and "/uploads/" in name and size >= MIB else []
    return found


@pytest.mark.slow
def test_aborted_and_killed_uploads_leave_nothing(tmp_path):
    data = tmp_path / "data"
    server = ServerProcess(data).start().ready()
    port, pid = int(server.url.rpartition(":")[2]), server.process.pid
    connection = begun(port, 60 * MIB)
    until(lambda: deleted_files(pid))
    assert leftovers(data) == [], "the file has no name"
    connection.close()
    until(lambda: deleted_files(pid), lambda files: files == [])
    with begun(port, 60 * MIB):
        until(lambda: deleted_files(pid))
        server.kill()
    assert leftovers(data) == []
    (data / "uploads" / "tmp_of_a_killed_server").write_bytes(bytes(MIB))
    server.start().ready()
    try:
        assert leftovers(data) == []
    finally:
        server.stop()


@pytest.mark.slow
def test_an_upload_is_never_whole_in_memory(tmp_path):
    size = 180 * MIB
    with ServerProcess(tmp_path / "data") as server:
        with httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
            sent(http, b"no model at all", "first")
            before, most, over = own_memory(server.process.pid), 0, threading.Event()
            seen: list[int] = []

            def look() -> None:
                while not over.is_set():
                    seen.append(own_memory(server.process.pid))
                    time.sleep(0.01)

            thread = threading.Thread(target=look)
            thread.start()
            answer = sent(http, bytes(size), "large")
            over.set()
            thread.join()
            problem(answer, 422, "unreadable-model")
            most = max(seen)
    assert most - before < size / 4, f"{(most - before) / MIB:.0f} MiB for {size / MIB:.0f} MiB"


def own_memory(pid: int) -> int:
    """Memory of a process that no file backs [bytes]."""
    status = Path(f"/proc/{pid}/status").read_text()
    return int(re.search(r"RssAnon:\s+(\d+) kB", status)[1]) * 1024


@pytest.mark.parametrize(
    ("body", "parts"),
    [
        (b'--x\r\ncontent-disposition: form-data; name="a"\r\n\r\none\r\n--x--\r\n', {"a": b"one"}),
        (b'before\r\n--x\r\nc: f; name="a"\r\n\r\nx--x\n\r\n--x--', {"a": b"x--x\n"}),
        (b'--x\r\nc: f; name="a"\r\n\r\n1\r\n--x\r\nc: f; name="b"\r\n\r\n\r\n--x--', {"a": b"1", "b": b""}),
        (b'--x\r\nc: f; name="a"\r\n\r\nunfinished', {"a": b"unfinished"}),
        (b"--x--\r\n", {}),
        (b"--x", {}),
        (b"", {}),
        (b"nothing", {}),
    ],
)
def test_parts_of_a_form(body, parts):
    read = read_parts(body, "multipart/form-data; boundary=x")
    assert {name: bytes(part.content) for name, part in read.items()} == parts
