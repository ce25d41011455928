"""The variant of a design that a study uses: its document, and the patch that a chosen row makes."""

from __future__ import annotations

from app.designs.document import Document
from app.designs.variants.names import BASE
from app.designs.variants.table import applied
from app.plain import JsonObject
from templates.core.errors import Fault, InvalidInputs, excerpt, listed


def document_of(document: JsonObject, variant: str | None) -> JsonObject:
    """Return the document with a variant applied, and without variants; unchanged for the design itself.

    Raises
    ------
    InvalidInputs
        If the revision has no variant with this name.
    """
    if variant is None or variant == BASE:
        return document
    read = Document.model_validate(document)
    if variant not in read.variants:
        raise InvalidInputs([Fault("variant", "unknown_name", _unknown(variant, [*read.variants]))])
    own: JsonObject = applied(read, read.variants[variant]).model_dump(mode="json")
    return own


def _unknown(variant: str, names: list[str]) -> str:
    if not names:
        return f"the design has no variant {excerpt(variant)}; it has none, so omit `variant`"
    return f"the design has no variant {excerpt(variant)}; its variants are {listed(names)}"


def within(patch: JsonObject, variant: str | None) -> JsonObject:
    """Return a merge patch of parameters, inputs and model parameters as a patch of a variant."""
    if variant is None or variant == BASE:
        return patch
    values = dict(patch.get("parameters", {}))
    for group, part in (("steps", "inputs"), ("models", "parameters")):
        for block, changes in patch.get(group, {}).items():
            values |= {f"{block}.{name}": value for name, value in changes[part].items()}
    return {"variants": {variant: values}}
