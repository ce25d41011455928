"""Analyses as the REST interface shows them, on their own and in designs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from app.solids.questions import Question, warnings
from cad.analysis.kinds import SURFACE


def shown(
    model: Mapping[str, Any], build: str, question: Question, found: Mapping[str, Mapping[str, Any]]
) -> dict[str, Any]:
    """An analysis on its own. Outputs that were found together have one mesh and one time."""
    meshes = [told["mesh"] for told in found.values()]
    return {
        "model": dict(model),
        "build": build,
        **in_design(build, question, found),
        "level": next((told["level"] for told in found.values() if told["level"]), question.level),
        "mesh": max(meshes, key=lambda mesh: mesh["degrees_of_freedom"], default=None),
        "seconds": sum({told["seconds"] for told in found.values()}),
    }


def in_design(build: str, question: Question, found: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """An analysis in a revision, which tells no times: equal revisions are equal."""
    key = question.key(build)
    return {
        "id": key,
        **question.told(),
        "outputs": {name: _linked(key, name, _timeless(told)) for name, told in found.items()},
        "warnings": warnings(question, found),
    }


def _timeless(told: Mapping[str, Any]) -> dict[str, Any]:
    return {name: part for name, part in told.items() if name != "seconds"}


def _linked(key: str, name: str, told: Mapping[str, Any]) -> dict[str, Any]:
    """An output; one that is a file says where it is."""
    return {"url": f"/api/v1/analyses/{key}/{name}", **told} if name == SURFACE else {**told}
