"""Convert analyses, of builds and in designs, to the schemas of the interface."""

from __future__ import annotations

from collections.abc import Mapping

from app.schemas.answers import Version
from app.solids.outputs import StoredOutput
from app.solids.questions import Question, warnings
from app.solids.schemas.analyses import Analysis, AnalysisOutput, ModelAnalysis
from cad.analysis.kinds import SURFACE


def shown(model: Version, build: str, question: Question, outputs: Mapping[str, StoredOutput]) -> Analysis:
    """Return one complete analysis. Outputs that were computed together have one mesh and one time."""
    meshes = [output["mesh"] for output in outputs.values()]
    levels = (output["level"] for output in outputs.values() if output["level"])
    fields = {
        **_fields(build, question, outputs),
        "model": model,
        "build": build,
        "level": next(levels, question.level),
        "mesh": max(meshes, key=lambda mesh: mesh["degrees_of_freedom"], default=None),
        "seconds": sum({output["seconds"] for output in outputs.values()}),
    }
    return Analysis.model_validate(fields)


def in_design(build: str, question: Question, outputs: Mapping[str, StoredOutput]) -> ModelAnalysis:
    """Return an analysis in a revision, without times, so that equal revisions are equal."""
    return ModelAnalysis.model_validate(_fields(build, question, outputs))


def output(stored: StoredOutput) -> AnalysisOutput:
    """Return one output of an analysis, without its time."""
    return AnalysisOutput.model_validate(_timeless(stored))


def _fields(build: str, question: Question, outputs: Mapping[str, StoredOutput]) -> dict[str, object]:
    key = question.key(build)
    return {
        "id": key,
        **question.shown(),
        "outputs": {name: _linked(key, name, _timeless(output)) for name, output in outputs.items()},
        "warnings": warnings(question, outputs),
    }


def _timeless(output: StoredOutput) -> dict[str, object]:
    return {name: part for name, part in output.items() if name != "seconds"}


def _linked(key: str, name: str, output: Mapping[str, object]) -> dict[str, object]:
    """Return an output, with a link if it is a file."""
    return {"url": f"/api/v1/analyses/{key}/{name}", **output} if name == SURFACE else {**output}
