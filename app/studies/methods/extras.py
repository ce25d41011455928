"""Packages of the extra `study`, imported only when a method needs them: this takes half a second."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from templates.core.errors import Fault, InvalidInputs


def extra(module: str) -> ModuleType:
    """Return a module of SALib or pymoo.

    Raises
    ------
    InvalidInputs
        If the package is missing; the code is `not_installed`.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        if (error.name or "").partition(".")[0] != package:
            raise
        detail = f"this method needs {package}: pip install 'crankwright[study]' on the server"
        raise InvalidInputs([Fault("method", "not_installed", detail)]) from None
