"""Frozen versions: a digest of the code, some inputs, every result; so a change beneath is caught by its results.

`crankwright freeze` writes the record of a released version once; a test compares for ever after. A file that
exists is never overwritten: a change to a released version is a new version.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from templates.core.catalogue import digest
from templates.core.declare import Given
from templates.core.errors import InvalidInputs
from templates.core.template import Template

STEPS = (0.9, 1.1)  # every numeric input in turn, around the example


def record(cls: type[Template]) -> dict[str, Any]:
    """The golden record of one version: SI inputs and SI results of the example and of steps around it."""
    return {"id": cls.id, "version": cls.version, "digest": digest(cls), "cases": list(_cases(cls))}


def _cases(cls: type[Template]) -> Iterator[dict[str, Any]]:
    example = cls.from_quantities(cls.example).inputs_si()
    yield {"inputs": _plain(example), "outputs": results(cls, example)}
    for name, declared in cls.inputs.items():
        for step in STEPS if isinstance(declared, Given) and not declared.meaning.integer else ():
            inputs = {**example, name: example[name] * step}
            try:
                yield {"inputs": _plain(inputs), "outputs": results(cls, inputs)}
            except InvalidInputs as refusal:
                yield {"inputs": _plain(inputs), "refused": sorted(fault.code for fault in refusal.faults)}


def results(cls: type[Template], inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Every output in SI for SI inputs.

    Raises
    ------
    InvalidInputs
        Where the template refuses.
    """
    template = cls.from_si(inputs)
    with np.errstate(all="ignore"):
        return _plain({name: getattr(template, formula.attribute) for name, formula in cls.formulas.items()})


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: value if isinstance(value, str) else np.asarray(value).tolist()
        for name, value in values.items()
    }
