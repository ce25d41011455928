"""The checks of a calculation report: every bound and rule of a template, held against its values.

For reports: what must hold, what is, and how much of the allowance is used. Nothing is refused here: a
template that exists has passed the rules that refuse; those that only warn may have been broken.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from templates.core.language.meaning import Bounds, Meaning
from templates.core.language.spec import Declaration, Requirement
from templates.core.language.syntax import returned, syntax
from templates.core.language.template import Template
from templates.core.paper.mathml import Writer, amount, symbol, symbols
from templates.core.paper.report import shown

Kind = Literal["domain", "published", "rule", "warning"]
Scope = Mapping[str, Any]

_OTHERWISE = {ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt}
_SIGNS = {ast.Lt: "<", ast.LtE: r"\le ", ast.Gt: ">", ast.GtE: r"\ge "}
_SMALL = 1e-2
_DEEPEST = 4  # calls that are written out, one within another


@dataclass(frozen=True)
class Check:
    """One bound or rule; `demand` and `numbers` are LaTeX, empty where there is no formula or no one value.

    `used` is the share of the allowance that is used, at the worst point; None where it has no meaning.
    """

    name: str
    words: str
    kind: Kind
    demand: str
    numbers: str
    used: float | None
    holds: bool
    broken: int = 0  # points at which it does not hold
    points: int = 1
    source: str | None = None


@dataclass(frozen=True)
class Side:
    """An inequality written out: its tree, and what its names stand for."""

    node: ast.Compare
    scope: Scope


def checks(template: Template) -> Iterator[Check]:
    """Every bound that says more than a sign, and every rule, as far as their values were calculated."""
    for declared in template.declarations.values():
        value = vars(template).get(declared.attribute)
        if isinstance(value, (float, np.ndarray)) and np.any(np.isfinite(value)):
            yield from _of_bounds(template, declared, declared.meaning.at(template.level), value)
    for rule in template.requirements:
        if template.ledger.missing.isdisjoint(rule.uses) or rule.missing:
            yield _of_rule(template, rule)


def _of_bounds(template: Template, declared: Declaration, meaning: Meaning, value: Any) -> Iterator[Check]:
    kinds: tuple[tuple[Kind, Bounds, Bounds | None], ...] = (
        ("domain", meaning.domain, meaning.domain_si),
        ("published", meaning.published, meaning.published_si),
    )
    for kind, told, si in kinds:
        if si is None or not any((told.gt, told.ge, told.lt is not None, told.le is not None)):
            continue
        known = np.asarray(value)[np.isfinite(value)]
        inside = np.asarray(si.admits(known))
        numbers = shown(template, declared.attribute, {}, absolute=True) if np.ndim(value) == 0 else ""
        yield Check(
            name=declared.name,
            words=meaning.words,
            kind=kind,
            demand=_demanded(symbol(declared), told, meaning.unit),
            numbers=numbers and f"{symbol(declared)}={numbers}",
            used=None if meaning.scale.absolute else _share_of(si, known),
            holds=bool(inside.all()),
            broken=int((~inside).sum()),
            points=known.size,
            source=meaning.source,
        )


def _demanded(letter: str, bounds: Bounds, unit: str) -> str:
    low = bounds.gt if bounds.ge is None else bounds.ge
    high = bounds.lt if bounds.le is None else bounds.le
    before = "" if low is None else amount(low, unit) + ("<" if bounds.ge is None else r"\le ")
    after = "" if high is None else ("<" if bounds.le is None else r"\le ") + amount(high, unit)
    if before and not after and low is not None:
        return letter + (">" if bounds.ge is None else r"\ge ") + amount(low, unit)
    return f"{before}{letter}{after}"


def _share_of(bounds: Bounds, value: Any) -> float | None:
    """The larger share of what a value uses of its lower and its upper limit."""
    highs = [_share(value, limit) for limit in (bounds.lt, bounds.le) if limit is not None]
    lows = [_share(limit, value) for limit in (bounds.gt, bounds.ge) if limit]
    return max((share for share in (*highs, *lows) if share is not None), default=None)


def _share(small: Any, large: Any) -> float | None:
    """What must be the smaller one over the larger one, at the worst point; None unless both are amounts."""
    low, high = np.broadcast_arrays(np.asarray(small, dtype=float), np.asarray(large, dtype=float))
    if low.size == 0 or not (np.isfinite(low).all() and np.isfinite(high).all()):
        return None
    return None if (high <= 0).any() or (low < 0).any() else float(np.max(low / high))


def _of_rule(template: Template, rule: Requirement) -> Check:
    with np.errstate(all="ignore"):
        truth = np.asarray(rule.function(template))
        inequalities = _applying(_inequalities(_body(rule), _scope(template, rule)))
        shares = [_share(*_ordered(one)) for one in inequalities if not _of_a_sign(one.node)]
    written = [_written(template, one) for one in inequalities]
    return Check(
        name=", ".join(rule.names),
        words=rule.sentence,
        kind="warning" if rule.warning else "rule",
        demand=r",\quad ".join(demand for demand, _ in written if demand),
        numbers=r",\quad ".join(numbers for _, numbers in written if numbers),
        used=max((share for share in shares if share is not None), default=None),
        holds=bool(truth.all()),
        broken=int((~truth.astype(bool)).sum()),
        points=truth.size,
    )


def _body(rule: Requirement) -> ast.expr:
    """What a rule returns; a constant where it does more than return."""
    try:
        return returned(rule.function)
    except TypeError:
        return ast.Constant(True)


def _scope(template: Template, rule: Requirement) -> Scope:
    return {**rule.function.__globals__, "self": template}


def _inequalities(node: ast.expr, scope: Scope, depth: int = 0) -> list[list[Side]]:
    """Alternatives, each of inequalities that must hold together; none where the rule is of another kind."""
    match node:
        case ast.Compare(ops=[op]) if type(op) in _SIGNS:
            return [[Side(node, scope)]]
        case ast.BinOp(op=ast.BitAnd(), left=left, right=right):
            both = _inequalities(left, scope, depth), _inequalities(right, scope, depth)
            return [[*first, *second] for first in both[0] for second in both[1]]
        case ast.BinOp(op=ast.BitOr(), left=left, right=right):
            return [*_inequalities(left, scope, depth), *_inequalities(right, scope, depth)]
        case ast.UnaryOp(op=ast.Invert(), operand=ast.Compare(ops=[op]) as inside) if type(op) in _SIGNS:
            opposite = ast.Compare(inside.left, [_OTHERWISE[type(op)]()], inside.comparators)
            return [[Side(opposite, scope)]]
        case ast.IfExp(test=test, body=body, orelse=other):
            return _inequalities(body if np.all(_value(test, scope)) else other, scope, depth)
        case ast.Call() if depth < _DEEPEST:
            called = _inlined(node, scope)
            return _inequalities(*called, depth + 1) if called else []
    return []


def _inlined(call: ast.Call, scope: Scope) -> tuple[ast.expr, Scope] | None:
    """What a called function returns, arguments put in, if it does no more than name values and return."""
    function = scope.get(ast.unparse(call.func))
    try:
        tree = syntax(function)  # type: ignore[arg-type]
        given = dict(zip((p.arg for p in tree.args.args), call.args, strict=True))
    except (TypeError, ValueError, OSError):  # a class or a built-in function
        return None
    for statement in tree.body:
        match statement:
            case ast.Expr(value=ast.Constant()):
                continue
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                given[name] = _Put(given).visit(value)
            case ast.Return(value=ast.expr() as value):
                outer = function.__globals__  # type: ignore[union-attr]
                return _Put(given).visit(value), {**scope, **outer, "self": scope["self"]}
            case _:
                return None
    return None


class _Put(ast.NodeTransformer):
    """Puts arguments in the places of their names; a lambda that is called becomes what it returns."""

    def __init__(self, given: Mapping[str, ast.expr]) -> None:
        self.given = given

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """A call without arguments of a lambda is its body."""
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        given = self.given.get(name)
        return given.body if isinstance(given, ast.Lambda) else self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        """A name is its argument."""
        return self.given.get(node.id, node)


def _applying(alternatives: list[list[Side]]) -> list[Side]:
    """The alternative that speaks of amounts: of several the last, unless an earlier one holds by itself."""
    if any(_holds(side) for together in alternatives[:-1] for side in together):
        return []
    return alternatives[-1] if alternatives else []


def _holds(side: Side) -> bool:
    return bool(np.all(_value(side.node, side.scope)))


def _ordered(side: Side) -> tuple[Any, Any]:
    """Both sides of an inequality, that which must be smaller first."""
    left, right = _value(side.node.left, side.scope), _value(side.node.comparators[0], side.scope)
    return (left, right) if isinstance(side.node.ops[0], (ast.Lt, ast.LtE)) else (right, left)


def _value(node: ast.expr, scope: Scope) -> Any:
    """The value of a piece of a template's own code."""
    code = compile(ast.fix_missing_locations(ast.Expression(node)), "<rule>", "eval")
    return eval(code, dict(scope))


