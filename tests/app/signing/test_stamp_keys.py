"""Keys of stamps: created once, readable by their owner only, replaced, lost; and the commands."""

import json
import re
import stat
from concurrent.futures import ThreadPoolExecutor

import pytest
from click.testing import CliRunner

from app.cli.main import main
from app.settings import Settings
from app.signing.keys import PRIVATE, PUBLIC, StampKeys, UnusableKey, opened_keys
from cad.signed_file import signed

STEP = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"
CLAIMS = {
    "design": {"id": "d", "name": "one"},
    "revision": 1,
    "date": "2026-12-01T00:00:00",
    "model": "shell",
    "kind": "step",
    "build": {"key": "b", "sha256": "s"},
    "relations": {"width": "shell.width"},
}


@pytest.fixture
def keys(tmp_path):
    keys = StampKeys(tmp_path / "stamp-keys")
    keys.create()
    return keys


def run(*words):
    return CliRunner().invoke(main, words)


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


def test_the_private_key_is_for_its_owner_only_and_stays(keys):
    assert (mode(keys.folder), mode(keys.folder / PRIVATE)) == (0o700, 0o600)
    before = keys.current
    again = StampKeys(keys.folder)
    again.create()
    assert again.current == before
    assert sorted(file.name for file in keys.folder.iterdir()) == [PRIVATE, PUBLIC]


def test_servers_that_start_at_once_share_one_key(tmp_path):
    def start(_):
        keys = StampKeys(tmp_path / "shared")
        keys.create()
        return keys.current.public

    with ThreadPoolExecutor(8) as pool:
        assert len(set(pool.map(start, range(16)))) == 1


def test_a_rotation_keeps_the_old_public_key_with_its_dates(keys):
    signature, old, other_server = keys.sign(b"text"), keys.current, StampKeys(keys.folder)
    assert other_server.current == old
    new = keys.rotate()
    assert new.public != old.public
    assert other_server.current == new, "a running server signs with the new key at once"
    first, second = keys.public()
    assert (first.public, first.until) == (new.public, None)
    assert (second.public, second.until) == (old.public, first.since)
    assert second.accepts(signature, b"text")
    assert not first.accepts(signature, b"text")


def test_a_lost_private_key_is_replaced_and_its_public_key_kept(keys):
    old = keys.current
    (keys.folder / PRIVATE).unlink()
    again = StampKeys(keys.folder)
    again.create()
    assert [key.public for key in again.public()] == [again.current.public, old.public]
    assert again.current.public != old.public


def test_a_running_server_keeps_a_key_whose_file_is_lost(keys):
    before = keys.current
    (keys.folder / PRIVATE).unlink()
    assert keys.current == before
    assert before.accepts(keys.sign(b"text"), b"text")


@pytest.mark.parametrize(
    "broken", [b"", b"no key", b"-----BEGIN PRIVATE KEY-----\nAAAA\n-----END PRIVATE KEY-----"]
)
def test_a_damaged_key_is_refused_by_name_and_never_replaced(keys, broken):
    (keys.folder / PRIVATE).write_bytes(broken)
    with pytest.raises(UnusableKey, match=r"key\.pem cannot be used .*restore your copy"):
        StampKeys(keys.folder).create()
    assert (keys.folder / PRIVATE).read_bytes() == broken


def test_a_folder_for_reading_only_is_enough(keys):
    (keys.folder / PUBLIC).unlink()
    keys.folder.chmod(0o500)
    try:
        again = StampKeys(keys.folder)
        again.create()
        assert again.public()[0].public == keys.current.public
    finally:
        keys.folder.chmod(0o700)


def test_servers_of_a_team_sign_only_with_a_folder_that_they_share(tmp_path):
    team = {"data": tmp_path, "database_url": "postgresql+psycopg://crank@database/crank"}
    assert opened_keys(Settings(**team)) is None
    shared = opened_keys(Settings(**team, stamp_keys=tmp_path / "secret"))
    assert shared.current == opened_keys(Settings(**team, stamp_keys=tmp_path / "secret")).current
    assert opened_keys(Settings(data=tmp_path)).folder == tmp_path / "stamp-keys"


def test_the_command_verifies_with_the_list_of_keys(keys, tmp_path):
    file, listed = tmp_path / "part.step", tmp_path / "keys.txt"
    file.write_bytes(signed(STEP, "step", {**CLAIMS, "key": keys.current.id}, keys.sign))
    keys.rotate()
    printed = run("stamp-keys", "list", "--data", str(tmp_path))
    assert printed.exit_code == 0
    assert len(printed.output.splitlines()) == 2
    listed.write_text(printed.output)
    done = run("verify", str(file), "--key", str(listed))
    assert done.exit_code == 0, done.output
    assert done.output.startswith("valid: every byte is as key ")
    assert "  width: shell.width\n" in done.output
    newest = run("verify", str(file), "--key", keys.current.public)
    assert newest.exit_code == 3
    assert newest.output.startswith("other key: ")
    file.write_bytes(file.read_bytes().replace(b"DATA;", b"DATA; "))
    changed = run("verify", str(file), "--key", str(listed))
    assert (changed.exit_code, changed.output.split(":")[0]) == (1, "tampered")
    file.write_bytes(STEP)
    assert run("verify", str(file), "--key", str(listed)).exit_code == 4
    file.write_bytes(b"PK")
    assert run("verify", str(file), "--key", str(listed)).exit_code == 6


def test_a_wrong_key_option_says_what_would_be_right(tmp_path):
    file = tmp_path / "part.step"
    file.write_bytes(STEP)
    for text in ("ed25519:12", str(tmp_path / "missing"), str(file), str(tmp_path)):
        done = run("verify", str(file), "--key", text)
        assert done.exit_code == 2
        assert "ed25519:" in done.output
    assert run("verify", str(file)).exit_code == 2


def test_rotation_by_the_command(keys, tmp_path):
    done = run("stamp-keys", "rotate", "--data", str(tmp_path))
    assert done.exit_code == 0
    assert done.output.startswith(keys.current.public)
    assert len(json.loads((keys.folder / PUBLIC).read_text())) == 2
    assert re.search(r"since 20\d\d-\d\d-\d\dT\d\d:\d\dZ$", done.output.strip())


def test_no_key_yet_is_said(tmp_path, monkeypatch):
    done = run("stamp-keys", "list", "--data", str(tmp_path))
    assert done.exit_code == 1
    assert "has no key yet" in done.output
    assert not (tmp_path / "stamp-keys").exists()
    monkeypatch.setenv("CRANKWRIGHT_DATABASE_URL", "postgresql+psycopg://crank@database/crank")
    assert "set CRANKWRIGHT_STAMP_KEYS" in run("stamp-keys", "list").output
