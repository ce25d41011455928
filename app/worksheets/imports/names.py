"""Convert Mathcad's names to worksheet names of plain letters, each with a single meaning.

The clause `symbol` preserves how a name is printed.
"""

from __future__ import annotations

import re
import unicodedata

from app.worksheets.imports.trees import Node

LONGEST = 40
GREEK = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ϵ": "epsilon", "ζ": "zeta",
    "η": "eta", "θ": "theta", "ϑ": "theta", "ι": "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu",
    "ξ": "xi", "ο": "omicron", "π": "pi_", "ϖ": "pi_", "ρ": "rho", "σ": "sigma", "ς": "sigma", "τ": "tau",
    "υ": "upsilon", "φ": "phi", "ϕ": "phi", "χ": "chi", "ψ": "psi", "ω": "omega",
    "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma",
    "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega", "µ": "mu",
}  # fmt: skip
_OTHER = {"Ø": "dia", "ø": "dia", "∅": "dia", "ß": "ss", "æ": "ae", "Æ": "Ae", "ℓ": "l", "∆": "Delta",
          "'": "_prime", "′": "_prime", "%": "_percent", "∞": "_inf", "ħ": "hbar", "ℏ": "hbar"}  # fmt: skip
_TEX = frozenset(
    letter for letter, name in GREEK.items() if name not in ("pi_", "omicron", "iota", "upsilon")
)


def key_of(node: Node) -> str:
    """Return a name as Mathcad distinguishes names: its letters, with the subscript in braces."""
    letters = []
    for piece in node.pieces:
        if isinstance(piece, str):
            letters.append(piece)
        elif piece.tag == "Subscript":
            letters.append(f"_{{{piece.whole_text}}}")
        else:
            letters.append(key_of(piece))
    return "".join(letters).strip()


def look(key: str) -> str:
    """Return a name as a reader sees it: `f_ck` for `f_{ck}`."""
    return key.replace("{", "").replace("}", "")


class Names:
    """Creates legal and unique names."""

    def __init__(self, reserved: frozenset[str]) -> None:
        self._used = set(reserved)

    def take(self, key: str) -> str:
        """Return a unique name for the Mathcad object `key`; a second object of that name becomes `x_2`."""
        wanted = legal(key)
        count, name = 1, wanted
        while name in self._used:
            count += 1
            name = f"{wanted}_{count}"
        self._used.add(name)
        return name


def legal(key: str) -> str:
    """Return a name of letters, digits and underscores, which begins with a letter."""
    spelled = "".join(_spelled(letter) for letter in look(key))
    plain = re.sub(r"_+", "_", re.sub(r"[^A-Za-z0-9_]+", "_", spelled)).strip("_")[:LONGEST].strip("_")
    if not plain:
        return "x"
    return plain if plain[0].isalpha() else f"x_{plain}"


def _spelled(letter: str) -> str:
    if letter in GREEK:
        return GREEK[letter].rstrip("_") if letter not in "πϖ" else "pi_"
    if letter in _OTHER:
        return _OTHER[letter]
    if letter.isascii():
        return letter
    return unicodedata.normalize("NFKD", letter).encode("ascii", "ignore").decode() or "_"


_SUBSCRIPT = re.compile(r"[A-Za-z0-9,*+ ]{1,20}")


def symbol(key: str) -> str:
    r"""Return LaTeX for a name with its subscript, such as `\sigma_{c2}`; empty if this is impossible."""
    head, _, below = key.partition("_{")
    head, below = head.strip(), below.replace("{", "").replace("}", "")
    letter = f"\\{GREEK[head]}" if head in _TEX else head if re.fullmatch("[A-Za-z]", head) else ""
    if not letter and re.fullmatch("[A-Za-z]{2,20}", head):
        letter = rf"\mathrm{{{head}}}"
    if not letter or (below and not _SUBSCRIPT.fullmatch(below)):
        return ""
    return f"{letter}_{{{below}}}" if below else letter