def _written(template: Template, side: Side) -> tuple[str, str]:
    """An inequality with symbols, and with numbers where all its values are single ones."""
    if any(_bare(one) for one in (side.node.left, side.node.comparators[0])):
        return "", ""  # a number in SI without its unit would mislead
    names = symbols(type(template))
    used = {n.attr for n in ast.walk(side.node) if isinstance(n, ast.Attribute)} & names.keys()
    values = {attribute: shown(template, attribute, {}) for attribute in used}
    try:
        demand = _joined(side, names, r"\,")
        return demand, _joined(side, values, r"\cdot ") if all(values.values()) else ""
    except TypeError:  # opaque code: its sentence says what it demands
        return "", ""


def _of_a_sign(node: ast.Compare) -> bool:
    """Whether a side is 0: of such an allowance there is no share."""
    return any(isinstance(one, ast.Constant) and one.value == 0 for one in (node.left, *node.comparators))


def _bare(node: ast.expr) -> bool:
    """Whether a side is a small number by itself, as are lengths in metres."""
    return isinstance(node, ast.Constant) and isinstance(node.value, float) and 0 < node.value < _SMALL


def _joined(side: Side, names: Mapping[str, str], times: str) -> str:
    attributes = {name: (text, 1 if r"\," in text else 3) for name, text in names.items()}
    writer = Writer(side.scope, attributes, {}, times)
    left, right = writer.write(side.node.left)[0], writer.write(side.node.comparators[0])[0]
    return f"{left}{_SIGNS[type(side.node.ops[0])]}{right}"
