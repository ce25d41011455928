"""Cached parsed definitions equal newly read ones; damaged ones are read again."""

import importlib
import os
import pickle
import sys

import pint
import pytest

from templates.core import definition_cache
from templates.core.units import units


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder of its own for what is kept."""
    monkeypatch.setattr(definition_cache, "place", lambda name: tmp_path / name)
    return tmp_path


def known(registry, names):
    """The size and the base units of each unit, and how a few are written."""
    written = [f"{registry.Unit(name):~P}" for name in ("kN", "mPa*s", "degC", "rpm", "W/(m*K)", "µm")]
    return {name: registry.get_base_units(name) for name in names}, written


def test_property_units_that_are_kept_are_those_of_the_definitions(folder):
    first, second = (definition_cache.from_folder("units", units._registry) for _ in range(2))
    assert [place.name for place in folder.iterdir()] == ["units"]
    assert second.cache_folder == folder / "units"
    read = pint.UnitRegistry()
    names = sorted({unit.name for unit in read._units.values()})
    assert len(names) > 400
    assert str(known(first, names)) == str(known(second, names)) == str(known(read, names))


@pytest.mark.parametrize("content", [b"", b"not a pickle", b"cnowhere\nnothing\n."])
def test_a_damaged_file_is_read_from_its_definition_and_made_again(folder, content):
    def make(given):
        if given is not None:
            given.mkdir(exist_ok=True)
            kept = given / "kept.pickle"
            if kept.exists():
                return pickle.loads(kept.read_bytes())
            kept.write_bytes(pickle.dumps("made"))
        return "made"

    assert definition_cache.from_folder("it", make) == "made"
    (folder / "it" / "kept.pickle").write_bytes(content)
    assert definition_cache.from_folder("it", make) == "made"
    assert not (folder / "it").exists()
    assert [definition_cache.from_folder("it", make) for _ in range(2)] == ["made", "made"]
    assert (folder / "it" / "kept.pickle").exists()


def test_where_python_keeps_no_bytecode_nothing_is_written(folder, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert definition_cache.from_folder("units", lambda given: given) is None
    assert definition_cache.file("grammar") is False
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert definition_cache.from_folder("units", lambda given: given) is None
    assert list(folder.iterdir()) == []


def test_what_cannot_be_written_is_made_all_the_same(folder):
    def make(given):
        if given is not None:
            raise PermissionError
        return "made"

    assert definition_cache.from_folder("units", make) == "made"
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("module", ["templates.core.units.relation", "templates.core.sheets.grammar"])
def test_a_grammar_is_kept_where_python_keeps_bytecode(module):
    importlib.import_module(module)
    name = {"relation": "relation.grammar", "grammar": "statement.grammar"}[module.rpartition(".")[2]]
    assert definition_cache.file(name) == str(definition_cache.place(name))
    assert definition_cache.place(name).stat().st_size > 1000
