"""Typeset a report as PDF with Typst. Worker processes import this module, so it imports little.

The typesetter receives a fixed document, `report.typ`, and the report as data. User texts are never
interpreted as markup: they are strings in the data, and formulas are MathML whose elements the document
knows. Typst provides the fonts; fonts of the system serve only for characters that these lack, such as other
alphabets.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any, NotRequired, TypedDict

import typst

from app.presentation.bidi import bare_everywhere
from app.reports.widths import CELL, LINE, fits

PICTURE, DRAWING = "png", "drawing.svg"  # kinds of a model's files that a report shows
PAINTED = "painted "  # prefix for the name of a field; its picture is also a PNG
SKETCH = "svg"  # kind of file for each solid of variants: a line drawing costs a tenth of a shaded picture

Pictures = Mapping[str, Mapping[str, bytes]]  # by model and kind

DOCUMENT = Path(__file__).with_name("report.typ")

# The parts of `app.reports.content.Report` that are read here, as `asdict` gives them: its classes are not
# imported, for they bring the models of answers into the worker.


class _Row(TypedDict):
    lead: str
    numbers: str
    result: str


class _Input(TypedDict):
    relation: str


class _Rule(TypedDict):
    demand: str
    numbers: str


class _Step(TypedDict):
    formulas: list[_Row]
    inputs: list[_Input]
    ranges: list[_Rule]
    rules: list[_Rule]


class _Solid(TypedDict):
    name: str


class _Model(_Solid):
    rules: list[_Rule]


class _Variants(TypedDict):
    solids: list[_Solid]


class ReportAsData(TypedDict):
    """A report as plain data."""

    date: str
    steps: list[_Step]
    models: list[_Model]
    variants: NotRequired[_Variants | None]


def typeset(report: ReportAsData, pictures: Pictures) -> bytes:
    """Return a report as PDF; equal reports give equal bytes."""
    steps = [_bounded(step) for step in report["steps"]]
    models = [
        {**part, "rules": _rules(part["rules"]), **_illustrated(part, pictures)} for part in report["models"]
    ]
    shown = {**report, "steps": steps, "models": models}
    if variants := report.get("variants"):
        shown["variants"] = {
            **variants,
            "solids": [{**solid, **_illustrated(solid, pictures)} for solid in variants["solids"]],
        }
    data = json.dumps(bare_everywhere(shown), ensure_ascii=True).encode()
    files: Any = {"main": DOCUMENT.read_bytes(), "data.json": data}  # type stubs of typst lack this
    date = datetime.fromisoformat(report["date"]).replace(microsecond=0)
    pdf = typst.compile(files, format="pdf", timestamp=date)
    assert isinstance(pdf, bytes), "one document makes one file"
    return pdf


def _bounded(step: _Step) -> dict[str, object]:
    """Return a step in which formulas that certainly fit are marked, so that they need not be measured."""
    return {
        **step,
        "formulas": [
            {**row, "fits": fits((row["lead"], row["numbers"], row["result"]), LINE)}
            for row in step["formulas"]
        ],
        "inputs": [{**one, "fits": fits([one["relation"]], CELL)} for one in step["inputs"]],
        "ranges": _rules(step["ranges"]),
        "rules": _rules(step["rules"]),
    }


def _rules(rules: Iterable[_Rule]) -> list[dict[str, object]]:
    return [
        {
            **rule,
            "demand-fits": fits([rule["demand"]], CELL),
            "numbers-fit": fits([rule["numbers"]], CELL),
        }
        for rule in rules
    ]


def _illustrated(part: _Solid, pictures: Pictures) -> dict[str, object]:
    """Return a model or solid with its pictures as a field, found by its name."""
    return {"pictures": _as_svg(pictures.get(part["name"], {}))}


def _as_svg(files: Mapping[str, bytes]) -> dict[str, str]:
    """Return pictures as SVG texts, because the typesetter's data is text; a PNG is embedded in an SVG."""
    kinds = {"drawing": DRAWING, "picture": SKETCH}
    pictures = {name: files[kind].decode() for name, kind in kinds.items() if kind in files}
    if PICTURE in files:
        pictures["picture"] = _in_svg(files[PICTURE])
    return pictures | {name: _in_svg(file) for name, file in files.items() if name.startswith(PAINTED)}


def _in_svg(png: bytes) -> str:
    coded = base64.b64encode(png).decode()
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 480" width="640" height="480">'
        f'<image width="640" height="480" href="data:image/png;base64,{coded}"/></svg>'
    )
