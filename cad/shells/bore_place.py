"""Find the split bore of a model, and the support of its solid, for finite elements.

A housing is held by the flat top of its block, where the crankcase continues. A rod is held by the bore of
its small end.
"""

from __future__ import annotations

from cad.imported_models import ImportedModel
from cad.model import CadModel
from cad.shaft import CAST_IRON_MATERIAL, STEEL_MATERIAL, BorePlace
from cad.shells.housing import Housing
from cad.shells.rod import Rod


def has_split_bore(cls: type[CadModel]) -> bool:
    """Return whether a model is a housing or a rod: its `drawn` returns a `Housing` or a `Rod`.

    An assembly based on one of them does not count, because its added parts do not belong to the bore.
    """
    if issubclass(cls, ImportedModel):
        return False
    declared = getattr(getattr(cls, "drawn", None), "__annotations__", {})
    return declared.get("return") in (Housing, Rod, Housing.__name__, Rod.__name__)


def bore_place(shape: CadModel) -> BorePlace | None:
    """Return the split bore of a model; None if it has none."""
    if not has_split_bore(type(shape)):
        return None
    drawn = getattr(shape, "drawn")()  # noqa: B009 - the base of models does not declare it
    if isinstance(drawn, Rod):
        end = drawn.big_end
        return BorePlace(end.bore, end.half_width, drawn.distance, drawn.pin_bore, STEEL_MATERIAL)
    if isinstance(drawn, Housing):
        solids = 4 if drawn.dowel > 0 else 2  # block, cap and dowels, which fill their counterbores
        return BorePlace(drawn.bore, drawn.half_width, drawn.block_height, None, CAST_IRON_MATERIAL, solids)
    return None
