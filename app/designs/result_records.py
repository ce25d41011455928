"""The results stored with a revision, as Pydantic models; equal texts are parsed once.

A revision stores its results once, but every page reads them several times. The cache is keyed by the stored
text, so it cannot return outdated results.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock

from cachetools import LRUCache
from pydantic import TypeAdapter
from sqlalchemy import Text, bindparam, select, type_coerce
from sqlalchemy.orm import Session

from app.designs.schemas.designs import RevisionStep, Round, RoundedValue
from app.designs.schemas.worksheets import DesignLine
from app.plain import JsonObject
from app.schemas.criteria import Criterion, Verdict
from app.solids.schemas.analyses import ModelAnalysis
from app.storage.tables import JsonText, RevisionRow, canonical_json

KEPT = 4 * 2**20  # characters of cached texts; the parsed models take about ten times as many bytes
_TEXT = select(type_coerce(RevisionRow.results, Text)).where(
    RevisionRow.design_id == bindparam("of"), RevisionRow.number == bindparam("at")
)
_JSON = JsonText()
_ROUNDS = TypeAdapter(list[Round])
_LINES = TypeAdapter(list[DesignLine])
_ROUNDED = TypeAdapter(dict[str | None, list[RoundedValue]])
_ANALYSES = TypeAdapter(dict[str, dict[str, ModelAnalysis]])
_JUDGED: Mapping[str, TypeAdapter[list[Criterion] | Verdict | None]] = {
    "criteria": TypeAdapter(list[Criterion] | None),
    "verdict": TypeAdapter(Verdict | None),
}


@dataclass(frozen=True)
class Results:
    """The results of a revision; they are shared by all readers and must not be modified."""

    text: str | None
    steps: Mapping[str, RevisionStep]  # the calculated steps
    judged: Mapping[str, list[Criterion] | Verdict | None]  # the stored members `criteria` and `verdict`
    iterations: list[Round]
    analyses: Mapping[str, dict[str, ModelAnalysis]]  # by model and kind
    governing: str = ""  # the variant that governs; empty if the design itself does
    governing_steps: Mapping[str, RevisionStep] = field(default_factory=dict)  # where they differ
    lines: list[DesignLine] = field(default_factory=list)  # of the worksheet
    governing_lines: list[DesignLine] = field(default_factory=list)
    rounded: Mapping[str | None, list[RoundedValue]] = field(
        default_factory=dict
    )  # by variant; None is the design itself

    @cached_property
    def digest(self) -> str:
        """Return the SHA-256 of the results in canonical form, which a signature covers."""
        return hashlib.sha256(canonical_json(_JSON.process_result_value(self.text)).encode()).hexdigest()


_kept: LRUCache[str, Results] = LRUCache(KEPT, getsizeof=lambda results: len(results.text or ""))
_keeping = Lock()


def results_of(session: Session, row: RevisionRow) -> Results:
    """Return the results of a revision; empty if there are none yet."""
    text: str | None = session.scalar(_TEXT, {"of": row.design_id, "at": row.number})
    if text is None:
        return Results(None, {}, {}, [], {})
    with _keeping:
        results = _kept.get(text)
    if results is None:
        results = _read(text)
        if len(text) <= KEPT:
            with _keeping:
                _kept[text] = results
    return results


def _read(text: str) -> Results:
    plain = _JSON.process_result_value(text)
    if not plain:
        return Results(text, {}, {}, [], {})
    governing = plain.get("governing", {"variant": "", "steps": {}})
    return Results(
        text=text,
        steps=_steps(plain["steps"]),
        judged={name: kind.validate_python(plain[name]) for name, kind in _JUDGED.items() if name in plain},
        iterations=_ROUNDS.validate_python(plain["iterations"]),
        rounded=_ROUNDED.validate_python(
            {
                variant: one["rounded"]
                for variant, one in {**plain.get("variants", {}), None: plain}.items()
                if "rounded" in one
            }
        ),
        analyses=_ANALYSES.validate_python(plain.get("analyses", {})),
        governing=governing["variant"],
        governing_steps=_steps(governing["steps"]),
        lines=_LINES.validate_python(plain.get("lines", [])),
        governing_lines=_LINES.validate_python(governing.get("lines", [])),
    )


def _steps(plain: JsonObject) -> dict[str, RevisionStep]:
    return {name: RevisionStep.model_validate(step) for name, step in plain.items() if "outputs" in step}
