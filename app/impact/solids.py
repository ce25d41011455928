"""The stored measurements of solids, as a calculation process receives them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.designs.engine.calculation import Measures
from app.solids.outputs import Outputs
from app.solids.questions import Question, under_load
from cad.model import CadModel
from cad.regenerate import build_key


@dataclass(frozen=True)
class Solids:
    """Measurements by key of build, and outputs of analyses by key of request; nothing else is known."""

    builds: Mapping[str, Measures] = field(default_factory=dict)
    analyses: Mapping[str, Outputs] = field(default_factory=dict)

    def measured(self, shape: CadModel) -> Measures | None:
        """Return the measurements of a model, if they are available."""
        return self.builds.get(build_key(shape))

    def analysed(self, shape: CadModel, question: Question, wanted: tuple[str, ...]) -> Outputs | None:
        """Return the finite-element results of a model, if all requested results are available."""
        outputs = self.analyses.get(question.key(build_key(shape)), {})
        if not set(wanted) <= outputs.keys():
            return None
        return under_load(question, {name: outputs[name] for name in wanted})
