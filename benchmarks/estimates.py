"""Check estimates of times before a calculation: ratio of the estimate to the processor time used.

    python -m benchmarks.estimates levels [template …]
    python -m benchmarks.estimates studies [template …]

`levels` calculates one step at each level with a stated cost, alone and as a table of 4 rows, as `decide`
does for its estimate; the costs of `oil_film_cycle` at level supplied are compared with calculations of other
engines. `studies` runs samples and sensitivities of the example of each template, with the estimates of the
form and the page.

The inputs are the examples with each single quantity multiplied by a random factor. The ratios use processor
time, so that they are valid on a busy machine; one-time loading does not count.
"""

from __future__ import annotations

import sys
import time
from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from typing import Any

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.graph import resolved
from app.pool.cost import level_seconds
from app.studies.chunks import explored
from app.studies.plan import planned
from app.studies.task import Task
from benchmarks import film_cycle_duties, film_cycle_ensemble
from cad.catalogue import models
from templates.core.errors import InvalidInputs, TemplateError
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import accuracy
from templates.core.language.spec import Curve, Table
from templates.core.language.template import Template
from templates.core.units.quantity import read_any
from templates.door import built_in

SEED, COUNT, ROWS = 36, 12, 4
SPREAD = 0.4  # standard deviation of the logarithm of each factor
WITHIN = 3.0
MOST_DRAWN = 200
LONGEST = 40.0  # longest estimated time of a study that is measured [s]
STUDIES = (
    {"method": "sample", "points": 64},
    {"method": "sample", "points": 2000},
    {"method": "sensitivity", "kind": "sobol", "points": 64},
)


def scalable(cls: type[Template]) -> list[str]:
    """Return the inputs of the example that are single quantities, except angles and temperatures."""
    return [
        name for name, raw in cls.example.items() if isinstance(raw, str) and _is_scalable(cls, name, raw)
    ]


def _is_scalable(cls: type[Template], name: str, raw: str) -> bool:
    declared = cls.inputs.get(name)
    if isinstance(declared, Curve | Table) or not hasattr(declared, "meaning"):
        return False
    try:
        typed = read_any(raw)
    except TemplateError:
        return False
    return isinstance(typed.value, int | float) and "deg" not in typed.unit and bool(typed.value)


def drawn(cls: type[Template], random: np.random.Generator, listed: str = "") -> dict[str, Any]:
    """Return the example with random factors on all single quantities; one quantity has several rows."""
    inputs = dict(cls.example)
    for name in scalable(cls):
        typed, rows = read_any(inputs[name]), ROWS if name == listed else 1
        values = (float(typed.value) * np.exp(random.uniform(-SPREAD, SPREAD, rows))).tolist()
        inputs[name] = {"value": values if name == listed else values[0], "unit": typed.unit}
    return inputs


def judged(cls: type[Template]) -> list[str]:
    """Return the outputs in criteria that have a stated error, which `decide` calculates."""
    measured = accuracy(cls)
    texts = " ".join(str(one) for one in cls.criteria.values())
    return [name for name in (measured.outputs if measured else ()) if name in texts] or list(cls.formulas)


def levels(wanted: Collection[str]) -> None:
    """Print how accurate the stated costs of levels are."""
    random = np.random.default_rng(SEED)
    for cls in built_in():
        measured = accuracy(cls) if not wanted or cls.id in wanted else None
        for level in cls.levels if measured else ():
            if (cls.id, level) == ("oil_film_cycle", "supplied"):
                continue  # these marches are kept
            report(f"{cls.id} {cls.version} {level}, alone", list(_ratios(cls, level, "", random)))
            if cls.most_points.get(level, ROWS) >= ROWS:
                listed = _listed(cls, level, random)
                report(
                    f"{cls.id} {cls.version} {level}, {ROWS} rows", list(_ratios(cls, level, listed, random))
                )


def _listed(cls: type[Template], level: str, random: np.random.Generator) -> str:
    """Return the first input that may have several rows."""
    for name in scalable(cls):
        for _ in range(COUNT):
            try:
                evaluate(cls, drawn(cls, random, name), level=level, outputs=judged(cls)[:1])
            except TemplateError:
                continue
            return name
    return ""


