"""A bucket that accepts connections and does not answer: every request ends with that reason."""

import pytest
from patience import patient
from silence import Silence

from app.settings import Settings
from app.storage.errors import ArtifactsUnreachable, StoreRefused
from app.storage.folder import DataFolder
from app.storage.stores import opened_store
from app.team.object_store import AWS

s3 = pytest.importorskip("app.storage.s3", reason="the client of S3 is not installed")

pytestmark = pytest.mark.timeout(patient(60))  # the longest download may take twice that

HALF = (
    b'HTTP/1.1 200 OK\r\nContent-Length: 1000\r\nETag: "a"\r\n'
    b"Last-Modified: Sun, 22 Nov 2026 20:00:00 GMT\r\n\r\nhalf of it"
)
REQUESTS = {
    "head": lambda bucket: bucket.head("key"),
    "get": lambda bucket: bucket.get("key"),
    "put": lambda bucket: bucket.create("key", b"bytes"),
    "list": lambda bucket: list(bucket.list()),
    "copy": lambda bucket: bucket.copy("key", "other"),
    "delete": lambda bucket: bucket.delete("key"),
}


@pytest.fixture(autouse=True)
def impatient(monkeypatch):
    monkeypatch.setattr(s3, "SILENCE", 0.5)
    for name, value in AWS.items():
        monkeypatch.setenv(name, value)


@pytest.fixture
def silence(request):
    silence = Silence(said=getattr(request, "param", b""))
    silence.url = f"http://127.0.0.1:{silence.port}"
    yield silence
    silence.end()


@pytest.mark.parametrize("request_", REQUESTS.values(), ids=REQUESTS)
@pytest.mark.sampled(2)
def test_a_request_ends_and_is_not_sent_again(silence, request_):
    bucket = s3.Bucket("bucket", None, silence.url)
    with pytest.raises(ArtifactsUnreachable, match="does not answer"):
        request_(bucket)
    assert len(silence.held) == 1
    assert bucket.is_silent


@pytest.mark.parametrize("silence", [HALF], indirect=True)
def test_so_does_a_download_of_which_half_has_come(silence):
    with pytest.raises(ArtifactsUnreachable, match="does not answer"):
        s3.Bucket("bucket", None, silence.url).get("key")


def test_a_server_does_not_start_with_it(silence, tmp_path):
    settings = Settings(data=tmp_path, artifacts_url="s3://bucket", s3_endpoint=silence.url)
    with pytest.raises(StoreRefused, match=r"does not answer\. Correct CRANKWRIGHT_S3_ENDPOINT"):
        opened_store(settings, DataFolder(tmp_path))


@pytest.mark.parametrize(("size", "seconds"), [(0, 5), (2**18, 5), (2**20, 8), (3 * 2**20, 20)])
def test_an_upload_has_time_by_its_size(size, seconds):
    assert s3.seconds_of_upload(size, silence=5.0) == seconds
