"""The example designs of the first page, shown if their templates and models exist."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from pydantic import JsonValue

from app.calculations.bodies import OIL_FILM
from app.catalogue.schemas.templates import TemplateSummary
from app.designs.bodies import PAPER, DesignIn
from app.designs.gallery.crank import CRANK
from app.designs.gallery.engine import FOUR_CYLINDERS, V8

FILM = {**OIL_FILM, "bearing_diameter": "= scale * 48 mm"}

Version = int | str | None


class Example(NamedTuple):
    """An example design to start from."""

    title: str
    text: str
    document: dict[str, JsonValue]


GALLERY = {
    "paper": Example(
        title="The paper's main bearing",
        text="A ball bearing of 50 mm follows the worksheet: change SCALE to 1 and it becomes 48 mm "
        "(Bhadke, Chaudhari, Sharma 2015).",
        document={**PAPER, "parameters": {"scale": "= 50 / 48"}},
    ),
    "shell": Example(
        title="A plain bearing at several levels",
        text="The same bearing calculated by oil film 2: friction, flow, stiffness, measured errors, and the "
        "pressure painted on the shell.",
        document={
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
                },
            },
        },
    ),
    "engine": Example(
        title="All bearings of a four-cylinder engine",
        text="From gas pressure to a film in every main and big end, the crankshaft, its torsion and its "
        "life: change the bore of the cylinders, and see what governs.",
        document=FOUR_CYLINDERS,
    ),
    "v8": Example(
        title="All bearings of a cross-plane V8",
        text="Two rods on each pin, five mains and eight big ends, a crankshaft whose pin angles follow from "
        "the firing order, its torsion and its life.",
        document=V8,
    ),
    "crank": Example(
        title="The paper's study of a crankshaft",
        text="Crankpin, journals, throw and the inclination of the webs' faces drive a solid; finite "
        "elements give its stiffness, torsion over the speeds its stress and life (Punewale et al. 2015).",
        document=CRANK,
    ),
}
"""Designs of the gallery by the name that the form sends."""


def offered(templates: Iterable[TemplateSummary], models: Iterable[TemplateSummary]) -> dict[str, Example]:
    """Return the examples whose templates and models exist."""
    present = {(item.id, item.version) for item in (*templates, *models)}
    return {name: example for name, example in GALLERY.items() if _uses(example) <= present}


def _uses(example: Example) -> set[tuple[str, Version]]:
    design = DesignIn.model_validate(example.document)
    uses: set[tuple[str, Version]] = {(step.template, step.version) for step in design.steps.values()}
    models = [*design.models.values(), *([design.model] if design.model else [])]
    return uses | {(model.id, model.version) for model in models}
