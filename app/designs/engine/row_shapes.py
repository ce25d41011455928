"""The model of one row: a shape from the values that its cells have in that row."""

from __future__ import annotations

from collections.abc import Mapping

from app.designs.engine.refusals import Refusal, refusal_of
from app.designs.network import Block
from cad.model import CadModel
from templates.core.errors import InvalidInputs
from templates.core.language.spec import Choice


def numbers_of(model: Block) -> list[str]:
    """Return the parameters of a model that the design sets, without the choices among them."""
    return [name for name, cell in model.cells.items() if not isinstance(cell.declared, Choice)]


def shape_of(model: Block, values: Mapping[str, float | list[float]]) -> CadModel | Refusal:
    """Return the model with these values [SI] of `numbers_of`, or a refusal with its faults."""
    words = {name: _word(cell.raw) for name, cell in model.cells.items() if name not in values}
    try:
        shape = model.cls.from_si({**words, **values})
    except InvalidInputs as error:
        return refusal_of([fault.within(model.name) for fault in error.faults])
    assert isinstance(shape, CadModel), "what is measured is a model"
    return shape


def _word(raw: object) -> str:
    return str(raw["value"] if isinstance(raw, dict) else raw)
