"""What a drawing takes from a model's declaration: whether it is a shaft, and the limits of its dimensions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from cad.catalogue import models
from cad.drafting.matching import Limits
from cad.header import Header
from cad.model import CadModel


@dataclass(frozen=True)
class Declared:
    """Of a file of nobody, or of a team's model, which other machines lack, it says nothing."""

    is_shaft: bool = False
    limits: Mapping[str, Limits] = field(default_factory=dict)

    @staticmethod
    def of(header: Header | None) -> Declared:
        """What the model of a STEP file declares."""
        if header is None:
            return Declared()
        model = models().versions.get((header.model, header.version))
        return Declared(model is not None and _is_shaft(model), {})


def _is_shaft(model: type[CadModel]) -> bool:
    return model.is_throw() or model.shaft is not CadModel.shaft
