"""Designs to start from: worked examples, offered where their templates and models exist."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from app.calculations.schemas import OIL_FILM
from app.designs.schemas import PAPER

FILM = {**OIL_FILM, "bearing_diameter": "= scale * 48 mm"}

GALLERY: dict[str, dict[str, Any]] = {
    "paper": {
        "title": "The paper's main bearing",
        "text": "A ball bearing of 50 mm follows the worksheet: change SCALE to 1 and it becomes 48 mm "
        "(Bhadke, Chaudhari, Sharma 2015).",
        "document": {**PAPER, "parameters": {"scale": "= 50 / 48"}},
    },
    "shell": {
        "title": "A plain bearing at several levels",
        "text": "The same duty by oil film 2: friction, flow, stiffness, measured errors, and the pressure "
        "painted on the shell.",
        "document": {
            "name": "plain main bearing",
            "parameters": {"scale": "1", "ratio": "0.5"},
            "steps": {
                "film": {
                    "template": "oil_film",
                    "version": 2,
                    "inputs": {
                        **FILM,
                        "bearing_width": "= ratio * film.bearing_diameter",
                        "journal_roughness": "0.2 um",
                        "bearing_roughness": "0.4 um",
                    },
                }
            },
            "model": {
                "id": "plain_bearing",
                "version": 1,
                "parameters": {
                    "inner_diameter": "= film.bearing_diameter",
                    "width": "= film.bearing_width",
                    "shell": "half",
                },
            },
        },
    },
}
"""By the name that its form sends."""


def offered(templates: Sequence[Mapping[str, Any]], models: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The examples whose templates and models are there."""
    known = {(item["id"], item["version"]) for item in (*templates, *models)}
    return {name: example for name, example in GALLERY.items() if _uses(example["document"]) <= known}


def _uses(document: Mapping[str, Any]) -> set[tuple[str, int]]:
    steps = {(step["template"], step["version"]) for step in document["steps"].values()}
    return steps | {(document["model"]["id"], document["model"]["version"])}
