"""Compiled code that numba stores on disk: calculations also work without folder, disk or intact file."""

import importlib.util
import shutil

import numba
import pytest

SOURCE = '''
from templates.physics.numerics.machine_code import compiled

@compiled
def doubled(x: float) -> float:
    """Twice."""
    return 2 * x
'''


@pytest.fixture
def load(tmp_path, monkeypatch):
    """Imports a module with a compiled function afresh; its machine code is kept in tmp_path / "cache"."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "doubling.py"
    path.write_text(SOURCE)

    def module():
        spec = importlib.util.spec_from_file_location("doubling", path)
        fresh = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(fresh)
        return fresh

    return module


def machine_code(tmp_path, suffix):
    return sorted((tmp_path / "cache").rglob(f"*.{suffix}"))


def test_machine_code_is_kept(load, tmp_path):
    assert load().doubled(2.0) == 4.0
    assert len(machine_code(tmp_path, "nbc")) == 1
    again = load().doubled
    assert again(2.0) == 4.0
    assert sum(again.stats.cache_hits.values()) == 1


def test_a_folder_that_is_lost_after_the_import(load, tmp_path):
    doubled = load().doubled
    shutil.rmtree(tmp_path / "cache")
    (tmp_path / "cache").write_text("no folder")
    assert doubled(2.0) == 4.0


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("left", [0, 20])
def test_a_damaged_file(load, tmp_path, suffix, left):
    load().doubled(2.0)
    (file,) = machine_code(tmp_path, suffix)
    file.write_bytes(file.read_bytes()[:left])
    assert load().doubled(2.0) == 4.0


def test_no_folder_at_all(load, tmp_path, monkeypatch):
    (tmp_path / "cache").write_text("no folder")
    monkeypatch.setattr("numba.core.caching.CacheImpl._locator_classes", [])
    assert load().doubled(2.0) == 4.0
