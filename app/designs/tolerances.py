"""Warn about tolerances that no calculation uses: of a design's own parameters, and of its models.

A step warns about tolerances of its own inputs. A tolerance of a model parameter only appears in the STEP
file, on the faces that have the dimension.
"""

from __future__ import annotations

from app.plain import JsonObject
from app.schemas.answers import Warning
from templates.core.language.ledger import Notice
from templates.core.language.tolerances import DETAIL, unused

OF_A_MODEL = (
    "the solid is built at the value; its STEP file states the tolerance, if a face of the model carries "
    f"this dimension; {DETAIL.partition('; ')[2]}"
)


def warnings(document: JsonObject) -> list[Warning]:
    """Return a warning for every parameter in a design's document that has `plus` or `minus`."""
    listed = list(map(_warning, unused(document["parameters"])))
    for name, model in document["models"].items():
        listed += (
            Warning(code=notice.code, name=f"{name}.{notice.name}", detail=OF_A_MODEL)
            for notice in unused(model["parameters"])
        )
    return listed


def _warning(notice: Notice) -> Warning:
    return Warning(code=notice.code, name=notice.name, detail=notice.detail)
