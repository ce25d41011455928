"""Create the classes of imported models from the text of their descriptions.

Each process creates a class once. A class is pickled as its text, from which another process creates it
again.
"""

from __future__ import annotations

import copyreg
import json
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from cad.assemblies import assembly_of
from cad.imported_models import NOTHING, Description, Ends, ImportedModel, Parameter, attribute_of
from templates.core.catalogue.modules import IMPORTED
from templates.core.language.declare import given
from templates.core.paper.mathml import named_symbol


def description_of(text: str) -> Description:
    """Parse the text of a description, as `Description.text` returns it."""
    read = json.loads(text)
    read["parameters"] = tuple(Parameter(**one) for one in read["parameters"])
    if "ends" in read:
        read["ends"] = Ends.of(read["ends"])
    if "overlapping" in read:
        read["overlapping"] = tuple((str(one), str(other)) for one, other in read["overlapping"])
    read["findings"] = tuple(read.get("findings", ()))
    if read["program"] == "assembly":
        return assembly_of(read)
    return Description(**read)


def _words(one: Parameter) -> str:
    """Return the words of a parameter.

    For a number without a unit they state what moved in a trial at the import.
    """
    if one.moves == NOTHING:
        return f"{one.words} (moves nothing)"
    return f"{one.words} ({one.role} in mm)" if one.role and one.unit == "1" else one.words


class ImportedClass(type):
    """The metaclass of classes created from descriptions, by which pickle recognises them."""


@lru_cache(maxsize=256)
def class_of(text: str, id: str, version: int) -> type[ImportedModel]:
    """Return the class of a description in this process: one class for each text, id and version."""
    description = description_of(text)
    declared = {
        attribute_of(one.name): given(
            one.unit,
            _words(one),
            name=one.name,
            symbol=named_symbol(one.name),
            default={"value": one.value, "unit": one.unit},
            ge=one.low,
            le=one.high,
        )
        for one in description.parameters
    }
    space = {
        **declared,
        "__module__": f"{IMPORTED}.{id}_v{version}",
        "__doc__": f"{description.title}.",
        "imported": description,
        "sheet": description,
        "example": description.example(),
    }
    cls = ImportedClass("".join(word.capitalize() for word in id.split("_")), description.bases(), space)
    assert issubclass(cls, ImportedModel)
    return cls


def _reduced(cls: Any) -> tuple[Callable[..., Any], tuple[str, str, int]]:
    return class_of, (cls.imported.text, cls.id, cls.version)


copyreg.pickle(ImportedClass, _reduced)
