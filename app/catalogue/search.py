"""Search templates by engineering terms: standards, authors, symbols, textbook names.

A template matches by its title, its documentation with the references, and the names, words, symbols and
sources of its declarations. `TERMS` lists textbook names of quantities that are defined differently here,
each with the conversion factor.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar
from weakref import WeakKeyDictionary

from templates.core.language.template import Template

T = TypeVar("T", bound=Template)


@dataclass(frozen=True)
class Term:
    """Textbook names, the words in templates that they mean, and a note on how the definitions differ."""

    names: tuple[str, ...]
    means: str
    note: str


TERMS = (
    Term(
        ("sommerfeld", "raimondi", "boyd", "shigley", "bearing characteristic number"),
        "sommerfeld number",
        "Two numbers bear Sommerfeld's name. ISO 7902 and DIN 31652, and the templates: So = F psi^2 / (D B"
        " eta omega). Raimondi and Boyd, and Shigley: S = (r/c)^2 mu N / P with N in rev/s and c the radial"
        " clearance. S = 1/(2 pi So).",
    ),
    Term(("din 31652", "din iso 7902"), "iso 7902", "DIN 31652:1983 has the method of ISO 7902:1998."),
    Term(("petroff",), "petrov", "Petroff is another spelling of Petrov."),
    Term(
        ("hersey",),
        "duty parameter",
        "Hersey's number is eta N / P with N in revolutions. The templates give Stribeck's duty parameter eta"
        " omega / p, which is 2 pi times as large.",
    ),
    Term(("dubois",), "ocvirk", "DuBois and Ocvirk solved the short bearing."),
    Term(
        ("kingsbury",), "thrust", "Kingsbury's and Michell's bearings are thrust bearings with tilting pads."
    ),
    Term(
        ("roller bearing", "roller bearings", "ball bearing", "ball bearings", "lundberg", "palmgren"),
        "rolling bearing",
        "Lundberg and Palmgren: the life of rolling bearings, as in ISO 281.",
    ),
    Term(("palmgren",), "rainflow", "Palmgren and Miner: damage adds up in proportion to the cycles."),
    Term(
        ("wohler", "woehler", "s n curve", "sn curve"),
        "basquin",
        "A Wöhler curve, or S-N curve, states the life over the stress; Basquin's line is one.",
    ),
    Term(
        ("haigh",),
        "goodman",
        "A Haigh diagram shows the amplitude over the mean stress; Goodman's line is one.",
    ),
)

_texts: WeakKeyDictionary[type[Template], str] = WeakKeyDictionary()


def matching(versions: Iterable[type[T]], query: str) -> tuple[list[type[T]], list[str]]:
    """Return the versions that match a query, and notes on its terms.

    Every word of the query must occur in a version. A word of up to two letters, such as a symbol, must
    match a whole word; a longer word must match the beginning of a word.
    """
    asked = plain_words(query)
    terms = [term for term in TERMS if any(_has(asked, name) for name in term.names)]
    means = [asked, *(term.means for term in terms)]
    kept = [cls for cls in versions if any(_fits(_text(cls), words) for words in means if words)]
    return kept, [term.note for term in terms]


def plain_words(text: str) -> str:
    """Return a text in lower case, with words and numbers separated and Greek letters spelled out."""
    spelled = "".join(map(_spelled, unicodedata.normalize("NFKD", text[:20_000])))
    return " ".join(re.findall(r"[a-z]+|[0-9]+", spelled.casefold()))


@lru_cache(maxsize=1024)
def _spelled(sign: str) -> str:
    if sign.isascii() or not unicodedata.name(sign, "").startswith("GREEK"):
        return "" if unicodedata.combining(sign) else sign
    letter = unicodedata.name(sign).rpartition("LETTER ")[2].split(" ")[0].lower()
    return f" {'lambda' if letter == 'lamda' else letter} "


def _has(asked: str, name: str) -> bool:
    return f" {name} " in f" {asked} "


def _fits(text: str, words: str) -> bool:
    return all((f" {word} " if len(word) < 3 else f" {word}") in text for word in words.split())


def _text(cls: type[Template]) -> str:
    """Return all searchable words of a version; they depend only on its class."""
    if (text := _texts.get(cls)) is None:
        parts = [cls.id, cls.title(), cls.summary(), cls.__doc__ or ""]
        for declared in (*cls.inputs.values(), *cls.formulas.values()):
            meaning = declared.meaning
            also = meaning.also
            parts += [declared.name, meaning.words, meaning.symbol or "", str(meaning.source or ""), *also]
        text = _texts[cls] = f" {' '.join(map(plain_words, parts))} "
    return text
