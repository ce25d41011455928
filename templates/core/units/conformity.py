"""Check whether a value fits a declared unit, and suggest what else it may mean.

In a formula every angular speed has its value in rad/s, whatever the unit in which it is typed or shown. A
textbook formula may expect turns for a name given in turns: this gives a remark, because the value differs
by a factor of 2*pi.
"""

from __future__ import annotations

import re
from dataclasses import replace

from templates.core.units.nodes import EITHER, Kind
from templates.core.units.rules import as_difference, in_words, meanings_of
from templates.core.units.units import Unit, compatible, is_rate, radians, registry

_PER_SECOND = registry.Unit("1/s")
_TYPED = re.compile(r"-?[0-9.eE+-]+ \S+")
_MINUTES = re.compile(
    r"(?<![\w.)*/])60(?:\.0*)?\s*\*(?!\*)\s*|\s*(?<!\*)[*/]\s*60(?:\.0*)?(?![\w.(*])(?!\s*\*\*)"
)
_PER = re.compile(r"1\s*/\s*(.+)", re.DOTALL)
_OF_TURNS = re.compile(r"(?:(2)\s*\*\s*)?pi\s*\*\s*(.+)", re.DOTALL)


def misfit(kind: Kind, want: Unit, text: str) -> tuple[str, str] | None:
    """Return the reason why a value does not fit a declared unit, and a remedy; None if it fits.

    Parameters
    ----------
    kind
        The kind of the value.
    want
        The declared unit.
    text
        The expression that gives the value, for the remedy; empty if unknown.
    """
    if not compatible(kind, want):
        return f"this gives {in_words(kind)}", _remedy_of_rates(kind, want, text)
    if is_rate(want.base) and radians(want.base) and not want.plain_angle and not radians(kind.base):
        return f"this gives {in_words(kind)}, which counts neither turns nor radians", _counted(kind, text)
    if want.base != registry.kelvin or want.text == "1":
        return None
    return _other_kind(kind, want, text)


def declared_kind(got: Kind, want: Kind) -> Kind:
    """Return the kind of a declared value: that of its unit, or that of the value if the unit leaves it open.

    A unit leaves the kind open if it is K, or 1/s, which may show rad/s or Hz.
    """
    counts = got.temperatures
    if leaves_rate_open(want) and is_rate(got.base):
        want = replace(want, base=got.base, cycles=got.cycles)
    if want.temperatures != EITHER or counts is None:
        return replace(want, temperatures=want.temperatures if want.temperatures != EITHER else counts)
    return replace(want, temperatures=counts & EITHER or counts)


def leaves_rate_open(want: Kind) -> bool:
    """Return whether a declared unit is 1/s, which may show rad/s or Hz."""
    return bool(want.base == _PER_SECOND) and not want.cycles


def _other_kind(kind: Kind, want: Unit, text: str) -> tuple[str, str] | None:
    counts = kind.temperatures
    if kind.literal and not want.absolute and _TYPED.fullmatch(text):
        if want.difference:
            return "this is a temperature, not a difference", f"write {as_difference(text)}"
        return f"{text} may be a temperature or a difference", f"write {meanings_of(text)}"
    if kind.literal and want.text == "K":
        return "a temperature in degC or degF may be meant as a difference", "write its numbers in K"
    if want.absolute and (counts is None or 1.0 not in counts):
        return "this is a difference of temperatures, or no plain one", "declare it in delta_degC, or in K"
    if want.difference and (counts is None or 0.0 not in counts):
        return "this is a temperature, not a difference", "declare it in degC, or take a difference"
    return None


def _remedy_of_rates(kind: Kind, want: Unit, text: str) -> str:
    if not (is_rate(kind.base) and is_rate(want.base)):
        return ""
    text, minutes = _without_minutes(text)
    if kind.cycles and radians(want.base):
        times = re.sub(r"(?<![\w.])pi(?![\w.])", "2*pi", text)
        return f"Hz counts cycles: {minutes}write {times if kind.pi == 1 else f'2*pi*{_in_brackets(text)}'}"
    if radians(kind.base) and want.cycles:
        return f"Hz counts cycles: {minutes}write {_in_brackets(text)}/(2*pi)"
    return ""


def _counted(kind: Kind, text: str) -> str:
    """Return the possible meanings of a rate in 1/s; one with a factor 2*pi is in radians."""
    if not text:
        return "multiply it by 1 turn or by 1 rad"
    text, minutes = _without_minutes(text)
    if kind.pi > 0:
        return f"{minutes}write {_in_brackets(text)} * 1 rad"
    if per := _PER.fullmatch(text.strip()):
        return f"{minutes}write 1 turn / {per[1]} or 1 rad / {per[1]}"
    return f"{minutes}write {_in_brackets(text)} * 1 turn or {_in_brackets(text)} * 1 rad"


def _without_minutes(text: str) -> tuple[str, str]:
    """Return a product without the factor 60 that formulas in minutes have, and the advice to omit it."""
    bare = _MINUTES.sub("", text) if not re.search(r"[-+,]", text) else text
    return bare, "omit 60, which the units contain, and " if bare != text else ""


def _per_minute(names: list[str], text: str) -> bool:
    """Return whether a formula only divides a speed in turns by 60, as one does who converts rpm."""
    bare, _ = _without_minutes(text)
    return bare != text and bare.strip() in names


def _in_brackets(text: str) -> str:
    text = text.strip()
    return text if re.fullmatch(r"[A-Za-z][A-Za-z0-9_.]*", text) else f"({text})"


def turns_remark(kind: Kind, want: Unit, text: str) -> str:
    """Return both readings of a formula with a speed given in turns; empty if there is only one.

    Parameters
    ----------
    kind
        The kind of the formula's value.
    want
        The unit in which the value is declared.
    text
        The formula.
    """
    names = sorted(kind.turned)
    if names and (not radians(want.base) or kind.pi or _per_minute(names, text)):
        return _both_readings(names, want, text)
    if want.turns and is_rate(want.base) and kind.pi < 0:
        return (
            f"{want.text} only shows a speed that the formula gives in rad/s: omit the factor that "
            "converts radians to turns, such as `30/pi`"
        )
    return ""


def _over(name: str, divisor: str) -> str:
    """Return the text of a name, or of a number with its unit, divided by a divisor."""
    return f"{name} / ({divisor})" if " " in name else f"{name}/({divisor})"


def _both_readings(names: list[str], want: Unit, text: str) -> str:
    which = f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'} given in turns"
    if radians(want.base):
        return f"{which}, but in a formula the value is in rad/s already: omit `2*pi`, `pi/30` or `60`"
    bare, minutes = _without_minutes(text)
    in_turns = bare
    for name in names:
        in_turns = re.sub(rf"(?<![\w.]){re.escape(name)}(?![\w.])", f"({_over(name, '2*pi')})", in_turns)
    plain = _OF_TURNS.fullmatch(bare.strip()) if len(names) == 1 and not re.search(r"[-+,]", text) else None
    same = f", which is {plain[2]}{'' if plain[1] else '/2'}" if plain else ""
    turns = f": {in_turns}{same}" if in_turns != bare else ""
    return (
        f"{which}, but in a formula the value is in rad/s, and {want.text} holds no angle; if the formula "
        f"takes turns, {minutes}write {_over(names[0], '2*pi')} for {names[0]}{turns}; if it takes radians, "
        f"give {names[0]} in rad/s, or write {_over(names[0], '1 rad')}"
    )
