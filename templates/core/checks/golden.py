"""Compare a version with its golden record (results) and with its release file (digest)."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from templates.core.catalogue.digests import digest, release_file
from templates.core.catalogue.golden import results
from templates.core.checks.faults import FileFault
from templates.core.errors import InvalidInputs
from templates.core.language.template import Template

MOST_DIFFERENCES = 5
NEW_VERSION = "undo the edit, and put the change into a new version"


def records(path: Path) -> tuple[Path, ...]:
    """Return the paths where the golden record may be.

    They are next to a team's file, or in a folder `golden` next to it.
    """
    return path.with_suffix(".json"), path.parent / "golden" / f"{path.stem}.json"


def faults_of_release(cls: type[Template], path: Path) -> Iterator[FileFault]:
    """Yield the differences from the release.

    Different results quarantine the version; a different digest is only reported.
    """
    for file in records(path):
        if file.is_file():
            yield from _against(cls, file)
    release = release_file(cls)
    recorded = _read(release) if release else None
    if release and recorded is not None and recorded.get("digest") != digest(cls):
        what = f"the code is not that of the release: {release.name} contains another digest"
        yield FileFault("released", what, NEW_VERSION, quarantines=False)


def _against(cls: type[Template], file: Path) -> Iterator[FileFault]:
    record = _read(file)
    if record is None or not isinstance(record.get("cases"), list):
        what = f"{file.name} is not a golden record"
        yield FileFault("golden", what, "write it with `crankwright freeze`, or delete it")
        return
    for number, what in enumerate(differences(cls, record)):
        if number == MOST_DIFFERENCES:
            return
        yield FileFault("golden", f"{file.name}: {what}", NEW_VERSION)


def _read(file: Path) -> dict[str, Any] | None:
    """Return a record as JSON; None if there is no readable one."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return content if isinstance(content, dict) else None


def differences(cls: type[Template], record: Mapping[str, Any]) -> Iterator[str]:
    """Yield a sentence for each difference between a version's results and its golden record."""
    precision = float(record.get("precision", cls.precision))
    for case in [*record["cases"], *record.get("levels", ())]:
        try:
            outcome = results(cls, case["inputs"], case.get("level", ""))
        except InvalidInputs as refusal:
            codes = sorted(fault.code for fault in refusal.faults)
            if case.get("refused") != codes:
                yield f"inputs {case['inputs']} are refused now: {refusal}"
            continue
        yield from _of_case(case, outcome, float(case.get("precision", precision)))


def _of_case(case: Mapping[str, Any], outcome: Mapping[str, Any], precision: float) -> Iterator[str]:
    if "refused" in case:
        yield f"inputs {case['inputs']} were refused and are calculated now"
        return
    for name in sorted(case["outputs"].keys() | outcome.keys()):
        old, new = case["outputs"].get(name), outcome.get(name)
        if not _equal(old, new, precision):
            yield f"{name} is {_short(new)}, recorded is {_short(old)}, at {_short(case['inputs'])}"


def _equal(old: Any, new: Any, precision: float) -> bool:
    """Return whether two results in SI agree: texts exactly, numbers within the relative precision."""
    if isinstance(old, str) or isinstance(new, str) or old is None or new is None:
        return bool(old == new)
    one, other = np.asarray(old, dtype=float), np.asarray(new, dtype=float)
    return one.shape == other.shape and np.allclose(other, one, rtol=precision, atol=0, equal_nan=True)


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= 200 else f"{text[:200]} …"
