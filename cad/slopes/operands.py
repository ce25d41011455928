"""The operands of a model's Boolean operations: a build without the operations takes a hundredth of the time.

Every face of a solid lies on a face of an operand. So the operands tell how the faces move with a parameter.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from OCP.BRep import BRep_Builder
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape

from cad.model import CadModel, Part

_OPERATIONS = ("BOPAlgo_BOP", "BRepAlgoAPI_Cut", "BRepAlgoAPI_Fuse", "BRepAlgoAPI_Common")
"""The kernel's classes through which CadQuery cuts, fuses and intersects."""


class _Operation:
    """A Boolean operation whose result is a compound of its operands; it ignores all options."""

    def __init__(self, *_: object) -> None:
        self._shapes: list[TopoDS_Shape] = []

    def AddArgument(self, shape: TopoDS_Shape) -> None:
        self._shapes.append(shape)

    def SetArguments(self, listed: Iterable[TopoDS_Shape]) -> None:
        self._shapes += listed

    AddTool, SetTools = AddArgument, SetArguments

    def Shape(self) -> TopoDS_Shape:
        compound, builder = TopoDS_Compound(), BRep_Builder()
        builder.MakeCompound(compound)
        for shape in self._shapes:
            builder.Add(compound, shape)
        return compound

    def __getattr__(self, name: str) -> Any:
        return lambda *_, **__: None


def operands(model: CadModel) -> tuple[Part, ...]:
    """Return the parts of a model; the shape of each is a compound of the operands of its operations."""
    with _without_operations():
        return model.build()


@contextmanager
def _without_operations() -> Iterator[None]:
    """Replace the kernel's operations in CadQuery; the process must not draw in another thread meanwhile."""
    from cadquery.occ_impl import shapes  # at the head it might be a placeholder (`cad.on_demand`)

    kernel = {name: getattr(shapes, name) for name in _OPERATIONS}
    try:
        for name in _OPERATIONS:
            setattr(shapes, name, _Operation)
        yield
    finally:
        for name, operation in kernel.items():
            setattr(shapes, name, operation)
