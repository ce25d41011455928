"""All checks of a template class, ordered so that one cause gives one fault."""

from __future__ import annotations

from pathlib import Path

from templates.core.checks.behaviour import faults_of_behaviour, faults_of_example
from templates.core.checks.faults import FileFault
from templates.core.checks.golden import faults_of_release
from templates.core.checks.structure import faults_of_structure
from templates.core.language.template import Template


def faults_of(cls: type[Template], path: Path | None) -> list[FileFault]:
    """Return every fault of the template or model declared by the file at `path` or by a worksheet."""
    if faults := list(faults_of_structure(cls)):
        return faults
    if faults := list(faults_of_example(cls)):
        return faults
    release = faults_of_release(cls, path) if path else ()
    return [*faults_of_behaviour(cls), *release]
