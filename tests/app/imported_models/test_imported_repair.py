"""`crankwright check --repair` rebuilds the lost files of an imported model from its source file."""

import httpx
import pytest
from click.testing import CliRunner
from freecad_files import imported
from serving import serving

from app.cli.main import main
from app.settings import Settings
from cad.regenerate import regenerate


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A data folder with one build of a fixed part; the digests of its STEP file and of the file as sent."""
    data = tmp_path_factory.mktemp("brought") / "data"
    washer = regenerate("thrust_washer", 1, {"inner_diameter": 0.03}).step
    with serving(Settings(data=data, wait_seconds=20)) as server:
        with httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
            model = imported(http, "bought_washer", washer)
            answer = http.post(f"{model}/build", json={"parameters": {}}, headers={"Prefer": "wait=60"})
            assert answer.status_code == 200, answer.text
            sent = http.get(f"{model}/origin").json()["sha256"]
    files = {path.name: path for path in (data / "artifacts").glob("[0-9a-f][0-9a-f]/*")}
    assert sent in files
    return data, files.pop(sent), list(files.values())


def repaired(data):
    return CliRunner().invoke(main, ["check", "--repair", "--data", str(data)])


@pytest.mark.slow
def test_a_lost_build_is_drawn_again_with_the_same_bytes(kept):
    data, _, built = kept
    before = {path: path.read_bytes() for path in built}
    for path in built:
        path.unlink()
    done = repaired(data)
    assert done.exit_code == 0, done.output
    assert "repaired: step of " in done.output
    assert {path: path.read_bytes() for path in built} == before


def test_without_the_file_that_was_sent_it_is_a_fault_that_says_what_to_do(kept):
    data, sent, built = kept
    content = {path: path.read_bytes() for path in (sent, *built)}
    try:
        for path in content:
            path.unlink()
        done = repaired(data)
        assert done.exit_code == 1
        assert "not repaired: step of " in done.output
        assert "not repaired: model of bought_washer: it is the file of an imported model" in done.output
        assert "import it again" in done.output
    finally:
        for path, bytes_ in content.items():
            path.write_bytes(bytes_)
