"""Function calls: the user's functions, Mathcad's own functions, and interpolation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.worksheets.imports import functions
from app.worksheets.imports.errors import Unnamed, Untranslatable
from app.worksheets.imports.names import key_of
from app.worksheets.imports.scope import Choice, FailedName, Function, InlineTerm, Range, Scope, Value
from app.worksheets.imports.terms import ATOM, LOOSE, PRODUCT, SUM, Term, binary, called, number, reduced
from app.worksheets.imports.trees import Node
from app.worksheets.imports.writer import MOST_INLINED, Writer


class Calls(Writer):
    """Writes function calls."""

    def call(self, operator: Node, arguments: list[Node]) -> Term:
        """Return a call of a function by its name."""
        key = key_of(operator)
        meant = self.scope.get(key)
        match meant:
            case Function():
                return self._own(meant, arguments)
            case FailedName(region):
                raise Unnamed(key, region)
            case Value() | Range() | InlineTerm() | Choice():
                raise Untranslatable("the called name is not a function", "write a product with `*`")
        if key in functions.REFUSED:
            raise Untranslatable(
                functions.REFUSED[key], "write the formula by hand, or give its value as an input"
            )
        if key == "if" and len(arguments) == 3:
            return self.either(self.condition(arguments[0]), arguments[1], arguments[2])
        if key == "linterp" and len(arguments) == 3:
            return self._interpolated(arguments)
        parts = [self.argument(part) for part in arguments]
        return self._builtin(key, parts)

    def _builtin(self, key: str, parts: list[Term]) -> Term:
        if key in ("min", "max"):
            return self._extreme(key, parts)
        if key in functions.COUNTS and len(parts) == 1:
            return self._count(key, parts[0])
        if key == "log" and len(parts) <= 2:
            base = [called("log", parts[1])] if len(parts) == 2 else []
            return (
                binary(called("log", parts[0]), "/", base[0], PRODUCT) if base else called("log10", parts[0])
            )
        if key in functions.SAME and len(parts) == 1:
            return called(functions.SAME[key], parts[0])
        pattern = functions.WRITTEN_OUT.get(key)
        if pattern is not None and len(parts) == pattern.count("{1}") // max(pattern.count("{1}"), 1) + 1:
            return _filled(pattern, parts).shaped(*parts)
        pattern = functions.OVER_LISTS.get(key)
        if pattern is not None and parts and len(parts) == (2 if "{1}" in pattern else 1):
            if key == "mean" and parts[0].axis is None:
                return parts[0]
            if any(part.axis is None for part in parts):
                raise Untranslatable(f"{key} needs a list", "give it a list")
            parts[0].shaped(*parts)
            return _filled(pattern, parts)
        if key in ("sum", "cnt"):
            return reduced("sum", parts[0])
        raise Unnamed(key)

    def _extreme(self, key: str, parts: list[Term]) -> Term:
        if any(part.is_vector for part in parts) and not (self.is_vectorised and len(parts) > 1):
            parts = [reduced(key, part) if part.is_vector else part for part in parts]
            return parts[0] if len(parts) == 1 else called(key, *parts)
        return parts[0] if len(parts) == 1 and parts[0].axis is None else called(key, *parts)

    def _count(self, key: str, part: Term) -> Term:
        if part.axis is None or part.is_row:
            raise Untranslatable("the formula uses the size of a matrix", "write the number")
        count = part.axis.length
        return number(count + part.axis.start - 1 if key == "last" else count)

    def _interpolated(self, arguments: list[Node]) -> Term:
        literal = replace(self, keep=None)
        across, up = (literal.quantity(part) or literal.term(part) for part in arguments[:2])
        at = self.quantity(arguments[2]) or self.term(arguments[2])
        if across.axis is None or up.axis is None or at.is_vector:
            raise Untranslatable("the arguments of an interpolation must be lists", "write a curve")
        return called(self.sheet.curve(across, up), at)

    def _own(self, function: Function, arguments: list[Node]) -> Term:
        if len(arguments) != len(function.parameters):
            raise Untranslatable(
                "the call has the wrong number of arguments", "call it with the arguments of its definition"
            )
        if self.depth >= MOST_INLINED:
            raise Untranslatable(
                f"function calls are nested more than {MOST_INLINED} levels deep", "name each step"
            )
        parts = [self.argument(part) for part in arguments]
        if not any(part.is_vector and not self.is_vectorised for part in parts):
            name = self.sheet.function(function, parts)
            if name is not None:
                return called(name, *parts) if parts else Term(name)
        return self._written_out(function, parts)

    def _written_out(self, function: Function, parts: list[Term]) -> Term:
        """Return the body of a function with its parameters replaced by the arguments."""
        inner: Scope = dict(function.scope)
        for key, part in zip(function.parameters, parts, strict=True):
            inner[key] = InlineTerm(part)
        return replace(self, scope=inner, depth=self.depth + 1).term(function.body)


def _filled(pattern: str, parts: Sequence[Term]) -> Term:
    texts = [part.bound(ATOM) for part in parts]
    return Term(pattern.format(*texts), LOOSE if pattern.startswith("if") else SUM)
