"""Errors of a calculation, worded so that the user can correct the input.

TemplateError
    InvalidInputs       wrong inputs, all of them at once, each a `Fault`
    UnknownTemplate     no such template or version in the catalogue
        QuarantinedTemplate     its file has faults
        UnreleasedTemplate      it is the draft of a worksheet
    UnusableFile        a file in a folder of templates or models is broken
    Unreachable         `solve` cannot reach the target within the bounds
    FaultyText          a text that is not a quantity, unit or relation
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from reprlib import Repr
from typing import Any

from templates.core.nearest import nearest

MOST_SUGGESTED = 10
"""Most unknown names of one request that get a suggestion; a thousand of them are not typing errors."""

MOST_LISTED = 100
"""Most names that one sentence lists."""


@dataclass(frozen=True)
class Fault:
    """One fault: the name that it concerns, a code for programs, a sentence with a remedy for people.

    `also` are other names that the sentence mentions: changing one of them may also remove the fault.
    """

    name: str
    code: str
    detail: str
    also: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Return every name that the fault concerns, its own name first."""
        return (self.name, *self.also)

    def within(self, prefix: str) -> Fault:
        """Return the same fault under its name in the enclosing design: `speed` becomes `film.speed`."""
        name, *also = (f"{prefix}.{name}" for name in self.names)
        return replace(self, name=name, also=tuple(also))


class TemplateError(Exception):
    """Base of all errors that templates raise; it pickles with all its attributes."""

    def __reduce__(self) -> tuple[Any, ...]:
        return _remade, (type(self), self.args, vars(self))


def _remade(kind: type[TemplateError], args: tuple[Any, ...], state: dict[str, Any]) -> TemplateError:
    error = kind.__new__(kind, *args)
    vars(error).update(state)
    return error


class InvalidInputs(TemplateError):
    """All wrong inputs of a request, reported at once."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__("; ".join(f"{f.name}: {f.detail}" for f in self.faults))


class UnknownTemplate(TemplateError):
    """The catalogue contains no such template or version."""

    code = "unknown_name"

    def __init__(self, name: str, detail: str) -> None:
        self.name = name
        super().__init__(detail)


class QuarantinedTemplate(UnknownTemplate):
    """The file of this version has faults, so the version cannot be used."""

    code = "quarantined"


class UnreleasedTemplate(UnknownTemplate):
    """The version is a draft worksheet: users can try it, but saved work cannot use it."""

    code = "unreleased"


class UnusableFile(TemplateError):
    """A file of the catalogue cannot be imported, or does not declare what its name states."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path}: {reason}")


class Unreachable(TemplateError):
    """The output cannot reach the target between the bounds, or only jumps across it.

    `reachable` is the range [unit] of the output between the bounds; NaN if it has no value there.
    """

    def __init__(self, name: str, detail: str, reachable: tuple[float, float], unit: str) -> None:
        self.name, self.reachable, self.unit = name, reachable, unit
        super().__init__(detail)


class FaultyText(TemplateError):
    """A text that is not a quantity, unit or relation; `code` names the kind of fault."""

    def __init__(self, code: str, detail: str) -> None:
        self.code = code
        super().__init__(detail)

    def fault(self, name: str) -> Fault:
        """Return the error as a fault of the input `name`."""
        return Fault(name, self.code, str(self))


def unknown_name(name: str, candidates: Iterable[str], kind: str, *, suggests: bool = True) -> Fault:
    """Return a fault for an undeclared name, with the nearest declared name if it `suggests` one."""
    if not suggests:
        return Fault(plain(name), "unknown_name", f"{kind} {plain(name)!r} is unknown")
    near = nearest(name, candidates := list(candidates))
    if (whole := name.replace("radial_clearance", "diametral_clearance")) != name and whole in candidates:
        remedy = f"give {whole}, which is twice the radial clearance"
        return Fault(plain(name), "unknown_name", f"{kind} {plain(name)!r} is unknown; {remedy}")
    remedy = f"did you mean {', '.join(near)}?" if near else f"use one of {listed(candidates)}"
    return Fault(plain(name), "unknown_name", f"{kind} {plain(name)!r} is unknown; {remedy}")


def unknown_names(names: Iterable[str], candidates: Iterable[str], kind: str) -> list[Fault]:
    """Return a fault for each undeclared name; the first ones suggest the nearest declared names."""
    if not (unknown := list(names)):
        return []
    declared = list(candidates)
    return [unknown_name(name, declared, kind, suggests=n < MOST_SUGGESTED) for n, name in enumerate(unknown)]


def listed(names: Sequence[str]) -> str:
    """Return names as a list for a sentence, limited in length."""
    more = f" and {len(names) - MOST_LISTED} more" if len(names) > MOST_LISTED else ""
    return ", ".join(names[:MOST_LISTED]) + more


_brief = Repr()
_brief.maxlevel, _brief.maxlist, _brief.maxdict, _brief.maxstring, _brief.maxother = 2, 3, 3, 60, 60


def excerpt(raw: Any) -> str:
    """Return a short ASCII excerpt of any received value.

    It is short even if the value is long or deeply nested, and valid in JSON.
    """
    if isinstance(raw, int) and raw.bit_length() > 200:
        return "a number of more than 60 digits"
    return ascii(_brief.repr(raw))[1:-1][:80] if not isinstance(raw, str) else ascii(raw[:60])


def plain(name: str, most: int = 80) -> str:
    """Return a received name, shortened and valid in JSON.

    Lone surrogates are escaped, other characters are unchanged.
    """
    return name[:most].encode("utf-8", "backslashreplace").decode("utf-8")