def _ratios(cls: type[Template], level: str, listed: str, random: np.random.Generator) -> Iterator[float]:
    """Yield the ratio of estimate to processor time for random inputs that the level accepts."""
    outputs, count = judged(cls), 0
    for _ in range(MOST_DRAWN):
        inputs = drawn(cls, random, listed)
        try:
            usual = evaluate(cls, inputs, outputs=outputs[:1]).template
            expected = level_seconds(usual, inputs, level, outputs)
            begun = time.process_time()
            evaluate(cls, inputs, level=level, outputs=outputs)
        except TemplateError:
            continue
        if count:  # the first run also loads modules
            yield expected / (time.process_time() - begun)
        count += 1
        if count > COUNT:
            return


def marches() -> None:
    """Print how accurate the expected times of level supplied are for engines not used to derive them."""
    lines = film_cycle_ensemble.fresh_engines()
    expected = film_cycle_ensemble.expected_seconds(film_cycle_ensemble.first_duties())["cases"]
    ratios = []
    for line in lines:
        if case := film_cycle_ensemble.case_of(line):
            i, j = film_cycle_duties.band(line["S"], line["b"])
            ratios.append(expected[case][i][j] / line["seconds"])
    report("oil_film_cycle 1 supplied, fresh engines", ratios)


def studies(wanted: Collection[str]) -> None:
    """Print how accurate the estimates of studies are, for the examples of templates."""
    catalogues = Catalogues(built_in(), models())
    every: dict[str, list[float]] = defaultdict(list)
    for cls in built_in():
        for asked in STUDIES if not wanted or cls.id in wanted else ():
            name = f"{asked['method']} {asked['points']}"
            try:
                ratio = _of_study(cls, catalogues, asked)
            except InvalidInputs as error:
                print(f"{cls.id} {cls.version} {name}: {error}"[:150])
                continue
            if ratio is not None:
                every[name].append(ratio[0])
                print(f"{cls.id} {cls.version} {name}: {ratio[0]:.2g} of {ratio[1]:.2g} s", flush=True)
    for name, ratios in every.items():
        report(name, ratios)


def _of_study(
    cls: type[Template], catalogues: Catalogues, asked: dict[str, Any]
) -> tuple[float, float] | None:
    """Return the ratio of estimate to processor time of a study, and that time [s]; None if it is long."""
    places = scalable(cls)[:3]
    if not places:
        return None
    step = {"template": cls.id, "version": cls.version, "inputs": cls.example}
    document = resolved(Document.model_validate({"name": cls.id, "steps": {"step": step}}), catalogues)
    vary = {}
    for place in places:
        typed = read_any(cls.example[place])
        ends = (float(typed.value) * np.exp([-SPREAD / 2, SPREAD / 2])).tolist()
        vary[f"step.{place}"] = {"between": [{"value": end, "unit": typed.unit} for end in ends]}
    outputs = [f"step.{name}" for name in judged(cls)[:3] if name in single(cls)] or [
        f"step.{single(cls)[0]}"
    ]
    body = {"design": "x", "vary": vary, "outputs": outputs, "seed": SEED, **asked}
    plain = document.model_dump(mode="json", by_alias=True)
    task = Task.of(plain, body, list(vary), {}, catalogues)
    plan, _ = planned(task, None, 0.0)
    if plan.seconds > LONGEST:
        print(f"{cls.id} {cls.version} {asked['method']}: estimated {plan.seconds:.2g} s, not run")
        return None
    begun = time.process_time()
    for first in range(0, plan.rows, plan.chunk):
        explored(task, first, min(first + plan.chunk, plan.rows), plan.levels, tuple(plan.criteria))
    seconds = time.process_time() - begun
    return plan.seconds / seconds, seconds


def single(cls: type[Template]) -> list[str]:
    """Return the outputs that are single numbers."""
    return [name for name, formula in cls.formulas.items() if type(formula).__name__ == "Formula"]


def report(name: str, ratios: Sequence[float]) -> None:
    """Print the share of estimates within the factor, and their range."""
    r = np.array(ratios)
    if not r.size:
        print(f"{name}: none")
        return
    inside = np.mean((r < WITHIN) & (r > 1 / WITHIN))
    spread = f"median {np.median(r):.2g}, {r.min():.2g} … {r.max():.2g}"
    print(f"{name}: n {r.size}, within {WITHIN:g}: {inside:.0%}, {spread}", flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "levels":
        levels(sys.argv[2:])
        marches()
    else:
        studies(sys.argv[2:])
