"""Golden records of released versions: the digest of the code, some inputs, and every result.

`crankwright freeze` writes the record of a released version once. From then on a test compares the results
with the record. An existing record is never overwritten: a changed calculation needs a new version.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from templates.core.catalogue.digests import digest, release_file
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import is_reported
from templates.core.language.spec import Choice, Input
from templates.core.language.template import Template

STEPS = (0.9, 1.1)  # factors applied to each numeric input of the example in turn
DIGITS = 3  # significant digits recorded beyond the precision of the comparison


def record(cls: type[Template], more: Iterable[Mapping[str, Any]] = ()) -> dict[str, Any]:
    """Return the golden record of one version: SI inputs and SI results of the example and its variations.

    Parameters
    ----------
    cls
        The version.
    more
        Further cases. Each gives its `level`, and under `inputs` the quantities that differ from the example.
    """
    return {
        "id": cls.id,
        "version": cls.version,
        "digest": digest(cls),
        "precision": cls.precision,
        "cases": list(_cases(cls)),
        "levels": [*cases_of_levels(cls), *(_case(cls, about["inputs"], about["level"]) for about in more)],
    }


def codes(refusal: InvalidInputs) -> list[str]:
    """Return the codes of the faults for which inputs are refused, each code once.

    The record does not state how many faults have the same cause.
    """
    return sorted({fault.code for fault in refusal.faults})


def golden_file(cls: type[Template], folder: Path) -> Path:
    """Return the path of the record of a version."""
    return folder / f"{cls.id}_v{cls.version}.json"


def freeze(cls: type[Template], folder: Path) -> Path:
    """Write the golden record of a version, and the digest file next to its source; return the record's path.

    Further cases are read from the file in the folder `more` that has the name of the record.

    Raises
    ------
    FileExistsError
        If a record of the version exists already.
    """
    path = golden_file(cls, folder)
    further = folder / "more" / path.name
    more = json.loads(further.read_text(encoding="utf-8")) if further.exists() else []
    text = _as_text(record(cls, more))
    folder.mkdir(parents=True, exist_ok=True)
    with path.open("x", encoding="utf-8") as file:
        file.write(text)
    mark_released(cls)
    return path


def _as_text(content: Mapping[str, Any]) -> str:
    """Return a record as JSON with one line per case.

    Numbers have `DIGITS` more digits than the comparison needs.
    """
    lists = {name: value for name, value in content.items() if isinstance(value, list)}
    parts = [f"{_json(name)}: {_json(value)}" for name, value in content.items() if name not in lists]
    for name, cases in lists.items():
        lines = [_json(_shortened(case, content["precision"])) for case in cases]
        parts.append(f"{_json(name)}: [" + ",".join(f"\n {line}" for line in lines) + "\n]")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def _shortened(case: Mapping[str, Any], precision: float) -> dict[str, Any]:
    """Return a case with its outputs rounded to the digits that the comparison needs."""
    digits = DIGITS - math.floor(math.log10(case.get("precision", precision)))
    return {**case, "outputs": _to(digits, case["outputs"])} if "outputs" in case else dict(case)


def _to(digits: int, value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _to(digits, one) for name, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_to(digits, one) for one in value]
    return float(f"{value:.{digits}g}") if isinstance(value, float) else value


def mark_released(cls: type[Template]) -> Path | None:
    """Write the digest of a version next to its file, where the service reads it; never overwrite a digest.

    A worksheet has no file: its release is stored with its text.
    """
    path = release_file(cls)
    if path and not path.exists():
        path.write_text(json.dumps({"digest": digest(cls)}) + "\n", encoding="utf-8")
    return path


def _cases(cls: type[Template]) -> Iterator[dict[str, Any]]:
    example = _given(cls)
    yield {"inputs": _plain(example), "outputs": results(cls, example)}
    for name, declared in cls.inputs.items():
        for value in _steps(declared, example.get(name)):
            inputs = {**example, name: value}
            try:
                yield {"inputs": _plain(inputs), "outputs": results(cls, inputs)}
            except InvalidInputs as refusal:
                yield {"inputs": _plain(inputs), "refused": codes(refusal)}


def cases_of_levels(cls: type[Template]) -> Iterator[dict[str, Any]]:
    """Yield the example at every level except the default level, which the other cases use."""
    yield from (_case(cls, {}, level) for level in cls.levels if level != cls.default_level)


def _case(cls: type[Template], others: Mapping[str, Any], level: str) -> dict[str, Any]:
    """Return the example at a level with some quantities replaced."""
    inputs = _given(cls, others)
    case: dict[str, Any] = {"level": level, "inputs": _plain(inputs)}
    if level in cls.level_precision:
        case["precision"] = cls.level_precision[level]
    try:
        return {**case, "outputs": results(cls, inputs, level)}
    except InvalidInputs as refusal:
        return {**case, "refused": codes(refusal)}


def _given(cls: type[Template], others: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the example's inputs in SI with defaults, except missing ones and those that are outputs."""
    template = cls.from_quantities({**cls.example, **(others or {})})
    reported = {name: declared for name, declared in cls.inputs.items() if is_reported(template, declared)}
    return {name: getattr(template, declared.attribute) for name, declared in reported.items()}


def _steps(declared: Input, value: Any) -> list[Any]:
    """Return alternative values of one input: other options, one more or less, or 10 % below and above."""
    if value is None or isinstance(value, tuple):
        return []
    if isinstance(declared, Choice):
        return [option for option in declared.options if option != value]
    if declared.meaning.integer:
        return [value - 1, value + 1]
    return [value * step for step in STEPS]


def results(cls: type[Template], inputs: Mapping[str, Any], level: str = "") -> dict[str, Any]:
    """Return every output in SI for SI inputs, at the default level unless another is named.

    Raises
    ------
    InvalidInputs
        If the template refuses the inputs.
    """
    template = cls.from_si(inputs)
    template = template.at(level) if level else template
    with np.errstate(all="ignore"):
        return _plain({name: getattr(template, formula.attribute) for name, formula in cls.formulas.items()})


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: value if isinstance(value, (str, tuple)) else _without_nan(np.asarray(value))
        for name, value in values.items()
    }


def _without_nan(value: NDArray[Any]) -> Any:
    """Return an array as JSON, with null for NaN."""
    plain = value.astype(object)
    plain[np.isnan(value)] = None
    return plain.tolist()
